// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/experiments/default_masks.h"

#include <opencv2/core.hpp>

#include "vantage/background/components.h"
#include "vantage/video/sequence.h"

namespace vantage {

DefaultMasks& DefaultMasks::operator+=(const DefaultMasks& other) {
  counts += other.counts;
  near_false_positives += other.near_false_positives;
  return *this;
}

cv::Mat NearMoving(const cv::Mat& labels) {
  cv::Mat near = cv::Mat::zeros(labels.size(), CV_8UC1);
  const cv::Rect all(0, 0, labels.cols, labels.rows);
  for (const Component& one : FindComponents(labels == TruthLabel::kMoving, {})) {
    const int reach_px = (one.box.height + 1) / 2;
    const cv::Rect grown(one.box.x - reach_px, one.box.y - reach_px, one.box.width + 2 * reach_px,
                         one.box.height + 2 * reach_px);
    near(grown & all) = 255;
  }
  return near;
}

Result<DefaultMasks> RunDefaultMasks(LabelledSequence sequence, BackgroundSubtractor subtractor,
                                     const RunControl& control) {
  DefaultMasks sum;
  LabelledFrame frame;
  cv::Mat mask;
  while (true) {
    if (control.Stopped()) return Cancelled();
    VANTAGE_ASSIGN_OR_RETURN(const bool more, sequence.Next(frame));
    if (!more) break;
    VANTAGE_RETURN_IF_ERROR(subtractor.Apply(frame.bgr, mask, 1));
    if (frame.labels.empty()) continue;
    VANTAGE_ASSIGN_OR_RETURN(const MaskCounts counts, CountMask(frame.labels, mask));
    // What is far from everybody does not count.
    cv::Mat near_labels = frame.labels.clone();
    near_labels.setTo(TruthLabel::kOutside, NearMoving(frame.labels) == 0);
    VANTAGE_ASSIGN_OR_RETURN(const MaskCounts near, CountMask(near_labels, mask));
    sum += {.counts = counts, .near_false_positives = near.false_positives};
  }
  return sum;
}

}  // namespace vantage
