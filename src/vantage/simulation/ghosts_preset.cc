// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <numbers>

#include "vantage/simulation/ghosts_world.h"
#include "vantage/simulation/preset_cameras.h"
#include "vantage/simulation/things.h"
#include "vantage/simulation/walkers.h"
#include "vantage/simulation/wardrobe.h"

namespace vantage::simulation {
namespace {

using Eigen::Vector2d;

constexpr double kFramesPerSecond = 25;
constexpr FrameIndex kFrames = 1200;
constexpr double kForever = 1e6;

/// Where somebody is at this time and how; in between they walk, sit down, bend.
struct Cue {
  double secs = 0;
  Vector2d place_m = {0, 0};
  double facing_deg = -90;  ///< while they stand; -90 is towards the camera
  double sit = 0;
  double bend = 0;
};

struct Part {
  std::string_view plot;
  std::vector<Cue> cues;  ///< not there before the first one and after the last one
};

/// The persons of the play, ids from 1. The door is at (-2.4, 12.5); the picture's sides are at
/// about x = -+6.5 where y is 5.
const std::vector<Part>& Parts() {
  static const std::vector<Part> parts = {
      {"stands there from the start, leaves (a ghost stays), comes back later and stays",
       {{0, {0.5, 5.5}, -60},
        {10, {0.5, 5.5}, -60},
        {11.6, {-0.9, 3.9}},
        {18.5, {-11.5, 3.2}},
        {29, {-11.5, 3.2}},
        {37, {-0.2, 5.0}},
        {38, {0.3, 5.3}, -120},
        {kForever, {0.3, 5.3}, -120}}},
      {"sits on the bench from the start, gets up and goes in",
       {{0, kBenchLeft, -90, 1},
        {14, kBenchLeft, -90, 1},
        {15.8, {-6.45, 8.15}, -90, 0},
        {20, {-2.4, 11.0}},
        {21.5, {-2.4, 13.3}}}},
      {"comes, stands still for twenty seconds, leaves",
       {{2, {12.5, 1.4}},
        {8.6, {3.6, 3.3}},
        {9.2, {3.2, 3.4}, -110},
        {29.2, {3.2, 3.4}, -110},
        {30.2, {4.0, 3.0}},
        {37, {13, 1.0}}}},
      {"comes, sits down on the bench and stays",
       {{20.5, {-12, 5.6}},
        {26, {-5.7, 7.6}},
        {27, {-5.55, 8.2}, -90},
        {28, {-5.55, 8.25}, -90},
        {30, kBenchRight, -90, 1},
        {kForever, kBenchRight, -90, 1}}},
      {"comes out with a bag, puts it down, leaves without it",
       {{4, {-2.4, 13.3}},
        {5.5, {-2.4, 11.0}},
        {8.6, {-1.3, 7.9}, -80},
        {9.2, {-1.3, 7.9}, -80},
        {10.2, {-1.3, 7.9}, -80, 0, 1},
        {11.2, {-1.3, 7.9}, -80},
        {13, {-3, 6.8}},
        {20, {-12, 6.3}}}},
      {"fetches the bag that lay there from the start",
       {{14.5, {13, 10.4}},
        {22, {2.6, 9.4}, 180},
        {22.4, {2.4, 9.4}, 180},
        {23.4, {2.4, 9.4}, 180, 0, 1},
        {24.4, {2.4, 9.4}, 180},
        {28.5, {-2.3, 10.7}},
        {30.2, {-2.4, 13.3}}}},
      {"creeps across the ghost that the first one has left",
       {{1, {-2.6, -6.5}},
        {9, {-1.7, 5.0}},
        {10, {-1.4, 5.3}, 0},
        {24, {1.5, 5.2}, 0},
        {26, {2.9, 4.3}},
        {33.5, {13, 3.6}}}},
      {"walks behind the young tree and stands behind the sign",
       {{24.5, {-10.5, 2.3}},
        {30, {-3.1, 2.7}},
        {31, {-2.7, 2.8}, -90},
        {33.5, {-2.6, 2.8}, -90},
        {37.4, {2.4, 3.1}},
        {38, {2.55, 3.1}, -90},
        {45, {2.55, 3.1}, -90},
        {48, {6.5, 2.8}},
        {53, {13, 2.5}}}},
      {"runs past in front when the lamp has been switched on",
       {{41.2, {-11, 1.4}}, {46.6, {11, 0.6}}}},
  };
  return parts;
}

/// A bag is with this person from one time to another; before and after it lies where they bend.
struct Carriage {
  int person = 0;
  double from_secs = 0;
  double to_secs = 0;
};
constexpr Carriage kCarriages[] = {
    {5, 4, 10.2},         // brought
    {6, 23.4, kForever},  // taken away
};

constexpr double kCarLeavesSecs = 20;
const Eigen::Vector3f kCarPlace = {4.4F, 6.4F, 0.003F};

double SmoothStep(double t) {
  const double clamped = std::clamp(t, 0.0, 1.0);
  return clamped * clamped * (3 - 2 * clamped);
}

Actor Rehearse(const Part& part, int id, const Figure& figure, FrameIndex frames) {
  std::vector<Waypoint> waypoints;
  for (const Cue& cue : part.cues) waypoints.push_back({cue.secs, cue.place_m});
  Walk walk = WalkThrough(waypoints, kFramesPerSecond, frames);
  const auto cue_after = [&](std::size_t i) {
    const double secs =
        static_cast<double>(walk.first + static_cast<FrameIndex>(i)) / kFramesPerSecond;
    std::size_t after = 1;
    while (after + 1 < part.cues.size() && part.cues[after].secs <= secs) ++after;
    const Cue& before = part.cues[after - 1];
    const double share = SmoothStep((secs - before.secs) / (part.cues[after].secs - before.secs));
    return std::pair(after, share);
  };
  for (std::size_t i = 0; i < walk.ground_m.size(); ++i) {
    const double facing_rad = part.cues[cue_after(i).first].facing_deg * std::numbers::pi / 180;
    walk.look_at_m.emplace_back(walk.ground_m[i] +
                                Vector2d(std::cos(facing_rad), std::sin(facing_rad)));
  }
  Actor actor{id, figure, walk.first, Postures(walk, kFramesPerSecond, figure.height_m)};
  for (std::size_t i = 0; i < actor.postures.size(); ++i) {
    const auto [after, share] = cue_after(i);
    Posture& posture = actor.postures[i];
    posture.sit = std::lerp(part.cues[after - 1].sit, part.cues[after].sit, share);
    posture.bend = std::lerp(part.cues[after - 1].bend, part.cues[after].bend, share);
    posture.arm_reach = posture.bend;
  }
  return actor;
}

/// A bag in somebody's hand: beside them, or before their feet when they bend.
Placement InHand(const Posture& posture) {
  const double forward = std::lerp(0.05, 0.5, posture.bend);
  const double aside = std::lerp(-0.36, 0.0, posture.bend);
  const double c = std::cos(posture.heading_rad);
  const double s = std::sin(posture.heading_rad);
  return {Eigen::Vector3d(posture.ground_m.x() + c * forward - s * aside,
                          posture.ground_m.y() + s * forward + c * aside,
                          std::lerp(0.34, 0.0, posture.bend))
              .cast<float>(),
          static_cast<float>(posture.heading_rad)};
}

std::vector<Placement> Carry(const Carriage& carriage, const Actor& actor, FrameIndex frames) {
  const auto first = static_cast<FrameIndex>(std::lround(carriage.from_secs * kFramesPerSecond));
  const auto last = static_cast<FrameIndex>(std::lround(carriage.to_secs * kFramesPerSecond));
  std::vector<Placement> placements;
  for (FrameIndex frame = 0; frame < frames; ++frame) {
    const FrameIndex index = std::clamp(std::clamp(frame, first, last) - actor.first, FrameIndex{0},
                                        static_cast<FrameIndex>(actor.postures.size()) - 1);
    placements.push_back(InHand(actor.postures[static_cast<std::size_t>(index)]));
  }
  return placements;
}

std::vector<Placement> DriveOff(FrameIndex frames) {
  constexpr double kAcceleration = 1.3;  // m/s^2
  constexpr double kDriven = 60;         // m, far out of the picture
  std::vector<Placement> placements;
  for (FrameIndex frame = 0; frame < frames; ++frame) {
    const double secs =
        std::max(static_cast<double>(frame) / kFramesPerSecond - kCarLeavesSecs, 0.0);
    const auto way = static_cast<float>(std::min(0.5 * kAcceleration * secs * secs, kDriven));
    placements.push_back({kCarPlace + Eigen::Vector3f(way, 0, 0), 0});
  }
  return placements;
}

Camera ForecourtCamera() {
  // Four and a half metres up, ten before the middle, 12 degrees down.
  const double down = 12 * std::numbers::pi / 180;
  CameraPose pose;
  pose.rotation << 1, 0, 0,                 //
      0, -std::sin(down), -std::cos(down),  //
      0, std::cos(down), -std::sin(down);
  pose.translation_m = -pose.rotation * Eigen::Vector3d(0, -10, 4.6);
  const PinholeModel lens{
      .fx_px = 760, .fy_px = 760, .cx_px = 319.5, .cy_px = 239.5, .distortion = {-0.12, 0.02}};
  return Camera::Create({640, 480}, lens, pose).value();
}

}  // namespace

Result<Stage> MakeGhosts(const PresetOptions& options) {
  if (!options.people.empty()) {
    return Fail("people is {}; ghosts has a play of its own: leave people out",
                options.people.string());
  }
  Stage stage;
  stage.name = "ghosts";
  stage.frames_per_second = kFramesPerSecond;
  stage.frames = options.frames.value_or(kFrames);
  VANTAGE_ASSIGN_OR_RETURN(stage.area, Polygon::Rectangle({-8, 0}, {8, 12}));
  VANTAGE_ASSIGN_OR_RETURN(stage.cameras,
                           SetUpCameras("ghosts", {{"camera1", ForecourtCamera()}}, options, 1.35));
  Dice dice(options.seed);
  Rehearsal rehearsal;
  rehearsal.frames_per_second = kFramesPerSecond;
  BuildForecourt(stage, rehearsal, dice);
  // The play knows its own length: a bag is taken up although the film ends before.
  const FrameIndex rehearsed = std::max(stage.frames, kFrames);
  for (const Part& part : Parts()) {
    const int id = static_cast<int>(rehearsal.actors.size()) + 1;
    rehearsal.actors.push_back(Rehearse(part, id, DressUp(stage.materials, dice), rehearsed));
  }
  int thing = kFirstThingId + 100;
  for (const Carriage& carriage : kCarriages) {
    const Actor& actor = rehearsal.actors[static_cast<std::size_t>(carriage.person - 1)];
    rehearsal.props.push_back({thing++, BagShape(stage, dice), Carry(carriage, actor, rehearsed)});
  }
  rehearsal.props.push_back({thing, GhostCarShape(stage), DriveOff(rehearsed)});
  stage.script = MakePlay(std::move(rehearsal));
  return stage;
}

}  // namespace vantage::simulation
