// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/experiments/map_figures.h"

#include <gmock/gmock.h>

#include <pugixml.hpp>
#include <vector>

#include "vantage/base/file.h"
#include "vantage/base/test_support.h"
#include "vantage/experiments/figure12.h"
#include "vantage/experiments/test_recorder.h"

namespace vantage {
namespace {

using testing::DrawnRecording;
using ::testing::HasSubstr;
using testing::TemporaryFolder;

Peak PeakAt(double x_m, double y_m) { return {.cell = 0, .position_m = {x_m, y_m}}; }
Person PersonAt(double x_m, double y_m) { return {.position_m = {x_m, y_m}, .trail = {}}; }

TEST(FalsePeaks, ThoseToWhomNobodyBelongs) {
  const Polygon area = Polygon::Rectangle({0, 0}, {10, 10}).value();
  EXPECT_EQ(FalsePeaks({}, {PersonAt(5, 5)}, area), 0);
  EXPECT_EQ(FalsePeaks({PeakAt(5.5, 5)}, {PersonAt(5, 5)}, area), 0);
  EXPECT_EQ(FalsePeaks({PeakAt(7, 5)}, {PersonAt(5, 5)}, area), 1);
  // Two of one person; one outside the area; one that belongs to somebody outside.
  EXPECT_EQ(FalsePeaks({PeakAt(5.5, 5), PeakAt(4.5, 5)}, {PersonAt(5, 5)}, area), 1);
  EXPECT_EQ(FalsePeaks({PeakAt(-3, 5)}, {}, area), 0);
  EXPECT_EQ(FalsePeaks({PeakAt(9.8, 5)}, {PersonAt(10.3, 5)}, area), 0);
}

/// The page of an experiment on the drawn recording, which must be valid.
std::string PageOf(const Experiment& experiment) {
  const TemporaryFolder folder;
  Study study;
  study.output = folder / "out";
  study.quick = true;
  study.frames = 30;
  study.record = &DrawnRecording::Record;
  const Result<StudyReport> report = RunStudy(std::vector{experiment}, study);
  EXPECT_TRUE(report) << testing::MessageOf(report);
  if (!report) return "";
  const std::string html = ReadTextFile(report->page).value();
  pugi::xml_document document;
  const pugi::xml_parse_result parsed = document.load_string(html.c_str());
  EXPECT_TRUE(parsed) << parsed.description();
  return html;
}

std::size_t Count(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) {
    ++count;
  }
  return count;
}

TEST(MapFigures, HoldTheirPictures) {
  const std::string html = PageOf(MapFiguresExperiment());
  EXPECT_EQ(Count(html, "<img src=\"data:image/"), 3u + 3 + 2);
  EXPECT_THAT(html, HasSubstr("<h3>Figure 14</h3>"));
  EXPECT_THAT(html, HasSubstr("where the extension removes the most false detections"));
}

TEST(Figure12, ShowsEveryStage) {
  const std::string html = PageOf(Figure12Experiment());
  EXPECT_EQ(Count(html, "href=\"data:image/"), 4u);
  for (const char* stage : {">background<", ">occupancy<", ">linking<", "reading: ", "hold: "}) {
    EXPECT_THAT(html, HasSubstr(stage));
  }
}

}  // namespace
}  // namespace vantage
