// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
// The chain of stages on pictures of several cameras: the same answer, or error, for every number
// of threads.
#include <gmock/gmock.h>
#include <oneapi/tbb/global_control.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

#include "vantage/base/file.h"
#include "vantage/base/test_support.h"
#include "vantage/pipeline/track.h"

namespace vantage {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using testing::MessageOf;
using testing::TemporaryFolder;

constexpr std::array kThreads = {1, 2, 3, 8};
constexpr int kFrames = 60;
constexpr int kEmpty = 20;  // in which the background is learnt and nobody is there

/// Pictures of three cameras around an area of 8 x 6 m, 5 m up; somebody comes in and stands,
/// somebody walks (simulated).
class ThreeCameras : public ::testing::Test {
 protected:
  ThreeCameras() {
    std::string text = R"(
name = "three"
frames_per_second = 10.0
[area]
polygon = [[-4.0, -3.0], [4.0, -3.0], [4.0, 3.0], [-4.0, 3.0]]
[grid]
cell = 0.5
extension = 1.0
[person]
width = 0.8
height = 1.8
[hold]
window = 0.8
)";
    const std::array rotations = {
        "[[1.0, 0.0, 0.0], [0.0, -0.4472136, -0.8944272], [0.0, 0.8944272, -0.4472136]]",
        "[[-1.0, 0.0, 0.0], [0.0, 0.4472136, -0.8944272], [0.0, -0.8944272, -0.4472136]]",
        "[[0.0, 1.0, 0.0], [0.4472136, 0.0, -0.8944272], [-0.8944272, 0.0, -0.4472136]]"};
    for (std::size_t i = 0; i < rotations.size(); ++i) {
      text += fmt::format(R"(
[[cameras]]
name = "{0}"
source = {{ pictures = "{0}" }}
offset_frames = {1}
[cameras.calibration.pinhole]
size_px = [160, 120]
focal_px = [120.0, 120.0]
center_px = [79.5, 59.5]
rotation = {2}
translation_m = [0.0, 0.0, 11.1803399]
)",
                          kNames[i], i == 2 ? -3 : 0, rotations[i]);
    }
    EXPECT_TRUE(WriteTextFile(folder_ / "scene.toml", text));
    cv::RNG random(7);
    cv::Mat floor(120, 160, CV_8UC3), clothes(120, 160, CV_8UC3), noise(120, 160, CV_8UC3);
    random.fill(floor, cv::RNG::UNIFORM, 60, 90);
    random.fill(clothes, cv::RNG::UNIFORM, 150, 255);
    const Scene scene = Load();
    for (const SceneCamera& camera : scene.cameras) {
      std::filesystem::create_directories(folder_ / camera.name);
      for (int frame = 0; frame < kFrames; ++frame) {
        cv::Mat picture = floor.clone();
        if (frame >= kEmpty) {
          for (const Eigen::Vector2d& person_m :
               {Eigen::Vector2d(std::min(-8.2 + 0.25 * frame, -1.2), 0.8),
                Eigen::Vector2d(2.5, -4.2 + 0.12 * frame)}) {
            const PixelBox box =
                PersonBox(camera.camera, person_m, scene.person.OrDefault()).value();
            const cv::Rect pixels(cv::Point(static_cast<int>(std::lround(box.min_x)),
                                            static_cast<int>(std::lround(box.min_y))),
                                  cv::Point(static_cast<int>(std::lround(box.max_x)),
                                            static_cast<int>(std::lround(box.max_y))));
            const cv::Rect seen = pixels & cv::Rect(0, 0, 160, 120);
            clothes(seen).copyTo(picture(seen));
          }
        }
        random.fill(noise, cv::RNG::UNIFORM, 0, 7);
        picture += noise;
        cv::imwrite(Picture(camera.name, frame).string(), picture);
      }
    }
  }

  std::filesystem::path Picture(const std::string& camera, int frame) const {
    return folder_ / fmt::format("{}/{:06d}.bmp", camera, frame);
  }
  Scene Load() const { return LoadScene(folder_ / "scene.toml").value(); }
  static StageOptions Options(const Scene& scene) {
    StageOptions options;
    EXPECT_TRUE(BindStages(scene, options));
    return options;
  }

  static constexpr std::array<const char*, 3> kNames = {"south", "north", "east"};
  TemporaryFolder folder_;
  // As many threads as are asked for, also where there are fewer processors.
  tbb::global_control threads_{tbb::global_control::max_allowed_parallelism, 8};
};

/// To the bit: hidden bands are NaN.
bool Same(const Appearance& a, const Appearance& b) {
  return a.frame == b.frame && a.cell == b.cell && a.camera == b.camera &&
         std::memcmp(a.colors.data(), b.colors.data(), sizeof a.colors) == 0;
}

