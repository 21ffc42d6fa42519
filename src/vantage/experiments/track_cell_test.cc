// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/experiments/track_cell.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <pugixml.hpp>

#include "vantage/base/file.h"
#include "vantage/base/test_support.h"
#include "vantage/experiments/area_tables.h"
#include "vantage/experiments/figure16.h"
#include "vantage/experiments/table2.h"
#include "vantage/experiments/test_recorder.h"
#include "vantage/experiments/track_report.h"
#include "vantage/metrics/mask_evaluation.h"

namespace vantage {
namespace {

namespace fs = std::filesystem;
using testing::DrawnRecording;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::SizeIs;
using testing::TemporaryFolder;

/// A quick study on the drawn recording, 30 frames of it.
struct DrawnStudy {
  TemporaryFolder folder;
  Study study;
  DrawnStudy() {
    study.output = folder / "out";
    study.quick = true;
    study.frames = 30;
    study.record = &DrawnRecording::Record;
  }
  StudyReport Run(const Experiment& experiment) const {
    Result<StudyReport> report = RunStudy(std::vector{experiment}, study);
    EXPECT_TRUE(report) << testing::MessageOf(report);
    return report ? *report : StudyReport{};
  }
};

double ValueOf(const StudyReport& report, const std::string& row, const std::string& measure) {
  for (const Figure& figure : report.figures) {
    if (figure.row.find(row) != std::string::npos && figure.measure == measure) {
      return figure.value;
    }
  }
  return std::nan("");
}

TEST(TrackCell, TracksTheDrawnPeople) {
  const DrawnStudy drawn;
  const TrackRecording recording = FloorballRecording(drawn.study).value();
  const CellPtr cell =
      TrackCell(recording, {.name = "defaults", .options = DefaultsFor(recording)});
  const CellsReport report = RunCells(drawn.study.output, {cell}, 1, false).value();
  const auto& result = report.results.at(cell->name);
  EXPECT_EQ(result["frames"], 30);
  EXPECT_EQ(result["every"]["gt"], 2 * 27);
  EXPECT_EQ(result["sparse"]["gt"], 2 * 3);  // frames 8, 16 and 24
  EXPECT_GT(MotaOf(result), 0.8) << result.dump(1);
  EXPECT_LT(NumberAt(result["every"], "motp"), 0.5);
  EXPECT_EQ(result["every"]["idsw"], 0);
}

TEST(TrackCell, MasksMadeBeforeGiveTheSameTracks) {
  const DrawnStudy drawn;
  const TrackRecording recording = FloorballRecording(drawn.study).value();
  const TrackSetting setting{.name = "without", .options = PlainOptionsFor(recording)};
  const CellPtr whole = TrackCell(recording, setting);
  const CellPtr masks = MasksCell(recording, "defaults", setting.options.background);
  TrackSetting named = setting;
  named.name = "from-masks";
  const CellPtr from_masks = TrackCell(recording, named, masks);
  const CellsReport report = RunCells(drawn.study.output, {whole, from_masks}, 2, false).value();
  EXPECT_EQ(report.computed, 4);
  EXPECT_EQ(report.results.at(whole->name)["every"], report.results.at(from_masks->name)["every"]);
  EXPECT_TRUE(fs::exists(drawn.study.output / masks->product / "camera2" / "masks.mkv"));
}

TEST(TrackCell, OptionsDecideWhatIsKept) {
  const DrawnStudy drawn;
  const TrackRecording recording = FloorballRecording(drawn.study).value();
  TrackSetting setting{.name = "one", .options = PlainOptionsFor(recording)};
  const auto run = [&] {
    return RunCells(drawn.study.output, {TrackCell(recording, setting)}, 1, false)->computed;
  };
  EXPECT_EQ(run(), 2);  // and the recording
  EXPECT_EQ(run(), 0);
  setting.options.occupancy.prior = 0.01;
  EXPECT_EQ(run(), 1);
  setting.extension_m = 0;
  EXPECT_EQ(run(), 1);
  setting.cell_m = 0.6;
  EXPECT_EQ(run(), 1);
  setting.options.background.mixture.alpha = 0.01;
  EXPECT_EQ(run(), 1);
  EXPECT_EQ(run(), 0);
}

TEST(Table3, ReportsAllRowsBesideTheThesis) {
  DrawnStudy drawn;
  const StudyReport report = drawn.Run(Table3Experiment());
  // 8 rows, 8 measures, two truths.
  EXPECT_THAT(report.figures, SizeIs(8 * 8 * 2));
  EXPECT_EQ(report.cells_computed, 10);
  EXPECT_GT(ValueOf(report, "extended area, continuous", "mota"), 0.8);
  const std::string csv = ReadTextFile(report.csv).value();
  EXPECT_THAT(csv, HasSubstr("table3,\"extended area, centre, truth at every 8th frame\",mota,"));
  EXPECT_THAT(csv, HasSubstr(",0.7563,\"floorball-quick, simulated: 4 cameras, 480 x 384, 30 "
                             "frames\",1\n"));
  EXPECT_THAT(report.findings, SizeIs(4));
  pugi::xml_document document;
  EXPECT_TRUE(document.load_string(ReadTextFile(report.page).value().c_str()));

  // On more threads nothing differs, on the same recording: encoders give other bytes each time.
  DrawnStudy parallel;
  parallel.study.threads = 2;
  for (const char* kept : {"data", "cells/data-floorball-quick.json", "reproduce.json"}) {
    fs::create_directories((parallel.study.output / kept).parent_path());
    fs::copy(drawn.study.output / kept, parallel.study.output / kept, fs::copy_options::recursive);
  }
  const StudyReport again = parallel.Run(Table3Experiment());
  EXPECT_EQ(again.cells_computed, 9);
  EXPECT_EQ(ReadTextFile(again.csv).value(), csv);
  // And figure 16 needs no other masks.
  EXPECT_EQ(drawn.Run(Figure16Experiment()).cells_computed, 4);
}

TEST(Table2, ReportsAllRowsOfBothRecordings) {
  DrawnStudy drawn;
  drawn.study.frames = 16;
  const StudyReport report = drawn.Run(Table2Experiment());
  EXPECT_THAT(report.figures, SizeIs(7 * 8 * 3));
  EXPECT_THAT(report.skipped, SizeIs(1));
  EXPECT_THAT(report.skipped[0], HasSubstr("View_001, real video: no --data"));
  EXPECT_THAT(ReadTextFile(report.csv).value(),
              HasSubstr("\"original rate, FEP, LUV, truth at every frame\",mota,"));
}

TEST(Table4, TheRealBoxesOfPets) {
  const fs::path data = testing::DataFolder();
  if (data.empty()) GTEST_SKIP() << "no research data";
  DrawnStudy drawn;
  drawn.study.data = data;
  drawn.study.frames = 40;
  const StudyReport report = drawn.Run(Table4Experiment());
  EXPECT_THAT(report.skipped, SizeIs(0));
  double best = 0;
  for (const Figure& figure : report.figures) {
    if (!figure.simulated && figure.measure == "mota") best = std::max(best, figure.value);
  }
  EXPECT_GT(best, 0.9);
}

TEST(TrackVerdicts, NeedADifference) {
  EXPECT_EQ(VerdictOfGain(0.02), Verdict::kHolds);
  EXPECT_EQ(VerdictOfGain(0.001), Verdict::kNotDecided);
  EXPECT_EQ(VerdictOfGain(-0.02), Verdict::kDoesNotHold);
  EXPECT_EQ(VerdictOfGain(std::nan("")), Verdict::kNotDecided);
  EXPECT_EQ(Both(Verdict::kHolds, Verdict::kHolds), Verdict::kHolds);
  EXPECT_EQ(Both(Verdict::kHolds, Verdict::kNotDecided), Verdict::kNotDecided);
  EXPECT_EQ(Both(Verdict::kNotDecided, Verdict::kHolds), Verdict::kNotDecided);
  EXPECT_EQ(Both(Verdict::kHolds, Verdict::kDoesNotHold), Verdict::kDoesNotHold);
}

}  // namespace
}  // namespace vantage
