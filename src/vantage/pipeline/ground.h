// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "vantage/base/result.h"
#include "vantage/geometry/grid.h"
#include "vantage/occupancy/extension.h"
#include "vantage/occupancy/solver.h"
#include "vantage/occupancy/views.h"
#include "vantage/scene/scene.h"

namespace vantage {

/// The ground of a scene cut into cells, and what each camera can say of them.
struct Ground {
  GroundGrid grid;
  /// How far the grid goes beyond the area, and why.
  ExtensionReport extension;
  /// Per cell: 1 inside the area of interest (its centre is), 0 in the extension.
  std::vector<std::uint8_t> in_area;
  /// Per cell: 1 where at least one camera speaks for it.
  std::vector<std::uint8_t> visible;
  /// One per camera of the scene.
  std::vector<CameraView> views;

  std::int64_t AreaCells() const;
  /// Cells of the area that no camera sees: nobody can be found there.
  std::int64_t UnseenAreaCells() const;
};

/// Cuts area and extension into cells; `person` is the scene's with every length known. Fails when
/// no cell's centre is inside the area (cells too large for it) and when no camera sees any cell of
/// the area.
Result<Ground> LayOutGround(const Scene& scene, const PersonOptions& person,
                            const OccupancyOptions& options);

}  // namespace vantage
