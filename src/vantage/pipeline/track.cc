// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/pipeline/track.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "vantage/base/parallel.h"
#include "vantage/base/stopwatch.h"
#include "vantage/linking/access.h"
#include "vantage/pipeline/ground.h"
#include "vantage/pipeline/mask_stream.h"
#include "vantage/pipeline/recent_tracks.h"

namespace vantage {
namespace {

/// Masks of consecutive frames, solved in parallel: frames are independent of each other. With a
/// warm start they are not, and one thread solves them in order.
class FrameBatch {
 public:
  FrameBatch(const OccupancySolver& solver, bool warm_start, std::int64_t frames, int threads)
      : solver_(solver),
        warm_start_(warm_start),
        masks_(static_cast<std::size_t>(frames)),
        threads_(warm_start ? 1 : threads) {}

  bool full() const { return used_ == masks_.size(); }
  std::vector<cv::Mat>& Next() { return masks_[used_++]; }
  void DropLast() { --used_; }

  /// Solves the frames held, appends their maps, and empties the batch.
  Status Solve(OccupancyMaps& maps, MapsReport& report) {
    const std::size_t cells = solver_.cell_count();
    const std::size_t start = maps.values.size();
    maps.values.resize(start + used_ * cells);
    std::vector<Result<SolveReport>> solved(used_);
    ParallelFor(threads_, static_cast<std::int64_t>(used_), [&](std::int64_t i) {
      const auto index = static_cast<std::size_t>(i);
      const std::span<float> values(maps.values);
      const std::size_t at = start + index * cells;
      const std::span<const float> previous =
          warm_start_ && at > 0 ? values.subspan(at - cells, cells) : std::span<float>();
      solved[index] = solver_.Solve(masks_[index], values.subspan(at, cells), previous);
    });
    for (const Result<SolveReport>& result : solved) {
      if (!result) return tl::unexpected(result.error());
      iterations_ += result->iterations;
      report.frames_not_converged += result->converged ? 0 : 1;
      report.pictures_missing += result->cameras_left_out;
      ++report.frames;
    }
    report.mean_iterations = static_cast<double>(iterations_) /
                             static_cast<double>(std::max<std::int64_t>(report.frames, 1));
    used_ = 0;
    return {};
  }

 private:
  const OccupancySolver& solver_;
  bool warm_start_;
  std::vector<std::vector<cv::Mat>> masks_;
  std::size_t used_ = 0;
  std::int64_t iterations_ = 0;
  int threads_;
};

/// The way back from the tracker to the masks: the tracks of the last moments name what the next
/// frames hold.
class Feedback {
 public:
  /// None when nothing is to be held, or no camera learns a background.
  static Result<std::optional<Feedback>> Create(const Scene& scene, const PersonOptions& person,
                                                const StageOptions& options,
                                                const MaskStream& stream,
                                                const OccupancyMaps& like) {
    VANTAGE_ASSIGN_OR_RETURN(std::vector<Polygon> doors,
                             DoorsAndEntrances(like.grid, scene.doors, scene.entrances_m));
    const auto learns = [](const auto& subtractor) { return subtractor.has_value(); };
    if (!options.hold.standing || std::ranges::none_of(stream.subtractors(), learns)) {
      return std::nullopt;
    }
    LinkingOptions linking = options.linking;
    linking.max_paths = 0;  // counts the paths of a whole recording
    std::vector<Camera> cameras;
    for (const SceneCamera& camera : scene.cameras) cameras.push_back(camera.camera);
    VANTAGE_ASSIGN_OR_RETURN(
        OccupiedRegions occupied,
        OccupiedRegions::Create(std::move(cameras), person, options.hold, scene.frames_per_second));
    VANTAGE_ASSIGN_OR_RETURN(RecentTracks recent,
                             RecentTracks::Create(like, occupied.window_frames(), linking,
                                                  options.tracks, doors, scene.obstacles));
    return Feedback(std::move(occupied), std::move(recent));
  }

  std::span<const cv::Mat> held() const { return occupied_.held(); }

  /// The frame just read.
  void Judge(const std::vector<cv::Mat>& masks, const MaskStream& stream) {
    for (std::size_t camera = 0; camera < masks.size(); ++camera) {
      const auto& subtractor = stream.subtractors()[camera];
      if (!subtractor || masks[camera].empty()) continue;
      occupied_.Judge(camera, masks[camera], subtractor->verdict());
    }
  }

  /// The maps of the frames read since the last call.
  Status Update(std::span<const float> maps) {
    VANTAGE_RETURN_IF_ERROR(recent_.Add(maps));
    VANTAGE_ASSIGN_OR_RETURN(const Tracks tracks, recent_.Link());
    occupied_.Name(tracks, recent_.next_frame());
    return {};
  }

  const HoldReport& report() const { return occupied_.report(); }

