// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
// The way back from the tracker to the masks, on drawn and on real pictures.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "vantage/base/file.h"
#include "vantage/base/test_support.h"
#include "vantage/metrics/mask_measures.h"
#include "vantage/occupancy/solver.h"
#include "vantage/pipeline/ground.h"
#include "vantage/pipeline/mask_stream.h"
#include "vantage/pipeline/summary.h"
#include "vantage/pipeline/track.h"
#include "vantage/video/sequence.h"

namespace vantage {
namespace {

using testing::DataFolder;
using testing::MessageOf;
using testing::TemporaryFolder;

using Masks = std::vector<cv::Mat>;

/// Maps and masks of a scene with one camera.
struct Masked {
  MapsResult result;
  Masks masks;
};

Masked Compute(const Scene& scene, const StageOptions& options, int threads = 2) {
  Masked run;
  auto result =
      ComputeMaps(scene, options, threads, {}, [&](FrameIndex, const Masks& masks) -> Status {
        run.masks.push_back(masks[0].clone());
        return {};
      });
  EXPECT_TRUE(result) << MessageOf(result);
  if (result) run.result = std::move(*result);
  return run;
}

/// A camera 4 m up that looks at a floor, at 10 frames per second (simulated).
class DrawnScene : public ::testing::Test {
 protected:
  DrawnScene() {
    EXPECT_TRUE(WriteTextFile(folder_ / "scene.toml", R"(
name = "drawn"
frames_per_second = 10.0
[area]
polygon = [[-3.0, -1.0], [3.0, -1.0], [3.0, 4.0], [-3.0, 4.0]]
[grid]
cell = 0.4
[background]
alpha = 0.02
[occupancy]
variance = 0.003
reduction = 2
[[cameras]]
name = "camera"
source = { pictures = "pictures" }
[cameras.calibration.pinhole]
size_px = [160, 120]
focal_px = [140.0, 140.0]
center_px = [79.5, 59.5]
rotation = [[1.0, 0.0, 0.0], [0.0, -0.6, -0.8], [0.0, 0.8, -0.6]]
translation_m = [0.0, 0.8, 5.6]
)"));
    std::filesystem::create_directories(folder_ / "pictures");
    cv::RNG random(7);
    // Brighter to the right, without edges.
    for (int x = 0; x < floor_.cols; ++x) floor_.col(x).setTo(cv::Scalar::all(40 + x / 2));
    random.fill(clothes_, cv::RNG::UNIFORM, 150, 255);
    clothes_.rowRange(0, 20).setTo(cv::Scalar(30, 20, 200));
  }

  /// Where a person at (x, 0.5) is.
  cv::Rect Person(double x_m) const {
    const Scene scene = Load();
    const PixelBox box =
        PersonBox(scene.cameras[0].camera, {x_m, 0.5}, scene.person.OrDefault()).value();
    return cv::Rect(cv::Point(static_cast<int>(std::lround(box.min_x)),
                              static_cast<int>(std::lround(box.min_y))),
                    cv::Point(static_cast<int>(std::lround(box.max_x)),
                              static_cast<int>(std::lround(box.max_y)))) &
           cv::Rect(0, 0, 160, 120);
  }

  /// Pictures of a person at x_m(frame); nobody where that is not a number.
  void Draw(int frames, const std::function<double(int)>& x_m) const {
    cv::RNG random(11);
    cv::Mat noise(120, 160, CV_8UC3);
    for (int frame = 0; frame < frames; ++frame) {
      cv::Mat picture = floor_.clone();
      if (const double x = x_m(frame); !std::isnan(x)) {
        const cv::Rect person = Person(x);
        clothes_(cv::Rect({0, 0}, person.size())).copyTo(picture(person));
      }
      random.fill(noise, cv::RNG::UNIFORM, 0, 7);
      picture += noise;
      cv::imwrite((folder_ / fmt::format("pictures/{:06d}.bmp", frame)).string(), picture);
    }
  }

  Scene Load() const { return LoadScene(folder_ / "scene.toml").value(); }
  StageOptions Options() const {
    StageOptions options;
    EXPECT_TRUE(BindStages(Load(), options));
    return options;
  }

  TemporaryFolder folder_;
  cv::Mat floor_ = cv::Mat(120, 160, CV_8UC3);
  cv::Mat clothes_ = cv::Mat(120, 160, CV_8UC3);
};

constexpr double kNobody = std::numeric_limits<double>::quiet_NaN();

/// Comes in from the left at frame 40, stands at x = 0 from frame 60 to `leaves`, and is gone 20
/// frames later.
std::function<double(int)> ComesAndStands(int leaves) {
  return [leaves](int frame) {
    if (frame < 40 || frame >= leaves + 20) return kNobody;
    if (frame < 60) return -2.5 + 0.125 * (frame - 40);
    return frame < leaves ? 0.0 : 0.125 * (frame - leaves);
  };
}

/// Share of the rectangle that is foreground.
double ShareOf(const cv::Mat& mask, const cv::Rect& rectangle) {
  return static_cast<double>(cv::countNonZero(mask(rectangle))) / rectangle.area();
}

TEST_F(DrawnScene, TheRecordSaysWhatDisturbedTheCamera) {
  Draw(140, ComesAndStands(120));
  for (int frame = 80; frame < 90; ++frame) {
    cv::imwrite((folder_ / fmt::format("pictures/{:06d}.bmp", frame)).string(),
                cv::Mat(120, 160, CV_8UC3, cv::Scalar::all(4)));
  }
  const Scene scene = Load();
  const auto result = TrackPeople(scene, Options(), 2);
  ASSERT_TRUE(result) << MessageOf(result);
  const auto summary = Summarize({.arguments = {}, .scene = {}, .data = {}, .threads = 2}, scene,
                                 Options(), *result);
  ASSERT_TRUE(summary) << MessageOf(summary);
  const auto& camera = (*summary)["background"]["camera"];
  EXPECT_EQ(camera["frames"], 140);
  EXPECT_EQ(camera["skipped_frames"], 10);
  ASSERT_EQ(camera["events"].size(), 1u) << camera.dump();
  EXPECT_EQ(camera["events"][0]["kind"], "black");
  EXPECT_EQ(camera["events"][0]["frame"], 80);
  EXPECT_EQ(camera["events"][0]["frames"], 10);
}

TEST_F(DrawnScene, WhoStandsFor600FramesStaysForeground) {
  Draw(700, ComesAndStands(660));
  StageOptions options = Options();
  options.background.mixture.alpha = 0.002;  // the default
  ASSERT_TRUE(options.hold.standing) << "on by default";
  const Masked held = Compute(Load(), options);
  options.hold.standing = false;
  const Masked faded = Compute(Load(), options);
  const cv::Rect person = Person(0);
  for (const std::size_t frame : {100U, 300U, 500U, 659U}) {
    EXPECT_GT(ShareOf(held.masks[frame], person), 0.9) << frame;
  }
  EXPECT_GT(ShareOf(faded.masks[100], person), 0.9);
  EXPECT_LT(ShareOf(faded.masks[659], person), 0.05);
  EXPECT_LT(cv::countNonZero(held.masks[659]), 1.5 * person.area()) << "and nothing else";
  EXPECT_EQ(cv::countNonZero(held.masks[699]), 0) << "nothing is left behind";
  EXPECT_EQ(held.result.report.hold.places, 1);
  EXPECT_GT(held.result.report.hold.pictures, 550);
  EXPECT_EQ(faded.result.report.hold.pictures, 0);
}

TEST_F(DrawnScene, DependsOnlyOnThePastAndNotOnThreads) {
  Draw(150, ComesAndStands(140));
  Scene scene = Load();
  const Masked whole = Compute(scene, Options(), 1);
  const Masked parallel = Compute(scene, Options(), 3);
  EXPECT_EQ(whole.result.maps.values, parallel.result.maps.values);
  const auto same = [](const cv::Mat& a, const cv::Mat& b) { return cv::norm(a, b) == 0; };
  EXPECT_TRUE(std::ranges::equal(whole.masks, parallel.masks, same));
  for (const int frames : {95, 101, 128}) {
    scene.frame_count = frames;
    const Masked part = Compute(scene, Options(), 2);
    ASSERT_EQ(std::ssize(part.masks), frames);
    EXPECT_GT(part.result.report.hold.pictures, 0);
    EXPECT_TRUE(std::equal(part.masks.begin(), part.masks.end(), whole.masks.begin(), same));
    EXPECT_TRUE(std::equal(part.result.maps.values.begin(), part.result.maps.values.end(),
                           whole.result.maps.values.begin()));
  }
}

TEST_F(DrawnScene, WithoutHoldEveryFrameIsForItself) {
  Draw(100, ComesAndStands(90));
  const Scene scene = Load();
  StageOptions options = Options();
  options.hold.standing = false;
  const Masked run = Compute(scene, options);
  const Ground ground =
      LayOutGround(scene, run.result.report.person.used, options.occupancy).value();
  const auto solver = OccupancySolver::Create(ground.views, options.occupancy);
  auto subtractor = BackgroundSubtractor::Create({160, 120}, options.background);
  ASSERT_TRUE(solver && subtractor);
  std::vector<float> map(solver->cell_count());
  for (int frame = 0; frame < 100; ++frame) {
    cv::Mat mask;
    ASSERT_TRUE(subtractor->Apply(
        cv::imread((folder_ / fmt::format("pictures/{:06d}.bmp", frame)).string()), mask, 1));
    ASSERT_EQ(cv::norm(mask, run.masks[static_cast<std::size_t>(frame)]), 0) << frame;
    ASSERT_TRUE(solver->Solve(std::span(&mask, 1), map));
    ASSERT_TRUE(std::ranges::equal(map, run.result.maps.Frame(frame))) << frame;
  }
}

TEST_F(DrawnScene, AThingThatWasPutDownIsReleasedAtTheLimitAndFades) {
  Draw(220, [](int frame) { return frame < 40 ? kNobody : 0.0; });
  StageOptions options = Options();
  options.hold.limit_secs = 8;
  const Masked run = Compute(Load(), options);
  const cv::Rect thing = Person(0);
  // Named from frame 56 on (15 frames seen, in steps of 8); it would fade within 35 frames.
  EXPECT_GT(ShareOf(run.masks[130], thing), 0.9) << "held";
  EXPECT_LT(ShareOf(run.masks[190], thing), 0.05) << "released and faded";
  EXPECT_EQ(run.result.report.hold.places, 1);
  EXPECT_EQ(run.result.report.hold.released_by_time, 1);
}

TEST_F(DrawnScene, AGhostThatIsHeldIsReleasedByVerdictsAndAbsorbed) {
  // Stands there from the start, and vanishes: what is left is a ghost.
  Draw(160, [](int frame) { return frame < 60 ? 0.0 : kNobody; });
  StageOptions options = Options();
  options.background.mixture.alpha = 0.002;
  options.background.ghosts.still_frames = 40;  // so late that the tracker believes in it first
  const cv::Rect ghost = Person(0);
  const Masked run = Compute(Load(), options);
  EXPECT_GT(ShareOf(run.masks[95], ghost), 0.9) << "held";
  EXPECT_GT(run.result.report.hold.pictures, 10);
  EXPECT_GT(run.result.report.hold.released_as_ghosts_px, 0.8 * ghost.area());
  EXPECT_EQ(cv::countNonZero(run.masks[159]), 0) << "absorbed";
  // Without the verdicts it would still be held.
  options.background.ghosts.rule.criterion = GhostCriterion::kNone;
  EXPECT_GT(ShareOf(Compute(Load(), options).masks[159], ghost), 0.9);
}

// CDnet's office: the man stands from about frame 780 on; without hold he fades from frame 1,100
// on. Floors that a regression would break.
TEST(Office, TheManWhoStandsStaysForeground) {
  const std::filesystem::path data = DataFolder() / "cdnet/office";
  if (DataFolder().empty() || !std::filesystem::exists(data)) {
    GTEST_SKIP() << "the research data is not here";
  }
  auto scene =
      LoadScene(std::filesystem::path(VANTAGE_SOURCE_DIR) / "examples/office/scene.toml", data);
  ASSERT_TRUE(scene) << MessageOf(scene);
  constexpr FrameIndex kFirst = 400;  // so that the background is known when he comes
  scene->first_frame = kFirst;
  scene->frame_count = 860;
  StageOptions options;
  ASSERT_TRUE(BindStages(*scene, options));
  options.occupancy.reduction = 6;
  const auto truth = OpenTruth(data);
  ASSERT_TRUE(truth) << MessageOf(truth);
  const auto measure = [&](const std::function<const cv::Mat&(FrameIndex)>& mask_of) {
    MaskCounts counts;
    for (FrameIndex frame = 1160; frame < 1260; frame += 10) {
      const cv::Mat labels = ReadTruthMask(truth->masks.at(frame), truth->size).value();
      counts += CountMask(labels, mask_of(frame), truth->roi).value();
    }
    return MeasureMasks(counts);
  };
  const Masked held = Compute(*scene, options);
  const MaskMeasures with = measure([&](FrameIndex frame) -> const cv::Mat& {
    return held.masks[static_cast<std::size_t>(frame - kFirst)];
  });
  auto stream = MaskStream::Create(*scene, options.background, 2);
  ASSERT_TRUE(stream) << MessageOf(stream);
  cv::Mat picture, mask;
  FrameIndex next = kFirst;
  const MaskMeasures without = measure([&](FrameIndex frame) -> const cv::Mat& {
    for (; next <= frame; ++next) {
      EXPECT_TRUE(stream->Read(0, next - kFirst, picture).value());
      EXPECT_TRUE(stream->Subtract(0, picture, {}, mask));
    }
    return mask;
  });
  EXPECT_GT(with.recall, 0.9);
  EXPECT_GT(with.precision, 0.9);
  EXPECT_LT(without.recall, 0.6) << "or there is nothing to hold";
}

}  // namespace
}  // namespace vantage
