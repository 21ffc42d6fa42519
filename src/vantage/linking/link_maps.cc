// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/linking/link_maps.h"

#include <utility>

#include "vantage/linking/access.h"

namespace vantage {

LinkingProblem ProblemOf(const OccupancyMaps& maps, std::span<const std::uint8_t> access,
                         std::span<const std::uint8_t> obstacle) {
  return {.columns = maps.grid.columns,
          .rows = maps.grid.rows,
          .frames = maps.frame_count(),
          .probability = maps.values,
          .access = access,
          .obstacle = obstacle,
          .cell_m = maps.grid.cell_m,
          .frames_per_second = maps.frames_per_second};
}

Result<LinkMapsResult> LinkMaps(const OccupancyMaps& maps, const LinkingOptions& linking,
                                const TrackOptions& tracks, std::span<const Polygon> doors,
                                std::span<const Polygon> obstacles, const RunControl& control) {
  const std::vector<std::uint8_t> access = AccessCells(maps, linking.access, doors);
  const std::vector<std::uint8_t> obstacle = CellsIn(maps.grid, obstacles);
  VANTAGE_ASSIGN_OR_RETURN(LinkingResult linked,
                           LinkPaths(ProblemOf(maps, access, obstacle), linking, control));
  LinkMapsResult result;
  VANTAGE_ASSIGN_OR_RETURN(result.tracks, BuildTracks(linked.paths, maps, tracks));
  result.paths = std::move(linked.paths);
  result.report.linking = linked.report;
  result.report.dropped_paths =
      linked.report.paths - static_cast<std::int64_t>(result.tracks.size());
  return result;
}

Result<StreamLinker> MakeStreamLinker(const OccupancyMaps& like, const LinkingOptions& linking,
                                      std::int64_t lag_frames, std::span<const Polygon> doors,
                                      std::span<const Polygon> obstacles) {
  const std::vector<std::uint8_t> access = AccessCells(like, linking.access, doors);
  const std::vector<std::uint8_t> obstacle = CellsIn(like.grid, obstacles);
  return StreamLinker::Create({.columns = like.grid.columns,
                               .rows = like.grid.rows,
                               .access = access,
                               .obstacle = obstacle,
                               .cell_m = like.grid.cell_m,
                               .frames_per_second = like.frames_per_second},
                              linking, lag_frames);
}

}  // namespace vantage
