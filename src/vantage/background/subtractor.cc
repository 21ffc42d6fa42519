// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/background/subtractor.h"

#include <opencv2/core.hpp>
#include <utility>

#include "vantage/base/stopwatch.h"

namespace vantage {
namespace {

BackgroundPicture PictureOf(const BackgroundMethod& method) {
  return [&method](const cv::Rect& region) { return method.BackgroundImage(region); };
}

}  // namespace

void VisitOptions(BackgroundOptions& options, OptionVisitor& visitor) {
  visitor.Choice(
      {"method", "", "background algorithm; mog2 and knn are OpenCV's, at their defaults"},
      options.method,
      {{"mixture", MethodKind::kMixture}, {"mog2", MethodKind::kMog2}, {"knn", MethodKind::kKnn}});
  VisitOptions(options.mixture, visitor);
  VisitOptions(options.disturbances, visitor);
  VisitOptions(options.shadows, visitor);
  VisitOptions(options.ghosts, visitor);
  VisitOptions(options.cleanup, visitor);
  VisitOptions(options.rehearsal, visitor);
}

Status Validate(const BackgroundOptions& options) {
  VANTAGE_RETURN_IF_ERROR(ValidateOptions(options, "background"));
  return Validate(options.mixture);
}

BackgroundSubtractor::BackgroundSubtractor(ImageSize size, std::unique_ptr<BackgroundMethod> method,
                                           DisturbanceDetector disturbances, GhostDetector ghosts,
                                           const BackgroundOptions& options)
    : size_(size),
      method_(std::move(method)),
      disturbances_(std::move(disturbances)),
      ghosts_(std::move(ghosts)),
      options_(options) {}

Result<BackgroundSubtractor> BackgroundSubtractor::Create(ImageSize size,
                                                          const BackgroundOptions& options,
                                                          double frames_per_second) {
  VANTAGE_RETURN_IF_ERROR(Validate(options));
  VANTAGE_ASSIGN_OR_RETURN(std::unique_ptr<BackgroundMethod> method,
                           CreateMethod(options.method, size, options.mixture));
  return Create(size, std::move(method), options, frames_per_second);
}

Result<BackgroundSubtractor> BackgroundSubtractor::Create(ImageSize size,
                                                          std::unique_ptr<BackgroundMethod> method,
                                                          const BackgroundOptions& options,
                                                          double frames_per_second) {
  VANTAGE_RETURN_IF_ERROR(ValidateOptions(options, "background"));
  if (method == nullptr) return Fail("background: no method given; it must be an object");
  VANTAGE_ASSIGN_OR_RETURN(
      DisturbanceDetector disturbances,
      DisturbanceDetector::Create(size, options.disturbances, frames_per_second));
  VANTAGE_ASSIGN_OR_RETURN(GhostDetector ghosts, GhostDetector::Create(size, options.ghosts));
  return BackgroundSubtractor(size, std::move(method), std::move(disturbances), std::move(ghosts),
                              options);
}

Status BackgroundSubtractor::CheckFrame(const cv::Mat& bgr, const cv::Mat& held) const {
  const cv::Size size(size_.width, size_.height);
  if (bgr.empty()) return Fail("background: frame {} is empty", report_.frames);
  if (bgr.type() != CV_8UC3 || bgr.size() != size) {
    return Fail(
        "background: frame {} is {}x{} px of type {}; it must be {}x{} px of 8-bit BGR (CV_8UC3)",
        report_.frames, bgr.cols, bgr.rows, cv::typeToString(bgr.type()), size.width, size.height);
  }
  if (!held.empty() && (held.type() != CV_8UC1 || held.size() != size)) {
    return Fail(
        "background: the held pixels of frame {} are {}x{} px of type {}; they must be {}x{} px "
        "of type CV_8UC1",
        report_.frames, held.cols, held.rows, cv::typeToString(held.type()), size.width,
        size.height);
  }
  return {};
}

/// A caller's own method may be wrong.
Status BackgroundSubtractor::CheckMask(const cv::Mat& mask) const {
  if (mask.type() == CV_8UC1 && mask.cols == size_.width && mask.rows == size_.height) return {};
  return Fail(
      "background: the method's mask is {}x{} px of type {}; it must be {}x{} px of type CV_8UC1",
      mask.cols, mask.rows, cv::typeToString(mask.type()), size_.width, size_.height);
}

/// The method's mask, made again when a disturbance had to be corrected.
Status BackgroundSubtractor::Learn(const cv::Mat& frame, cv::Mat& mask, int threads,
                                   const cv::Mat& held) {
  Stopwatch watch;
  VANTAGE_RETURN_IF_ERROR(method_->Apply(frame, held, mask, threads));
  VANTAGE_RETURN_IF_ERROR(CheckMask(mask));
  watch.LapInto(report_.method_secs);
  VANTAGE_ASSIGN_OR_RETURN(const Disturbance found,
                           disturbances_.Inspect(frame, mask, PictureOf(*method_)));
  if (found.action != DisturbanceAction::kNone) {
    reliable_ = false;
    bool relit = false;
    if (found.action == DisturbanceAction::kRelight) {
      VANTAGE_ASSIGN_OR_RETURN(relit, method_->Relight(found.gain, threads));
    }
    if (!relit) method_->Restart();
    VANTAGE_RETURN_IF_ERROR(method_->Apply(frame, held, mask, threads));
    VANTAGE_RETURN_IF_ERROR(CheckMask(mask));
  }
  watch.LapInto(report_.disturbance_secs);
  return {};
}

Status BackgroundSubtractor::TakeGhosts(const cv::Mat& frame, cv::Mat& mask, const cv::Mat& held) {
  VANTAGE_ASSIGN_OR_RETURN(verdict_, ghosts_.Judge(frame, mask, PictureOf(*method_)));
  if (verdict_.ghosts.empty()) return {};
  if (!held.empty()) {
    verdict_.ghosts.setTo(0, held);
    verdict_.ghosts_px = cv::countNonZero(verdict_.ghosts);
    if (verdict_.ghosts_px == 0) {
      verdict_.ghosts.release();
      return {};
    }
  }
  VANTAGE_RETURN_IF_ERROR(method_->Absorb(verdict_.ghosts));
  mask.setTo(0, verdict_.ghosts);
  ++report_.ghost_frames;
  report_.ghosts_px += verdict_.ghosts_px;
  return {};
}

Status BackgroundSubtractor::Rehearse(const cv::Mat& bgr, cv::Mat& mask, int threads) {
  VANTAGE_RETURN_IF_ERROR(CheckFrame(bgr, {}));
  const cv::Mat frame = bgr;  // NOLINT(performance-unnecessary-copy-initialization)
  VANTAGE_RETURN_IF_ERROR(method_->Apply(frame, {}, mask, threads));
  VANTAGE_RETURN_IF_ERROR(CheckMask(mask));
  VANTAGE_RETURN_IF_ERROR(RejectShadows(frame, mask, PictureOf(*method_), options_.shadows));
  ++report_.rehearsed;
  return CleanMask(mask, options_.cleanup);
}

Status BackgroundSubtractor::Apply(const cv::Mat& bgr, cv::Mat& mask, int threads,
                                   const cv::Mat& held) {
  VANTAGE_RETURN_IF_ERROR(CheckFrame(bgr, held));
  // `mask` may be the same object.
  const cv::Mat frame = bgr;  // NOLINT(performance-unnecessary-copy-initialization)
  Stopwatch watch;
  VANTAGE_ASSIGN_OR_RETURN(const Disturbance seen, disturbances_.Look(frame));
  watch.LapInto(report_.disturbance_secs);
  reliable_ = seen.action == DisturbanceAction::kNone;
  verdict_ = {};
  if (reliable_) {
    VANTAGE_RETURN_IF_ERROR(Learn(frame, mask, threads, held));
    watch = {};
    VANTAGE_ASSIGN_OR_RETURN(const int shadows_px,
                             RejectShadows(frame, mask, PictureOf(*method_), options_.shadows));
    report_.shadows_px += shadows_px;
    watch.LapInto(report_.shadow_secs);
    mask.copyTo(judged_mask_);
    VANTAGE_RETURN_IF_ERROR(TakeGhosts(frame, mask, held));
    watch.LapInto(report_.ghost_secs);
    VANTAGE_RETURN_IF_ERROR(CleanMask(mask, options_.cleanup));
    watch.LapInto(report_.cleanup_secs);
    mask.copyTo(last_mask_);
  } else {
    const bool frozen = seen.kind == DisturbanceKind::kFreeze && !last_mask_.empty();
    mask = frozen ? last_mask_.clone() : cv::Mat::zeros(frame.size(), CV_8UC1);
    mask.copyTo(judged_mask_);
  }
  ++report_.frames;
  if (!reliable_) ++report_.unreliable;
  report_.disturbances = disturbances_.report();
  return {};
}

Status Rehearse(BackgroundSubtractor& subtractor, FrameSource& source, const RehearsalPlan& plan,
                int threads, const RunControl& control) {
  cv::Mat frame, mask;
  for (std::int64_t sample = 0; sample < plan.samples; ++sample) {
    if (control.Stopped()) return Cancelled();
    if (sample > 0) VANTAGE_RETURN_IF_ERROR(source.Skip(plan.interval - 1));
    VANTAGE_ASSIGN_OR_RETURN(const bool more, source.Read(frame));
    if (!more) break;
    VANTAGE_RETURN_IF_ERROR(subtractor.Rehearse(frame, mask, threads));
  }
  return {};
}

}  // namespace vantage
