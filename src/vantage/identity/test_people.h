// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

#include "vantage/geometry/grid.h"
#include "vantage/linking/linker.h"

/// For tests only: people who walk at random and whose observations are drawn at random.

namespace vantage::testing {

/// The same numbers from the same seed.
class Draws {
 public:
  explicit Draws(unsigned seed) : engine_(seed) {}
  int Int(int low, int high) { return std::uniform_int_distribution<int>(low, high)(engine_); }
  double Unit() { return std::uniform_real_distribution<double>(0, 1)(engine_); }
  bool Chance(double p) { return Unit() < p; }
  double Normal() { return std::normal_distribution<double>()(engine_); }
  Eigen::VectorXd Normals(Eigen::Index size) {
    Eigen::VectorXd values(size);
    for (double& value : values) value = Normal();
    return values;
  }

 private:
  std::mt19937_64 engine_;
};

/// Centres of cells of half a metre have exact coordinates.
inline GroundGrid WalkGrid(int side) {
  return {.min_x_m = -2, .min_y_m = 1, .cell_m = 0.5, .columns = side, .rows = side};
}

/// Begins and ends anywhere within `frames`; steps to one of the 8 neighbours or stays.
inline LinkedPath RandomWalk(Draws& draws, const GroundGrid& grid, int frames) {
  LinkedPath path{.first_frame = draws.Int(0, frames / 3), .cells = {}};
  const std::int64_t end = draws.Int(frames / 2, frames);
  int column = draws.Int(0, grid.columns - 1);
  int row = draws.Int(0, grid.rows - 1);
  for (std::int64_t frame = path.first_frame; frame < end; ++frame) {
    path.cells.push_back(grid.Index(column, row));
    column = std::clamp(column + draws.Int(-1, 1), 0, grid.columns - 1);
    row = std::clamp(row + draws.Int(-1, 1), 0, grid.rows - 1);
  }
  return path;
}

inline std::vector<LinkedPath> RandomWalks(Draws& draws, const GroundGrid& grid, int people,
                                           int frames) {
  std::vector<LinkedPath> paths;
  for (int i = 0; i < people; ++i) paths.push_back(RandomWalk(draws, grid, frames));
  return paths;
}

/// Observations of people, a matrix each: person + noise, with these standard deviations in each
/// dimension, independent of each other, away from 0.
inline std::vector<Eigen::MatrixXd> DrawPeople(Draws& draws, int people, int rows,
                                               const Eigen::VectorXd& between,
                                               const Eigen::VectorXd& within) {
  std::vector<Eigen::MatrixXd> observations;
  for (int i = 0; i < people; ++i) {
    const Eigen::VectorXd person = draws.Normals(between.size()).cwiseProduct(between).array() + 10;
    Eigen::MatrixXd& matrix = observations.emplace_back(rows, between.size());
    for (Eigen::Index row = 0; row < rows; ++row) {
      matrix.row(row) = person + draws.Normals(within.size()).cwiseProduct(within);
    }
  }
  return observations;
}

}  // namespace vantage::testing
