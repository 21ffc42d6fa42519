// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <limits>
#include <vector>

namespace vantage {

/// Costs of joining each row to each column: at least 0, or kForbidden.
struct CostMatrix {
  static constexpr double kForbidden = std::numeric_limits<double>::infinity();

  CostMatrix(std::size_t row_count, std::size_t column_count)
      : rows(row_count), columns(column_count), values(row_count * column_count, kForbidden) {}
  double& operator()(std::size_t row, std::size_t column) { return values[row * columns + column]; }
  double operator()(std::size_t row, std::size_t column) const {
    return values[row * columns + column];
  }

  std::size_t rows, columns;
  std::vector<double> values;
};

/// Joins rows to columns one to one: as many pairs as can be without a forbidden one, and among
/// these the pairs with the smallest sum of costs. For each row its column, or -1. O(n^3) by the
/// Hungarian method with shortest augmenting paths (Jonker and Volgenant, 1987).
std::vector<int> Assign(const CostMatrix& cost);

}  // namespace vantage
