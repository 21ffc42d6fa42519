// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>

#include "vantage/base/result.h"
#include "vantage/base/run_control.h"
#include "vantage/occupancy/pom_file.h"

namespace vantage {

struct PomReport {
  std::int64_t frames = 0;
  /// Of all frames together.
  std::int64_t iterations = 0;
  /// Frames that reached the bound on iterations.
  std::int64_t not_converged = 0;
  double seconds = 0;
};

/// Does what the original POM program does with its configuration: reads the pictures (any kind of
/// 8 bits; the mean of the channels counts, 255 is foreground) and writes one result a frame with a
/// line "cell probability" for each cell. Results go to `output_folder`, or where the configuration
/// says when that is empty; they are written when all frames are done. Fails, naming the file, on
/// pictures that are missing, damaged or of another size.
Result<PomReport> RunPom(const PomFile& file, const std::filesystem::path& output_folder,
                         int threads, const RunControl& control);

}  // namespace vantage
