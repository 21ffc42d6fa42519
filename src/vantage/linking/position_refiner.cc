// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/linking/position_refiner.h"

#include <algorithm>
#include <cmath>

namespace vantage::linking {
namespace {

using Eigen::Vector2d;

/// More frames than any recording has: absurd frame rates must not overflow.
constexpr double kMaxReachFrames = 1e9;

/// The value at `frame` of the line through the seen positions around it: local linear regression
/// with Epanechnikov's kernel (W. Cleveland, "Robust locally weighted regression", 1979, without
/// the robustness). A plain mean where one instant alone is seen, none where nothing is.
std::optional<Vector2d> Smooth(std::span<const SeenPosition> around, FrameIndex frame,
                               double half_width_frames) {
  double s0 = 0, s1 = 0, s2 = 0;
  Vector2d y0 = Vector2d::Zero();
  Vector2d y1 = Vector2d::Zero();
  for (const SeenPosition& seen : around) {
    const auto t = static_cast<double>(seen.frame - frame);
    const double u = t / (half_width_frames + 1);
    const double weight = 1 - u * u;
    s0 += weight;
    s1 += weight * t;
    s2 += weight * t * t;
    y0 += weight * seen.position_m;
    y1 += weight * t * seen.position_m;
  }
  const double determinant = s0 * s2 - s1 * s1;
  if (determinant > 1e-9) return (s2 * y0 - s1 * y1) / determinant;
  if (s0 > 0) return y0 / s0;
  return std::nullopt;
}

Vector2d Between(const SeenPosition& before, const SeenPosition& after, FrameIndex frame) {
  const double t =
      static_cast<double>(frame - before.frame) / static_cast<double>(after.frame - before.frame);
  return (1 - t) * before.position_m + t * after.position_m;
}

}  // namespace

PositionRefiner::PositionRefiner(const OccupancyMaps& like, const TrackOptions& options)
    : grid_(like.grid),
      in_area_(like.in_area),
      support_(options.support),
      half_width_frames_(
          std::min(options.smoothing_secs * like.frames_per_second, kMaxReachFrames)),
      reach_frames_(static_cast<std::int64_t>(half_width_frames_)),
      min_seen_frames_(options.min_length_secs * like.frames_per_second) {}

Result<PositionRefiner> PositionRefiner::Create(const OccupancyMaps& like,
                                                const TrackOptions& options) {
  VANTAGE_RETURN_IF_ERROR(ValidateOptions(options, "tracks"));
  if (!(like.frames_per_second > 0)) {
    return Fail("the maps' frames per second are {}; they must be above 0", like.frames_per_second);
  }
  return PositionRefiner(like, options);
}

std::optional<Vector2d> SupportedPosition(const GroundGrid& grid, std::span<const float> q,
                                          CellIndex cell, double support) {
  double mass = 0;
  Vector2d sum = Vector2d::Zero();
  for (int row = std::max(grid.Row(cell) - 1, 0);
       row <= std::min(grid.Row(cell) + 1, grid.rows - 1); ++row) {
    for (int column = std::max(grid.Column(cell) - 1, 0);
         column <= std::min(grid.Column(cell) + 1, grid.columns - 1); ++column) {
      const CellIndex neighbour = grid.Index(column, row);
      const double weight = static_cast<double>(q[static_cast<std::size_t>(neighbour)]);
      mass += weight;
      sum += weight * grid.Center(neighbour);
    }
  }
  if (mass < support) return std::nullopt;
  return sum / mass;
}

std::optional<Vector2d> PositionRefiner::Find(std::span<const float> q, CellIndex cell) const {
  return SupportedPosition(grid_, q, cell, support_);
}

std::optional<TrackPoint> PositionRefiner::PointAt(std::span<const SeenPosition> seen,
                                                   FrameIndex frame) const {
  if (seen.empty() || frame < seen.front().frame || frame > seen.back().frame) return std::nullopt;
  const auto at_or_after = [&](FrameIndex first) {
    return std::ranges::lower_bound(seen, first, {}, &SeenPosition::frame);
  };
  const auto here = at_or_after(frame);
  const std::optional<Vector2d> smooth =
      Smooth({at_or_after(frame - reach_frames_), at_or_after(frame + reach_frames_ + 1)}, frame,
             half_width_frames_);
  // Nothing in reach means that it is not seen here, so that there is a position before.
  const Vector2d position_m = smooth ? *smooth : Between(*std::prev(here), *here, frame);
  const std::optional<CellIndex> cell = grid_.CellAt(position_m);
  if (!cell || in_area_[static_cast<std::size_t>(*cell)] == 0) return std::nullopt;
  return TrackPoint{.frame = frame,
                    .x_m = position_m.x(),
                    .y_m = position_m.y(),
                    .inferred = here->frame != frame};
}

}  // namespace vantage::linking
