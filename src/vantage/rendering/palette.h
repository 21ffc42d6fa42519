// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <opencv2/core/types.hpp>

#include "vantage/base/ids.h"

namespace vantage {

/// Colour of a person everywhere (boxes, trails, plan): blue, green, red, 0 to 255. Depends on the
/// id alone. Hues follow the golden angle, so that few people differ as much as can be, and
/// lightness goes round three steps, so that they also differ for eyes that do not tell hues apart.
/// All are light enough for a dark ground.
cv::Scalar ColorOf(TrackId id);

/// Near-black or near-white, whichever reads better on `color`.
cv::Scalar TextColorOn(const cv::Scalar& color);

}  // namespace vantage
