// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/background/disturbance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/core.hpp>

#include "vantage/background/camera_shift.h"
#include "vantage/background/light_change.h"

namespace vantage {
namespace {

// The thresholds below were chosen on vtest.avi, CDnet's office and traffic and SBI's CaVignal and
// IBMtest2, undisturbed and with what the tests inject; none of them was held out.

constexpr int kSamples = 8192;  // of a picture, about
// Rates of the slow means of what is usual, per frame.
constexpr double kUsualRate = 0.02;
constexpr double kFallRate = 0.2;
constexpr double kSuspiciousShare = 0.04;  // of foreground above the usual
constexpr double kFlood = 0.5;             // "most of the picture"
// Frames between checks that found nothing.
constexpr int kLightChecksApart = 3;
constexpr int kShiftChecksApart = 5;
constexpr double kLearning_secs = 1;  // in which a new model is not judged

// A frame repeats the last one when it differs by less than this share of the usual change, and
// nowhere by more than these levels.
constexpr double kStill = 0.1;
constexpr double kStillest_levels = 8;
// A frame that differs from the last one by so many times the usual change may be of a camera that
// was pushed; it is looked at for so long.
constexpr double kJump = 2;
constexpr double kJump_secs = 1;

// The light explains a frame when it predicts this share of the samples, and of the texture.
constexpr double kExplained = 0.65;
constexpr double kStructure = 0.3;
constexpr double kLit = 0.05;  // share of the picture that is foreground for the light alone
// After a change the light is followed for a while by smaller steps.
constexpr double kSettling_secs = 1;
constexpr double kLitSettling = 0.01;
constexpr double kResidue = 0.04;

constexpr double kMoved_secs = 0.4;  // a moved camera's shift is the same for so long,
constexpr double kSameShift = 0.1;   // but for this share of it

/// SamplePixels of the background; asks only for the rows that hold samples. Empty where the method
/// has no picture of it.
Result<cv::Mat> SampleBackground(const BackgroundPicture& background, cv::Size size, int step_px) {
  std::vector<cv::Mat> rows;
  for (int y = step_px / 2; y < size.height; y += step_px) {
    const cv::Mat row = background({0, y, size.width, 1});
    if (row.empty()) return cv::Mat();
    VANTAGE_RETURN_IF_ERROR(CheckBackgroundPicture("disturbances", row, {size.width, 1}));
    cv::Mat samples(1, (size.width - step_px / 2 + step_px - 1) / step_px, CV_8UC3);
    for (int x = 0; x < samples.cols; ++x) {
      samples.at<cv::Vec3b>(0, x) = row.at<cv::Vec3b>(0, step_px / 2 + x * step_px);
    }
    rows.push_back(samples);
  }
  cv::Mat all;
  cv::vconcat(rows, all);
  return all;
}

/// Levels within which all but 1 % at either end of a channel lie; of the widest channel.
int SpreadOf(const cv::Mat& samples) {
  std::array<std::array<int, 256>, 3> histograms{};
  for (int y = 0; y < samples.rows; ++y) {
    const auto* pixel = samples.ptr<cv::Vec3b>(y);
    for (int x = 0; x < samples.cols; ++x) {
      for (int c = 0; c < 3; ++c) ++histograms[static_cast<std::size_t>(c)][pixel[x][c]];
    }
  }
  const auto tail = static_cast<int>(samples.total() / 100);
  int spread = 0;
  for (const auto& histogram : histograms) {
    std::size_t low = 0;
    std::size_t high = 255;
    for (int seen = histogram[low]; seen <= tail && low < 255;) seen += histogram[++low];
    for (int seen = histogram[high]; seen <= tail && high > low;) seen += histogram[--high];
    spread = std::max(spread, static_cast<int>(high - low));
  }
  return spread;
}

/// Mean difference of two pictures' levels.
double MeanChange(const cv::Mat& a, const cv::Mat& b) {
  return cv::norm(a, b, cv::NORM_L1) / (3.0 * static_cast<double>(a.total()));
}

void Follow(double& usual, double now) { usual += kUsualRate * (now - usual); }

}  // namespace

void VisitOptions(DisturbanceOptions& o, OptionVisitor& v) {
  v.Flag({"disturbances", "",
          "watch for changes of the whole picture: light, freezing, black-out, "
          "moved camera"},
         o.enabled);
  v.Number({"light_share", "", "share of the picture whose levels a change of the light changes"},
           o.light_share, Range::AboveUpTo(0, 1));
  v.Number({"freeze_secs", "s", "frames that repeat for so long are a frozen camera; 0: never"},
           o.freeze_secs, Range::Between(0, 3600));
  v.Number({"uniform_levels", "levels", "a picture whose levels differ by less is black; 0: never"},
           o.uniform_levels, Range::Between(0, 255));
  v.Number({"moved_px", "px", "least shift of a moved camera's picture; 0: never"}, o.moved_px,
           Range::Between(0, 10000));
  v.Number({"restart_secs", "s",
            "most of the picture may be foreground for so long after a change "
            "of the light"},
           o.restart_secs, Range::AboveUpTo(0, 3600));
}

Result<DisturbanceDetector> DisturbanceDetector::Create(ImageSize size,
                                                        const DisturbanceOptions& options,
                                                        double frames_per_second) {
  VANTAGE_RETURN_IF_ERROR(ValidateOptions(options, "background"));
  if (size.width < 1 || size.height < 1) {
    return Fail("disturbances: frames of {}x{} px; each side must be at least 1 px", size.width,
                size.height);
  }
  if (!(frames_per_second > 0 && frames_per_second <= 10000)) {
    return Fail("disturbances: {} frames per second; must be above 0 and at most 10000",
                frames_per_second);
  }
  DisturbanceDetector detector;
  detector.size_ = size;
  detector.options_ = options;
  detector.frames_per_second_ = frames_per_second;
  const double step_px = std::sqrt(static_cast<double>(size.width) * size.height / kSamples);
  detector.step_px_ =
      std::clamp(static_cast<int>(std::lround(step_px)), 1, std::min(size.width, size.height));
  return detector;
}

std::int64_t DisturbanceDetector::FramesOf(double secs) const {
  return std::max<std::int64_t>(1, std::llround(secs * frames_per_second_));
}

DisturbanceEvent& DisturbanceDetector::Note(DisturbanceKind kind, std::int64_t gap) {
  for (DisturbanceEvent& event : report_.events) {
    if (event.kind != kind || frame_ > event.frame + event.frames + gap) continue;
    event.frames = frame_ - event.frame + 1;
    return event;
  }
  report_.events.push_back({.kind = kind, .frame = frame_});
  return report_.events.back();
}

Result<Disturbance> DisturbanceDetector::Look(const cv::Mat& bgr) {
  if (bgr.type() != CV_8UC3 || bgr.cols != size_.width || bgr.rows != size_.height) {
    return Fail(
        "disturbances: frame {} is {}x{} px of type {}; it must be {}x{} px of 8-bit BGR "
        "(CV_8UC3)",
        frame_ + 1, bgr.cols, bgr.rows, cv::typeToString(bgr.type()), size_.width, size_.height);
  }
  ++frame_;
  if (!options_.enabled) return Disturbance();
  const cv::Mat samples = SamplePixels(bgr, step_px_);
  const bool black = IsBlack(samples);
  const bool frozen = IsFrozen(bgr, samples) && !black;
  samples_ = samples;
  if (!black && !frozen) return Disturbance();
  ++report_.skipped;
  const DisturbanceKind kind = black ? DisturbanceKind::kBlack : DisturbanceKind::kFreeze;
  Note(kind, 1);
  return Disturbance{.action = DisturbanceAction::kSkip, .kind = kind, .gain = {}};
}

bool DisturbanceDetector::IsBlack(const cv::Mat& samples) {
  const int spread = SpreadOf(samples);
  // A camera that never sees more than a plain wall is not black.
  if (spread < options_.uniform_levels && usual_spread_ > 3.0 * options_.uniform_levels)
    return true;
  Follow(usual_spread_, spread);
  return false;
}

bool DisturbanceDetector::IsFrozen(const cv::Mat& bgr, const cv::Mat& samples) {
  if (samples_.empty()) return false;
  const double change = MeanChange(samples, samples_);
  if (usual_change_ > 0 && change > kJump * usual_change_) jumped_ = frame_;
  if (options_.freeze_secs <= 0 || change > kStill * usual_change_) {
    repeats_ = 0;
  } else if (repeats_ > 0 && cv::norm(bgr, repeated_, cv::NORM_INF) <= kStillest_levels) {
    ++repeats_;  // something small that moves may have slipped between the samples: none has
  } else {
    repeats_ = 1;
    repeated_ = bgr.clone();
  }
  if (repeats_ > 0 && repeats_ >= FramesOf(options_.freeze_secs)) return true;
  if (usual_change_ == 0) usual_change_ = change;
  if (change > 0) Follow(usual_change_, change);
  return false;
}

Result<Disturbance> DisturbanceDetector::Inspect(const cv::Mat& bgr, const cv::Mat& mask,
                                                 const BackgroundPicture& background) {
  const cv::Size size(size_.width, size_.height);
  if (bgr.type() != CV_8UC3 || bgr.size() != size || mask.type() != CV_8UC1 ||
      mask.size() != size) {
    return Fail(
        "disturbances: frame {} is {}x{} px of type {} and its mask {}x{} px of type {}; they must "
        "be {}x{} px of types CV_8UC3 and CV_8UC1",
        frame_, bgr.cols, bgr.rows, cv::typeToString(bgr.type()), mask.cols, mask.rows,
        cv::typeToString(mask.type()), size_.width, size_.height);
  }
  if (!options_.enabled) return Disturbance();
  const double share = static_cast<double>(cv::countNonZero(mask)) / size.area();
  const bool suspicious = share > usual_share_ + kSuspiciousShare;
  if (++learnt_ <= FramesOf(kLearning_secs)) {
    usual_share_ = share;
    foreground_ = SamplePixels(mask, step_px_);
    return Disturbance();
  }
  // Falls fast, so that what happens after a crowd has left stands out.
  usual_share_ += (share < usual_share_ ? kFallRate : kUsualRate) * (share - usual_share_);

  if (suspicious || frame_ < settled_) {
    VANTAGE_ASSIGN_OR_RETURN(cv::Mat gain, GainOfLight(mask, background));
    if (!gain.empty()) {
      flooded_ = share > kFlood ? flooded_ + 1 : 0;
      if (flooded_ >= FramesOf(options_.restart_secs)) return Restart(DisturbanceKind::kLost);
      return Disturbance{DisturbanceAction::kRelight, DisturbanceKind::kLight, std::move(gain)};
    }
  }
  flooded_ = share > kFlood ? flooded_ + 1 : 0;
  const double patience = frame_ < settled_ + FramesOf(options_.restart_secs) ? 1 : 5;
  if (flooded_ >= FramesOf(patience * options_.restart_secs)) {
    return Restart(DisturbanceKind::kLost);
  }
  if (!suspicious) foreground_ = SamplePixels(mask, step_px_);

  const bool jumped = frame_ < jumped_ + FramesOf(kJump_secs);
  if (suspicious || jumped || shift_px_) {
    VANTAGE_ASSIGN_OR_RETURN(const bool moved, IsMoved(bgr, background));
    if (moved) return Restart(DisturbanceKind::kMoved);
  }
  return Disturbance();
}

Result<cv::Mat> DisturbanceDetector::GainOfLight(const cv::Mat& mask,
                                                 const BackgroundPicture& background) {
  const bool settling = frame_ < settled_;
  if (!settling && frame_ < next_light_check_) return cv::Mat();
  const cv::Size size(size_.width, size_.height);
  VANTAGE_ASSIGN_OR_RETURN(const cv::Mat behind, SampleBackground(background, size, step_px_));
  if (behind.empty()) return cv::Mat();
  const LightChange change =
      EstimateLightChange(samples_, behind, SamplePixels(mask, step_px_), foreground_);
  const bool same_things = change.explained >= kExplained && change.structure >= kStructure;
  const bool sudden = change.changed >= options_.light_share && change.lit >= kLit;
  const double residue = std::abs(change.factor - 1);
  const bool residual =
      settling && (residue >= kResidue || (residue >= kResidue / 2 && change.lit >= kLitSettling));
  if (!same_things || !(sudden || residual)) {
    next_light_check_ = frame_ + kLightChecksApart;
    return cv::Mat();
  }
  const cv::Mat picture = background({0, 0, size_.width, size_.height});
  VANTAGE_RETURN_IF_ERROR(CheckBackgroundPicture("disturbances", picture, size));
  DisturbanceEvent& event = Note(DisturbanceKind::kLight, FramesOf(kSettling_secs));
  event.factor *= change.factor;
  if (sudden || residue >= kResidue) {
    settled_ = frame_ + FramesOf(kSettling_secs);
  }
  shift_px_.reset();
  ++report_.relit;
  return GainPicture(change, picture);
}

Result<bool> DisturbanceDetector::IsMoved(const cv::Mat& bgr, const BackgroundPicture& background) {
  if (options_.moved_px <= 0 || frame_ < next_shift_check_) return false;
  next_shift_check_ = frame_ + kShiftChecksApart;
  const cv::Mat picture = background({0, 0, size_.width, size_.height});
  if (picture.empty()) return false;
  VANTAGE_RETURN_IF_ERROR(CheckBackgroundPicture("disturbances", picture, bgr.size()));
  const std::optional<CameraShift> shift = EstimateCameraShift(bgr, picture, options_.moved_px);
  if (!shift) {
    shift_px_.reset();
    return false;
  }
  const double drift_px = shift_px_ ? cv::norm(shift->shift_px - *shift_px_) : 0;
  if (!shift_px_ || drift_px > std::max(1.0, kSameShift * shift->length_px)) {
    shift_px_ = shift->shift_px;
    shifted_since_ = frame_;
    return false;
  }
  // A camera that shakes comes back; one that still turns has another shift at each check.
  if (frame_ < shifted_since_ + FramesOf(kMoved_secs)) return false;
  Note(DisturbanceKind::kMoved, 0).length_px = shift->length_px;
  return true;
}

Disturbance DisturbanceDetector::Restart(DisturbanceKind kind) {
  if (kind == DisturbanceKind::kLost) Note(kind, 0);
  ++report_.restarts;
  learnt_ = 0;
  flooded_ = 0;
  settled_ = frame_;
  shift_px_.reset();
  jumped_ = -FramesOf(kJump_secs);
  return {DisturbanceAction::kRestart, kind, {}};
}

}  // namespace vantage
