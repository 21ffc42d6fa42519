// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/pipeline/track.h"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "vantage/base/file.h"
#include "vantage/base/test_support.h"
#include "vantage/metrics/clear_mot.h"
#include "vantage/pipeline/ground.h"
#include "vantage/pipeline/summary.h"
#include "vantage/tracks/track_file.h"

namespace vantage {
namespace {

using testing::DataFolder;
using ::testing::HasSubstr;
using testing::MessageOf;
using testing::TemporaryFolder;

/// Two cameras that face each other across an area of 8 x 6 m, 5 m up, and people drawn into their
/// masks as the model sees them (simulated).
class TwoCameras : public ::testing::Test {
 protected:
  static constexpr int kFrames = 30;

  TwoCameras() {
    EXPECT_TRUE(WriteTextFile(folder_ / "scene.toml", R"(
name = "two"
frames_per_second = 10.0
[area]
polygon = [[-4.0, -3.0], [4.0, -3.0], [4.0, 3.0], [-4.0, 3.0]]
[grid]
cell = 0.5
extension = 1.0
[[cameras]]
name = "south"
source = { masks = "south/%06d.png" }
[cameras.calibration.pinhole]
size_px = [320, 240]
focal_px = [240.0, 240.0]
center_px = [159.5, 119.5]
rotation = [[1.0, 0.0, 0.0], [0.0, -0.4472136, -0.8944272], [0.0, 0.8944272, -0.4472136]]
translation_m = [0.0, 0.0, 11.1803399]
[[cameras]]
name = "north"
source = { masks = "north/%06d.png" }
[cameras.calibration.pinhole]
size_px = [320, 240]
focal_px = [240.0, 240.0]
center_px = [159.5, 119.5]
rotation = [[-1.0, 0.0, 0.0], [0.0, 0.4472136, -0.8944272], [0.0, -0.8944272, -0.4472136]]
translation_m = [0.0, 0.0, 11.1803399]
)"));
  }

  /// Writes the masks of people who walk these straight ways, one position per frame.
  void Draw(const Tracks& people) const {
    const Scene scene = LoadScene(folder_ / "scene.toml").value();
    for (const SceneCamera& camera : scene.cameras) {
      std::filesystem::create_directories(folder_ / camera.name);
      for (int frame = 0; frame < kFrames; ++frame) {
        cv::Mat mask = cv::Mat::zeros(240, 320, CV_8UC1);
        for (const Track& person : people) {
          const TrackPoint& point = person.points[static_cast<std::size_t>(frame)];
          const auto box =
              PersonBox(camera.camera, {point.x_m, point.y_m}, scene.person.OrDefault()).value();
          const cv::Rect rectangle(cv::Point(static_cast<int>(std::lround(box.min_x)),
                                             static_cast<int>(std::lround(box.min_y))),
                                   cv::Point(static_cast<int>(std::lround(box.max_x)),
                                             static_cast<int>(std::lround(box.max_y))));
          cv::rectangle(mask, rectangle, cv::Scalar(255), cv::FILLED);
        }
        cv::imwrite((folder_ / fmt::format("{}/{:06d}.png", camera.name, frame)).string(), mask);
      }
    }
  }

  static Track Walk(int id, Eigen::Vector2d from_m, Eigen::Vector2d to_m) {
    Track track;
    track.id = static_cast<TrackId>(id);
    for (int frame = 0; frame < kFrames; ++frame) {
      const Eigen::Vector2d at_m = from_m + (to_m - from_m) * frame / (kFrames - 1.0);
      track.points.push_back({.frame = frame, .x_m = at_m.x(), .y_m = at_m.y()});
    }
    return track;
  }

  Scene Load() const { return LoadScene(folder_ / "scene.toml").value(); }

  TemporaryFolder folder_;
};

/// Each crosses the ways of the two others, 1.2 m from them at the nearest: who stand in one place
/// cannot be told apart by where they stand.
TEST_F(TwoCameras, ThreePeopleWhoseWaysCrossKeepTheirIdentities) {
  const Tracks truth = {Walk(1, {-3, -2}, {3, 2}), Walk(2, {1.4, 2.5}, {1.6, -2.5}),
                        Walk(3, {3, -1.5}, {-2, -1.5})};
  Draw(truth);
  const Scene scene = Load();
  StageOptions options;
  ASSERT_TRUE(BindStages(scene, options));
  const auto result = TrackPeople(scene, options, 2);
  ASSERT_TRUE(result) << MessageOf(result);
  const auto measures = EvaluateTracks(truth, result->tracks, {.threshold_m = 0.5});
  ASSERT_TRUE(measures);
  EXPECT_GE(measures->mota, 0.95);
  EXPECT_EQ(measures->switches, 0);
  EXPECT_LT(measures->motp, 0.15) << "positions are finer than the cells of 0.5 m";
  EXPECT_EQ(result->report.maps.frames, kFrames);
  EXPECT_EQ(result->report.maps.unseen_area_cells, 0);
}

TEST_F(TwoCameras, ThreadsAndBatchesDoNotChangeTheMaps) {
  Draw({Walk(1, {-3, -2}, {3, 2}), Walk(2, {-3, 2}, {3, -2})});
  const Scene scene = Load();
  const StageOptions options;
  const auto one = ComputeMaps(scene, options, 1);
  const auto three = ComputeMaps(scene, options, 3);
  ASSERT_TRUE(one && three);
  EXPECT_EQ(one->maps.values, three->maps.values);
}

TEST_F(TwoCameras, FramesAskedForAreTheFramesGiven) {
  Draw({Walk(1, {-3, -2}, {3, 2})});
  Scene scene = Load();
  const auto whole = ComputeMaps(scene, {}, 2);
  scene.first_frame = 10;
  scene.frame_count = 5;
  std::vector<FrameIndex> frames;
  const auto part =
      ComputeMaps(scene, {}, 2, {}, [&](FrameIndex frame, const auto& masks) -> Status {
        EXPECT_EQ(masks.size(), 2U);
        frames.push_back(frame);
        return {};
      });
  ASSERT_TRUE(whole && part);
  EXPECT_EQ(part->maps.first_frame, 10);
  ASSERT_EQ(part->maps.frame_count(), 5);
  EXPECT_EQ(frames, (std::vector<FrameIndex>{10, 11, 12, 13, 14}));
  for (int i = 0; i < 5; ++i) {
    EXPECT_TRUE(std::ranges::equal(part->maps.Frame(i), whole->maps.Frame(10 + i)));
  }
  scene.first_frame = 1000;
  EXPECT_NE(MessageOf(ComputeMaps(scene, {}, 2)), "");
}

TEST_F(TwoCameras, StopsWhenAsked) {
  Draw({Walk(1, {-3, -2}, {3, 2})});
  const std::atomic<bool> stop{true};
  EXPECT_THAT(MessageOf(TrackPeople(Load(), {}, 2, {.progress = {}, .stop = &stop})),
              HasSubstr("interrupted"));
}

TEST_F(TwoCameras, SummaryRecordsInputsAndOptions) {
  Draw({Walk(1, {-3, -2}, {3, 2})});
  const Scene scene = Load();
  StageOptions options;
  options.linking.depth = 2;
  const auto result = TrackPeople(scene, options, 1);
  ASSERT_TRUE(result);
  const auto summary =
      Summarize({.arguments = {"track"}, .scene = scene.file, .data = {}, .threads = 1}, scene,
                options, *result);
  ASSERT_TRUE(summary) << MessageOf(summary);
  EXPECT_EQ((*summary)["options"]["linking"]["depth"], 2);
  EXPECT_EQ((*summary)["inputs_sha256"][scene.file.string()], Sha256OfFile(scene.file).value());
  EXPECT_EQ((*summary)["counts"]["frames"], kFrames);
  EXPECT_EQ((*summary)["options"]["grid"]["extension"], 1);
  EXPECT_EQ((*summary)["extension"]["max_y"].dump(), R"({"metres":1.0,"reason":"given"})");
}

TEST_F(TwoCameras, TheGroundGoesAsFarAsWhoCoversTheArea) {
  Draw({Walk(1, {-3, -2}, {3, 2})});
  Scene scene = Load();
  scene.grid.extension_m = std::nullopt;
  scene.grid.max_extension_m = 5;
  scene.frame_count = 2;
  const auto result = TrackPeople(scene, {}, 1);
  ASSERT_TRUE(result) << MessageOf(result);
  const ExtensionReport& extension = result->report.maps.extension;
  const auto& sides = extension.sides;
  // Each camera looks across the area; the one in the south down on it from y = -10 m.
  EXPECT_EQ(sides[2].camera, 1u);
  EXPECT_EQ(sides[3].camera, 0u);
  EXPECT_EQ(sides[2].extension_m, sides[3].extension_m);
  EXPECT_GT(sides[3].extension_m, 1);
  EXPECT_EQ(result->maps.grid,
            GroundGrid::Cover(scene.area, scene.grid.cell_m, extension.extension()).value());

  const auto summary = Summarize({.arguments = {}, .scene = scene.file, .data = {}, .threads = 1},
                                 scene, {}, *result);
  ASSERT_TRUE(summary) << MessageOf(summary);
  EXPECT_EQ((*summary)["options"]["grid"]["extension"], "auto");
  const auto& max_y = (*summary)["extension"]["max_y"];
  EXPECT_EQ(max_y["metres"], sides[3].extension_m);
  EXPECT_EQ(max_y["reason"], NameOf(sides[3].reason));
  EXPECT_EQ(max_y["camera"], "south");
  EXPECT_EQ(max_y["cameras_metres"]["north"], sides[3].cameras_m[1]);
}

TEST_F(TwoCameras, AreaThatNoCameraSeesIsAnError) {
  Draw({Walk(1, {-3, -2}, {3, 2})});
  Scene scene = Load();
  scene.area = Polygon::Rectangle({200, 200}, {205, 205}).value();
  EXPECT_THAT(MessageOf(LayOutGround(scene, {}, {})), HasSubstr("no camera sees any of the area"));
  scene.area = Polygon::Rectangle({0, 0}, {0.1, 0.1}).value();
  EXPECT_THAT(MessageOf(LayOutGround(scene, {}, {})), HasSubstr("use smaller cells"));
}

TEST_F(TwoCameras, BlindPixelsReachTheViews) {
  Draw({Walk(1, {-3, -2}, {3, 2})});
  Scene scene = Load();
  OccupancyOptions options;
  options.reduction = 1;
  const Ground whole = LayOutGround(scene, scene.person.OrDefault(), options).value();
  cv::Mat& blind = scene.cameras[0].blind;
  blind = cv::Mat::zeros(240, 320, CV_8UC1);
  blind.colRange(0, 160) = 255;
  const Ground half = LayOutGround(scene, scene.person.OrDefault(), options).value();
  EXPECT_EQ(cv::norm(half.views[0].informative, 255 - blind, cv::NORM_L1), 0);
  EXPECT_TRUE(half.views[1].informative.empty());
  EXPECT_EQ(half.views[1].rectangles, whole.views[1].rectangles);
  for (std::size_t i = 0; i < whole.visible.size(); ++i) {
    const cv::Rect& r = whole.views[0].rectangles[i];
    EXPECT_EQ(half.views[0].rectangles[i], r.x + r.width <= 160 ? cv::Rect() : r);
  }
}

// Real data: floors that a regression would break; the figures are in README.md.

/// Measures at 1 m inside the usual area of PETS 2009 S2.L1 over the first frames of an example.
TrackMeasures MeasuresOfExample(const std::string& example, const std::filesystem::path& data,
                                std::int64_t frames) {
  auto scene =
      LoadScene(std::filesystem::path(VANTAGE_SOURCE_DIR) / "examples/pets2009" / example, data);
  EXPECT_TRUE(scene) << MessageOf(scene);
  scene->frame_count = frames;
  StageOptions options;
  EXPECT_TRUE(BindStages(*scene, options));
  const auto result = TrackPeople(*scene, options, 2);
  EXPECT_TRUE(result) << MessageOf(result);
  Tracks truth = ReadTracks(DataFolder() / "pets2009/gt-mot15-3d.txt").value();
  for (Track& track : truth) {
    std::erase_if(track.points, [&](const TrackPoint& point) { return point.frame >= frames; });
  }
  std::erase_if(truth, [](const Track& track) { return track.points.empty(); });
  return EvaluateTracks(truth, result->tracks, {.threshold_m = 1}, &scene->area).value();
}

TEST(PetsS2L1, SevenViewsOfBoxes) {
  if (DataFolder().empty()) GTEST_SKIP() << "the research data is not here";
  EXPECT_GE(MeasuresOfExample("seven-views.toml", DataFolder() / "pets2009", 120).mota, 0.90);
}

TEST(PetsS2L1, OneViewOfVideo) {
  const std::filesystem::path video_folder = "/usr/share/doc/opencv-doc/examples/data";
  if (DataFolder().empty()) GTEST_SKIP() << "the research data is not here";
  if (!std::filesystem::exists(video_folder / "vtest.avi")) GTEST_SKIP() << "vtest.avi is not here";
  const TrackMeasures measures = MeasuresOfExample("scene.toml", video_folder, 795);
  EXPECT_GE(measures.mota, 0.96);
  EXPECT_LE(measures.motp, 0.26);
  EXPECT_LE(measures.switches, 2);
  EXPECT_GE(measures.idf1, 0.95);
}

}  // namespace
}  // namespace vantage
