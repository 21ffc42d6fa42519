// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include "vantage/occupancy/exact_solver.h"

namespace vantage::internal {

/// The same fixed point, of the part of the problem that matters:
///
/// 1. Only cells that the foreground can raise are iterated: those of the informative part of whose
///    rectangles, averaged over the cameras that speak for the cell, enough is foreground. Where
///    nobody else covers anything evidence "person" needs cost / (1 + cost), 0.26 at the default;
///    a quarter or that is asked for, whichever is less. Evidence "picture" is raised by any, and
///    2 % are asked for. Nobody stands in the others: q = 0. A cell that has fallen to a tenth of
///    its prior and does not rise is out as well.
/// 2. Only pixels that the rectangles of these cells touch are computed, in runs of columns.
/// 3. Sums go down the columns only: log M is one running sum of what rectangles add at their top
///    row and take away below their bottom row; a box sum is the difference of two rows, which for
///    a person's few columns is as fast as the four corners of an integral image, and exact enough
///    in float.
/// 4. In M and in r the absence is at least 1e-4, so that what is left of M under a person can be
///    told from rounding; the absence itself is not bounded so.
SolveReport SolveFast(const Problem& problem, std::span<float> q);

}  // namespace vantage::internal
