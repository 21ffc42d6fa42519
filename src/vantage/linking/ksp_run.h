// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "vantage/base/result.h"
#include "vantage/base/run_control.h"
#include "vantage/linking/ksp_file.h"
#include "vantage/linking/linker.h"

namespace vantage {

struct KspReport {
  std::int64_t frames = 0;
  std::int64_t cells = 0;
  /// K, the number of paths.
  std::int64_t paths = 0;
  /// Sum of the costs -log(p / (1 - p)) of the paths' cells, as that program has it: entering,
  /// moving and leaving cost nothing.
  double cost = 0;
  double seconds = 0;
};

/// What the original KSP program does: a path must earn more than 45, moves cost nothing,
/// probabilities are clipped to [1e-6, 1 - 1e-6]; depth and number of paths are the file's.
LinkingOptions OriginalKspOptions(const KspFile& file);

/// Its output: K, then a line for each frame with the frame and the cell of each path or -1, each
/// followed by a tab. Paths are in the order of `paths`.
std::string KspResultText(const KspFile& file, const std::vector<LinkedPath>& paths);

/// Does what the original KSP program does with its configuration and writes its output to
/// `output`. The optimum is the same up to that program's rounding (its costs are float32, so that
/// of several sets of paths whose costs are equal or nearly so it may take another); paths are
/// numbered by their first frame, then their first cell, not by the order in which they were found.
Result<KspReport> RunKsp(const KspFile& file, const std::filesystem::path& output,
                         const RunControl& control);

}  // namespace vantage
