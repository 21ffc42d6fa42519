// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/background/subtractor.h"

#include <opencv2/core.hpp>
#include <utility>

#include "vantage/base/stopwatch.h"

namespace vantage {

void VisitOptions(BackgroundOptions& options, OptionVisitor& visitor) {
  VisitOptions(options.mixture, visitor);
  VisitOptions(options.ghosts, visitor);
  VisitOptions(options.cleanup, visitor);
}

Status Validate(const BackgroundOptions& options) {
  VANTAGE_RETURN_IF_ERROR(ValidateOptions(options, "background"));
  return Validate(options.mixture);
}

Result<BackgroundSubtractor> BackgroundSubtractor::Create(ImageSize size,
                                                          const BackgroundOptions& options) {
  VANTAGE_RETURN_IF_ERROR(Validate(options));
  VANTAGE_ASSIGN_OR_RETURN(MixtureModel model, MixtureModel::Create(size, options.mixture));
  return BackgroundSubtractor(std::move(model), options);
}

Status BackgroundSubtractor::Apply(const cv::Mat& bgr, cv::Mat& mask, int threads) {
  Stopwatch watch;
  // `mask` may be the same object.
  const cv::Mat frame = bgr;  // NOLINT(performance-unnecessary-copy-initialization)
  VANTAGE_RETURN_IF_ERROR(model_.Apply(frame, mask, threads));
  watch.LapInto(report_.mixture_secs);

  const auto background = [this](const cv::Rect& region) { return model_.BackgroundImage(region); };
  VANTAGE_ASSIGN_OR_RETURN(const std::vector<JudgedComponent> judged,
                           JudgeComponents(frame, mask, background, options_.ghosts));
  bool any_ghost = false;
  for (const JudgedComponent& one : judged) {
    if (!one.ghost) continue;
    any_ghost = true;
    ++report_.ghosts;
    report_.ghosts_px += one.component.area_px;
  }
  if (any_ghost) {
    const cv::Mat ghosts = GhostMask(judged, mask.size());
    VANTAGE_RETURN_IF_ERROR(model_.Absorb(ghosts));
    mask.setTo(0, ghosts);
  }
  watch.LapInto(report_.ghost_secs);

  VANTAGE_RETURN_IF_ERROR(CleanMask(mask, options_.cleanup));
  watch.LapInto(report_.cleanup_secs);
  ++report_.frames;
  return {};
}

}  // namespace vantage
