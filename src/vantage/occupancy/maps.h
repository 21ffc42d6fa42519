// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "vantage/base/ids.h"
#include "vantage/geometry/grid.h"

namespace vantage {

/// Marginal probabilities of occupancy of a recording: q[frame][cell], cell = column + row *
/// columns.
struct OccupancyMaps {
  GroundGrid grid;
  /// Frame number of the first map; the following maps are of the following frames.
  FrameIndex first_frame = 0;
  /// Frames per second of the recording.
  double frames_per_second = 0;
  /// 1 for cells of the area of interest, 0 for cells of its extension.
  std::vector<std::uint8_t> in_area;
  /// 1 for cells that at least one camera speaks for.
  std::vector<std::uint8_t> visible;
  /// frame_count() * grid.count() values, frame by frame.
  std::vector<float> values;

  std::int64_t frame_count() const {
    return grid.count() == 0 ? 0 : static_cast<std::int64_t>(values.size()) / grid.count();
  }
  std::span<const float> Frame(std::int64_t index) const {
    const auto cells = static_cast<std::size_t>(grid.count());
    return std::span(values).subspan(static_cast<std::size_t>(index) * cells, cells);
  }
};

}  // namespace vantage
