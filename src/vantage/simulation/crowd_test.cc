// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>

#include "vantage/base/file.h"
#include "vantage/base/test_support.h"
#include "vantage/scene/calibration.h"
#include "vantage/simulation/crowd_people.h"
#include "vantage/simulation/preset_cameras.h"
#include "vantage/simulation/presets.h"
#include "vantage/simulation/test_stages.h"

namespace vantage::simulation {
namespace {

using ::testing::HasSubstr;
using vantage::testing::DataFolder;
using vantage::testing::MessageOf;
using vantage::testing::TemporaryFolder;

TEST(CrowdCamerasTest, AreThoseOfTheDataSet) {
  if (DataFolder().empty()) GTEST_SKIP() << "no research data";
  const std::vector<NamedCamera> cameras = CrowdCameras();
  const char* const files[] = {"CVLab1", "CVLab2", "CVLab3", "CVLab4",
                               "IDIAP1", "IDIAP2", "IDIAP3"};
  ASSERT_EQ(cameras.size(), std::size(files));
  const auto folder = DataFolder() / "wildtrack" / "calibrations";
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    const std::string name = files[i];
    SCOPED_TRACE(name);
    const Result<Camera> file = ReadIntrinsicExtrinsic(
        folder / "intrinsic_zero" / ("intr_" + name + ".xml"),
        folder / "extrinsic" / ("extr_" + name + ".xml"), {.unit_m = 0.01, .size = {{1920, 1080}}});
    ASSERT_TRUE(file.has_value()) << MessageOf(file);
    for (const Eigen::Vector2d& pixel : {Eigen::Vector2d(400, 900), Eigen::Vector2d(1500, 700)}) {
      const auto here = cameras[i].camera.WorldFromImage(pixel);
      const auto there = file->WorldFromImage(pixel);
      ASSERT_TRUE(here && there);
      EXPECT_LT((*here - *there).norm(), 1e-9);
    }
  }
}

TEST(CrowdTest, PicturesAreHalfTheSize) {
  const Stage stage = std::move(MakeCrowd({.frames = 1}).value());
  ASSERT_EQ(stage.cameras.size(), 7U);
  EXPECT_EQ(stage.cameras[0].camera.size(), (ImageSize{960, 540}));
  EXPECT_EQ(stage.frames_per_second, 10);
  EXPECT_THAT(MessageOf(MakeCrowd({.cameras = 8})), HasSubstr("crowd has 7: ask for 1 to 7"));
}

class InventedCrowdTest : public ::testing::TestWithParam<int> {
 protected:
  Stage Make(FrameIndex frames = 400) const {
    return std::move(
        MakeCrowd({.seed = static_cast<std::uint64_t>(GetParam()), .frames = frames}).value());
  }
};

TEST_P(InventedCrowdTest, IsACrowd) {
  const Stage stage = Make();
  double sum = 0;
  for (FrameIndex frame = 0; frame < stage.frames; frame += 20) {
    const int people = testing::PeopleInArea(stage, frame);
    EXPECT_GE(people, 15) << "frame " << frame;
    EXPECT_LE(people, 50) << "frame " << frame;
    sum += people;
  }
  EXPECT_NEAR(sum / 20, 29, 8);
}

TEST_P(InventedCrowdTest, PeopleWalkAsPeopleDo) {
  const Stage stage = Make();
  testing::ExpectNobodyJumps(stage, 2.3);
  testing::ExpectNobodyPopsUp(stage);
  for (FrameIndex frame = 0; frame < stage.frames; frame += 100) {
    testing::ExpectSoundFrame(stage, frame);
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, InventedCrowdTest, ::testing::Values(1, 2));

TEST(CrowdTest, TheSeedIsAll) {
  const Stage a = std::move(MakeCrowd({.seed = 5, .frames = 60}).value());
  const Stage b = std::move(MakeCrowd({.seed = 5, .frames = 60}).value());
  for (const FrameIndex frame : {0, 31, 59}) testing::ExpectSameThings(a, b, frame);
}

TEST(CrowdTest, RealPeopleStandWhereTheTruthSays) {
  if (DataFolder().empty()) GTEST_SKIP() << "no research data";
  const Result<Stage> stage = MakeCrowd({.people = DataFolder() / "wildtrack"});
  ASSERT_TRUE(stage.has_value()) << MessageOf(stage);
  const auto truth = ReadCrowdPeople(DataFolder() / "wildtrack");
  ASSERT_TRUE(truth.has_value()) << MessageOf(truth);
  int compared = 0;
  int own = 0;
  for (FrameIndex frame = 0; frame < stage->frames; frame += 5) {
    const auto there = testing::PeopleAt(*stage, frame);
    for (const auto& [id, known] : *truth) {
      for (const Waypoint& point : known) {
        if (std::lround(point.seconds * 10) != frame) continue;
        // Under their own id or, after a leap of the annotation, another one.
        double nearest = 1e9;
        for (const auto& [other, place] : there) {
          nearest = std::min(nearest, (place - point.ground_m).norm());
        }
        EXPECT_LT(nearest, 0.01) << "person " << id << ", frame " << frame;
        own += there.count(id) > 0 && (there.at(id) - point.ground_m).norm() < 0.01;
        ++compared;
      }
    }
  }
  EXPECT_GT(compared, 1500);
  EXPECT_GT(own, 0.98 * compared);
  testing::ExpectNobodyJumps(*stage, 10.5);  // 7 m/s between annotations
  testing::ExpectNobodyPopsUp(*stage);
  testing::ExpectSoundFrame(*stage, 203);
}

TEST(CrowdPeopleTest, ReadsCellsAsMetres) {
  const TemporaryFolder folder;
  ASSERT_TRUE(WriteTextFile(folder / "annotations_positions/00000005.json",
                            R"([{"personID": 0, "positionID": 962, "views": []}])"));
  const auto people = ReadCrowdPeople(folder.path());
  ASSERT_TRUE(people.has_value()) << MessageOf(people);
  ASSERT_EQ(people->count(1), 1U);
  const Waypoint& point = people->at(1).at(0);
  EXPECT_DOUBLE_EQ(point.seconds, 0.5);
  EXPECT_NEAR(point.ground_m.x(), -2.95, 1e-12);
  EXPECT_NEAR(point.ground_m.y(), -8.95, 1e-12);
}

TEST(CrowdPeopleTest, BrokenFilesFail) {
  const TemporaryFolder folder;
  EXPECT_THAT(MessageOf(ReadCrowdPeople(folder.path())), HasSubstr("annotations_positions"));
  std::filesystem::create_directories(folder / "annotations_positions");
  EXPECT_THAT(MessageOf(ReadCrowdPeople(folder.path())), HasSubstr("no file named like"));
  const auto fails = [&](const std::string& text) {
    EXPECT_TRUE(WriteTextFile(folder / "annotations_positions/00000000.json", text).has_value());
    return MessageOf(ReadCrowdPeople(folder.path()));
  };
  EXPECT_THAT(fails("["), HasSubstr("00000000.json: not valid JSON"));
  EXPECT_THAT(fails("{}"), HasSubstr("a list of entries"));
  EXPECT_THAT(fails("[3]"), HasSubstr("each entry must be an object"));
  EXPECT_THAT(fails(R"([{"personID": 1}])"), HasSubstr("positionID must be a whole number"));
  EXPECT_THAT(fails(R"([{"personID": 1.5, "positionID": 1}])"), HasSubstr("personID must be"));
  EXPECT_THAT(fails(R"([{"personID": 1, "positionID": -1}])"), HasSubstr("positionID must be"));
  EXPECT_THAT(fails(R"([{"personID": 1, "positionID": 691200}])"), HasSubstr("from 0 to 691199"));
  EXPECT_THAT(fails(R"([{"personID": 1e300, "positionID": 5}])"), HasSubstr("personID must be"));
  EXPECT_THAT(fails(R"([{"personID": 1, "positionID": 5}, {"personID": 1, "positionID": 6}])"),
              HasSubstr("personID 1 is there twice"));
}

}  // namespace
}  // namespace vantage::simulation
