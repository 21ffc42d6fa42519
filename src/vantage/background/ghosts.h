// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "vantage/background/background_picture.h"
#include "vantage/background/components.h"
#include "vantage/background/criteria.h"
#include "vantage/base/options.h"
#include "vantage/base/result.h"
#include "vantage/geometry/camera.h"

namespace vantage {

/// What of the foreground is judged.
enum class GhostJudgement {
  /// What stands still, piece by piece, by several frames in agreement. A ghost is background that
  /// was uncovered, so it keeps its colour from its first moment; a ghost that still hangs together
  /// with the person who left it is a piece of its own by that, and pieces of somebody who moves
  /// are never judged.
  kStill,
  /// The thesis's plain form: every component whole, in every frame for itself.
  kPlain,
};

/// Options of ghost detection (algorithms.md section 2; thesis 3.3.2). Those of kStill were chosen
/// on SBI's CaVignal and CDnet's office begun at frame 900, and on office from its start for
/// agree_frames; checked on traffic and IBMtest2.
struct GhostOptions {
  CriterionOptions rule;
  GhostJudgement judgement = GhostJudgement::kStill;
  /// T_S: components of fewer pixels are not judged and stay, px, >= 1.
  int min_area_px = 50;

  // The rest is for kStill.
  /// A pixel stands still when it has kept its colour since it became foreground or last changed,
  /// for this many frames, 1 <= still_frames <= 250,
  int still_frames = 8;
  /// each channel within this, levels, 0 <= still_levels <= 255.
  int still_levels = 12;
  /// A component of which at least this share stands still is judged whole, the still pieces of
  /// others by themselves, 0 < whole_share <= 1.
  double whole_share = 0.5;
  /// Foreground no further apart than this is judged together, px, 1 <= join_px <= 50.
  int join_px = 4;
  /// A piece is judged when at least this share of its border is away from other foreground,
  /// 0 <= free_share <= 1.
  double free_share = 0.3;
  /// Frames in a row that must find a pixel in a ghost before it is absorbed,
  /// 1 <= agree_frames <= 250.
  int agree_frames = 3;
};
void VisitOptions(GhostOptions& options, OptionVisitor& visitor);

/// A component, or a piece of one, and what was found about it.
struct JudgedComponent {
  Component component;
  double value = 0;       ///< of the criterion
  double free_share = 1;  ///< of its border
  bool decided = true;    ///< false: too little of its border is free, nothing is known
  bool ghost = false;     ///< the value speaks for a ghost
};

/// What was found in one frame.
struct GhostVerdict {
  std::vector<JudgedComponent> judged;
  /// Pixels that are to be absorbed now, 255 in a CV_8UC1 picture of the mask's size; empty: none.
  cv::Mat ghosts;
  int ghosts_px = 0;
};

/// Finds the ghosts in the masks of one camera, frame after frame, whatever algorithm made them.
class GhostDetector {
 public:
  static Result<GhostDetector> Create(ImageSize size, const GhostOptions& options);

  /// `bgr` (CV_8UC3) and `mask` (CV_8UC1, not 0 is foreground) are of the detector's size. Fails on
  /// others, and when the rule needs a background picture that the algorithm does not have.
  Result<GhostVerdict> Judge(const cv::Mat& bgr, const cv::Mat& mask,
                             const BackgroundPicture& background);

 private:
  /// Of a pixel of a component that is large enough to be judged.
  struct History {
    std::uint8_t color[3];    ///< blue, green, red when it last changed
    std::uint8_t still = 0;   ///< frames since
    std::uint8_t votes = 0;   ///< frames in a row that found it in a ghost
    bool voted = false;       ///< the last frame that knew it was one of them
    std::uint16_t frame = 0;  ///< the last frame that knew it as foreground, modulo 65536
  };

  GhostDetector(ImageSize size, const GhostOptions& options);
  std::size_t Index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(size_.width) +
           static_cast<std::size_t>(x);
  }
  Status CheckSizes(const cv::Mat& bgr, const cv::Mat& mask) const;
  cv::Mat UpdateStillness(const cv::Mat& bgr, const Component& component);
  cv::Mat OthersBeside(const cv::Mat& bgr, const cv::Mat& mask, const Component& piece) const;
  Status JudgePiece(const cv::Mat& bgr, const BackgroundPicture& background, Component piece,
                    const cv::Mat& others, GhostVerdict& verdict) const;
  bool Vote(const JudgedComponent& piece, cv::Mat& ghosts);

  ImageSize size_;
  GhostOptions options_;
  int margin_px_ = 0;
  std::uint64_t frame_ = 0;
  std::vector<History> history_;  ///< row by row; empty for kPlain
};

}  // namespace vantage
