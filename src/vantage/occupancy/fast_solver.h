// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include "vantage/occupancy/exact_solver.h"

namespace vantage::internal {

/// The same fixed point, of the part of the problem that matters:
///
/// 1. Only cells that the foreground can raise are iterated: those of whose rectangles, averaged
///    over the cameras that speak for the cell, at least kMinForeground is foreground. Of the rest
///    nobody stands anywhere (n = 1). A cell that gives way (presence and new value below kGivenUp)
///    is out as well.
/// 2. Only pixels that the rectangles of these cells touch are computed, in runs of columns.
/// 3. Sums go down the columns only: log M is one running sum of what rectangles add at their top
///    row and take away below their bottom row; a box sum is the difference of two rows, which for
///    a person's few columns is as fast as the four corners of an integral image, and exact enough
///    in float.
/// 4. In M and in r the absence is at least kMinCover, so that what is left of M under a person
///    can be told from rounding; the absence itself is not bounded so.
SolveReport SolveFast(const Problem& problem, std::span<float> q);

}  // namespace vantage::internal
