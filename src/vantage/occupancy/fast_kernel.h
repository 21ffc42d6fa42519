// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>

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

/// The columns [left, right) of a run between two of its rows: a part of a rectangle. `top` and
/// `bottom` are where the first row and the row below the last begin, in the arrays of a CoverRun
/// or in one that holds several.
struct CoverPiece {
  std::uint32_t top;
  std::uint32_t bottom;
  std::uint8_t left;
  std::uint8_t right;
};

/// Adds values[i] to `difference` in the columns of piece i at its top, and takes it away at its
/// bottom; a value of 0 costs nothing.
void AddPieces(std::span<const CoverPiece> pieces, const float* values, float* difference);

/// Sum over each piece of what `sums` (CoverRun::sum_first) gained between its rows.
void SumPieces(std::span<const CoverPiece> pieces, const float* sums, float* out);

/// One pass down the columns: M = exp(log M), and its sums. Vectors of whatever length the
/// processor has.
void SumCovered(const CoverRun& run);

}  // namespace vantage::internal
