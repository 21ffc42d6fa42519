// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/metrics/mask_measures.h"

#include <array>
#include <cmath>
#include <limits>

#include "vantage/video/sequence.h"

namespace vantage {
namespace {

double Ratio(std::int64_t part, std::int64_t whole) {
  return whole == 0 ? std::numeric_limits<double>::quiet_NaN()
                    : static_cast<double>(part) / static_cast<double>(whole);
}

bool IsLabel(int value) {
  return value == TruthLabel::kStatic || value == TruthLabel::kShadow ||
         value == TruthLabel::kOutside || value == TruthLabel::kUnknown ||
         value == TruthLabel::kMoving;
}

/// Names the first pixel whose label is none.
tl::unexpected<Error> WrongLabel(const cv::Mat& truth) {
  for (int row = 0; row < truth.rows; ++row) {
    for (int column = 0; column < truth.cols; ++column) {
      const int value = truth.at<std::uint8_t>(row, column);
      if (IsLabel(value)) continue;
      return Fail(
          "pixel ({}, {}) has the label {}; labels are 0 static, 50 shadow, 85 outside, "
          "170 unknown and 255 moving",
          column, row, value);
    }
  }
  return Fail("a label is not one of 0, 50, 85, 170 and 255");
}

}  // namespace

MaskCounts& MaskCounts::operator+=(const MaskCounts& other) {
  frames += other.frames;
  true_positives += other.true_positives;
  false_positives += other.false_positives;
  false_negatives += other.false_negatives;
  true_negatives += other.true_negatives;
  shadow_px += other.shadow_px;
  shadow_false_positives += other.shadow_false_positives;
  return *this;
}

Result<MaskCounts> CountMask(const cv::Mat& truth, const cv::Mat& mask, const cv::Mat& roi) {
  if (truth.type() != CV_8UC1 || mask.type() != CV_8UC1 ||
      (!roi.empty() && roi.type() != CV_8UC1)) {
    return Fail("truth, mask and region of interest must have one channel of 8 bits");
  }
  if (mask.size() != truth.size()) {
    return Fail("the mask has {} x {} px, the truth {} x {}", mask.cols, mask.rows, truth.cols,
                truth.rows);
  }
  if (!roi.empty() && roi.size() != truth.size()) {
    return Fail("the region of interest has {} x {} px, the truth {} x {}", roi.cols, roi.rows,
                truth.cols, truth.rows);
  }

  // How often each label meets background [0] and foreground [1]. One pass, without branches on
  // what the pixels are; wrong labels show at the end.
  std::array<std::array<std::int64_t, 256>, 2> met = {};
  for (int row = 0; row < truth.rows; ++row) {
    const auto* labels = truth.ptr<std::uint8_t>(row);
    const auto* found = mask.ptr<std::uint8_t>(row);
    const auto* inside = roi.empty() ? nullptr : roi.ptr<std::uint8_t>(row);
    for (int column = 0; column < truth.cols; ++column) {
      const bool counts = inside == nullptr || inside[column] >= 128;
      ++met[found[column] >> 7][counts ? labels[column] : TruthLabel::kOutside];
    }
  }
  for (int value = 0; value < 256; ++value) {
    const auto label = static_cast<std::size_t>(value);
    if (met[0][label] + met[1][label] > 0 && !IsLabel(value)) return WrongLabel(truth);
  }

  const auto& background = met[0];
  const auto& foreground = met[1];
  return MaskCounts{
      .frames = 1,
      .true_positives = foreground[TruthLabel::kMoving],
      .false_positives = foreground[TruthLabel::kStatic] + foreground[TruthLabel::kShadow],
      .false_negatives = background[TruthLabel::kMoving],
      .true_negatives = background[TruthLabel::kStatic] + background[TruthLabel::kShadow],
      .shadow_px = foreground[TruthLabel::kShadow] + background[TruthLabel::kShadow],
      .shadow_false_positives = foreground[TruthLabel::kShadow]};
}

MaskMeasures MeasureMasks(const MaskCounts& counts) {
  const auto& [frames, tp, fp, fn, tn, shadow, shadow_fp] = counts;
  return {.recall = Ratio(tp, tp + fn),
          .specificity = Ratio(tn, tn + fp),
          .fpr = Ratio(fp, fp + tn),
          .fnr = Ratio(fn, tp + fn),
          .pwc = 100 * Ratio(fn + fp, tp + fp + fn + tn),
          .precision = Ratio(tp, tp + fp),
          .f1 = Ratio(2 * tp, 2 * tp + fp + fn),
          .shadow_fpr = Ratio(shadow_fp, shadow)};
}

MaskMeasures MeanOf(const std::vector<MaskMeasures>& sequences) {
  MaskMeasures mean;
  for (double MaskMeasures::*measure :
       {&MaskMeasures::recall, &MaskMeasures::specificity, &MaskMeasures::fpr, &MaskMeasures::fnr,
        &MaskMeasures::pwc, &MaskMeasures::precision, &MaskMeasures::f1,
        &MaskMeasures::shadow_fpr}) {
    double sum = 0;
    int count = 0;
    for (const MaskMeasures& one : sequences) {
      if (std::isnan(one.*measure)) continue;
      sum += one.*measure;
      ++count;
    }
    mean.*measure = count == 0 ? std::numeric_limits<double>::quiet_NaN() : sum / count;
  }
  return mean;
}

}  // namespace vantage
