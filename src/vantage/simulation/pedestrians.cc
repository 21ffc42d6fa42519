// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/simulation/pedestrians.h"

#include <algorithm>
#include <cmath>
#include <numeric>

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
  bool gone = false;
  std::size_t stop = 1;  // the next one
  double stayed_secs = 0;
  Vector2d place = {0, 0};
  Vector2d velocity = {0, 0};
  Vector2d force = {0, 0};
};

bool Stays(const Pedestrian& who, const Mover& mover) {
  return mover.stayed_secs > 0 && who.stops[mover.stop].stay_secs > 0;
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
  const auto entering = [&](std::size_t i) {
    return static_cast<FrameIndex>(std::ceil(people[i].enters_secs * frames_per_second));
  };
  std::vector<std::size_t> waiting(people.size());  // the next one at the back
  std::iota(waiting.begin(), waiting.end(), std::size_t{0});
  std::stable_sort(waiting.begin(), waiting.end(),
                   [&](std::size_t a, std::size_t b) { return entering(a) > entering(b); });
  std::vector<std::size_t> present;
  FrameIndex frame = waiting.empty() ? frames : std::min<FrameIndex>(0, entering(waiting.back()));
  for (; frame < frames; ++frame) {
    for (; !waiting.empty() && entering(waiting.back()) <= frame; waiting.pop_back()) {
      movers[waiting.back()].place = people[waiting.back()].stops.front().ground_m;
      present.push_back(waiting.back());
    }
    std::erase_if(present, [&](std::size_t i) { return movers[i].gone; });
    for (const std::size_t i : present) {
      if (frame < 0) continue;
      if (walks[i].ground_m.empty()) walks[i].first = frame;
      walks[i].ground_m.push_back(movers[i].place);
      walks[i].look_at_m.push_back(
          Stays(people[i], movers[i]) ? people[i].stops[movers[i].stop].look_at_m : std::nullopt);
    }
    for (int step = 0; step < steps_a_frame; ++step) {
      for (const std::size_t i : present) {
        Mover& mover = movers[i];
        if (mover.gone) continue;
        mover.force = (WishedVelocity(people[i], mover) - mover.velocity) / kRelaxationSecs;
        for (const std::size_t k : present) {
          if (k == i || movers[k].gone) continue;
          mover.force += Repulsion(mover.place, movers[k].place, 2 * kBodyRadius);
        }
        for (const Pillar& pillar : pillars) {
          mover.force += Repulsion(mover.place, pillar.center_m, kBodyRadius + pillar.radius_m);
        }
      }
      for (const std::size_t i : present) {
        if (!movers[i].gone) Advance(people[i], movers[i], step_secs);
      }
    }
  }
  return walks;
}

}  // namespace vantage::simulation
