// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/simulation/floorball_sideline.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace vantage::simulation {
namespace {

using Eigen::Vector2d;

constexpr double kRise_m = 0.7;  // from the seat to where one stands before it

Walker& At(std::vector<Walker>& walkers, int index) {
  return walkers[static_cast<std::size_t>(index)];
}

bool Near(const Walker& walker, const Vector2d& place, double distance) {
  return (walker.place_m - place).norm() < distance;
}

}  // namespace

Bench::Bench(int team, std::vector<int> resting, double first_secs, std::vector<Walker>& walkers)
    : side_(team == 0 ? -1 : 1), next_secs_(first_secs) {
  for (std::size_t i = 0; i < resting.size(); ++i) {
    Seat seat;
    seat.walker = resting[i];
    seat.stands = i == 4;
    seat.place_m = {side_ * (kBenchFrom_m + kSeat_m * static_cast<double>(i)), kBench_m};
    if (seat.stands) seat.place_m += Vector2d(side_ * 0.3, -0.5);
    seat.since_secs = -static_cast<double>(resting.size() - i);
    seats_.push_back(seat);
    Walker& walker = At(walkers, seat.walker);
    walker.place_m = walker.target_m = seat.place_m;
    walker.seated = true;
    walker.sit = walker.posture.sit = seat.stands ? 0 : 1;
    walker.posture.heading_rad = -std::numbers::pi / 2;
  }
}

void Bench::Step(std::vector<Walker>& walkers, Squad& squad, std::optional<int> holder,
                 double clock_secs, Dice& dice) {
  const Vector2d out(side_ * kLaneOut_m, 10.75), in(side_ * kLaneIn_m, 10.6);
  Seat& seat = seats_[seat_];
  const Vector2d before = seat.place_m - Vector2d(0, kRise_m);
  Walker& enters = At(walkers, entering_);
  Walker& leaves = At(walkers, leaving_);
  switch (state_) {
    case State::kQuiet: {
      if (clock_secs < next_secs_) break;
      // Who has rested longest comes, who has played longest goes.
      seat_ = static_cast<std::size_t>(std::min_element(seats_.begin(), seats_.end(),
                                                        [](const Seat& a, const Seat& b) {
                                                          return a.since_secs < b.since_secs;
                                                        }) -
                                       seats_.begin());
      entering_ = seats_[seat_].walker;
      Walker& rises = At(walkers, entering_);
      rises.sit = 0;
      rises.target_m = seats_[seat_].place_m - Vector2d(0, kRise_m);
      rises.pace_m_s = 0.7;
      state_ = State::kRising;
      break;
    }
    case State::kRising:
      if (enters.posture.sit > 0 || !Near(enters, before, 0.15)) break;
      enters.seated = false;
      enters.target_m = in;
      enters.pace_m_s = dice.Uniform(1.3, 2.4);
      state_ = State::kWalking;
      break;
    case State::kWalking: {
      if (!Near(enters, in, 0.3)) break;
      const auto played_longest = [&](std::size_t a, std::size_t b) {
        return on_since_secs_[a] < on_since_secs_[b];
      };
      std::array<std::size_t, 5> order = {0, 1, 2, 3, 4};
      std::sort(order.begin(), order.end(), played_longest);
      slot_ = squad.slots[order[0]] == holder ? order[1] : order[0];
      leaving_ = squad.slots[slot_];
      squad.leaving = leaving_;
      state_ = State::kLeaving;
      break;
    }
    case State::kLeaving: {
      leaves.target_m = {out.x(), 8.6};
      leaves.pace_m_s = 4;
      leaves.look_at_m = out;
      leaves.crouch = 0;
      if (!Near(leaves, leaves.target_m, 0.9)) break;
      leaves.in_rink = false;
      leaves.target_m = out;
      enters.target_m = {in.x(), 7.5};
      enters.pace_m_s = 4.5;
      state_ = State::kCrossing;
      break;
    }
    case State::kCrossing:
      if (enters.place_m.y() < kRinkHalfWidth_m - 0.5) enters.in_rink = true;
      if (!enters.in_rink || leaves.place_m.y() < kRinkHalfWidth_m + 0.3) break;
      squad.slots[slot_] = entering_;
      squad.leaving.reset();
      on_since_secs_[slot_] = clock_secs;
      leaves.target_m = before;
      leaves.pace_m_s = dice.Uniform(1.1, 1.6);
      leaves.look_at_m.reset();
      state_ = State::kReturning;
      break;
    case State::kReturning:
      if (!Near(leaves, before, 0.25)) break;
      leaves.look_at_m = Vector2d(before.x(), 0);
      leaves.target_m = before;
      if (std::abs(leaves.posture.heading_rad + std::numbers::pi / 2) > 0.3) break;
      leaves.seated = true;
      leaves.target_m = seat.place_m;
      leaves.pace_m_s = 0.7;
      leaves.sit = seat.stands ? 0 : 1;
      state_ = State::kSittingDown;
      break;
    case State::kSittingDown:
      if (!Near(leaves, seat.place_m, 0.1)) break;
      seat.walker = leaving_;
      seat.since_secs = clock_secs;
      next_secs_ = clock_secs + dice.Uniform(4, 16);
      state_ = State::kQuiet;
      break;
  }
}

void StepBystander(Bystander& bystander, std::vector<Walker>& walkers,
                   const Eigen::Vector3d& ball_m, double clock_secs, Dice& dice) {
  Walker& walker = At(walkers, bystander.walker);
  walker.pace_m_s = bystander.pace_m_s;
  if (clock_secs < bystander.still_until_secs) {
    walker.target_m = walker.place_m;
    walker.seated = bystander.sits_at_first;
    walker.sit = bystander.sits_at_first ? 1 : 0;
    return;
  }
  walker.sit = 0;
  if (walker.posture.sit > 0) return;  // first gets up
  walker.seated = false;
  if (bystander.follows_ball) {
    const Vector2d line = bystander.to_m - bystander.from_m;
    const double share =
        std::clamp((ball_m.head<2>() - bystander.from_m).dot(line) / line.squaredNorm(), 0.0, 1.0);
    const Vector2d wanted = bystander.from_m + share * line;
    walker.look_at_m = ball_m.head<2>();
    // Catches up only when left behind.
    if ((wanted - walker.target_m).norm() > 2.5) walker.target_m = wanted;
    return;
  }
  if (clock_secs < bystander.next_secs) return;
  if (!Near(walker, walker.target_m, 0.4)) return;
  bystander.next_secs = clock_secs + dice.Uniform(0.2, 1) * bystander.pause_secs;
  walker.target_m = bystander.from_m + dice.Unit() * (bystander.to_m - bystander.from_m);
  walker.arm_reach = dice.Unit() < 0.3 ? dice.Uniform(0.2, 0.8) : 0;
}

}  // namespace vantage::simulation
