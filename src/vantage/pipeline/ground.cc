// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/pipeline/ground.h"

#include <functional>
#include <numeric>
#include <utility>

namespace vantage {
namespace {

double Reduction(const Camera& camera, const GroundGrid& grid, const PersonOptions& person,
                 const OccupancyOptions& options) {
  if (options.reduction) return *options.reduction;
  return options.mode == SolveMode::kFast ? AutomaticReduction(camera, grid, person) : 1;
}

}  // namespace

std::int64_t Ground::AreaCells() const {
  return std::accumulate(in_area.begin(), in_area.end(), std::int64_t{0});
}

std::int64_t Ground::UnseenAreaCells() const {
  return std::transform_reduce(in_area.begin(), in_area.end(), visible.begin(), std::int64_t{0},
                               std::plus<>(), [](std::uint8_t inside, std::uint8_t seen) {
                                 return std::int64_t{inside != 0 && seen == 0};
                               });
}

Result<Ground> LayOutGround(const Scene& scene, const PersonOptions& person,
                            const OccupancyOptions& options) {
  Ground ground;
  std::vector<Camera> cameras;
  for (const SceneCamera& camera : scene.cameras) cameras.push_back(camera.camera);
  VANTAGE_ASSIGN_OR_RETURN(ground.extension, ChooseExtension(scene.area, scene.grid, cameras,
                                                             person, options.visibility));
  VANTAGE_ASSIGN_OR_RETURN(
      ground.grid, GroundGrid::Cover(scene.area, scene.grid.cell_m, ground.extension.extension()));
  const auto cells = static_cast<std::size_t>(ground.grid.count());
  ground.in_area.resize(cells);
  for (CellIndex cell = 0; cell < ground.grid.count(); ++cell) {
    ground.in_area[static_cast<std::size_t>(cell)] = scene.area.Contains(ground.grid.Center(cell));
  }
  if (ground.AreaCells() == 0) {
    return Fail("{}: no cell of {} m has its centre inside the area; use smaller cells",
                scene.file.string(), scene.grid.cell_m);
  }
  for (const SceneCamera& camera : scene.cameras) {
    const cv::Mat informative = camera.blind.empty() ? cv::Mat() : cv::Mat(camera.blind == 0);
    VANTAGE_ASSIGN_OR_RETURN(
        CameraView view,
        BuildView(camera.camera, ground.grid, person, options.visibility,
                  Reduction(camera.camera, ground.grid, person, options), informative));
    ground.views.push_back(std::move(view));
  }
  ground.visible = VisibleCells(ground.views);
  if (ground.UnseenAreaCells() == ground.AreaCells()) {
    return Fail(
        "{}: no camera sees any of the area (visibility rule and size of a person "
        "considered); check the polygon and the calibrations",
        scene.file.string());
  }
  return ground;
}

}  // namespace vantage
