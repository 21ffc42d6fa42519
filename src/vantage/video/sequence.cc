// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/video/sequence.h"

#include <algorithm>
#include <limits>
#include <opencv2/core.hpp>
#include <optional>
#include <string_view>
#include <utility>

#include "vantage/base/file.h"
#include "vantage/base/text.h"
#include "vantage/video/file_lists.h"
#include "vantage/video/mask_writer.h"
#include "vantage/video/open.h"
#include "vantage/video/picture.h"

namespace vantage {
namespace {

namespace fs = std::filesystem;

struct NumberedFile {
  std::int64_t number = 0;
  fs::path path;
};

/// The value of the last run of digits in a name.
std::optional<std::int64_t> LastNumber(std::string_view name) {
  constexpr std::string_view kDigits = "0123456789";
  name = name.substr(0, name.find_last_of(kDigits) + 1);  // all but what follows the last digit
  const std::size_t before = name.find_last_not_of(kDigits);
  if (before != std::string_view::npos) name.remove_prefix(before + 1);
  std::int64_t number = 0;
  if (!ParseNumber(name, number)) return std::nullopt;
  return number;
}

/// The pictures of a folder in the order of their names, with the last number in each name.
Result<std::vector<NumberedFile>> ListByNumber(const fs::path& folder) {
  VANTAGE_ASSIGN_OR_RETURN(std::vector<fs::path> paths, internal::ListPictures(folder));
  std::vector<NumberedFile> files;
  std::map<std::int64_t, fs::path> seen;
  for (fs::path& path : paths) {
    const std::optional<std::int64_t> number = LastNumber(path.stem().string());
    if (!number) {
      return Fail("{}: has no frame number in its name; names are like 000000.png", path.string());
    }
    const auto [other, is_new] = seen.emplace(*number, path);
    if (!is_new) {
      return Fail("{}: has the same number as {}; one picture a frame is needed", path.string(),
                  other->second.filename().string());
    }
    files.push_back({*number, std::move(path)});
  }
  return files;
}

struct TemporalRange {
  std::int64_t first = std::numeric_limits<std::int64_t>::min();
  std::int64_t last = std::numeric_limits<std::int64_t>::max();

  bool Contains(std::int64_t number) const { return number >= first && number <= last; }
};

Result<TemporalRange> ReadTemporalRange(const fs::path& path) {
  std::error_code code;
  if (!fs::exists(path, code)) return TemporalRange();
  constexpr std::size_t kMaxBytes = 4096;
  VANTAGE_ASSIGN_OR_RETURN(std::string text, ReadTextFile(path, kMaxBytes));
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c == '\n' || c == '\r' || c == '\t'; }, ' ');
  std::vector<std::string_view> words = Fields(text, ' ');
  std::erase(words, "");
  TemporalRange range;
  if (words.size() != 2 || !ParseNumber(words[0], range.first) ||
      !ParseNumber(words[1], range.last) || range.first < 0 || range.last < range.first) {
    return Fail(
        "{}: must hold two numbers, those of the first and the last picture that count, "
        "as in '570 2050'",
        path.string());
  }
  return range;
}

/// Finds the region of interest of a sequence, or says in a note why none is used.
Status ReadRegion(TruthSequence& sequence) {
  for (const char* name : {"ROI.bmp", "ROI.png", "ROI.jpg"}) {
    const fs::path path = sequence.folder / name;
    std::error_code code;
    if (!fs::exists(path, code)) continue;
    VANTAGE_ASSIGN_OR_RETURN(const cv::Mat picture, internal::ReadPicture(path));
    if (picture.cols != sequence.size.width || picture.rows != sequence.size.height) {
      sequence.notes.push_back(fmt::format("{} is not used: it has {} x {} px, the truth {} x {}",
                                           name, picture.cols, picture.rows, sequence.size.width,
                                           sequence.size.height));
    } else if (internal::LargestChannelDifference(picture) > internal::kChannelNoise) {
      sequence.notes.push_back(
          fmt::format("{} is not used: it is a coloured picture, not a mask", name));
    } else {
      cv::Mat grey;
      cv::extractChannel(picture, grey, 1);
      sequence.roi = grey >= 128;
      if (cv::countNonZero(sequence.roi) == 0) {
        return Fail("{}: is black, so that no pixel counts; white marks what counts",
                    path.string());
      }
      sequence.notes.clear();
      return {};
    }
  }
  return {};
}

