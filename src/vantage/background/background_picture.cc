// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/background/background_picture.h"

#include <opencv2/core.hpp>

namespace vantage {

Status CheckBackgroundPicture(std::string_view part, const cv::Mat& picture, cv::Size size) {
  if (picture.type() == CV_8UC3 && picture.size() == size) return {};
  return Fail(
      "{}: the background picture is {}x{} px of type {}; it must be {}x{} px of type CV_8UC3",
      part, picture.cols, picture.rows, cv::typeToString(picture.type()), size.width, size.height);
}

}  // namespace vantage
