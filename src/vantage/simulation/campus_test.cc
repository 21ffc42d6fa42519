// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>

#include "vantage/base/file.h"
#include "vantage/base/test_support.h"
#include "vantage/scene/calibration.h"
#include "vantage/simulation/preset_cameras.h"
#include "vantage/simulation/presets.h"
#include "vantage/simulation/test_stages.h"
#include "vantage/tracks/track_file.h"

namespace vantage::simulation {
namespace {

using ::testing::HasSubstr;
using vantage::testing::DataFolder;
using vantage::testing::MessageOf;
using vantage::testing::TemporaryFolder;

void ExpectSameCamera(const Camera& a, const Camera& b) {
  EXPECT_EQ(a.size(), b.size());
  for (const Eigen::Vector3d& point :
       {Eigen::Vector3d(-5, -6, 0), Eigen::Vector3d(-8, -10, 1.7), Eigen::Vector3d(0, -3, 0.9)}) {
    const auto pixel = a.ImageFromWorld(point);
    const auto other = b.ImageFromWorld(point);
    ASSERT_EQ(pixel.has_value(), other.has_value());
    if (pixel) {
      EXPECT_LT((*pixel - *other).norm(), 1e-9);
    }
  }
}

TEST(CampusCamerasTest, AreThoseOfTheDataSet) {
  if (DataFolder().empty()) GTEST_SKIP() << "no research data";
  for (const NamedCamera& named : CampusCameras()) {
    const std::string number(named.name.substr(4));
    SCOPED_TRACE(named.name);
    const Result<Camera> file =
        ReadTsaiXml(DataFolder() / "pets2009" / "calibration" / ("View_00" + number + ".xml"));
    ASSERT_TRUE(file.has_value()) << MessageOf(file);
    ExpectSameCamera(named.camera, *file);
  }
}

TEST(CampusCamerasTest, SevenAreTheUsualOnes) {
  const Result<Stage> stage = MakeCampus({.frames = 1, .cameras = 7});
  ASSERT_TRUE(stage.has_value()) << MessageOf(stage);
  std::vector<std::string> names;
  for (const StageCamera& camera : stage->cameras) names.push_back(camera.name);
  EXPECT_THAT(
      names, ::testing::ElementsAre("view1", "view3", "view4", "view5", "view6", "view7", "view8"));
}

TEST(CampusCamerasTest, ScaleKeepsSidesEven) {
  const Result<Stage> stage = MakeCampus({.frames = 1, .scale = 0.33});
  ASSERT_TRUE(stage.has_value()) << MessageOf(stage);
  for (const StageCamera& camera : stage->cameras) {
    EXPECT_EQ(camera.camera.size().width % 2, 0);
    EXPECT_EQ(camera.camera.size().height, 190);
  }
}

TEST(CampusTest, MoreCamerasThanThereAreFail) {
  for (const int cameras : {0, 9, -1}) {
    EXPECT_THAT(MessageOf(MakeCampus({.frames = 1, .cameras = cameras})),
                HasSubstr("campus has 8: ask for 1 to 8"));
  }
}

class InventedCampusTest : public ::testing::TestWithParam<int> {
 protected:
  Stage Make(FrameIndex frames = 795) const {
    return std::move(
        MakeCampus({.seed = static_cast<std::uint64_t>(GetParam()), .frames = frames}).value());
  }
};

TEST_P(InventedCampusTest, AsManyPeopleAsInTheRecording) {
  const Stage stage = Make();
  int seconds_within = 0;
  int seconds = 0;
  for (FrameIndex frame = 0; frame < stage.frames; frame += 7) {
    const int people = testing::PeopleInArea(stage, frame);
    EXPECT_LE(people, 14) << "frame " << frame;
    seconds_within += people >= 5 && people <= 12;
    ++seconds;
  }
  EXPECT_GE(seconds_within, 0.8 * seconds);
}

TEST_P(InventedCampusTest, PeopleWalkAsPeopleDo) {
  const Stage stage = Make(300);
  testing::ExpectNobodyJumps(stage, 2.3);
  for (FrameIndex frame = 0; frame < stage.frames; frame += 50) {
    testing::ExpectSoundFrame(stage, frame);
    // Nobody walks through anybody.
    const auto people = testing::PeopleAt(stage, frame);
    for (const auto& [id, place] : people) {
      for (const auto& [other, there] : people) {
        if (other > id && stage.area.Contains(place)) {
          EXPECT_GT((place - there).norm(), 0.3) << id << " and " << other << ", frame " << frame;
        }
      }
    }
  }
}

TEST_P(InventedCampusTest, NobodyPopsUp) { testing::ExpectNobodyPopsUp(Make()); }

INSTANTIATE_TEST_SUITE_P(Seeds, InventedCampusTest, ::testing::Values(1, 2, 3));

TEST(CampusTest, TheSeedIsAll) {
  const Stage a = std::move(MakeCampus({.seed = 5, .frames = 100}).value());
  const Stage b = std::move(MakeCampus({.seed = 5, .frames = 100}).value());
  const Stage other = std::move(MakeCampus({.seed = 6, .frames = 100}).value());
  for (const FrameIndex frame : {0, 37, 99}) testing::ExpectSameThings(a, b, frame);
  EXPECT_NE(testing::PeopleAt(a, 50), testing::PeopleAt(other, 50));
}

TEST(CampusTest, RealPeopleStandWhereTheTruthSays) {
  if (DataFolder().empty()) GTEST_SKIP() << "no research data";
  const auto truth = DataFolder() / "pets2009" / "gt-mot15-3d.txt";
  const Result<Stage> stage = MakeCampus({.people = truth});
  ASSERT_TRUE(stage.has_value()) << MessageOf(stage);
  EXPECT_EQ(stage->frames, 795);
  const Tracks tracks = ReadTracks(truth).value();
  std::map<FrameIndex, std::map<int, Eigen::Vector2d>> at;
  for (const Track& track : tracks) {
    for (const TrackPoint& point : track.points) {
      at[point.frame][static_cast<int>(track.id)] = {point.x_m, point.y_m};
    }
  }
  for (const auto& [frame, people] : at) {
    const auto there = testing::PeopleAt(*stage, frame);
    for (const auto& [id, place] : people) {
      ASSERT_EQ(there.count(id), 1U) << "person " << id << ", frame " << frame;
      EXPECT_LT((there.at(id) - place).norm(), 0.01) << "person " << id << ", frame " << frame;
    }
  }
  testing::ExpectNobodyJumps(*stage, 3);
  testing::ExpectNobodyPopsUp(*stage);
  testing::ExpectSoundFrame(*stage, 400);
}

TEST(CampusTest, BrokenTruthFails) {
  const TemporaryFolder folder;
  EXPECT_THAT(MessageOf(MakeCampus({.people = folder / "none.txt"})), HasSubstr("none.txt"));
  const auto fails = [&](const std::string& text) {
    EXPECT_TRUE(WriteTextFile(folder / "truth.txt", text).has_value());
    return MessageOf(MakeCampus({.frames = 10, .people = folder / "truth.txt"}));
  };
  EXPECT_THAT(fails("1,1,0,0,10,10,1,nan,2,0\n"), HasSubstr("truth.txt"));
  EXPECT_THAT(fails("1,1,0,0,10,10,1,4000,2,0\n"), HasSubstr("person 1 is at (4000, 2) m"));
  EXPECT_THAT(fails("1,-7,0,0,10,10,1,4,2,0\n"), HasSubstr("truth.txt"));
  EXPECT_THAT(fails("1,1000001,0,0,10,10,1,4,2,0\n"), HasSubstr("ids must be 1 to 1000000"));
  EXPECT_THAT(fails(""), HasSubstr("truth.txt"));
}

}  // namespace
}  // namespace vantage::simulation
