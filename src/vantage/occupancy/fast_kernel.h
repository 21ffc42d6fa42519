// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

namespace vantage::internal {

/// Columns are taken this many at a time.
constexpr int kColumns = 16;

/// kColumns columns of a picture from row `top` to before row `bottom`, starting at a multiple of
/// kColumns.
struct ColumnRun {
  int x;
  int top;
  int bottom;
};

/// Rows of floats, `stride` apart (a multiple of kColumns), aligned to kColumns floats.
struct CoverImages {
  std::size_t stride;
  /// In: first difference of log M along the columns, 0 before the top of a run. Out: 0. A run
  /// uses its rows and the one below.
  float* difference;
  /// What is summed.
  const float* first;
  const float* second;  // may be null
  /// Out: sums down the column over the rows of the run above this one, of M first and M second. A
  /// run fills its rows and the one below.
  float* sum_first;
  float* sum_second;
};

/// One pass over a run: M = exp(log M), and its sums. Vectors of whatever length the processor has.
void SumCovered(const ColumnRun& run, const CoverImages& images);

}  // namespace vantage::internal
