// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <numbers>

#include "vantage/simulation/campus_world.h"
#include "vantage/simulation/preset_cameras.h"
#include "vantage/simulation/things.h"
#include "vantage/tracks/track_file.h"

namespace vantage::simulation {
namespace {

using Eigen::Vector2d;

constexpr double kFramesPerSecond = 7;
constexpr FrameIndex kFrames = 795;
/// The part of the scene in which trackers are usually compared.
const Vector2d kAreaMin = {-14.0696, -14.274};
const Vector2d kAreaMax = {4.9813, 1.7335};
/// Longer holes in somebody's real track are filled by going away and coming back.
constexpr double kMaxGapSecs = 3;

/// The people of a truth file, each from gate to gate.
Result<std::vector<NumberedWalk>> RealPeople(const std::filesystem::path& path, FrameIndex frames) {
  VANTAGE_ASSIGN_OR_RETURN(const Tracks tracks, ReadTracks(path));
  std::vector<NumberedWalk> people;
  for (const Track& track : tracks) {
    const auto id = static_cast<std::int64_t>(track.id);
    if (id < 1 || id >= kFirstThingId) {
      return Fail("{}: id {} of a person; ids must be 1 to {}", path.string(), id,
                  kFirstThingId - 1);
    }
    std::vector<Waypoint> known;
    for (const TrackPoint& point : track.points) {
      // A mistake in units or columns would put everybody where no camera looks.
      if (std::abs(point.x_m) > 1000 || std::abs(point.y_m) > 1000) {
        return Fail(
            "{}: person {} is at ({}, {}) m in frame {}; ground positions within 1000 m "
            "of the origin are needed (columns 8 and 9 of a MOTChallenge file)",
            path.string(), id, point.x_m, point.y_m, point.frame);
      }
      known.push_back(
          {static_cast<double>(point.frame) / kFramesPerSecond, {point.x_m, point.y_m}});
    }
    people.push_back(
        {static_cast<int>(id),
         WalkThrough(ThroughGates(known, CampusGates(), kMaxGapSecs), kFramesPerSecond, frames)});
  }
  return people;
}

/// A place in the area that is not at a pillar.
Vector2d PlaceInArea(const std::vector<Pillar>& pillars, Dice& dice) {
  constexpr double kMargin = 1.5;
  for (;;) {
    const Vector2d place = {dice.Uniform(kAreaMin.x() + kMargin, kAreaMax.x() - kMargin),
                            dice.Uniform(kAreaMin.y() + kMargin, kAreaMax.y() - kMargin)};
    const bool free = std::none_of(pillars.begin(), pillars.end(), [&](const Pillar& pillar) {
      return (pillar.center_m - place).norm() < pillar.radius_m + 1.2;
    });
    if (free) return place;
  }
}

/// People alone and in groups who cross the area, some of whom stop and talk: about as many at a
/// time, and about as long, as in the recording.
std::vector<NumberedWalk> InventedPeople(FrameIndex frames, Dice& dice) {
  const std::vector<Gate> gates = CampusGates();
  const std::vector<Pillar> pillars = CampusPillars();
  const double seconds = static_cast<double>(frames) / kFramesPerSecond;
  std::vector<Pedestrian> people;
  double enters = -75;
  while (enters < seconds) {
    const double draw = dice.Uniform(0, 1);
    const int members = draw < 0.45 ? 1 : (draw < 0.8 ? 2 : 3);
    const auto& from = gates[static_cast<std::size_t>(dice.Below(static_cast<int>(gates.size())))];
    const auto& to = gates[static_cast<std::size_t>(dice.Below(static_cast<int>(gates.size())))];
    std::vector<Stop> common;
    for (const Vector2d& place : from) common.push_back({place});
    const int errands = 3 + dice.Below(3);
    for (int errand = 0; errand < errands; ++errand) {
      const double stay = dice.Chance(0.45) ? dice.Uniform(6, 20) : 0;
      const Vector2d place = PlaceInArea(pillars, dice);
      // Who is alone looks about, a group looks at its middle.
      const Vector2d aside = {dice.Uniform(-5, 5), dice.Uniform(-5, 5)};
      common.push_back({place, stay, members == 1 ? Vector2d(place + aside) : place});
    }
    for (auto place = to.rbegin(); place != to.rend(); ++place) common.push_back({*place});
    const double speed = dice.Uniform(1.0, 1.6);
    const double turn = dice.Uniform(0, 2 * std::numbers::pi);
    for (int member = 0; member < members; ++member) {
      const double angle = turn + 2 * std::numbers::pi * member / members;
      const Vector2d offset =
          members == 1 ? Vector2d(0, 0) : Vector2d(0.5 * std::cos(angle), 0.5 * std::sin(angle));
      Pedestrian who{
          .enters_secs = enters, .speed_m_s = speed * dice.Uniform(0.97, 1.03), .stops = common};
      for (Stop& stop : who.stops) stop.ground_m += offset;
      people.push_back(who);
    }
    enters += members * dice.Uniform(6.5, 8.5);  // the larger the group, the longer until the next
  }
  std::vector<NumberedWalk> walkers;
  for (Walk& walk : Stroll(people, pillars, kFramesPerSecond, frames)) {
    if (walk.ground_m.empty()) continue;  // gone before the film begins
    walkers.push_back({static_cast<int>(walkers.size()) + 1, std::move(walk)});
  }
  return walkers;
}

}  // namespace

Result<Stage> MakeCampus(const PresetOptions& options) {
  Stage stage;
  stage.name = "campus";
  stage.frames_per_second = kFramesPerSecond;
  stage.frames = options.frames.value_or(kFrames);
  VANTAGE_ASSIGN_OR_RETURN(stage.area, Polygon::Rectangle(kAreaMin, kAreaMax));
  VANTAGE_ASSIGN_OR_RETURN(stage.cameras, SetUpCameras("campus", CampusCameras(), options, 1.5));
  Dice dice(options.seed);
  Rehearsal rehearsal;
  rehearsal.frames_per_second = kFramesPerSecond;
  BuildCampus(stage, rehearsal, static_cast<double>(stage.frames) / kFramesPerSecond, dice);
  std::vector<NumberedWalk> people;
  if (options.people.empty()) {
    people = InventedPeople(stage.frames, dice);
  } else {
    VANTAGE_ASSIGN_OR_RETURN(people, RealPeople(options.people, stage.frames));
  }
  AddWalkers(stage, rehearsal, people, dice);
  stage.script = MakePlay(std::move(rehearsal));
  return stage;
}

}  // namespace vantage::simulation
