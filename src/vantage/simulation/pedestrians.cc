// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/simulation/pedestrians.h"

#include <algorithm>
#include <cmath>

namespace vantage::simulation {
namespace {

using Eigen::Vector2d;

constexpr double kRelaxationSecs = 0.5;
constexpr double kRepulsion = 4.0;        // m/s^2 when two just touch
constexpr double kRepulsionRange = 0.3;   // m
constexpr double kBodyRadius = 0.3;       // m
constexpr double kSidestep = 0.4;         // of the repulsion, to one's right
constexpr double kPassingDistance = 0.8;  // m: this near to a stop one goes on to the next
constexpr double kMaxAcceleration = 8;    // m/s^2
constexpr double kStepSecs = 0.05;        // at most

/// One of them during the simulation.
struct Mover {
  bool present = false;
  bool gone = false;
  std::size_t stop = 1;  // the next one
  double stayed_secs = 0;
  Vector2d place = {0, 0};
  Vector2d velocity = {0, 0};
  Vector2d force = {0, 0};
};

bool Stays(const Pedestrian& who, const Mover& mover) {
  return mover.stayed_secs > 0 && !mover.gone && who.stops[mover.stop].stay_secs > 0;
}

/// The velocity wished for: towards the next stop, slowing down where they will stay.
Vector2d WishedVelocity(const Pedestrian& who, const Mover& mover) {
  const Stop& stop = who.stops[mover.stop];
  const Vector2d way = stop.ground_m - mover.place;
  const double distance = way.norm();
  if (distance < 1e-6) return {0, 0};
  const double speed =
      stop.stay_secs > 0 ? std::min(who.speed_m_s, distance / kRelaxationSecs) : who.speed_m_s;
  return speed / distance * way;
}

/// Pushes away from something round, the more the nearer, and to one's right, so that two who meet
/// head-on do not stop.
Vector2d Repulsion(const Vector2d& place, const Vector2d& other, double radii) {
  const Vector2d apart = place - other;
  const double distance = std::max(apart.norm(), 1e-3);
  if (distance > radii + 5 * kRepulsionRange) return {0, 0};
  const Vector2d away = apart / distance;
  const double strength = kRepulsion * std::exp((radii - distance) / kRepulsionRange);
  return strength * (away + kSidestep * Vector2d(away.y(), -away.x()));
}

void Advance(const Pedestrian& who, Mover& mover, double secs) {
  Vector2d acceleration = mover.force;
  if (acceleration.norm() > kMaxAcceleration)
    acceleration *= kMaxAcceleration / acceleration.norm();
  mover.velocity += secs * acceleration;
  const double fastest = 1.3 * who.speed_m_s;
  if (mover.velocity.norm() > fastest) mover.velocity *= fastest / mover.velocity.norm();
  mover.place += secs * mover.velocity;
  const Stop& stop = who.stops[mover.stop];
  const bool last = mover.stop + 1 == who.stops.size();
  const double distance = (stop.ground_m - mover.place).norm();
  if (stop.stay_secs > 0 && !last) {
    if (distance < 0.5 || mover.stayed_secs > 0) mover.stayed_secs += secs;
    if (mover.stayed_secs < stop.stay_secs) return;
  } else if (distance > kPassingDistance) {
    return;
  }
  mover.stayed_secs = 0;
  if (last) {
    mover.gone = true;
  } else {
    ++mover.stop;
  }
}

}  // namespace

std::vector<Walk> Stroll(const std::vector<Pedestrian>& people, const std::vector<Pillar>& pillars,
                         double frames_per_second, FrameIndex frames) {
  std::vector<Walk> walks(people.size());
  std::vector<Mover> movers(people.size());
  const auto steps_a_frame =
      static_cast<int>(std::ceil(1 / (frames_per_second * kStepSecs) - 1e-9));
  const double step_secs = 1 / (frames_per_second * steps_a_frame);
  double earliest = 0;
  for (const Pedestrian& who : people) earliest = std::min(earliest, who.enters_secs);
  const auto first = static_cast<FrameIndex>(std::floor(earliest * frames_per_second));
  for (FrameIndex frame = first; frame < frames; ++frame) {
    for (std::size_t i = 0; i < people.size(); ++i) {
      Mover& mover = movers[i];
      if (!mover.present && !mover.gone &&
          people[i].enters_secs * frames_per_second <= static_cast<double>(frame)) {
        mover.present = true;
        mover.place = people[i].stops.front().ground_m;
      }
      if (mover.gone) mover.present = false;
      if (!mover.present || frame < 0) continue;
      if (walks[i].ground_m.empty()) walks[i].first = frame;
      walks[i].ground_m.push_back(mover.place);
      walks[i].look_at_m.push_back(Stays(people[i], mover) ? people[i].stops[mover.stop].look_at_m
                                                           : std::nullopt);
    }
    for (int step = 0; step < steps_a_frame; ++step) {
      for (std::size_t i = 0; i < people.size(); ++i) {
        Mover& mover = movers[i];
        if (!mover.present || mover.gone) continue;
        mover.force = (WishedVelocity(people[i], mover) - mover.velocity) / kRelaxationSecs;
        for (std::size_t k = 0; k < people.size(); ++k) {
          if (k == i || !movers[k].present || movers[k].gone) continue;
          mover.force += Repulsion(mover.place, movers[k].place, 2 * kBodyRadius);
        }
        for (const Pillar& pillar : pillars) {
          mover.force += Repulsion(mover.place, pillar.center_m, kBodyRadius + pillar.radius_m);
        }
      }
      for (std::size_t i = 0; i < people.size(); ++i) {
        if (movers[i].present && !movers[i].gone) Advance(people[i], movers[i], step_secs);
      }
    }
  }
  return walks;
}

}  // namespace vantage::simulation
