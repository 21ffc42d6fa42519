// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/pipeline/track.h"

#include <algorithm>
#include <utility>

#include "vantage/base/parallel.h"
#include "vantage/base/stopwatch.h"
#include "vantage/pipeline/ground.h"
#include "vantage/pipeline/mask_stream.h"

namespace vantage {
namespace {

/// Masks of consecutive frames, solved in parallel: frames are independent of each other.
class FrameBatch {
 public:
  FrameBatch(const OccupancySolver& solver, int threads)
      : solver_(solver),
        masks_(static_cast<std::size_t>(std::max(threads, 1)) * 4),
        threads_(threads) {}

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
      solved[index] = solver_.Solve(masks_[index],
                                    std::span(maps.values).subspan(start + index * cells, cells));
    });
    for (const Result<SolveReport>& result : solved) {
      if (!result) return tl::unexpected(result.error());
      iterations_ += result->iterations;
      report.frames_not_converged += result->converged ? 0 : 1;
      ++report.frames;
    }
    report.mean_iterations = static_cast<double>(iterations_) /
                             static_cast<double>(std::max<std::int64_t>(report.frames, 1));
    used_ = 0;
    return {};
  }

 private:
  const OccupancySolver& solver_;
  std::vector<std::vector<cv::Mat>> masks_;
  std::size_t used_ = 0;
  std::int64_t iterations_ = 0;
  int threads_;
};

}  // namespace

Status BindStages(const Scene& scene, StageOptions& options) {
  VANTAGE_RETURN_IF_ERROR(scene.stages.Bind("background", options.background));
  VANTAGE_RETURN_IF_ERROR(scene.stages.Bind("occupancy", options.occupancy));
  VANTAGE_RETURN_IF_ERROR(scene.stages.Bind("linking", options.linking));
  return scene.stages.Bind("tracks", options.tracks);
}

Result<MapsResult> ComputeMaps(const Scene& scene, const StageOptions& options, int threads,
                               const RunControl& control, const MaskSink& mask_sink) {
  VANTAGE_ASSIGN_OR_RETURN(Ground ground, LayOutGround(scene, options.occupancy));
  VANTAGE_ASSIGN_OR_RETURN(const OccupancySolver solver,
                           OccupancySolver::Create(ground.views, options.occupancy));
  VANTAGE_ASSIGN_OR_RETURN(MaskStream stream,
                           MaskStream::Create(scene, options.background, threads));

  MapsResult result;
  OccupancyMaps& maps = result.maps;
  MapsReport& report = result.report;
  report.area_cells = ground.AreaCells();
  report.unseen_area_cells = ground.UnseenAreaCells();
  maps.grid = ground.grid;
  maps.first_frame = scene.first_frame;
  maps.frames_per_second = scene.frames_per_second;
  maps.in_area = std::move(ground.in_area);
  maps.visible = std::move(ground.visible);

  const std::int64_t total = stream.frame_count().value_or(0);
  FrameBatch batch(solver, threads);
  std::int64_t frames_read = 0;
  for (bool more = true; more;) {
    while (more && !batch.full()) {
      if (control.Stopped()) return Cancelled();
      std::vector<cv::Mat>& masks = batch.Next();
      VANTAGE_ASSIGN_OR_RETURN(more, stream.Read(masks));
      if (!more) {
        batch.DropLast();
      } else if (mask_sink) {
        VANTAGE_RETURN_IF_ERROR(mask_sink(scene.first_frame + frames_read, masks));
      }
      frames_read += more ? 1 : 0;
    }
    const Stopwatch stopwatch;
    VANTAGE_RETURN_IF_ERROR(batch.Solve(maps, report));
    report.occupancy_secs += stopwatch.Seconds();
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
  return result;
}

Result<TrackingResult> TrackPeople(const Scene& scene, const StageOptions& options, int threads,
                                   const RunControl& control, const MaskSink& mask_sink) {
  const Stopwatch stopwatch;
  VANTAGE_ASSIGN_OR_RETURN(MapsResult mapped,
                           ComputeMaps(scene, options, threads, control, mask_sink));
  VANTAGE_ASSIGN_OR_RETURN(LinkMapsResult linked,
                           LinkMaps(mapped.maps, options.linking, options.tracks, scene.doors,
                                    scene.obstacles, control));
  TrackingResult result;
  result.tracks = std::move(linked.tracks);
  result.maps = std::move(mapped.maps);
  result.report.maps = std::move(mapped.report);
  result.report.linking = linked.report;
  result.report.total_secs = stopwatch.Seconds();
  return result;
}

}  // namespace vantage
