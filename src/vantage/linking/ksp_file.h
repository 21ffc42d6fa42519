// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "vantage/base/ids.h"
#include "vantage/base/result.h"
#include "vantage/base/run_control.h"

namespace vantage {

/// Configuration file of the original KSP program (J. Berclaz and others, EPFL), one keyword a
/// line; words are separated by blanks, '#' begins a comment line:
///
///   GRID width height          cells
///   FRAMES first last          both included
///   ACCESS_POINTS a,b,c        optional: cells where people appear and vanish at every frame
///   DEPTH cells                optional, 1: cells that a person may move per frame
///   MAX_TRAJ number            optional, 255: at most this many paths
///   INPUT_FORMAT name          a file a frame; %d stands for the frame, %06d for six digits of it
///
/// Cell = x + y * width. A frame's file has a line "cell probability" for each cell; the order of
/// lines counts, the column of cells is read and left.
struct KspFile {
  std::filesystem::path path;
  int columns = 0;
  int rows = 0;
  std::int64_t first_frame = 0;
  std::int64_t last_frame = 0;
  std::vector<CellIndex> access_points;
  int depth = 1;
  int max_paths = 255;
  std::string input_format;

  std::int64_t cell_count() const { return std::int64_t{columns} * rows; }
  std::int64_t frame_count() const { return last_frame - first_frame + 1; }
  /// Relative names are relative to the configuration file's folder.
  std::filesystem::path InputPath(std::int64_t frame) const;
};

/// Reads a configuration. Errors name file and line and say what is allowed.
Result<KspFile> ReadKspFile(const std::filesystem::path& path);

/// Reads the probabilities of all frames, frame_count() * cell_count() values, row-major. Errors
/// name file and line: files that are missing or have fewer or more lines than the grid has cells,
/// and values that are not from 0 to 1.
Result<std::vector<float>> ReadKspMaps(const KspFile& file, const RunControl& control);

}  // namespace vantage
