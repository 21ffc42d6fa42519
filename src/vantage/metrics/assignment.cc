// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/metrics/assignment.h"

#include <algorithm>
#include <cmath>

namespace vantage {
namespace {

constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();

/// Finite costs, rows <= columns: every row gets a column. Returns the row of each column.
std::vector<std::size_t> AssignAllRows(const CostMatrix& cost) {
  std::vector<double> row_price(cost.rows, 0);
  std::vector<double> column_price(cost.columns, 0);
  std::vector<std::size_t> row_of(cost.columns, kNone);
  std::vector<double> distance(cost.columns);
  std::vector<std::size_t> before(
      cost.columns);  // column before this one on the path; kNone: start
  std::vector<bool> done(cost.columns);
  for (std::size_t start = 0; start < cost.rows; ++start) {
    // Dijkstra's algorithm on reduced costs, from the new row to the nearest free column.
    std::fill(distance.begin(), distance.end(), CostMatrix::kForbidden);
    std::fill(before.begin(), before.end(), kNone);
    std::fill(done.begin(), done.end(), false);
    std::size_t row = start;
    std::size_t last = kNone;
    double reached = 0;
    while (true) {
      std::size_t nearest = kNone;
      for (std::size_t column = 0; column < cost.columns; ++column) {
        if (done[column]) continue;
        const double through = reached + cost(row, column) - row_price[row] - column_price[column];
        if (through < distance[column]) {
          distance[column] = through;
          before[column] = last;
        }
        if (nearest == kNone || distance[column] < distance[nearest]) nearest = column;
      }
      reached = distance[nearest];
      last = nearest;
      if (row_of[last] == kNone) break;
      done[last] = true;
      row = row_of[last];
    }
    row_price[start] += reached;
    for (std::size_t column = 0; column < cost.columns; ++column) {
      if (!done[column]) continue;
      row_price[row_of[column]] += reached - distance[column];
      column_price[column] -= reached - distance[column];
    }
    for (std::size_t column = last; column != kNone; column = before[column]) {
      row_of[column] = before[column] == kNone ? start : row_of[before[column]];
    }
  }
  return row_of;
}

}  // namespace

std::vector<int> Assign(const CostMatrix& cost) {
  std::vector<int> column_of(cost.rows, -1);
  if (cost.rows == 0 || cost.columns == 0) return column_of;
  // A forbidden pair costs more than all allowed ones together, so that fewest are taken.
  double largest = 0;
  for (const double value : cost.values) {
    if (std::isfinite(value)) largest = std::max(largest, value);
  }
  const double forbidden =
      (largest + 1) * static_cast<double>(std::min(cost.rows, cost.columns) + 1);
  const bool transposed = cost.rows > cost.columns;
  CostMatrix finite(std::min(cost.rows, cost.columns), std::max(cost.rows, cost.columns));
  for (std::size_t row = 0; row < cost.rows; ++row) {
    for (std::size_t column = 0; column < cost.columns; ++column) {
      const double value = cost(row, column);
      (transposed ? finite(column, row) : finite(row, column)) =
          std::isfinite(value) ? value : forbidden;
    }
  }
  const std::vector<std::size_t> row_of = AssignAllRows(finite);
  for (std::size_t column = 0; column < finite.columns; ++column) {
    if (row_of[column] == kNone) continue;
    const std::size_t row = transposed ? column : row_of[column];
    const std::size_t partner = transposed ? row_of[column] : column;
    if (std::isfinite(cost(row, partner))) column_of[row] = static_cast<int>(partner);
  }
  return column_of;
}

}  // namespace vantage
