// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/occupancy/map_checks.h"

#include <cmath>

namespace vantage {

Status CheckMapHeader(const std::filesystem::path& path, const OccupancyMaps& maps) {
  const std::string name = path.string();
  const GroundGrid& grid = maps.grid;
  const auto cells = static_cast<std::size_t>(grid.count());
  if (!std::isfinite(grid.min_x_m) || !std::isfinite(grid.min_y_m)) {
    return Fail("{}: min_x_m or min_y_m is not finite", name);
  }
  if (!std::isfinite(grid.cell_m) || grid.cell_m <= 0) {
    return Fail("{}: cell_m is {}; it must be above 0", name, grid.cell_m);
  }
  if (!std::isfinite(maps.frames_per_second) || maps.frames_per_second < 0) {
    return Fail("{}: frames_per_second is {}; it must be at least 0", name, maps.frames_per_second);
  }
  for (const auto* flags : {&maps.in_area, &maps.visible}) {
    const char* what = flags == &maps.in_area ? "in_area" : "visible";
    if (flags->size() != cells) {
      return Fail("{}: {} has {} cells; the grid has {}", name, what, flags->size(), cells);
    }
    for (std::size_t i = 0; i < cells; ++i) {
      if ((*flags)[i] > 1) {
        return Fail("{}: {} is {} at cell {}; it must be 0 or 1", name, what, (*flags)[i], i);
      }
    }
  }
  return {};
}

Status CheckMapValues(const std::filesystem::path& path, std::span<const float> values,
                      std::size_t cells, std::int64_t first_map) {
  if (values.size() % cells != 0) {
    return Fail("{}: {} values are not whole maps of {} cells", path.string(), values.size(),
                cells);
  }
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!(values[i] >= 0 && values[i] <= 1)) {
      return Fail("{}: /occupancy is {} in map {} at cell {}; it must be between 0 and 1",
                  path.string(), values[i], first_map + static_cast<std::int64_t>(i / cells),
                  i % cells);
    }
  }
  return {};
}

}  // namespace vantage
