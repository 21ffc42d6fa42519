// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>

#include "vantage/background/cleanup.h"
#include "vantage/background/ghosts.h"
#include "vantage/background/mixture.h"
#include "vantage/base/options.h"
#include "vantage/base/result.h"

namespace vantage {

/// Options of the background stage; one flat table, e.g. `[background]` of a scene.
struct BackgroundOptions {
  MixtureOptions mixture;
  GhostOptions ghosts;
  CleanupOptions cleanup;
};
void VisitOptions(BackgroundOptions& options, OptionVisitor& visitor);
/// Fields one by one, then the rules that join two of them.
Status Validate(const BackgroundOptions& options);

/// What the stage did so far.
struct BackgroundReport {
  std::int64_t frames = 0;
  std::int64_t ghosts = 0;     ///< components absorbed, counted in each frame
  std::int64_t ghosts_px = 0;  ///< their pixels
  double mixture_secs = 0;
  double ghost_secs = 0;
  double cleanup_secs = 0;
};

/// Frames of one fixed camera in, masks out: the mixture model, then ghosts, which are absorbed
/// into the model and taken out of the mask, then the clean-up. One object per camera; not
/// thread-safe.
class BackgroundSubtractor {
 public:
  static Result<BackgroundSubtractor> Create(ImageSize size, const BackgroundOptions& options);

  /// `bgr` is CV_8UC3 of the given size, `mask` becomes CV_8UC1 of that size, 0 background and 255
  /// foreground. Same bits for every thread count. Fails on a frame of another size or type.
  Status Apply(const cv::Mat& bgr, cv::Mat& mask, int threads);

  const MixtureModel& model() const { return model_; }
  const BackgroundReport& report() const { return report_; }

 private:
  BackgroundSubtractor(MixtureModel model, const BackgroundOptions& options)
      : model_(std::move(model)), options_(options) {}

  MixtureModel model_;
  BackgroundOptions options_;
  BackgroundReport report_;
};

}  // namespace vantage
