// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/linking/track_builder.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <optional>

namespace vantage {
namespace {

using Eigen::Vector2d;

/// A position within a path, before smoothing.
struct Sample {
  Vector2d position_m = Vector2d::Zero();
  bool seen = false;
};

/// Centre of mass of the probabilities of the 3 x 3 cells around `cell`.
Sample Refine(const OccupancyMaps& maps, std::int64_t frame, CellIndex cell, double support) {
  const GroundGrid& grid = maps.grid;
  const std::span<const float> q = maps.Frame(frame);
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
  if (mass < support) return {grid.Center(cell), false};
  return {sum / mass, true};
}

/// Drops what is not supported at both ends, and puts what is not supported between on straight
/// lines. Returns the index of the first sample left.
std::size_t TrimAndInterpolate(std::vector<Sample>& samples) {
  const auto seen = [](const Sample& sample) { return sample.seen; };
  const auto first = std::find_if(samples.begin(), samples.end(), seen);
  const auto last = std::find_if(samples.rbegin(), samples.rend(), seen).base();
  const auto start = static_cast<std::size_t>(first - samples.begin());
  if (first == samples.end()) {
    samples.clear();
    return start;
  }
  samples = std::vector<Sample>(first, last);
  std::size_t before = 0;
  for (std::size_t i = 1; i < samples.size(); ++i) {
    if (!samples[i].seen) continue;
    for (std::size_t gap = before + 1; gap < i; ++gap) {
      const double t = static_cast<double>(gap - before) / static_cast<double>(i - before);
      samples[gap].position_m = (1 - t) * samples[before].position_m + t * samples[i].position_m;
    }
    before = i;
  }
  return start;
}

/// Local linear regression with Epanechnikov's kernel over seen samples (W. Cleveland, "Robust
/// locally weighted regression", 1979, without the robustness); inferred samples follow the line
/// too.
std::vector<Vector2d> Smooth(const std::vector<Sample>& samples, double half_width_frames) {
  std::vector<Vector2d> smooth(samples.size());
  const auto reach = static_cast<std::ptrdiff_t>(half_width_frames);
  for (std::ptrdiff_t i = 0; i < std::ssize(samples); ++i) {
    double s0 = 0, s1 = 0, s2 = 0;
    Vector2d y0 = Vector2d::Zero();
    Vector2d y1 = Vector2d::Zero();
    const std::ptrdiff_t end = std::min(i + reach, std::ssize(samples) - 1);
    for (std::ptrdiff_t j = std::max<std::ptrdiff_t>(i - reach, 0); j <= end; ++j) {
      const Sample& sample = samples[static_cast<std::size_t>(j)];
      if (!sample.seen) continue;
      const auto t = static_cast<double>(j - i);
      const double u = t / (half_width_frames + 1);
      const double weight = 1 - u * u;
      s0 += weight;
      s1 += weight * t;
      s2 += weight * t * t;
      y0 += weight * sample.position_m;
      y1 += weight * t * sample.position_m;
    }
    // The line's value at t = 0; a plain mean where one instant alone is seen, and the interpolated
    // position where nothing is.
    const double determinant = s0 * s2 - s1 * s1;
    Vector2d& result = smooth[static_cast<std::size_t>(i)];
    if (determinant > 1e-9) {
      result = (s2 * y0 - s1 * y1) / determinant;
    } else {
      result = s0 > 0 ? Vector2d(y0 / s0) : samples[static_cast<std::size_t>(i)].position_m;
    }
  }
  return smooth;
}

}  // namespace

void VisitOptions(TrackOptions& o, OptionVisitor& v) {
  v.Number({"support", "", "probability around a position that makes it seen, not inferred"},
           o.support, Range::AboveUpTo(0, 1));
  v.Number({"smoothing", "s", "half width of the smoothing window; 0: none"}, o.smoothing_secs,
           Range::Between(0, 60));
  v.Number({"min_length", "s", "tracks seen for less are dropped"}, o.min_length_secs,
           Range::Between(0, 1e6));
}

Result<Tracks> BuildTracks(const std::vector<LinkedPath>& paths, const OccupancyMaps& maps,
                           const TrackOptions& options) {
  VANTAGE_RETURN_IF_ERROR(ValidateOptions(options, "tracks"));
  if (!(maps.frames_per_second > 0)) {
    return Fail("the maps' frames per second are {}; they must be above 0", maps.frames_per_second);
  }
  const double half_width_frames = options.smoothing_secs * maps.frames_per_second;
  const double min_seen = options.min_length_secs * maps.frames_per_second;
  Tracks tracks;
  for (const LinkedPath& path : paths) {
    std::vector<Sample> samples;
    for (std::size_t i = 0; i < path.cells.size(); ++i) {
      samples.push_back(Refine(maps, path.first_frame + static_cast<std::int64_t>(i), path.cells[i],
                               options.support));
    }
    const std::size_t start = TrimAndInterpolate(samples);
    const std::vector<Vector2d> positions_m = Smooth(samples, half_width_frames);
    Track track;
    std::int64_t seen = 0;
    for (std::size_t i = 0; i < samples.size(); ++i) {
      const auto cell = maps.grid.CellAt(positions_m[i]);
      if (!cell || maps.in_area[static_cast<std::size_t>(*cell)] == 0) continue;
      track.points.push_back(
          {.frame = maps.first_frame + path.first_frame + static_cast<FrameIndex>(start + i),
           .x_m = positions_m[i].x(),
           .y_m = positions_m[i].y(),
           .inferred = !samples[i].seen});
      seen += samples[i].seen ? 1 : 0;
    }
    if (seen > 0 && static_cast<double>(seen) >= min_seen) tracks.push_back(std::move(track));
  }
  std::stable_sort(tracks.begin(), tracks.end(), [](const Track& a, const Track& b) {
    return a.points.front().frame < b.points.front().frame;
  });
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    tracks[i].id = static_cast<TrackId>(i + 1);
  }
  return tracks;
}

}  // namespace vantage
