// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "vantage/base/result.h"
#include "vantage/occupancy/solver.h"
#include "vantage/occupancy/views.h"

namespace vantage {

/// Configuration file of the original POM program (F. Fleuret and others, EPFL), one keyword a
/// line; words are separated by blanks or commas and may stand in double quotes, '#' begins a
/// comment line:
///
///   ROOM width height cameras cells          size of all pictures; cameras are numbered from 0
///   ROOM -1 -1 cameras cells                 later form: every camera has a line
///   CAMERA number width height
///   RECTANGLE camera cell xmin ymin xmax ymax   inclusive corners; or: RECTANGLE c n notvisible
///   INPUT_VIEW_FORMAT, RESULT_FORMAT, RESULT_VIEW_FORMAT, CONVERGENCE_VIEW_FORMAT   file names
///   PRIOR, SIGMA_IMAGE_DENSITY (a variance), SMOOTHING_COEFFICIENT, MAX_NB_SOLVER_ITERATIONS,
///   ERROR_MAX, NB_STABLE_ERROR_FOR_CONVERGENCE, PROBA_IGNORED
///   PROCESS first count                      frames; may be repeated
///
/// Pictures of the result and of the convergence are not drawn: their formats are read and left.
struct PomFile {
  struct Frames {
    std::int64_t first = 0;
    std::int64_t count = 0;
  };
  std::filesystem::path path;
  /// The cameras' numbers, which %c stands for, in the order of `views`.
  std::vector<int> camera_numbers;
  std::vector<CameraView> views;
  std::string input_format;
  std::string result_format;
  OccupancyOptions options = OriginalPomOptions();
  std::vector<Frames> frames;

  /// File names have %c and %f replaced by camera and frame, without padding, and are relative to
  /// the configuration file's folder; those of results to `folder` when that is not empty.
  std::filesystem::path InputPath(std::size_t camera, std::int64_t frame) const;
  std::filesystem::path ResultPath(std::int64_t frame, const std::filesystem::path& folder) const;
};

/// Reads a configuration. Errors name file and line and say what is allowed. A setting that follows
/// PROCESS would hold for later frames only in the original program; here it is an error.
Result<PomFile> ReadPomFile(const std::filesystem::path& path);

}  // namespace vantage
