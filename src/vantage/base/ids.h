// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

namespace vantage {

/// Number of a frame within a recording, from 0 unless a file format says otherwise.
using FrameIndex = std::int64_t;

/// One identity within one run; never a person's name.
enum class TrackId : std::int64_t {};

/// Cell of a ground grid: column + row * columns.
using CellIndex = std::int32_t;

}  // namespace vantage
