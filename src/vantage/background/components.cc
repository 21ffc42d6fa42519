// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/background/components.h"

#include <opencv2/imgproc.hpp>

namespace vantage {

std::vector<Component> FindComponents(const cv::Mat& mask, int min_area_px, int margin_px) {
  cv::Mat labels, stats, centroids;
  const int count = cv::connectedComponentsWithStats(mask, labels, stats, centroids, 8, CV_32S);
  const cv::Rect picture(0, 0, mask.cols, mask.rows);
  std::vector<Component> components;
  for (int label = 1; label < count; ++label) {
    const int area_px = stats.at<int>(label, cv::CC_STAT_AREA);
    if (area_px < min_area_px) continue;
    const cv::Rect box(
        stats.at<int>(label, cv::CC_STAT_LEFT), stats.at<int>(label, cv::CC_STAT_TOP),
        stats.at<int>(label, cv::CC_STAT_WIDTH), stats.at<int>(label, cv::CC_STAT_HEIGHT));
    const cv::Rect window = cv::Rect(box.x - margin_px, box.y - margin_px,
                                     box.width + 2 * margin_px, box.height + 2 * margin_px) &
                            picture;
    components.push_back(
        {.box = box, .area_px = area_px, .window = window, .pixels = labels(window) == label});
  }
  return components;
}

BorderRegions BorderOf(const Component& component, int half_width_px) {
  BorderRegions regions;
  const cv::Mat square = cv::getStructuringElement(cv::MORPH_RECT, {3, 3});
  cv::Mat inside;
  // OpenCV takes what lies outside the picture for foreground when it erodes.
  cv::erode(component.pixels, inside, square);
  regions.true_border = component.pixels & ~inside;
  cv::dilate(regions.true_border, regions.expanded, square, {-1, -1}, half_width_px);
  regions.expansion = regions.expanded & ~regions.true_border;
  return regions;
}

}  // namespace vantage
