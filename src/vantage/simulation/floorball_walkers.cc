// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/simulation/floorball_walkers.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace vantage::simulation {
namespace {

using Eigen::Vector2d;

constexpr double kAcceleration = 3;    // m/s^2, of one's own wish
constexpr double kEvasion = 5.5;       // m/s^2, to keep clear of others and the boards
constexpr double kElbowRoom_m = 0.58;  // between the middles of two people
constexpr double kBoardRoom_m = 0.35;

Vector2d Clamped(const Vector2d& v, double length) {
  const double norm = v.norm();
  return norm > length ? Vector2d(v * (length / norm)) : v;
}

// The speed at which one can still stop within `gap`.
double Stoppable(double gap_m) { return std::sqrt(2 * kAcceleration * std::max(0.0, gap_m)); }

Vector2d Wish(const Walker& walker) {
  const Vector2d way = walker.target_m - walker.place_m;
  const double distance = way.norm();
  if (distance < 0.02) return -walker.velocity_m_s / 0.2;
  const double speed =
      std::min({walker.pace_m_s, walker.fastest_m_s, 1.8 * distance, Stoppable(distance)});
  return (way * (speed / distance) - walker.velocity_m_s) / 0.25;
}

// What keeps two people apart: who is about to run into another turns aside in time, and nobody
// approaches faster than they could stop.
Vector2d Evade(const Walker& self, const Walker& other) {
  const Vector2d away = self.place_m - other.place_m;
  const double distance = std::max(away.norm(), 1e-3);
  if (distance > 6) return {0, 0};
  const Vector2d normal = away / distance;
  const Vector2d relative = self.velocity_m_s - other.velocity_m_s;
  const double gap = distance - kElbowRoom_m;
  const double closing = -relative.dot(normal);
  Vector2d evasion = {0, 0};
  const double allowed = gap > 0 ? Stoppable(gap) : 2 * gap;
  if (closing > allowed) evasion += normal * std::min(12.0, 6 * (closing - allowed));
  if (gap < 0.3) evasion += normal * (0.3 - gap) * 3;
  if (closing > 0.1) {
    const double secs = distance * closing / relative.squaredNorm();  // until they are closest
    const Vector2d miss = away + secs * relative;
    if (secs < 1 && miss.norm() < 0.8) {
      // To the side on which they pass, the right one when they meet head on.
      const Vector2d right(normal.y(), -normal.x());
      const Vector2d side = miss.norm() > 0.15 ? Vector2d(miss.normalized()) : right;
      evasion += side * 4 * (1 - secs) * (1 - miss.norm() / 0.8);
    }
  }
  return evasion;
}

Vector2d EvadeBoards(const Walker& walker) {
  const double gap = GapToBoards(walker.place_m) - kBoardRoom_m;
  if (gap > 2.5) return {0, 0};
  const Vector2d inner = WithinBoards(walker.place_m, kBoardRoom_m + 3);
  const Vector2d inwards = (inner - walker.place_m).normalized();
  const double closing = -walker.velocity_m_s.dot(inwards);
  const double allowed = gap > 0 ? Stoppable(gap) : 2 * gap;
  return closing > allowed ? Vector2d(inwards * std::min(15.0, 8 * (closing - allowed)))
                           : Vector2d(0, 0);
}

double TurnedTowards(double heading_rad, const Vector2d& direction, double seconds) {
  const double error =
      std::remainder(std::atan2(direction.y(), direction.x()) - heading_rad, 2 * std::numbers::pi);
  return std::remainder(heading_rad + std::clamp(6 * error, -5.0, 5.0) * seconds,
                        2 * std::numbers::pi);
}

void Pose(Walker& walker, double seconds) {
  Posture& posture = walker.posture;
  const double speed = walker.velocity_m_s.norm();
  posture.ground_m = walker.place_m;
  posture.speed_m_s += (speed - posture.speed_m_s) * std::min(1.0, seconds / 0.12);
  if (posture.speed_m_s < 0.01) posture.speed_m_s = 0;  // who stands stands still
  posture.gait = AdvanceGait(posture.gait, posture.speed_m_s, walker.height_m, seconds);
  posture.gait -= std::floor(posture.gait);
  const double follow = walker.look_at_m ? std::clamp(speed - 0.5, 0.0, 1.0) : 1;
  Vector2d ahead = speed > 0.15 ? Vector2d(walker.velocity_m_s * (follow / speed)) : Vector2d(0, 0);
  if (walker.look_at_m) {
    const Vector2d look = *walker.look_at_m - walker.place_m;
    if (look.norm() > 0.1) ahead += look.normalized() * (1 - follow);
  }
  if (ahead.norm() > 0.05) {
    posture.heading_rad = TurnedTowards(posture.heading_rad, ahead, seconds);
  }
  const auto ease = [&](double& value, double wish, double secs) {
    value += std::clamp(wish - value, -seconds / secs, seconds / secs);
  };
  ease(posture.crouch, walker.crouch, 1.2);
  ease(posture.sit, walker.sit, 1.1);
  ease(posture.arm_reach, walker.arm_reach, 0.8);
}

}  // namespace

double GapToBoards(const Vector2d& place_m) {
  // Signed distance of a rectangle with round corners.
  const double x = std::abs(place_m.x()) - (kRinkHalfLength_m - kRinkCornerRadius_m);
  const double y = std::abs(place_m.y()) - (kRinkHalfWidth_m - kRinkCornerRadius_m);
  const double outside = std::hypot(std::max(x, 0.0), std::max(y, 0.0));
  return kRinkCornerRadius_m - outside - std::min(std::max(x, y), 0.0);
}

Vector2d WithinBoards(const Vector2d& place_m, double gap_m) {
  const double radius = std::max(0.0, kRinkCornerRadius_m - gap_m);
  const double x = kRinkHalfLength_m - gap_m - radius;
  const double y = kRinkHalfWidth_m - gap_m - radius;
  const Vector2d core(std::clamp(place_m.x(), -x, x), std::clamp(place_m.y(), -y, y));
  return core + Clamped(place_m - core, radius);
}

void MoveWalkers(std::vector<Walker>& walkers, double seconds) {
  std::vector<Vector2d> pushes(walkers.size());
  for (std::size_t i = 0; i < walkers.size(); ++i) {
    Walker& self = walkers[i];
    const Vector2d wish = Clamped(Wish(self), kAcceleration);
    if (self.seated) {
      pushes[i] = wish;
      continue;
    }
    Vector2d evasion = {0, 0};
    for (std::size_t j = 0; j < walkers.size(); ++j) {
      if (j != i) evasion += Evade(self, walkers[j]);
    }
    if (self.in_rink) evasion += EvadeBoards(self);
    pushes[i] = Clamped(wish + evasion, kEvasion);
  }
  for (std::size_t i = 0; i < walkers.size(); ++i) {
    Walker& self = walkers[i];
    self.velocity_m_s += pushes[i] * seconds;
    if (self.velocity_m_s.norm() < 0.02 && (self.target_m - self.place_m).norm() < 0.02) {
      self.velocity_m_s = {0, 0};
    }
    self.place_m += self.velocity_m_s * seconds;
    Pose(self, seconds);
  }
}

}  // namespace vantage::simulation
