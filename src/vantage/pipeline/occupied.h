// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <span>
#include <vector>

#include "vantage/background/ghosts.h"
#include "vantage/base/ids.h"
#include "vantage/base/options.h"
#include "vantage/base/result.h"
#include "vantage/geometry/camera.h"
#include "vantage/geometry/person.h"
#include "vantage/tracks/track.h"

namespace vantage {

/// Options of keeping people who stand in the foreground (table [hold]).
struct HoldOptions {
  /// People who stand are kept from fading into the background.
  bool standing = true;
  /// Tracks are looked for in this last stretch, 0.1 <= window_secs <= 10.
  double window_secs = 2;
  /// Somebody is believed who is seen in at least this share of its frames,
  /// 0 < presence <= 1,
  double presence = 0.75;
  /// and stands who is slower than this on average, m/s, > 0. Who walks needs no holding.
  double max_speed = 0.5;
  /// The rectangle of a person is grown on each side by this share of its height,
  /// 0 <= margin <= 1: arms, and a position that is off by a little.
  double margin = 0.1;
  /// The way out when the tracker is wrong: nobody is held at one place for longer,
  /// 0 < limit_secs <= 86400,
  double limit_secs = 120;
  /// and no pixel that ghost detection found in a ghost this many times in a row,
  /// 1 <= ghost_verdicts <= 255. A little less than twice its own agree_frames: what it would
  /// absorb twice is absorbed the second time.
  int ghost_verdicts = 5;
};
void VisitOptions(HoldOptions& options, OptionVisitor& visitor);

/// What was held.
struct HoldReport {
  std::int64_t places = 0;            ///< at which somebody stood
  std::int64_t pictures = 0;          ///< of all cameras together, in which something was held
  std::int64_t released_by_time = 0;  ///< places
  std::int64_t released_as_ghosts_px = 0;
};

/// The pixels that each camera holds for the sake of people who stand: from the tracker's own
/// output, and only from frames before the one that they are for.
///
/// A *place* is where a believed track stands, up to a metre around its first position. It is held,
/// as the rectangles of a person there in all views, while a track stands there. It is released
/// when none does any more (they went, or the evidence of the masks fell), and when it was first
/// held limit_secs ago; then it stays released until no track has stood there for a whole window,
/// so that the same mistake does not begin again.
///
/// A pixel inside is released when `ghost_verdicts` verdicts of its camera in a row found it in a
/// ghost: in a piece of foreground that has no edges of its own. A verdict for an object starts the
/// count anew; frames in which its piece is not judged do not count. It is held again when a
/// verdict is for an object, and when it has become background.
///
/// What is released fades or is absorbed as usual.
class OccupiedRegions {
 public:
  /// Frames between two calls of Name: fading takes hundreds, so this lag costs nothing.
  static constexpr std::int64_t kFramesBetween = 8;

  /// Each camera is of its masks' size.
  static Result<OccupiedRegions> Create(std::vector<Camera> cameras, const PersonOptions& person,
                                        const HoldOptions& options, double frames_per_second);

  /// Length of the window, at least 1.
  std::int64_t window_frames() const { return window_frames_; }

  /// One for each camera: CV_8UC1, 255 held, else 0; an empty one holds nothing.
  std::span<const cv::Mat> held() const { return held_; }

  /// What a camera found in a frame to which held() was applied: its mask, of the camera's size,
  /// and the verdict on ghosts in it. Different cameras may be judged at the same time, Name not
  /// meanwhile.
  void Judge(std::size_t camera, const cv::Mat& mask, const GhostVerdict& verdict);

  /// `tracks` of the window that ends before frame `next`; held() is for that frame and those that
  /// follow, until the next call.
  void Name(const Tracks& tracks, FrameIndex next);

  HoldReport report() const;

 private:
  struct Place {
    Eigen::Vector2d first_m;  ///< position when it was first named
    FrameIndex since = 0;     ///< first frame for which it was named
    FrameIndex last = 0;      ///< the last call that named it
    bool expired = false;
    /// Of the person in each camera, margin included; empty where not seen.
    std::vector<cv::Rect> rectangles;
  };

  OccupiedRegions(std::vector<Camera> cameras, const PersonOptions& person,
                  const HoldOptions& options, double frames_per_second);
  Place& PlaceAt(const Eigen::Vector2d& position_m, FrameIndex next);
  void Draw(std::size_t camera, FrameIndex next);

  std::vector<Camera> cameras_;
  PersonOptions person_;
  HoldOptions options_;
  std::int64_t window_frames_ = 0;
  double speed_per_frame_m_ = 0;
  double limit_frames_ = 0;
  std::vector<Place> places_;
  std::vector<cv::Mat> held_;
  /// For each camera that holds something, CV_8UC1: verdicts in a row that found the pixel in a
  /// ghost.
  std::vector<cv::Mat> ghosts_;
  // Of the report, for each camera.
  std::vector<std::int64_t> pictures_;
  std::vector<std::int64_t> released_px_;
  HoldReport report_;  ///< places only
};

}  // namespace vantage
