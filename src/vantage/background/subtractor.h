// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <opencv2/core/mat.hpp>

#include "vantage/background/cleanup.h"
#include "vantage/background/disturbance.h"
#include "vantage/background/ghosts.h"
#include "vantage/background/method.h"
#include "vantage/background/rehearsal.h"
#include "vantage/background/report.h"
#include "vantage/background/shadows.h"
#include "vantage/base/options.h"
#include "vantage/base/result.h"
#include "vantage/base/run_control.h"
#include "vantage/video/frame_source.h"

namespace vantage {

/// Options of the background stage; one flat table, e.g. `[background]` of a scene.
struct BackgroundOptions {
  MethodKind method = MethodKind::kMixture;
  MixtureOptions mixture;
  DisturbanceOptions disturbances;
  ShadowOptions shadows;
  GhostOptions ghosts;
  CleanupOptions cleanup;
  /// Of whoever has the recording: subtractors do not read.
  RehearsalOptions rehearsal;
};
void VisitOptions(BackgroundOptions& options, OptionVisitor& visitor);
/// Fields one by one, then the rules that join two of them.
Status Validate(const BackgroundOptions& options);

/// Frames of one fixed camera in, masks out. In this order: frames that are frozen or black are
/// kept from the method; the method's mask; a sudden change of light or a moved camera corrected in
/// the method and the mask made again; shadows; ghosts, which are absorbed by the method and taken
/// out of the mask; the clean-up. One object per camera; not thread-safe.
class BackgroundSubtractor {
 public:
  /// `frames_per_second` > 0 turns the options' seconds into frames.
  static Result<BackgroundSubtractor> Create(ImageSize size, const BackgroundOptions& options,
                                             double frames_per_second = 25);

  /// The same around a method of the caller's own; `options.method` and `options.mixture` are not
  /// used.
  static Result<BackgroundSubtractor> Create(ImageSize size,
                                             std::unique_ptr<BackgroundMethod> method,
                                             const BackgroundOptions& options,
                                             double frames_per_second = 25);

  /// `bgr` is CV_8UC3 of the given size, `mask` becomes CV_8UC1 of that size, 0 background and 255
  /// foreground. `held`, empty or CV_8UC1 of that size, is not 0 where an object is known to stand:
  /// it neither fades into the background there nor is it taken for a ghost. Same bits for every
  /// thread count. Fails on matrices of another size or type.
  Status Apply(const cv::Mat& bgr, cv::Mat& mask, int threads, const cv::Mat& held = {});

  /// Before the first Apply: learns one of the frames that a rehearsal samples. `mask` becomes what
  /// is foreground so far, without shadows, cleaned up. Neither ghosts nor disturbances are looked
  /// for: samples are far apart, and what is true of few of them does no harm. Otherwise as Apply.
  Status Rehearse(const cv::Mat& bgr, cv::Mat& mask, int threads);

  const BackgroundMethod& method() const { return *method_; }
  const BackgroundReport& report() const { return report_; }
  /// What was found about the last frame's components, before the clean-up.
  const GhostVerdict& verdict() const { return verdict_; }
  /// The last frame's mask as it was judged: before ghosts were taken out and the clean-up.
  const cv::Mat& foreground() const { return judged_mask_; }
  /// False when a disturbance made the last mask unreliable.
  bool reliable() const { return reliable_; }

 private:
  BackgroundSubtractor(ImageSize size, std::unique_ptr<BackgroundMethod> method,
                       DisturbanceDetector disturbances, GhostDetector ghosts,
                       const BackgroundOptions& options);
  Status CheckFrame(const cv::Mat& bgr, const cv::Mat& held) const;
  Status CheckMask(const cv::Mat& mask) const;
  Status Learn(const cv::Mat& frame, cv::Mat& mask, int threads, const cv::Mat& held);
  Status TakeGhosts(const cv::Mat& frame, cv::Mat& mask, const cv::Mat& held);

  ImageSize size_;
  std::unique_ptr<BackgroundMethod> method_;
  DisturbanceDetector disturbances_;
  GhostDetector ghosts_;
  BackgroundOptions options_;
  BackgroundReport report_;
  GhostVerdict verdict_;
  cv::Mat judged_mask_;
  cv::Mat last_mask_;  ///< of the last frame that was learnt; what a frozen camera shows
  bool reliable_ = true;
};

/// Rehearses on samples of `source`, which stands at the recording's first frame and is read as far
/// as they reach; fewer where it ends. Fails as the source does.
Status Rehearse(BackgroundSubtractor& subtractor, FrameSource& source, const RehearsalPlan& plan,
                int threads, const RunControl& control = {});

}  // namespace vantage
