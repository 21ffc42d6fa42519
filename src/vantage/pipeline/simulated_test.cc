// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
// The whole way on small simulated recordings: floors of accuracy that a regression would break.
#include <fmt/format.h>
#include <gtest/gtest.h>

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

/// Records, tracks by default options and compares, all at 1 m inside the area.
Result<TrackMeasures> Measure(const simulation::RecordOptions& options) {
  const testing::TemporaryFolder folder;
  const int threads = HardwareThreads();
  VANTAGE_RETURN_IF_ERROR(simulation::RecordScene(options, folder.path(), threads));
  VANTAGE_ASSIGN_OR_RETURN(const Scene scene, LoadScene(folder / "scene.toml"));
  VANTAGE_ASSIGN_OR_RETURN(const TrackingResult tracked, TrackPeople(scene, {}, threads));
  VANTAGE_ASSIGN_OR_RETURN(const Tracks truth, ReadTracks(folder / "truth" / "tracks.csv"));
  VANTAGE_ASSIGN_OR_RETURN(const TrackMeasures measures,
                           EvaluateTracks(truth, tracked.tracks, {}, &scene.area));
  fmt::print("{}: MOTA {:.4f} MOTP {:.3f} FN {} FP {} IDSW {} of {}\n", options.preset,
             measures.mota, measures.motp, measures.misses, measures.false_positives,
             measures.switches, measures.truth_positions);
  return measures;
}

TEST(Simulated, SmallFloorball) {
  const auto measures = Measure({.preset = "floorball",
                                 .stage = {.frames = 120, .cameras = 3, .scale = 0.4},
                                 .masks = false});
  ASSERT_TRUE(measures) << MessageOf(measures);
  EXPECT_GT(measures->mota, 0.5);
}

TEST(Simulated, SmallCampus) {
  const auto measures = Measure(
      {.preset = "campus", .stage = {.frames = 120, .cameras = 3, .scale = 0.5}, .masks = false});
  ASSERT_TRUE(measures) << MessageOf(measures);
  EXPECT_GT(measures->mota, 0.5);
}

}  // namespace
}  // namespace vantage
