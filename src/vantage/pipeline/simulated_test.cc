// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
// The whole way on small simulated recordings: floors of accuracy that a regression would break.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <vector>

#include "vantage/base/parallel.h"
#include "vantage/base/test_support.h"
#include "vantage/metrics/clear_mot.h"
#include "vantage/pipeline/track.h"
#include "vantage/scene/scene.h"
#include "vantage/simulation/recording.h"
#include "vantage/tracks/track_file.h"

namespace vantage {
namespace {

using testing::MessageOf;

/// Records, tracks and compares at 1 m inside the area. What happens before frame `judged` is seen
/// and not judged: in so short a recording who stands still at first is background until they move,
/// and appears where that is. All options are the defaults, but that paths may begin there.
Result<TrackMeasures> Measure(const simulation::RecordOptions& options, FrameIndex judged) {
  const testing::TemporaryFolder folder;
  const int threads = HardwareThreads();
  VANTAGE_RETURN_IF_ERROR(simulation::RecordScene(options, folder.path(), threads));
  VANTAGE_ASSIGN_OR_RETURN(const Scene scene, LoadScene(folder / "scene.toml"));
  StageOptions stages;
  stages.linking.inside_cost = kInsideCostOfStreams;
  VANTAGE_ASSIGN_OR_RETURN(TrackingResult tracked, TrackPeople(scene, stages, threads));
  VANTAGE_ASSIGN_OR_RETURN(Tracks truth, ReadTracks(folder / "truth" / "tracks.csv"));
  for (Track& track : truth) {
    std::erase_if(track.points, [&](const TrackPoint& point) { return point.frame < judged; });
  }
  for (Track& track : tracked.tracks) {
    std::erase_if(track.points, [&](const TrackPoint& point) { return point.frame < judged; });
  }
  VANTAGE_ASSIGN_OR_RETURN(const TrackMeasures measures,
                           EvaluateTracks(truth, tracked.tracks, {}, &scene.area));
  fmt::print("{}: MOTA {:.4f} MOTP {:.3f} FN {} FP {} IDSW {} of {}\n", options.preset,
             measures.mota, measures.motp, measures.misses, measures.false_positives,
             measures.switches, measures.truth_positions);
  return measures;
}

TEST(Simulated, SmallFloorball) {
  const auto measures = Measure(
      {.preset = "floorball", .stage = {.frames = 170, .cameras = 4, .scale = 0.5}, .masks = false},
      120);
  ASSERT_TRUE(measures) << MessageOf(measures);
  EXPECT_GT(measures->mota, 0.8);
  EXPECT_LT(measures->motp, 0.25);
}

TEST(Simulated, SmallCampus) {
  const auto measures = Measure(
      {.preset = "campus", .stage = {.frames = 160, .cameras = 4, .scale = 0.5}, .masks = false},
      80);
  ASSERT_TRUE(measures) << MessageOf(measures);
  EXPECT_GT(measures->mota, 0.7);
  EXPECT_LT(measures->motp, 0.2);
}

}  // namespace
}  // namespace vantage
