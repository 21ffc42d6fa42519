// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

namespace vantage::internal {

/// Columns are taken this many at a time.
constexpr int kColumns = 16;

/// `rows` rows of kColumns floats, one after the other, aligned to kColumns floats.
struct CoverRun {
  int rows;
  /// In: first difference of log M along the columns, 0 above the first row. Out: 0. `rows` + 1
  /// rows.
  float* difference;
  /// What M is multiplied by, `rows` rows; `second` may be null.
  const float* first;
  const float* second;
  /// Out: in each row the sums of M first and M second over the rows above it, `rows` + 1 rows.
  float* sum_first;
  float* sum_second;
};

/// One pass down the columns: M = exp(log M), and its sums. Vectors of whatever length the
/// processor has.
void SumCovered(const CoverRun& run);

}  // namespace vantage::internal
