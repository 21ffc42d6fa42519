// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "vantage/background/subtractor.h"
#include "vantage/base/result.h"
#include "vantage/base/run_control.h"
#include "vantage/identity/appearance.h"
#include "vantage/identity/identify.h"
#include "vantage/linking/link_maps.h"
#include "vantage/occupancy/extension.h"
#include "vantage/occupancy/maps.h"
#include "vantage/occupancy/solver.h"
#include "vantage/pipeline/occupied.h"
#include "vantage/pipeline/person.h"
#include "vantage/scene/scene.h"
#include "vantage/tracks/track.h"

namespace vantage {

/// The options of every stage.
struct StageOptions {
  BackgroundOptions background;
  HoldOptions hold;
  OccupancyOptions occupancy;
  LinkingOptions linking;
  IdentityOptions identity;
  TrackOptions tracks;
};

/// Sets what the scene's tables [background], [hold], [occupancy], [linking], [identity] and
/// [tracks] give.
Status BindStages(const Scene& scene, StageOptions& options);

/// What the way from pictures to maps did.
struct MapsReport {
  std::int64_t frames = 0;
  /// The first pass over the beginning of the recording (Rehearse).
  double rehearsal_secs = 0;
  PersonReport person;
  /// Fixed-point iterations per frame, and frames that used all allowed ones without settling.
  double mean_iterations = 0;
  std::int64_t frames_not_converged = 0;
  /// Pictures, of all cameras together, that were missing: the maps of those frames are without
  /// them.
  std::int64_t pictures_missing = 0;
  /// Cells of the area, and of these the ones that no camera sees.
  std::int64_t area_cells = 0;
  std::int64_t unseen_area_cells = 0;
  ExtensionReport extension;
  /// Time spent in the stages, which overlap, all threads together; collecting the maps and finding
  /// what to hold are one stage.
  double read_secs = 0;
  double background_secs = 0;
  double occupancy_secs = 0;
  double hold_secs = 0;
  /// Time that threads were without work, and wall-clock time of the whole chain.
  double idle_secs = 0;
  double wall_secs = 0;
  /// One entry per camera; cameras that deliver masks have an empty one.
  std::vector<BackgroundReport> background;
  HoldReport hold;
};

struct MapsResult {
  OccupancyMaps maps;
  /// Colours of the people in the maps; none without options.identity.appearance and where no
  /// camera delivers colour.
  Appearances appearances;
  MapsReport report;
};

/// Takes the masks of each frame as the pipeline sees them (e.g. to write them); may be empty.
using MaskSink = std::function<Status(FrameIndex frame, const std::vector<cv::Mat>& masks)>;

/// From pictures to occupancy maps. With options.hold, people found so far who stand are held in
/// the foreground of the frames that follow (OccupiedRegions); without, and where no camera
/// delivers colour, every frame is solved by itself.
Result<MapsResult> ComputeMaps(const Scene& scene, const StageOptions& options, int threads,
                               const RunControl& control = {}, const MaskSink& mask_sink = {});

struct TrackingReport {
  MapsReport maps;
  LinkMapsReport linking;
  IdentityReport identity;
  double total_secs = 0;
};

struct TrackingResult {
  Tracks tracks;
  OccupancyMaps maps;
  Appearances appearances;
  TrackingReport report;
};

/// The whole way: from a scene to tracks.
Result<TrackingResult> TrackPeople(const Scene& scene, const StageOptions& options, int threads,
                                   const RunControl& control = {}, const MaskSink& mask_sink = {});

}  // namespace vantage
