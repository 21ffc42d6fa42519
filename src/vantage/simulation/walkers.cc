// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/simulation/walkers.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace vantage::simulation {
namespace {

using Eigen::Vector2d;

constexpr double kWalkingSpeed = 1.3;  // m/s, of people of whom nothing else is known
constexpr double kSmoothingSecs = 0.35;
constexpr double kTurningSpeed = 0.25;  // m/s: slower people look around
constexpr double kFastestTurn = 6;      // rad/s

/// Tangent of a monotone cubic between two secants over spans of these lengths.
double MonotoneTangent(double secant_before, double span_before, double secant_after,
                       double span_after) {
  if (secant_before * secant_after <= 0) return 0;
  const double w1 = 2 * span_after + span_before;
  const double w2 = span_after + 2 * span_before;
  return (w1 + w2) / (w1 / secant_before + w2 / secant_after);
}

/// Gaussian means of a sequence, which goes on beyond its ends as its mirror image through them:
/// steady motion stays steady.
std::vector<Vector2d> Smoothed(const std::vector<Vector2d>& values, double sigma_frames) {
  const int reach = static_cast<int>(std::ceil(3 * sigma_frames));
  const int count = static_cast<int>(values.size());
  const auto at = [&](int i) -> Vector2d {
    const int within = std::clamp(i, 0, count - 1);
    const Vector2d& end = values[static_cast<std::size_t>(within)];
    if (within == i) return end;
    const int mirrored = std::clamp(2 * within - i, 0, count - 1);
    return end + (end - values[static_cast<std::size_t>(mirrored)]);
  };
  std::vector<Vector2d> smooth(values.size());
  for (int i = 0; i < count; ++i) {
    Vector2d sum = {0, 0};
    double weights = 0;
    for (int k = -reach; k <= reach; ++k) {
      const double weight = std::exp(-0.5 * (k / sigma_frames) * (k / sigma_frames));
      sum += weight * at(i + k);
      weights += weight;
    }
    smooth[static_cast<std::size_t>(i)] = sum / weights;
  }
  return smooth;
}

/// The gate that asks for the least turning from `direction` at `from`, near ones preferred.
const Gate& BestGate(const std::vector<Gate>& gates, const Vector2d& from,
                     const Vector2d& direction) {
  const Gate* best = nullptr;
  double lowest = std::numeric_limits<double>::infinity();
  for (const Gate& gate : gates) {
    const Vector2d way = gate.back() - from;
    const double turning =
        direction.norm() < 1e-6 ? 1 : 1 - way.normalized().dot(direction.normalized());
    const double cost = turning + way.norm() / 30;
    if (cost < lowest) {
      lowest = cost;
      best = &gate;
    }
  }
  return *best;
}

/// Waypoints from `from` (left out) into the gate at walking speed.
std::vector<Waypoint> IntoGate(const Waypoint& from, const Gate& gate) {
  std::vector<Waypoint> way;
  Waypoint at = from;
  for (auto place = gate.rbegin(); place != gate.rend(); ++place) {
    const double secs = std::max((*place - at.ground_m).norm() / kWalkingSpeed, 0.05);
    at = {at.seconds + secs, *place};
    way.push_back(at);
  }
  return way;
}

/// The same way backwards in time: from the gate to `to` (left out).
std::vector<Waypoint> OutOfGate(const Waypoint& to, const Gate& gate) {
  std::vector<Waypoint> way = IntoGate({-to.seconds, to.ground_m}, gate);
  for (Waypoint& waypoint : way) waypoint.seconds = -waypoint.seconds;
  std::reverse(way.begin(), way.end());
  return way;
}

/// What is done between two places known with a long time between them: into the gate and back,
/// else as far towards it as walking there and back takes no longer, else straight on.
std::vector<Waypoint> Excursion(const Waypoint& from, const Waypoint& to, const Gate& gate) {
  constexpr int kSteps = 20;
  std::vector<Waypoint> in = IntoGate(from, gate);
  const std::vector<Waypoint> out = OutOfGate(to, gate);
  if (in.back().seconds < out.front().seconds) {
    in.insert(in.end(), out.begin(), out.end());
    return in;
  }
  const double secs = to.seconds - from.seconds;
  for (int step = kSteps; step > 0; --step) {
    const Vector2d turn =
        from.ground_m + static_cast<double>(step) / kSteps * (gate.back() - from.ground_m);
    const double there = (turn - from.ground_m).norm();
    const double back = (turn - to.ground_m).norm();
    if (there > 0.1 && back > 0.1 && there + back <= secs * kWalkingSpeed) {
      return {{from.seconds + secs * there / (there + back), turn}};
    }
  }
  return {};
}

/// Mean velocity over about a second from (or, with `step` -1, up to) one of the known waypoints.
Vector2d Velocity(const std::vector<Waypoint>& known, std::size_t at, int step) {
  std::size_t other = at;
  const auto within = [&](std::size_t i) {
    const double apart = std::abs(known[i].seconds - known[at].seconds);
    return apart <= 1.05;
  };
  if (step > 0) {
    while (other + 1 < known.size() && within(other + 1)) ++other;
  } else {
    while (other > 0 && within(other - 1)) --other;
  }
  if (other == at) return {0, 0};
  return (known[other].ground_m - known[at].ground_m) / (known[other].seconds - known[at].seconds);
}

}  // namespace