 private:
  Feedback(OccupiedRegions occupied, RecentTracks recent)
      : occupied_(std::move(occupied)), recent_(std::move(recent)) {}
  OccupiedRegions occupied_;
  RecentTracks recent_;
};

}  // namespace

Status BindStages(const Scene& scene, StageOptions& options) {
  VANTAGE_RETURN_IF_ERROR(scene.stages.Bind("background", options.background));
  VANTAGE_RETURN_IF_ERROR(scene.stages.Bind("hold", options.hold));
  VANTAGE_RETURN_IF_ERROR(scene.stages.Bind("occupancy", options.occupancy));
  VANTAGE_RETURN_IF_ERROR(scene.stages.Bind("linking", options.linking));
  return scene.stages.Bind("tracks", options.tracks);
}

Result<MapsResult> ComputeMaps(const Scene& scene, const StageOptions& options, int threads,
                               const RunControl& control, const MaskSink& mask_sink) {
  VANTAGE_ASSIGN_OR_RETURN(PersonReport person,
                           ResolvePerson(scene, options.background, threads, control));
  VANTAGE_ASSIGN_OR_RETURN(Ground ground, LayOutGround(scene, person.used, options.occupancy));
  VANTAGE_ASSIGN_OR_RETURN(const OccupancySolver solver,
                           OccupancySolver::Create(ground.views, options.occupancy));
  VANTAGE_ASSIGN_OR_RETURN(MaskStream stream,
                           MaskStream::Create(scene, options.background, threads));

  MapsResult result;
  OccupancyMaps& maps = result.maps;
  MapsReport& report = result.report;
  report.person = std::move(person);
  report.area_cells = ground.AreaCells();
  report.unseen_area_cells = ground.UnseenAreaCells();
  report.extension = ground.extension;
  maps.grid = ground.grid;
  maps.first_frame = scene.first_frame;
  maps.frames_per_second = scene.frames_per_second;
  maps.in_area = std::move(ground.in_area);
  maps.visible = std::move(ground.visible);

  VANTAGE_ASSIGN_OR_RETURN(std::optional<Feedback> feedback,
                           Feedback::Create(scene, report.person.used, options, stream, maps));

  const std::int64_t total = stream.frame_count().value_or(0);
  // What a frame holds must not depend on the number of threads.
  FrameBatch batch(solver, options.occupancy.warm_start,
                   feedback ? OccupiedRegions::kFramesBetween : 4 * std::max(threads, 1), threads);
  std::int64_t frames_read = 0;
  for (bool more = true; more;) {
    while (more && !batch.full()) {
      if (control.Stopped()) return Cancelled();
      std::vector<cv::Mat>& masks = batch.Next();
      VANTAGE_ASSIGN_OR_RETURN(
          more, stream.Read(masks, feedback ? feedback->held() : std::span<const cv::Mat>()));
      if (!more) {
        batch.DropLast();
        break;
      }
      if (feedback) feedback->Judge(masks, stream);
      if (mask_sink) VANTAGE_RETURN_IF_ERROR(mask_sink(scene.first_frame + frames_read, masks));
      ++frames_read;
    }
    const std::size_t known = maps.values.size();
    Stopwatch stopwatch;
    VANTAGE_RETURN_IF_ERROR(batch.Solve(maps, report));
    stopwatch.LapInto(report.occupancy_secs);
    if (feedback && more) {
      VANTAGE_RETURN_IF_ERROR(feedback->Update(std::span(maps.values).subspan(known)));
      stopwatch.LapInto(report.hold_secs);
    }
    control.Report(report.frames, total);
  }
  if (report.frames == 0) {
    return Fail("{}: no frame to process: the cameras have no picture at frame {} or after it",
                scene.file.string(), scene.first_frame);
  }
  report.read_secs = stream.read_secs();
  report.background_secs = stream.background_secs();
  for (const auto& subtractor : stream.subtractors()) {
    report.background.push_back(subtractor ? subtractor->report() : BackgroundReport{});
  }
  if (feedback) report.hold = feedback->report();
  return result;
}

Result<TrackingResult> TrackPeople(const Scene& scene, const StageOptions& options, int threads,
                                   const RunControl& control, const MaskSink& mask_sink) {
  const Stopwatch stopwatch;
  VANTAGE_ASSIGN_OR_RETURN(MapsResult mapped,
                           ComputeMaps(scene, options, threads, control, mask_sink));
  VANTAGE_ASSIGN_OR_RETURN(const std::vector<Polygon> doors,
                           DoorsAndEntrances(mapped.maps.grid, scene.doors, scene.entrances_m));
  VANTAGE_ASSIGN_OR_RETURN(
      LinkMapsResult linked,
      LinkMaps(mapped.maps, options.linking, options.tracks, doors, scene.obstacles, control));
  TrackingResult result;
  result.tracks = std::move(linked.tracks);
  result.maps = std::move(mapped.maps);
  result.report.maps = std::move(mapped.report);
  result.report.linking = linked.report;
  result.report.total_secs = stopwatch.Seconds();
  return result;
}

}  // namespace vantage
