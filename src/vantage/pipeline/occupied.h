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
  /// Tracks are looked for in this last stretch, 0.1 <= window_secs <= 60.
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
  /// nor in a camera whose ghost detection judged what is seen there a ghost this many times in a
  /// row, >= 1.
  int ghost_verdicts = 15;
};
void VisitOptions(HoldOptions& options, OptionVisitor& visitor);

/// What was held.
struct HoldReport {
  std::int64_t places = 0;    ///< at which somebody stood
  std::int64_t pictures = 0;  ///< of all cameras together, in which something was held
  std::int64_t released_by_time = 0;
  std::int64_t released_as_ghosts = 0;  ///< counted for each camera
};

/// The pixels that each camera holds for the sake of people who stand: from the tracker's own
/// output, and only from frames before the one that they are for.
///
/// A *place* is where a believed track stands, up to a metre around its first position. It is held,
/// as the rectangles of a person there in all views, while a track stands there. It is released
///  - at once when no track stands there any more: the evidence of the masks fell, or they went;
///  - in all cameras when it was first held limit_secs ago;
///  - in one camera when `ghost_verdicts` verdicts in a row say that most of the foreground in its
///    rectangle is a ghost there (no edges of its own). A verdict for an object starts the count
///    anew; frames in which most of it is not judged do not count.
/// A released place stays so until no track has stood there for a whole window, so that the same
/// mistake does not begin again; what is not held fades or is absorbed as usual.
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
  /// and the verdict on ghosts in it.
  void Judge(std::size_t camera, const cv::Mat& mask, const GhostVerdict& verdict);

  /// `tracks` of the window that ends before frame `next`; held() is for that frame and those that
  /// follow, until the next call.
  void Name(const Tracks& tracks, FrameIndex next);

  const HoldReport& report() const { return report_; }

 private:
  /// A place in one camera.
  struct View {
    cv::Rect rectangle;  ///< of the person, margin included; empty where not seen
    int ghosts = 0;      ///< verdicts in a row
    bool released = false;
  };
  struct Place {
    Eigen::Vector2d first_m;  ///< position when it was first named
    FrameIndex since = 0;     ///< first frame for which it was named
    FrameIndex last = 0;      ///< the last call that named it
    bool expired = false;
    std::vector<View> views;  ///< by camera
  };

  OccupiedRegions(std::vector<Camera> cameras, const PersonOptions& person,
                  const HoldOptions& options, double frames_per_second);
  Place& PlaceAt(const Eigen::Vector2d& position_m, FrameIndex next);
  bool IsHeld(const Place& place, const View& view) const;
  void Draw(std::size_t camera);

  std::vector<Camera> cameras_;
  PersonOptions person_;
  HoldOptions options_;
  std::int64_t window_frames_ = 0;
  double speed_per_frame_m_ = 0;
  double limit_frames_ = 0;
  FrameIndex named_ = 0;  ///< `next` of the last call of Name
  std::vector<Place> places_;
  std::vector<cv::Mat> held_;
  HoldReport report_;
};

}  // namespace vantage
