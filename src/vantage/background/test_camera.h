// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <gtest/gtest.h>

#include <opencv2/core.hpp>
#include <utility>
#include <vector>

#include "vantage/background/disturbance.h"
#include "vantage/background/mixture.h"
#include "vantage/base/test_support.h"

namespace vantage::testing {

/// The mixture model with the detector beside it: raw masks of one camera.
class Camera {
 public:
  explicit Camera(ImageSize size, const DisturbanceOptions& options = {})
      : model_(MixtureModel::Create(size, {}).value()),
        detector_(DisturbanceDetector::Create(size, options).value()) {}

  cv::Mat Step(const cv::Mat& frame) {
    const auto look = detector_.Look(frame);
    EXPECT_TRUE(look) << MessageOf(look);
    if (look->action == DisturbanceAction::kSkip) {
      return look->kind == DisturbanceKind::kFreeze ? last_.clone()
                                                    : cv::Mat::zeros(frame.size(), CV_8UC1);
    }
    cv::Mat mask;
    Expect(model_.Apply(frame, mask, 1));
    const auto background = [this](const cv::Rect& r) { return model_.BackgroundImage(r); };
    const auto found = detector_.Inspect(frame, mask, background);
    EXPECT_TRUE(found) << MessageOf(found);
    if (found->action == DisturbanceAction::kRelight) Expect(model_.Relight(found->gain, 1));
    if (found->action == DisturbanceAction::kRestart) model_.Restart();
    if (found->action != DisturbanceAction::kNone) Expect(model_.Apply(frame, mask, 1));
    last_ = mask.clone();
    return mask;
  }

  const DisturbanceReport& report() const { return detector_.report(); }

 private:
  static void Expect(const Status& status) { EXPECT_TRUE(status) << MessageOf(status); }

  MixtureModel model_;
  DisturbanceDetector detector_;
  cv::Mat last_;
};

inline std::vector<DisturbanceKind> EventsOf(const DisturbanceReport& report) {
  std::vector<DisturbanceKind> kinds;
  for (const DisturbanceEvent& event : report.events) kinds.push_back(event.kind);
  return kinds;
}

}  // namespace vantage::testing
