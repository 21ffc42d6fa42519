// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <opencv2/core/mat.hpp>

#include "vantage/background/background_picture.h"
#include "vantage/base/options.h"
#include "vantage/base/result.h"

namespace vantage {

/// Options of shadow rejection after KaewTraKulPong and Bowden, "An improved adaptive background
/// mixture model for real-time tracking with shadow detection" (AVBS 2001, printed 2002),
/// section 3.
/// The defaults were chosen on CDnet's traffic (F1 0.733 without and 0.743 with) and SBI's IBMtest2
/// (0.942, 0.946); on CDnet's office up to frame 900 (0.862, 0.863) and SBI's CaVignal (0.606,
/// 0.604), on which they were not chosen, they change nothing, so the rejection is off.
struct ShadowOptions {
  bool enabled = false;
  /// tau: a shadow keeps at least this share of the background's brightness, 0 < tau < 1.
  double tau = 0.6;
  /// A shadow's colour is nearer to the background's, once both are equally bright, levels, > 0. In
  /// place of the paper's 2.5 sigma of the mixture, so that any background method can be used.
  double color_levels = 8;
};
void VisitOptions(ShadowOptions& options, OptionVisitor& visitor);

/// Takes cast shadows out of `mask` (CV_8UC1, in place): pixels whose colour I is the background's
/// colour B made darker, tau < a < 1 with a = (I . B) / (B . B) and |I - a B| within the options'
/// distance. A black background casts no shadow: its pixels stay. `bgr` is the frame, CV_8UC3 of
/// the mask's size. Returns the number of pixels taken out; 0 when off.
Result<int> RejectShadows(const cv::Mat& bgr, cv::Mat& mask, const BackgroundPicture& background,
                          const ShadowOptions& options);

}  // namespace vantage