Status AssignTruthToFrames(TruthSequence& sequence) {
  const fs::path truth_folder =
      sequence.input.empty() ? sequence.folder : sequence.folder / "groundtruth";
  VANTAGE_ASSIGN_OR_RETURN(const std::vector<NumberedFile> truth, ListByNumber(truth_folder));
  if (sequence.input.empty()) {
    for (const NumberedFile& file : truth) sequence.masks.emplace(file.number, file.path);
    return {};
  }
  VANTAGE_ASSIGN_OR_RETURN(const std::vector<NumberedFile> input, ListByNumber(sequence.input));
  const fs::path range_file = sequence.folder / "temporalROI.txt";
  VANTAGE_ASSIGN_OR_RETURN(const TemporalRange range, ReadTemporalRange(range_file));
  std::map<std::int64_t, FrameIndex> frame_of_number;
  for (std::size_t frame = 0; frame < input.size(); ++frame) {
    frame_of_number.emplace(input[frame].number, static_cast<FrameIndex>(frame));
    if (range.Contains(input[frame].number)) ++sequence.frames_without_truth;
  }
  for (const NumberedFile& file : truth) {
    const auto found = frame_of_number.find(file.number);
    if (found == frame_of_number.end()) {
      return Fail("{}: belongs to no picture: none in {} has the number {}", file.path.string(),
                  sequence.input.string(), file.number);
    }
    if (!range.Contains(file.number)) continue;
    sequence.masks.emplace(found->second, file.path);
    --sequence.frames_without_truth;
  }
  if (sequence.masks.empty()) {
    return Fail("{}: no picture from {} to {} has truth, so that nothing counts",
                range_file.string(), range.first, range.last);
  }
  return {};
}

}  // namespace

bool IsSequenceFolder(const fs::path& folder) {
  std::error_code code;
  return fs::is_directory(folder / "input", code) && fs::is_directory(folder / "groundtruth", code);
}

std::vector<fs::path> FindSequences(const fs::path& root) {
  constexpr int kLevels = 3;
  std::vector<fs::path> found;
  std::vector<fs::path> level = {root};
  for (int depth = 0; depth <= kLevels; ++depth) {
    std::vector<fs::path> next;
    for (const fs::path& folder : level) {
      if (IsSequenceFolder(folder)) {
        found.push_back(folder);
        continue;
      }
      std::error_code code;
      fs::directory_iterator entries(folder, code);
      for (; !code && entries != fs::directory_iterator(); entries.increment(code)) {
        std::error_code ignored;
        if (entries->is_directory(ignored)) next.push_back(entries->path());
      }
    }
    level = std::move(next);
  }
  std::sort(found.begin(), found.end());
  return found;
}

Result<TruthSequence> OpenTruth(const fs::path& folder) {
  std::error_code code;
  if (!fs::is_directory(folder, code)) {
    return Fail(
        "{}: no such folder; the truth is a sequence folder (input, groundtruth) or a "
        "folder of masks",
        folder.string());
  }
  TruthSequence sequence;
  sequence.folder = folder;
  if (IsSequenceFolder(folder)) {
    sequence.input = folder / "input";
  } else if (fs::is_directory(folder / "groundtruth", code)) {
    return Fail("{}: no such folder; without the pictures name {} as a plain folder of masks",
                (folder / "input").string(), (folder / "groundtruth").string());
  }
  VANTAGE_RETURN_IF_ERROR(AssignTruthToFrames(sequence));
  VANTAGE_ASSIGN_OR_RETURN(sequence.size, internal::PictureSize(sequence.masks.begin()->second));
  if (!sequence.input.empty()) VANTAGE_RETURN_IF_ERROR(ReadRegion(sequence));
  return sequence;
}

Result<cv::Mat> ReadTruthMask(const fs::path& path, ImageSize size) {
  VANTAGE_ASSIGN_OR_RETURN(const cv::Mat picture, internal::ReadPicture(path));
  if (picture.cols != size.width || picture.rows != size.height) {
    return Fail("{}: has {} x {} px; the first truth mask has {} x {}", path.string(), picture.cols,
                picture.rows, size.width, size.height);
  }
  if (internal::LargestChannelDifference(picture) > 0) {
    return Fail("{}: is a colour picture; a truth mask is grey", path.string());
  }
  cv::Mat labels;
  cv::extractChannel(picture, labels, 0);
  return labels;
}

Result<NumberedMasks> OpenNumberedMasks(const fs::path& path) {
  if (IsSequenceFolder(path)) {
    return Fail("{}: holds pictures and their truth; name a folder or a video of masks",
                path.string());
  }
  NumberedMasks masks;
  VANTAGE_ASSIGN_OR_RETURN(masks.source, OpenMasks(path));
  std::error_code code;
  if (!fs::is_directory(path, code) || fs::exists(path / kMaskVideoName, code)) return masks;
  VANTAGE_ASSIGN_OR_RETURN(const std::vector<NumberedFile> files, ListByNumber(path));
  for (const NumberedFile& file : files) {
    if (!masks.numbers.empty() && file.number < masks.numbers.back()) {
      return Fail(
          "{}: its number is below that of the picture before it in the order of names; "
          "names must differ by their numbers only",
          file.path.string());
    }
    masks.numbers.push_back(file.number);
  }
  return masks;
}

}  // namespace vantage
