// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "evaluate_masks.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "vantage/base/file.h"
#include "vantage/base/text.h"
#include "vantage/metrics/mask_evaluation.h"
#include "vantage/metrics/mask_measures.h"
#include "vantage/video/sequence.h"

namespace vantage::app {
namespace {

namespace fs = std::filesystem;

struct Flags {
  std::vector<fs::path> truth, masks;  // pairs
  std::string frames;
  fs::path counts_file;
  MaskEvaluationOptions options;
};

struct Column {
  const char* name;
  double MaskMeasures::*value;
  const char* definition;
};
constexpr std::array<Column, 8> kColumns = {{
    {"recall", &MaskMeasures::recall, "TP / (TP + FN)"},
    {"precision", &MaskMeasures::precision, "TP / (TP + FP)"},
    {"f1", &MaskMeasures::f1, "2 TP / (2 TP + FP + FN)"},
    {"specificity", &MaskMeasures::specificity, "TN / (TN + FP)"},
    {"fpr", &MaskMeasures::fpr, "FP / (FP + TN)"},
    {"fnr", &MaskMeasures::fnr, "FN / (TP + FN)"},
    {"pwc", &MaskMeasures::pwc, "wrong pixels, % of all that count"},
    {"shadow_fpr", &MaskMeasures::shadow_fpr, "shadow taken for foreground / shadow"},
}};

/// One sequence with its masks, and what comes of comparing them.
struct Comparison {
  std::string name;
  fs::path masks;
  TruthSequence truth;
  std::vector<MaskFrameCounts> frames;
  MaskCounts counts;
  MaskMeasures measures;
};

/// FIRST:LAST
Status ParseFrames(const std::string& text, MaskEvaluationOptions& options) {
  if (text.empty()) return {};
  const std::vector<std::string_view> numbers = Fields(text, ':');
  if (numbers.size() != 2 || !ParseNumber(numbers[0], options.first_frame) ||
      !ParseNumber(numbers[1], options.last_frame) || options.first_frame < 0 ||
      options.last_frame < options.first_frame) {
    return Fail(
        "--frames: '{}' is not FIRST:LAST, the first and the last frame that count, from 0, as in "
        "150:257",
        text);
  }
  return {};
}

/// The sequences of one --truth with their masks: itself, or those in it by their paths.
Status AddComparisons(const fs::path& truth, const fs::path& masks,
                      std::vector<Comparison>& comparisons) {
  std::vector<fs::path> folders = FindSequences(truth);
  if (folders.empty()) folders = {truth};  // a plain folder of truth masks
  for (const fs::path& folder : folders) {
    Comparison& comparison = comparisons.emplace_back();
    if (folder == truth) {
      std::error_code code;
      comparison.name = fs::canonical(truth, code).filename().string();
      comparison.masks = masks;
    } else {
      const fs::path inside = folder.lexically_relative(truth);
      comparison.name = inside.string();
      comparison.masks = masks / inside;
      std::error_code code;
      if (!fs::exists(comparison.masks, code)) {
        return Fail(
            "{}: no such folder; each of the {} sequences in {} needs its masks under the "
            "same name",
            comparison.masks.string(), folders.size(), truth.string());
      }
    }
    VANTAGE_ASSIGN_OR_RETURN(comparison.truth, OpenTruth(folder));
  }
  return {};
}

/// NaN, a ratio of nothing, is "-".
std::string Text(double value) { return std::isnan(value) ? "-" : fmt::format("{:.4f}", value); }

nlohmann::ordered_json ToJson(const MaskCounts& counts) {
  return {{"frames", counts.frames},
          {"tp", counts.true_positives},
          {"fp", counts.false_positives},
          {"fn", counts.false_negatives},
          {"tn", counts.true_negatives},
          {"shadow_px", counts.shadow_px},
          {"shadow_fp", counts.shadow_false_positives}};
}

void AddMeasures(const MaskMeasures& measures, nlohmann::ordered_json& json) {
  for (const Column& column : kColumns) json[column.name] = measures.*column.value;
}

struct Together {
  MaskCounts sum;
  MaskMeasures mean_of_sequences, of_sum;
};

void PrintJson(const std::vector<Comparison>& comparisons, const Together& together) {
  nlohmann::ordered_json json;
  json["sequences"] = nlohmann::ordered_json::array();
  for (const Comparison& comparison : comparisons) {
    nlohmann::ordered_json one = {{"name", comparison.name},
                                  {"truth", comparison.truth.folder.string()},
                                  {"masks", comparison.masks.string()},
                                  {"first_frame", comparison.frames.front().frame},
                                  {"last_frame", comparison.frames.back().frame},
                                  {"frames_without_truth", comparison.truth.frames_without_truth},
                                  {"notes", comparison.truth.notes}};
    one.update(ToJson(comparison.counts));
    AddMeasures(comparison.measures, one);
    json["sequences"].push_back(std::move(one));
  }
  AddMeasures(together.mean_of_sequences, json["mean"]);
  json["sum"] = ToJson(together.sum);
  AddMeasures(together.of_sum, json["sum"]);
  fmt::print("{}\n", json.dump(2));
}

void PrintOne(const Comparison& comparison) {
  std::vector<ReportRow> rows;
  for (const std::string& note : comparison.truth.notes) rows.push_back({"note", note});
  const auto add_count = [&](const char* name, std::int64_t value, const std::string& definition) {
    rows.push_back({name, fmt::format("{:>11}  {}", value, definition)});
  };
  const MaskCounts& counts = comparison.counts;
  add_count("frames", counts.frames,
            fmt::format("that count, from {} to {}", comparison.frames.front().frame,
                        comparison.frames.back().frame));
  add_count("tp", counts.true_positives, "pixels: moving, foreground");
  add_count("fp", counts.false_positives, "static or shadow, foreground");
  add_count("fn", counts.false_negatives, "moving, background");
  add_count("tn", counts.true_negatives, "static or shadow, background");
  add_count("shadow_fp", counts.shadow_false_positives, "shadow, foreground");
  for (const Column& column : kColumns) {
    rows.push_back({column.name, fmt::format("{:>11}  {}", Text(comparison.measures.*column.value),
                                             column.definition)});
  }
  PrintTable(rows);
}

void PrintSeveral(const std::vector<Comparison>& comparisons, const Together& together) {
  std::vector<ReportRow> rows;
  const auto row = [](const std::string& frames, const MaskMeasures& measures) {
    std::string line = fmt::format("{:>7}", frames);
    for (const Column& column : kColumns) {
      line += fmt::format("  {:>{}}", Text(measures.*column.value),
                          std::max<std::size_t>(7, std::string_view(column.name).size()));
    }
    return line;
  };
  std::string head = fmt::format("{:>7}", "frames");
  for (const Column& column : kColumns) head += fmt::format("  {:>7}", column.name);
  rows.push_back({"sequence", head});
  for (const Comparison& comparison : comparisons) {
    rows.push_back(
        {comparison.name, row(fmt::to_string(comparison.counts.frames), comparison.measures)});
  }
  rows.push_back({"mean", row("", together.mean_of_sequences)});
  rows.push_back({"sum", row(fmt::to_string(together.sum.frames), together.of_sum)});
  PrintTable(rows);
  for (const Comparison& comparison : comparisons) {
    for (const std::string& note : comparison.truth.notes) {
      fmt::print("note: {}: {}\n", comparison.name, note);
    }
  }
  fmt::print("mean: of the sequences' measures; sum: from the pixels of all sequences\n");
}

Status WriteCounts(const fs::path& path, const std::vector<Comparison>& comparisons) {
  std::string text = "sequence,frame,tp,fp,fn,tn,shadow_px,shadow_fp\n";
  for (const Comparison& comparison : comparisons) {
    for (const auto& [frame, counts] : comparison.frames) {
      text += fmt::format("{},{},{},{},{},{},{},{}\n", comparison.name, frame,
                          counts.true_positives, counts.false_positives, counts.false_negatives,
                          counts.true_negatives, counts.shadow_px, counts.shadow_false_positives);
    }
  }
  return WriteTextFile(path, text);
}

Status EvaluateMaskFolders(Flags flags, const CommonFlags& common) {
  VANTAGE_RETURN_IF_ERROR(ParseFrames(flags.frames, flags.options));
  if (flags.truth.size() != flags.masks.size()) {
    return Fail("--truth is given {} times for {} folders of masks; each needs its own",
                flags.truth.size(), flags.masks.size());
  }
  std::vector<Comparison> comparisons;
  for (std::size_t i = 0; i < flags.truth.size(); ++i) {
    VANTAGE_RETURN_IF_ERROR(AddComparisons(flags.truth[i], flags.masks[i], comparisons));
  }
  Together together;
  std::vector<MaskMeasures> measures;
  for (Comparison& comparison : comparisons) {
    const RunControl control = MakeRunControl(common, comparison.name, "frames");
    VANTAGE_ASSIGN_OR_RETURN(comparison.frames, EvaluateMasks(comparison.truth, comparison.masks,
                                                              flags.options, control));
    comparison.counts = SumOf(comparison.frames);
    comparison.measures = MeasureMasks(comparison.counts);
    together.sum += comparison.counts;
    measures.push_back(comparison.measures);
  }
  together.of_sum = MeasureMasks(together.sum);
  together.mean_of_sequences = MeanOf(measures);
  if (!flags.counts_file.empty()) {
    VANTAGE_RETURN_IF_ERROR(WriteCounts(flags.counts_file, comparisons));
  }
  if (common.json) {
    PrintJson(comparisons, together);
  } else if (comparisons.size() == 1) {
    PrintOne(comparisons.front());
  } else {
    PrintSeveral(comparisons, together);
  }
  return {};
}

}  // namespace

Action DefineEvaluateMasks(CLI::App& app) {
  const auto flags = std::make_shared<Flags>();
  app.add_option("--truth", flags->truth,
                 "Sequence folder (input, groundtruth, ROI.bmp, temporalROI.txt, as CDnet and SBI "
                 "have them), a folder that holds several, or a plain folder of truth masks. "
                 "Repeat with its masks for more: --truth T1 R1 --truth T2 R2")
      ->type_name("DIR")
      ->allow_extra_args(false)
      ->required();
  app.add_option("masks", flags->masks,
                 "Masks to measure: folder of pictures (000000.png for frame 0), video, or folder "
                 "with masks.mkv; of several sequences a folder with theirs under the same names")
      ->type_name("DIR")
      ->required();
  app.add_option("--frames", flags->frames,
                 "Only these frames count, first and last, counted from 0 in the order of the "
                 "sequence's pictures; default: all with truth in its temporal range")
      ->type_name("FIRST:LAST");
  app.add_option("--offset", flags->options.offset_frames,
                 "Frame of the sequence that the mask with number 0, or the first of a video, "
                 "belongs to [frames]")
      ->type_name("NUMBER")
      ->capture_default_str();
  app.add_option("--save-counts", flags->counts_file, "CSV file for the counts of every frame")
      ->type_name("FILE");
  return [flags](const CommonFlags& common) { return EvaluateMaskFolders(*flags, common); };
}

}  // namespace vantage::app