Way::Way(std::vector<Waypoint> waypoints)
    : waypoints_(std::move(waypoints)), velocities_m_s_(waypoints_.size(), Vector2d(0, 0)) {
  const auto span = [&](std::size_t i) {
    return waypoints_[i + 1].seconds - waypoints_[i].seconds;
  };
  const auto secant = [&](std::size_t i) -> Vector2d {
    return (waypoints_[i + 1].ground_m - waypoints_[i].ground_m) / span(i);
  };
  if (waypoints_.size() < 2) return;
  const std::size_t last = waypoints_.size() - 1;
  velocities_m_s_[0] = secant(0);
  velocities_m_s_[last] = secant(last - 1);
  for (std::size_t i = 1; i < last; ++i) {
    for (int axis = 0; axis < 2; ++axis) {
      velocities_m_s_[i][axis] =
          MonotoneTangent(secant(i - 1)[axis], span(i - 1), secant(i)[axis], span(i));
    }
  }
}

Vector2d Way::At(double seconds) const {
  if (seconds <= waypoints_.front().seconds) return waypoints_.front().ground_m;
  if (seconds >= waypoints_.back().seconds) return waypoints_.back().ground_m;
  const auto after =
      std::upper_bound(waypoints_.begin(), waypoints_.end(), seconds,
                       [](double value, const Waypoint& w) { return value < w.seconds; });
  const std::size_t i = static_cast<std::size_t>(after - waypoints_.begin()) - 1;
  const double span = waypoints_[i + 1].seconds - waypoints_[i].seconds;
  const double t = (seconds - waypoints_[i].seconds) / span;
  // Cubic Hermite polynomials.
  const double t2 = t * t;
  const double t3 = t2 * t;
  const Vector2d& from = waypoints_[i].ground_m;
  return from + (3 * t2 - 2 * t3) * (waypoints_[i + 1].ground_m - from) +
         (t3 - 2 * t2 + t) * span * velocities_m_s_[i] + (t3 - t2) * span * velocities_m_s_[i + 1];
}

std::vector<Waypoint> ThroughGates(const std::vector<Waypoint>& known,
                                   const std::vector<Gate>& gates, double max_gap_secs) {
  const auto leave = [&](std::size_t i) -> const Gate& {
    return BestGate(gates, known[i].ground_m, Velocity(known, i, -1));
  };
  const auto arrive = [&](std::size_t i) -> const Gate& {
    return BestGate(gates, known[i].ground_m, -Velocity(known, i, 1));
  };
  std::vector<Waypoint> way = OutOfGate(known.front(), arrive(0));
  for (std::size_t i = 0; i < known.size(); ++i) {
    way.push_back(known[i]);
    if (i + 1 == known.size()) continue;
    if (known[i + 1].seconds - known[i].seconds <= max_gap_secs) continue;
    for (const Waypoint& w : Excursion(known[i], known[i + 1], leave(i))) way.push_back(w);
  }
  for (const Waypoint& w : IntoGate(known.back(), leave(known.size() - 1))) {
    way.push_back(w);
  }
  return way;
}

Walk WalkThrough(const std::vector<Waypoint>& waypoints, double frames_per_second,
                 FrameIndex frames) {
  Walk walk;
  const Way way(waypoints);
  // A frame at a waypoint's very time counts although rounding may put it just before.
  const auto first =
      static_cast<FrameIndex>(std::ceil(waypoints.front().seconds * frames_per_second - 1e-6));
  const auto last =
      static_cast<FrameIndex>(std::floor(waypoints.back().seconds * frames_per_second + 1e-6));
  walk.first = std::max<FrameIndex>(first, 0);
  for (FrameIndex frame = walk.first; frame <= std::min(last, frames - 1); ++frame) {
    walk.ground_m.push_back(way.At(static_cast<double>(frame) / frames_per_second));
  }
  return walk;
}

std::vector<Posture> Postures(const Walk& walk, double frames_per_second, double height_m) {
  const std::size_t count = walk.ground_m.size();
  std::vector<Posture> postures(count);
  if (count == 0) return postures;
  const double sigma = std::max(kSmoothingSecs * frames_per_second, 0.5);
  const std::vector<Vector2d> places = Smoothed(walk.ground_m, sigma);
  std::vector<Vector2d> directions(count, Vector2d(0, 0));
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t before = i == 0 ? 0 : i - 1;
    const std::size_t after = std::min(i + 1, count - 1);
    const Vector2d velocity = after == before
                                  ? Vector2d(0, 0)
                                  : Vector2d((places[after] - places[before]) * frames_per_second /
                                             static_cast<double>(after - before));
    postures[i].ground_m = walk.ground_m[i];
    postures[i].speed_m_s = velocity.norm();
    if (postures[i].speed_m_s >= kTurningSpeed) {
      directions[i] = velocity.normalized();
    } else if (i < walk.look_at_m.size() && walk.look_at_m[i] &&
               (*walk.look_at_m[i] - walk.ground_m[i]).norm() > 0.05) {
      directions[i] = (*walk.look_at_m[i] - walk.ground_m[i]).normalized();
    }
  }
  // Who stands looks where they last went; at the beginning, where they will go.
  for (std::size_t i = 1; i < count; ++i) {
    if (directions[i].isZero()) directions[i] = directions[i - 1];
  }
  for (std::size_t i = count - 1; i-- > 0;) {
    if (directions[i].isZero()) directions[i] = directions[i + 1];
  }
  directions = Smoothed(directions, sigma);
  double gait = 0;
  for (std::size_t i = 0; i < count; ++i) {
    // Mean directions of a turn by half a circle jump, or vanish in its middle.
    const double towards = std::atan2(directions[i].y(), directions[i].x());
    const double before = i == 0 ? towards : postures[i - 1].heading_rad;
    const double turn = std::remainder(towards - before, 2 * std::numbers::pi);
    const double most = kFastestTurn / frames_per_second;
    postures[i].heading_rad = before + std::clamp(turn, -most, most);
    gait = AdvanceGait(gait, postures[i].speed_m_s, height_m, 1 / frames_per_second);
    postures[i].gait = gait;
  }
  return postures;
}

}  // namespace vantage::simulation
