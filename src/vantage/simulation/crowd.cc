// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <numbers>

#include "vantage/simulation/crowd_people.h"
#include "vantage/simulation/crowd_world.h"
#include "vantage/simulation/preset_cameras.h"
#include "vantage/simulation/things.h"

namespace vantage::simulation {
namespace {

using Eigen::Vector2d;

constexpr double kFramesPerSecond = 10;
constexpr FrameIndex kFrames = 400;
constexpr double kPictureScale = 0.5;  // of the recording's 1920 x 1080
/// The area that WILDTRACK annotates.
const Vector2d kAreaMin = {-3, -9};
const Vector2d kAreaMax = {9, 27};
/// Who is not annotated for longer has gone away.
constexpr double kMaxGapSecs = 2.05;
/// Nobody runs faster: there the annotation took one person for another.
constexpr double kFastest = 7;  // m/s
constexpr int kFirstRestId = 10001;

/// Parts in which nobody leaps.
std::vector<std::vector<Waypoint>> WithoutLeaps(const std::vector<Waypoint>& known) {
  std::vector<std::vector<Waypoint>> parts;
  for (const Waypoint& waypoint : known) {
    if (parts.empty() || (waypoint.ground_m - parts.back().back().ground_m).norm() >
                             kFastest * (waypoint.seconds - parts.back().back().seconds)) {
      parts.emplace_back();
    }
    parts.back().push_back(waypoint);
  }
  return parts;
}

/// The annotated people, each from door to door. What follows a leap is somebody else with an id
/// of their own.
Result<std::vector<NumberedWalk>> RealPeople(const std::filesystem::path& folder,
                                             FrameIndex frames) {
  VANTAGE_ASSIGN_OR_RETURN(const auto ways, ReadCrowdPeople(folder));
  std::vector<NumberedWalk> people;
  int rest_id = kFirstRestId;
  for (const auto& [id, known] : ways) {
    bool whole = true;
    for (const std::vector<Waypoint>& part : WithoutLeaps(known)) {
      const int part_id = whole ? id : rest_id++;
      whole = false;
      Walk walk =
          WalkThrough(ThroughGates(part, SquareGates(), kMaxGapSecs), kFramesPerSecond, frames);
      if (!walk.ground_m.empty()) people.push_back({part_id, std::move(walk)});
    }
  }
  return people;
}

Vector2d PlaceInArea(Dice& dice) {
  constexpr double kMargin = 0.8;
  const double x = dice.Uniform(kAreaMin.x() + kMargin, kAreaMax.x() - kMargin);
  return {x, dice.Uniform(kAreaMin.y() + kMargin, kAreaMax.y() - kMargin)};
}

/// Groups that stand and talk all the time, and passers-by, alone or together, from door to door.
std::vector<Pedestrian> InventPeople(double seconds, Dice& dice) {
  const std::vector<Gate> gates = SquareGates();
  const auto any_gate = [&]() -> const Gate& {
    return gates[static_cast<std::size_t>(dice.Below(static_cast<int>(gates.size())))];
  };
  std::vector<Pedestrian> people;
  const auto add_group = [&](int members, double enters, const std::vector<Stop>& common,
                             double apart_m) {
    const double speed = dice.Uniform(1.1, 1.6);
    const double turn = dice.Uniform(0, 2 * std::numbers::pi);
    for (int member = 0; member < members; ++member) {
      const double angle = turn + 2 * std::numbers::pi * member / members;
      Pedestrian who{
          .enters_secs = enters, .speed_m_s = speed * dice.Uniform(0.97, 1.03), .stops = common};
      if (members > 1) {
        for (Stop& stop : who.stops) {
          stop.ground_m += apart_m * Vector2d(std::cos(angle), std::sin(angle));
        }
      }
      people.push_back(who);
    }
  };
  const int standing = 4;
  for (int group = 0; group < standing; ++group) {
    const Gate& gate = any_gate();
    const Vector2d place = PlaceInArea(dice);
    std::vector<Stop> stops = {{place}, {place, dice.Uniform(40, 200), place}};
    for (auto step = gate.rbegin(); step != gate.rend(); ++step) stops.push_back({*step});
    add_group(2 + dice.Below(3), -20, stops, 0.55);
  }
  for (double enters = -45; enters < seconds; enters += dice.Uniform(1.5, 3.2)) {
    const Gate& from = any_gate();
    const Gate& to = any_gate();
    std::vector<Stop> stops;
    for (const Vector2d& place : from) stops.push_back({place});
    stops.push_back({PlaceInArea(dice)});
    if (dice.Chance(0.5)) {
      const Vector2d place = PlaceInArea(dice);
      stops.push_back({place, dice.Chance(0.3) ? dice.Uniform(3, 12) : 0.0, place});
    }
    for (auto step = to.rbegin(); step != to.rend(); ++step) stops.push_back({*step});
    add_group(dice.Chance(0.65) ? 1 : 2, enters, stops, 0.4);
  }
  return people;
}

}  // namespace

Result<Stage> MakeCrowd(const PresetOptions& options) {
  Stage stage;
  stage.name = "crowd";
  stage.frames_per_second = kFramesPerSecond;
  stage.frames = options.frames.value_or(kFrames);
  stage.cell_m = 0.25;  // people stand close
  VANTAGE_ASSIGN_OR_RETURN(stage.area, Polygon::Rectangle(kAreaMin, kAreaMax));
  PresetOptions reduced = options;
  reduced.scale *= kPictureScale;
  VANTAGE_ASSIGN_OR_RETURN(stage.cameras, SetUpCameras("crowd", CrowdCameras(), reduced, 1.15));
  Dice dice(options.seed);
  Rehearsal rehearsal;
  rehearsal.frames_per_second = kFramesPerSecond;
  const double seconds = static_cast<double>(stage.frames) / kFramesPerSecond;
  BuildSquare(stage, rehearsal, seconds, dice);
  std::vector<NumberedWalk> people;
  if (options.people.empty()) {
    for (Walk& walk :
         Stroll(InventPeople(seconds, dice), SquarePillars(), kFramesPerSecond, stage.frames)) {
      if (walk.ground_m.empty()) continue;  // gone before the film begins
      people.push_back({static_cast<int>(people.size()) + 1, std::move(walk)});
    }
  } else {
    VANTAGE_ASSIGN_OR_RETURN(people, RealPeople(options.people, stage.frames));
  }
  AddWalkers(stage, rehearsal, people, dice);
  stage.script = MakePlay(std::move(rehearsal));
  return stage;
}

}  // namespace vantage::simulation
