// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/experiments/mask_pictures.h"

#include <gmock/gmock.h>

#include <pugixml.hpp>

#include "vantage/base/test_support.h"
#include "vantage/experiments/test_mask_recording.h"

namespace vantage {
namespace {

using ::testing::HasSubstr;
using testing::MessageOf;
using testing::TemporaryFolder;

TEST(MaskPictures, OnePageWithItsGrids) {
  const TemporaryFolder folder;
  int recorded = 0;
  Study study = testing::DrawnStudy(folder / "out", recorded);
  study.frames = 60;  // figure 5 begins at 350 otherwise
  // View_001 as it would be in a data folder.
  testing::WriteMaskRecording(folder / "drawn", 1, 30);
  const auto data = folder / "data";
  std::filesystem::create_directories(data / "pets2009");
  std::filesystem::rename(folder / "drawn/cam1.mp4", data / "pets2009/vtest.avi");
  study.data = data;
  const std::vector<Experiment> experiments = MaskPictureExperiments();
  const auto report = RunStudy(experiments, study);
  ASSERT_TRUE(report) << MessageOf(report);
  EXPECT_EQ(recorded, 2);  // floorball, which figures 1 and 6 share, and ghosts
  EXPECT_EQ(report->cells_computed, 4 + 2);
  const std::string html = ReadTextFile(report->page).value();
  pugi::xml_document document;
  const auto parsed = document.load_string(html.c_str());
  ASSERT_TRUE(parsed) << parsed.description();
  // Figure 1; the others judged in two ways.
  EXPECT_EQ(document.select_nodes("//table[@class='pictures']").size(), 1u + 3 * 2);
  EXPECT_EQ(document.select_nodes("//svg").size(), 2u);
  for (const auto& table : document.select_nodes("//table[@class='pictures']")) {
    const std::size_t columns = table.node().select_nodes("thead/tr/th").size();
    EXPECT_GE(columns, 2u);
    EXPECT_GT(table.node().select_nodes("tbody/tr").size(), 4u);
    for (const auto& row : table.node().select_nodes("tbody/tr")) {
      EXPECT_EQ(row.node().select_nodes("td").size(), columns);
    }
  }
  EXPECT_THAT(html, HasSubstr("real video PETS 2009 S2.L1 View_001"));
  EXPECT_THAT(html, HasSubstr("simulated preset floorball"));
  ASSERT_EQ(report->findings.size(), 1u);
  EXPECT_EQ(report->findings[0].experiment, "fig1");
  EXPECT_NE(report->findings[0].verdict, Verdict::kNotDecided);
  bool real = false;
  for (const Figure& figure : report->figures) {
    real |= !figure.simulated;
    EXPECT_EQ(figure.simulated, figure.experiment != "fig7");
  }
  EXPECT_TRUE(real);
  // All is kept.
  const auto again = RunStudy(experiments, study);
  EXPECT_EQ(again->cells_computed, 0);
  EXPECT_EQ(ReadTextFile(again->page).value(), html);
}

TEST(MaskPictures, ABrokenVideoIsNamed) {
  const TemporaryFolder folder;
  int recorded = 0;
  Study study = testing::DrawnStudy(folder / "out", recorded);
  study.data = folder / "data";
  std::filesystem::create_directories(study.data / "pets2009");
  ASSERT_TRUE(WriteTextFile(study.data / "pets2009/vtest.avi", "no video"));
  EXPECT_THAT(MessageOf(RunStudy(std::vector{MaskPictureExperiments()[3]}, study)),
              HasSubstr("vtest.avi"));
}

}  // namespace
}  // namespace vantage
