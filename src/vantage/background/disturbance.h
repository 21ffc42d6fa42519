// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <vector>

#include "vantage/background/background_picture.h"
#include "vantage/base/options.h"
#include "vantage/base/result.h"
#include "vantage/geometry/camera.h"

namespace vantage {

/// Options of what is done when the whole picture of a fixed camera is disturbed.
struct DisturbanceOptions {
  bool enabled = true;
  /// The light has changed when the levels of this share of the picture did, 0 < share <= 1.
  double light_share = 0.4;
  /// Frames that repeat for so long are a frozen camera, s, >= 0; 0: never.
  double freeze_secs = 1;
  /// A picture whose levels, but for 2 % of its pixels, differ by less is black, levels, >= 0;
  /// 0: never.
  int uniform_levels = 12;
  /// The camera was moved when its picture is shifted by so much and stays, px, >= 0; 0: never.
  double moved_px = 2;
  /// After a change of the light most of the picture may stay foreground for so long, then the
  /// background is learnt anew, s, > 0. Where no cause was found, five times as long.
  double restart_secs = 1;
};
void VisitOptions(DisturbanceOptions& options, OptionVisitor& visitor);

enum class DisturbanceKind {
  kLight,   ///< a lamp, a cloud
  kFreeze,  ///< the camera repeats a frame
  kBlack,   ///< black, or of one colour
  kMoved,   ///< the camera was moved or turned
  kLost,    ///< most of the picture stayed foreground, of whatever cause
};

struct DisturbanceEvent {
  DisturbanceKind kind = DisturbanceKind::kLight;
  std::int64_t frame = 0;   ///< in which it was noticed
  std::int64_t frames = 1;  ///< from that one to the last whose mask it made unreliable
  double factor = 1;        ///< kLight: of the levels, median over the picture
  double length_px = 0;     ///< kMoved: how far
};

struct DisturbanceReport {
  std::vector<DisturbanceEvent> events;
  std::int64_t skipped = 0;   ///< frames not shown to the model: frozen or black
  std::int64_t relit = 0;     ///< times that the model was corrected for the light
  std::int64_t restarts = 0;  ///< times that the model began anew
};

enum class DisturbanceAction {
  kNone,
  kSkip,     ///< the model must not see the frame
  kRelight,  ///< multiply the model's means by `gain`, apply the frame again
  kRestart,  ///< drop the model, apply the frame again as its first
};

/// What the caller has to do about one frame.
struct Disturbance {
  DisturbanceAction action = DisturbanceAction::kNone;
  /// Not for kNone; kFreeze: the last mask still holds. kBlack: nothing is known, the mask is
  /// empty.
  DisturbanceKind kind = DisturbanceKind::kLight;
  cv::Mat gain;  ///< kRelight: CV_32FC3 of the frame's size, factors of blue, green and red levels
};

/// Watches one fixed camera for what changes its whole picture: light, freezing, black-out, being
/// moved. Works beside any background method: it sees the frame, the mask before ghosts and
/// clean-up, and the background picture. Undisturbed frames cost a look at a few thousand pixels;
/// the background picture is asked for only when more is foreground than usual.
class DisturbanceDetector {
 public:
  /// `frames_per_second` > 0 turns seconds into frames.
  static Result<DisturbanceDetector> Create(ImageSize size, const DisturbanceOptions& options,
                                            double frames_per_second = 25);

  /// Before the model sees the frame (CV_8UC3 of the given size): kNone or kSkip. Fails on another
  /// size or type.
  Result<Disturbance> Look(const cv::Mat& bgr);

  /// After the model has made `mask` (CV_8UC1) of the frame that was last looked at, unless that
  /// was to be skipped: kNone, kRelight or kRestart.
  Result<Disturbance> Inspect(const cv::Mat& bgr, const cv::Mat& mask,
                              const BackgroundPicture& background);

  const DisturbanceReport& report() const { return report_; }

 private:
  DisturbanceDetector() = default;
  std::int64_t FramesOf(double secs) const;
  /// One more unreliable frame: of the event under way, or of a new one.
  DisturbanceEvent& Note(DisturbanceKind kind, std::int64_t gap);
  bool IsBlack(const cv::Mat& samples);
  bool IsFrozen(const cv::Mat& bgr, const cv::Mat& samples);
  /// The gain to relight the model with; empty when the light did not change.
  Result<cv::Mat> GainOfLight(const cv::Mat& mask, const BackgroundPicture& background);
  Result<bool> IsMoved(const cv::Mat& bgr, const BackgroundPicture& background);
  Disturbance Restart(DisturbanceKind kind);

  ImageSize size_;
  DisturbanceOptions options_;
  double frames_per_second_ = 25;
  int step_px_ = 1;
  DisturbanceReport report_;

  std::int64_t frame_ = -1;  ///< of the last look
  std::int64_t learnt_ = 0;  ///< frames inspected since the model began
  cv::Mat samples_;          ///< of the last frame
  cv::Mat foreground_;       ///< samples of the last mask that was not suspicious
  // What is usual.
  double usual_share_ = 0;   ///< of foreground
  double usual_change_ = 0;  ///< mean difference of frames in a row, levels
  double usual_spread_ = 0;  ///< of levels in a frame
  // Freezing.
  cv::Mat repeated_;  ///< the frame that may be repeating
  std::int64_t repeats_ = 0;
  // Light.
  std::int64_t settled_ = 0;  ///< frame until which the light may still change
  std::int64_t next_light_check_ = 0;
  std::int64_t flooded_ = 0;  ///< frames in a row with most of the picture foreground
  // Moved camera.
  std::int64_t jumped_ = -1000000;  ///< frame that differed much from the one before
  std::int64_t next_shift_check_ = 0;
  std::optional<cv::Point2d> shift_px_;  ///< found at the last check
  std::int64_t shifted_since_ = 0;
};

}  // namespace vantage
