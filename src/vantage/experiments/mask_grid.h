// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

#include "vantage/background/subtractor.h"
#include "vantage/base/run_control.h"
#include "vantage/experiments/labelled_sequence.h"

/// Masks as pictures: rows of methods, columns of frames (the thesis's figures 1 and 5 to 7).

namespace vantage {

/// A mask (CV_8UC1, 128 and above foreground) beside its truth (labels, CV_8UC1): true positives
/// white, false positives red, misses blue, true negatives black, what does not count grey. Without
/// truth (empty) foreground is white. CV_8UC3.
cv::Mat DrawMask(const cv::Mat& mask, const cv::Mat& labels);

struct MaskGridRow {
  std::string name;
  BackgroundOptions options = {};
  /// Whether a row with the background picture stands above that of the masks.
  bool background = false;
};

struct MaskGridPlan {
  std::vector<MaskGridRow> rows;
  /// Frames shown, ascending, counted from the first that the methods see; those beyond the end of
  /// the sequence are left out.
  std::vector<FrameIndex> columns;
  int width_px = 200;  ///< of each picture
};

/// Runs the rows' methods over a sequence and draws: {"columns": [names of frames], "rows":
/// [{"name", "pictures": [data URIs]}], "foreground": [{"name", "frames": [[frame, pixels],
/// ...]}]}, where pixels are false positives, or all of the foreground where the sequence has no
/// truth. `open` opens the sequence at its first frame, for each pass over it.
Result<nlohmann::ordered_json> DrawMaskGrid(LabelledSequence sequence, const MaskGridPlan& plan,
                                            const RunControl& control = {});

}  // namespace vantage
