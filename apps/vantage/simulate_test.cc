// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
// `vantage simulate` as a user runs it.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <opencv2/core.hpp>

#include "test_program.h"
#include "vantage/base/file.h"
#include "vantage/base/test_support.h"
#include "vantage/scene/scene.h"
#include "vantage/tracks/track_file.h"

namespace vantage {
namespace {

using testing::Entries;
using testing::ExpectOneLine;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::MessageOf;
using testing::Outcome;
using testing::RunProgram;
using testing::TemporaryFolder;

constexpr const char* kSmall = "--frames 6 --cameras 2 --scale 0.1 --quiet";

Outcome Simulate(const std::filesystem::path& folder, const std::string& arguments) {
  return RunProgram(fmt::format("simulate {} -o '{}'", arguments, folder.string()));
}

/// Number of pictures of a source until its end.
int Count(const SourceSpec& source) {
  const auto opened = OpenSource(source);
  if (!opened) return -1;
  int count = 0;
  for (cv::Mat frame; (*opened)->Read(frame).value_or(false);) ++count;
  return count;
}

TEST(Simulate, WritesASceneAndItsTruth) {
  const TemporaryFolder folder;
  // Large enough that legs are seen: a pixel shows what is at its centre.
  const Outcome outcome =
      Simulate(folder / "out", "floorball --frames 6 --cameras 2 --scale 0.4 --quiet --json");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const auto report = nlohmann::json::parse(outcome.out);
  EXPECT_EQ(report["frames"], 6);
  EXPECT_EQ(report["cameras"], 2);
  EXPECT_GE(report["people"], 21) << "two teams";

  const auto scene = LoadScene(folder / "out" / "scene.toml");
  ASSERT_TRUE(scene) << MessageOf(scene);
  ASSERT_EQ(scene->cameras.size(), 2U);
  const auto tracks = ReadTracks(folder / "out" / "truth" / "tracks.csv");
  ASSERT_TRUE(tracks) << MessageOf(tracks);
  EXPECT_EQ(tracks->size(), report["people"].get<std::size_t>());
  for (const SceneCamera& camera : scene->cameras) {
    EXPECT_EQ(Count(camera.source), 6);
    EXPECT_EQ(Count({.kind = SourceSpec::Kind::kMasks,
                     .path = folder / "out" / "truth" / "masks" / camera.name,
                     .size = {}}),
              6);
    // The calibration belongs to the pictures: the foot of each box lies near where they stand.
    const auto path = folder / "out" / "truth" / "boxes" / (camera.name + ".txt");
    const auto boxes = ReadBoxTracks(path);
    const auto people = ReadTracks(path);
    ASSERT_TRUE(boxes && people) << MessageOf(boxes) << MessageOf(people);
    int compared = 0;
    for (std::size_t i = 0; i < boxes->size(); ++i) {
      const BoxPoint& box = (*boxes)[i].points.front();
      const TrackPoint& person = (*people)[i].points.front();
      const auto foot = camera.camera.ImageFromWorld({person.x_m, person.y_m, 0});
      const ImageSize size = camera.camera.size();
      const double bottom = box.top_px + box.height_px;
      if (!foot || bottom >= size.height || box.left_px <= 0 ||
          box.left_px + box.width_px >= size.width) {
        continue;
      }
      EXPECT_NEAR(foot->x() + 0.5, box.left_px + box.width_px / 2, 0.5 * box.width_px + 1);
      EXPECT_NEAR(foot->y() + 0.5, bottom, 0.25 * box.height_px + 1);
      ++compared;
    }
    EXPECT_GT(compared, 8) << camera.name;
  }
}

TEST(Simulate, TheSameSeedGivesTheSameTruthForEveryThreadCount) {
  const TemporaryFolder folder;
  for (const auto& [name, arguments] : std::vector<std::pair<std::string, std::string>>{
           {"one", "--threads 1"}, {"three", "--threads 3"}, {"other", "--seed 2"}}) {
    const Outcome outcome =
        Simulate(folder / name, fmt::format("floorball {} {}", kSmall, arguments));
    ASSERT_EQ(outcome.status, 0) << outcome.err;
  }
  const auto text = [&](const char* name, const char* file) {
    return ReadTextFile(folder / name / "truth" / file).value_or("");
  };
  for (const char* file : {"tracks.csv", "visibility.csv", "boxes/camera1.txt"}) {
    EXPECT_EQ(text("one", file), text("three", file)) << file;
    EXPECT_NE(text("one", file), text("other", file)) << file;
  }
}

TEST(Simulate, FaultsChangeWhatIsDeliveredAndNotTheTruth) {
  const TemporaryFolder folder;
  ASSERT_EQ(Simulate(folder / "well", fmt::format("floorball {}", kSmall)).status, 0);
  const Outcome outcome = Simulate(
      folder / "ill", fmt::format("floorball {} --fault drop:1:2:3 --fault black:2:0:6", kSmall));
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const auto scene = LoadScene(folder / "ill" / "scene.toml");
  ASSERT_TRUE(scene) << MessageOf(scene);
  EXPECT_EQ(Count(scene->cameras[0].source), 3);
  const auto source = OpenSource(scene->cameras[1].source);
  ASSERT_TRUE(source) << MessageOf(source);
  cv::Mat black;
  ASSERT_TRUE((*source)->Read(black).value());
  EXPECT_LT(cv::mean(black)[0], 3);
  EXPECT_EQ(ReadTextFile(folder / "well" / "truth" / "visibility.csv").value(),
            ReadTextFile(folder / "ill" / "truth" / "visibility.csv").value());
}

TEST(Simulate, RefusesWhatThereIsNot) {
  const TemporaryFolder folder;
  const auto out = folder / "out";
  ExpectOneLine(Simulate(out, "football"), 2, "football");
  ExpectOneLine(Simulate(out, "floorball --cameras 9 --quiet"), 1, "8");
  ExpectOneLine(Simulate(out, "floorball --scale 0"), 2, "scale");
  ExpectOneLine(Simulate(out, fmt::format("floorball {} --fault melt:1:1:1", kSmall)), 1,
                "melt:1:1:1: is not a fault");
  ExpectOneLine(Simulate(out, fmt::format("floorball {} --fault drop:3:1:1", kSmall)), 1,
                "there is no camera 3; there are 2");
  ExpectOneLine(Simulate(out, fmt::format("floorball {} --fault drop:1:0:6", kSmall)), 1,
                "camera 1 would deliver no picture");
  ExpectOneLine(Simulate(out, fmt::format("campus {} --people /nowhere.txt", kSmall)), 1,
                "/nowhere.txt");
  EXPECT_THAT(Entries(folder.path()), IsEmpty()) << "no half of a recording is left";
}

}  // namespace
}  // namespace vantage
