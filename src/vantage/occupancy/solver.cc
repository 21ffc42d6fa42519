// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/occupancy/solver.h"

#include <cmath>
#include <utility>

#include "vantage/occupancy/camera_cells.h"
#include "vantage/occupancy/exact_solver.h"
#include "vantage/occupancy/fast_solver.h"

namespace vantage {
namespace {

constexpr std::size_t kMaxCells = 4'000'000;

}  // namespace

OccupancySolver::OccupancySolver() = default;
OccupancySolver::OccupancySolver(OccupancySolver&&) noexcept = default;
OccupancySolver& OccupancySolver::operator=(OccupancySolver&&) noexcept = default;
OccupancySolver::~OccupancySolver() = default;

std::size_t OccupancySolver::camera_count() const { return cameras_.size(); }

Result<OccupancySolver> OccupancySolver::Create(const std::vector<CameraView>& views,
                                                const OccupancyOptions& options,
                                                std::vector<double> priors) {
  VANTAGE_RETURN_IF_ERROR(ValidateOptions(options, "occupancy"));
  if (views.empty()) return Fail("there is no camera; occupancy needs at least one");
  const std::size_t cells = views.front().rectangles.size();
  if (cells < 1 || cells > kMaxCells) {
    return Fail("the grid has {} cells; it must have 1 to {}", cells, kMaxCells);
  }
  if (priors.empty()) priors.assign(cells, options.prior);
  if (priors.size() != cells) {
    return Fail("there are priors for {} cells; the grid has {}", priors.size(), cells);
  }
  for (const double prior : priors) {
    if (!(prior > 0 && prior < 1)) {
      return Fail("the prior of a cell is {}; it must be above 0 and below 1", prior);
    }
  }
  OccupancySolver solver;
  solver.options_ = options;
  solver.priors_ = std::move(priors);
  for (const CameraView& view : views) {
    VANTAGE_ASSIGN_OR_RETURN(internal::CameraCells camera,
                             internal::MakeCameraCells(view, solver.cameras_.size(), cells));
    solver.cameras_.push_back(std::move(camera));
  }
  return solver;
}

Result<SolveReport> OccupancySolver::Solve(std::span<const cv::Mat> masks, std::span<float> q,
                                           std::span<const float> previous) const {
  if (q.size() != cell_count()) {
    return Fail("the map has room for {} cells; the grid has {}", q.size(), cell_count());
  }
  if (!previous.empty() && previous.size() != cell_count()) {
    return Fail("the map to begin at has {} cells; the grid has {}", previous.size(), cell_count());
  }
  for (const float presence : previous) {
    if (!(presence >= 0 && presence <= 1)) {
      return Fail("a cell of the map to begin at is {}; it must be between 0 and 1", presence);
    }
  }
  if (masks.size() != cameras_.size()) {
    return Fail("{} masks are given for {} cameras", masks.size(), cameras_.size());
  }
  std::vector<internal::Foreground> foreground(masks.size());
  int left_out = 0;
  for (std::size_t c = 0; c < masks.size(); ++c) {
    if (masks[c].empty()) {
      ++left_out;
      continue;
    }
    VANTAGE_ASSIGN_OR_RETURN(foreground[c], internal::MakeForeground(cameras_[c], c, masks[c]));
  }
  const internal::Problem problem{options_, priors_, cameras_, foreground, previous};
  SolveReport report = options_.mode == SolveMode::kExact ? internal::SolveExactly(problem, q)
                                                          : internal::SolveFast(problem, q);
  report.cameras_left_out = left_out;
  return report;
}

}  // namespace vantage
