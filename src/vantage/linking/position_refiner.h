// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "vantage/base/ids.h"
#include "vantage/base/result.h"
#include "vantage/linking/track_builder.h"
#include "vantage/occupancy/maps.h"
#include "vantage/tracks/track.h"

/// Internal to the linking module: what turns the cells of a path into positions, for whole
/// recordings and for streams alike.

namespace vantage::linking {

/// A frame in which what was seen supports a path, and where.
struct SeenPosition {
  FrameIndex frame = 0;
  Eigen::Vector2d position_m = Eigen::Vector2d::Zero();
};

/// Centre of mass of the probabilities `q` of the 3 x 3 cells around `cell`; none where they are
/// less than `support` together.
std::optional<Eigen::Vector2d> SupportedPosition(const GroundGrid& grid, std::span<const float> q,
                                                 CellIndex cell, double support);

class PositionRefiner {
 public:
  /// `like` gives grid, area and frame rate; its values are not used. Fails on options out of range
  /// and unless the frame rate is above 0.
  static Result<PositionRefiner> Create(const OccupancyMaps& like, const TrackOptions& options);

  /// SupportedPosition with the options' support.
  std::optional<Eigen::Vector2d> Find(std::span<const float> q, CellIndex cell) const;

  /// The path's position in `frame`, from those of its seen positions (by frame) that are known:
  /// smoothed, or between its neighbours where none is in the smoothing's reach. None before the
  /// first and after the last of them, and outside the area.
  std::optional<TrackPoint> PointAt(std::span<const SeenPosition> seen, FrameIndex frame) const;

  /// Seen positions further from a frame than this do not matter to its smoothing.
  std::int64_t reach_frames() const { return reach_frames_; }

  /// Whether a track seen in so many frames inside the area is kept.
  bool LongEnough(std::int64_t seen_frames) const {
    return seen_frames > 0 && static_cast<double>(seen_frames) >= min_seen_frames_;
  }

 private:
  PositionRefiner(const OccupancyMaps& like, const TrackOptions& options);

  GroundGrid grid_;
  std::vector<std::uint8_t> in_area_;
  double support_;
  double half_width_frames_;
  std::int64_t reach_frames_;
  double min_seen_frames_;
};

}  // namespace vantage::linking