TEST_F(ThreeCameras, EveryNumberOfThreadsGivesTheSame) {
  const Scene scene = Load();
  for (const bool standing : {true, false}) {
    for (const bool warm_start : {false, true}) {
      StageOptions options = Options(scene);
      options.hold.standing = standing;
      options.occupancy.warm_start = warm_start;
      std::vector<std::vector<cv::Mat>> masks;
      std::optional<TrackingResult> sequential;
      for (const int threads : kThreads) {
        FrameIndex next = 0;
        const auto sink = [&](FrameIndex frame, const std::vector<cv::Mat>& made) -> Status {
          EXPECT_EQ(frame, next);
          if (threads == 1) {
            masks.emplace_back();
            for (const cv::Mat& mask : made) masks.back().push_back(mask.clone());
          }
          const auto& expected = masks[static_cast<std::size_t>(next++)];
          for (std::size_t camera = 0; camera < made.size(); ++camera) {
            EXPECT_EQ(made[camera].empty(), expected[camera].empty());
            if (made[camera].empty()) continue;
            EXPECT_EQ(cv::norm(made[camera], expected[camera], cv::NORM_INF), 0);
          }
          return {};
        };
        std::int64_t reported = 0;
        auto result = TrackPeople(scene, options, threads,
                                  {.progress =
                                       [&](std::int64_t done, std::int64_t total) {
                                         if (total == kFrames) reported = std::max(reported, done);
                                       }},
                                  sink);
        ASSERT_TRUE(result) << MessageOf(result);
        EXPECT_EQ(next, kFrames);
        EXPECT_EQ(reported, kFrames);
        if (!sequential) {
          sequential = std::move(*result);
          EXPECT_GE(sequential->tracks.size(), 2u);
          EXPECT_EQ(sequential->report.maps.pictures_missing, 3) << "one camera starts later";
          EXPECT_EQ(sequential->report.maps.hold.pictures > 0, standing);
          EXPECT_GE(sequential->appearances.size(), 10u);
          continue;
        }
        EXPECT_EQ(result->maps.values, sequential->maps.values);
        EXPECT_EQ(result->tracks, sequential->tracks);
        EXPECT_TRUE(std::ranges::equal(result->appearances, sequential->appearances, Same));
        const MapsReport& report = result->report.maps;
        const MapsReport& expected = sequential->report.maps;
        EXPECT_EQ(report.frames, expected.frames);
        EXPECT_EQ(report.mean_iterations, expected.mean_iterations);
        EXPECT_EQ(report.pictures_missing, expected.pictures_missing);
        EXPECT_EQ(report.hold.places, expected.hold.places);
        EXPECT_EQ(report.hold.pictures, expected.hold.pictures);
        EXPECT_EQ(report.hold.released_as_ghosts_px, expected.hold.released_as_ghosts_px);
      }
    }
  }
}

TEST_F(ThreeCameras, TheShortestRecordingEndsIt) {
  for (int frame = 30; frame < kFrames; ++frame) {
    std::filesystem::remove(Picture("north", frame));
  }
  const Scene scene = Load();
  for (const int threads : kThreads) {
    const auto result = ComputeMaps(scene, Options(scene), threads);
    ASSERT_TRUE(result) << MessageOf(result);
    EXPECT_EQ(result->report.frames, 30);
    EXPECT_EQ(result->maps.frame_count(), 30);
  }
}

TEST_F(ThreeCameras, AnErrorMidwayIsTheSameError) {
  // Cut short: the later one, of the camera that is read first, is not the first to count.
  std::filesystem::resize_file(Picture("south", 24), 1000);
  std::filesystem::resize_file(Picture("north", 23), 1000);
  const Scene scene = Load();
  for (const int threads : kThreads) {
    FrameIndex frames = 0;
    const std::string message = MessageOf(TrackPeople(
        scene, Options(scene), threads, {}, [&](FrameIndex, const std::vector<cv::Mat>&) -> Status {
          ++frames;
          return {};
        }));
    EXPECT_THAT(message, AllOf(HasSubstr("north"), HasSubstr("000023.bmp")));
    EXPECT_EQ(frames, 23) << "what comes before it is done";
  }
}

TEST_F(ThreeCameras, AnErrorOfTheMasksReaderIsReported) {
  const Scene scene = Load();
  for (const int threads : kThreads) {
    EXPECT_EQ(MessageOf(ComputeMaps(scene, Options(scene), threads, {},
                                    [](FrameIndex frame, const auto&) -> Status {
                                      if (frame >= 11) return Fail("no space at {}", frame);
                                      return {};
                                    })),
              "no space at 11");
  }
}

TEST_F(ThreeCameras, StopsInTheMiddle) {
  const Scene scene = Load();
  for (const int threads : kThreads) {
    std::atomic<bool> stop = false;
    FrameIndex last = 0;
    const auto result = TrackPeople(scene, Options(scene), threads, {.progress = {}, .stop = &stop},
                                    [&](FrameIndex frame, const auto&) -> Status {
                                      last = frame;
                                      if (frame == 10) stop = true;
                                      return {};
                                    });
    EXPECT_THAT(MessageOf(result), HasSubstr("interrupted"));
    EXPECT_EQ(last, 10);
  }
}

}  // namespace
}  // namespace vantage
