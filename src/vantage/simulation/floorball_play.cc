// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/simulation/floorball_play.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace vantage::simulation {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kBallRadius_m = 0.036;
constexpr double kReach_m = 0.8;  // from the hips to the ball on the blade

double Direction(int team) { return team == 0 ? 1 : -1; }
Vector2d Goal(int defended_by) { return {-Direction(defended_by) * kGoalLine_m, 0}; }

// Where each slot stands relative to the ball, along the team's direction and to its left.
constexpr std::array<std::array<double, 2>, 5> kFormation = {
    {{-5.5, 4.2}, {-5.5, -4.2}, {0.5, 0}, {4.5, 6.5}, {4.5, -6.5}}};

// The slot of the other team that one marks.
int Marked(int slot) { return slot == 2 ? 2 : 4 - slot; }

// Keeps clear of goals and keepers.
Vector2d BesideGoals(Vector2d place) {
  if (std::abs(place.x()) > 14.2 && std::abs(place.y()) < 1.7) {
    place.x() = std::copysign(14.2, place.x());
  }
  return place;
}

// The blade of a stick held ahead and to the right.
Vector2d Blade(const Walker& walker) {
  const double angle = walker.posture.heading_rad - 0.35;
  return walker.place_m + 0.85 * Vector2d(std::cos(angle), std::sin(angle));
}

}  // namespace

struct Play::View {
  std::vector<Walker>& walkers;
  const std::array<Squad, 2>& squads;

  Walker& at(int player) const { return walkers[static_cast<std::size_t>(player)]; }
  bool Plays(int player) const {
    return squads[0].leaving != player && squads[1].leaving != player && at(player).in_rink;
  }
  int Team(int player) const {
    const Squad& squad = squads[0];
    return squad.keeper == player || std::count(squad.slots.begin(), squad.slots.end(), player) > 0
               ? 0
               : 1;
  }
  bool IsKeeper(int player) const {
    return squads[0].keeper == player || squads[1].keeper == player;
  }
  // Field players of a team by distance to a place.
  std::vector<int> Nearest(int team, const Vector2d& place) const {
    std::vector<int> players;
    for (const int player : squads[static_cast<std::size_t>(team)].slots) {
      if (Plays(player)) players.push_back(player);
    }
    std::sort(players.begin(), players.end(), [&](int a, int b) {
      return (at(a).place_m - place).norm() < (at(b).place_m - place).norm();
    });
    return players;
  }
  double Freedom(int player, int against) const {  // distance to the nearest opponent
    const std::vector<int> near = Nearest(against, at(player).place_m);
    return near.empty() ? 10 : (at(near[0]).place_m - at(player).place_m).norm();
  }
};

Play::Play(std::uint64_t seed) : dice_(seed) {
  spot_m_ = {dice_.Uniform(-6, 6), dice_.Uniform(-7, 4)};
  ball_m_ = {spot_m_.x(), spot_m_.y(), kBallRadius_m};
  team_ = dice_.Below(2);
}

void Play::Whistle() { until_secs_ = clock_secs_ + dice_.Uniform(3.5, 4.5); }

void Play::Step(std::vector<Walker>& walkers, const std::array<Squad, 2>& squads, double seconds) {
  const View view{walkers, squads};
  clock_secs_ += seconds;
  MoveBall(view, seconds);
  Decide(view, seconds);
  SetWishes(view);
}

void Play::MoveBall(const View& view, double seconds) {
  const Vector2d ball = ball_m_.head<2>();
  Vector2d goal = ball;
  double fastest = 0;
  if (state_ == State::kHeld) {
    goal = view.IsKeeper(*holder_) ? Vector2d(view.at(*holder_).place_m +
                                              Vector2d(0.5 * Direction(view.Team(*holder_)), 0))
                                   : Blade(view.at(*holder_));
    fastest = std::min(14.0, 8 * (goal - ball).norm());
  } else if (state_ == State::kPassed) {
    goal = stray_ ? spot_m_ : Blade(view.at(*holder_));
    fastest = ball_speed_m_s_ = std::max(2.5, ball_speed_m_s_ - 2.5 * seconds);
  } else if (state_ == State::kFreeHit) {
    goal = spot_m_;  // someone puts it there
    fastest = 3;
  } else if (state_ == State::kFight) {
    const double t = clock_secs_;
    goal = spot_m_ + 0.22 * Vector2d(std::sin(5.1 * t) + std::sin(2.3 * t), std::cos(3.9 * t));
    fastest = 2.5;
  }
  const Vector2d way = goal - ball;
  Vector2d place = ball;
  if (way.norm() > 1e-6) place += way * std::min(1.0, fastest * seconds / way.norm());
  place = WithinBoards(place, 0.1);
  ball_m_ = {place.x(), place.y(), kBallRadius_m};
}

void Play::HoldBy(int player, double secs) {
  state_ = State::kHeld;
  holder_ = player;
  until_secs_ = clock_secs_ + secs;
  drive_until_secs_ = 0;
}

// To the team mate who is free, ahead and neither near nor far; sometimes it goes astray.
void Play::Pass(const View& view) {
  const Walker& from = view.at(*holder_);
  const Vector2d ahead(Direction(team_), 0);
  const bool near_goal = (Goal(1 - team_) - from.place_m).norm() < 9;
  state_ = State::kPassed;
  stray_ = false;
  ball_speed_m_s_ = dice_.Uniform(9, 13);
  if (near_goal && dice_.Unit() < 0.35) {  // a shot, saved
    ball_speed_m_s_ = dice_.Uniform(14, 18);
    holder_ = view.squads[static_cast<std::size_t>(1 - team_)].keeper;
    return;
  }
  double best = -std::numeric_limits<double>::infinity();
  int receiver = *holder_;
  for (const int mate : view.squads[static_cast<std::size_t>(team_)].slots) {
    if (mate == *holder_ || !view.Plays(mate)) continue;
    const Vector2d way = view.at(mate).place_m - from.place_m;
    const double merit = std::min(view.Freedom(mate, 1 - team_), 3.0) + 0.12 * way.dot(ahead) -
                         0.2 * std::abs(way.norm() - 7) + dice_.Uniform(0, 2);
    if (merit > best) {
      best = merit;
      receiver = mate;
    }
  }
  if (dice_.Unit() < 0.22) {
    stray_ = true;
    spot_m_ = WithinBoards(view.at(receiver).place_m +
                               Vector2d(dice_.Uniform(-2, 6) * ahead.x(), dice_.Uniform(-6, 6)),
                           0.6);
  }
  holder_ = receiver;
}

void Play::StartFight(const View& view) {
  spot_m_ = BesideGoals(WithinBoards(ball_m_.head<2>(), 0.75));
  fighters_.clear();
  for (const int team : {0, 1}) {
    const std::vector<int> near = view.Nearest(team, spot_m_);
    const std::size_t most = 1 + static_cast<std::size_t>(dice_.Below(2));
    for (std::size_t i = 0; i < std::min(most, near.size()); ++i) {
      if ((view.at(near[i]).place_m - spot_m_).norm() < 4) fighters_.push_back(near[i]);
    }
  }
  state_ = State::kFight;
  holder_.reset();
  until_secs_ = clock_secs_ + dice_.Uniform(1.5, 4);
}

void Play::EndFight(const View& view) {
  if (fighters_.empty() || dice_.Unit() < 0.25) {  // a foul
    team_ = dice_.Below(2);
    spot_m_ = WithinBoards(spot_m_, 2.5);
    spot_m_.x() = std::clamp(spot_m_.x(), -13.0, 13.0);
    holder_.reset();
    state_ = State::kFreeHit;
    until_secs_ = clock_secs_ + dice_.Uniform(4, 6);
    return;
  }
  const int winner =
      fighters_[static_cast<std::size_t>(dice_.Below(static_cast<int>(fighters_.size())))];
  team_ = view.Team(winner);
  HoldBy(winner, dice_.Uniform(0.5, 1.6));
}

void Play::Decide(const View& view, double seconds) {
  const Vector2d ball = ball_m_.head<2>();
  switch (state_) {
    case State::kFreeHit: {
      const std::vector<int> takers = view.Nearest(team_, spot_m_);
      if (clock_secs_ > until_secs_ && !takers.empty() &&
          (view.at(takers[0]).place_m - spot_m_).norm() < 1.2) {
        HoldBy(takers[0], dice_.Uniform(0.2, 0.6));
      }
      break;
    }
    case State::kHeld: {
      if (!view.IsKeeper(*holder_) && !view.Plays(*holder_)) {
        state_ = State::kLoose;
        break;
      }
      if (clock_secs_ > until_secs_) {
        Pass(view);
        break;
      }
      const std::vector<int> near = view.Nearest(1 - team_, ball);
      if (view.IsKeeper(*holder_) || near.empty()) break;
      if ((view.at(near[0]).place_m - ball).norm() > 1.2) break;
      if (dice_.Happens(0.35, seconds)) {
        StartFight(view);
      } else if (dice_.Happens(0.25, seconds)) {
        team_ = 1 - team_;
        HoldBy(near[0], dice_.Uniform(0.8, 3));
      }
      break;
    }
    case State::kPassed: {
      if (stray_) {
        if ((ball - spot_m_).norm() < 0.1) state_ = State::kLoose;
        break;
      }
      const int receiver = *holder_;
      const bool kept = view.IsKeeper(receiver);
      if ((ball - view.at(receiver).place_m).norm() < kReach_m + 0.15) {
        team_ = view.Team(receiver);
        HoldBy(receiver, kept ? dice_.Uniform(1, 2.2) : dice_.Uniform(0.6, 3.2));
        break;
      }
      const std::vector<int> near = view.Nearest(1 - team_, ball);
      if (!kept && !near.empty() && (view.at(near[0]).place_m - ball).norm() < kReach_m &&
          dice_.Happens(3, seconds)) {
        team_ = 1 - team_;
        HoldBy(near[0], dice_.Uniform(0.8, 3));
      }
      break;
    }
    case State::kLoose: {
      if (BesideGoals(ball) != ball) {  // the keeper's
        team_ = ball.x() < 0 ? 0 : 1;
        HoldBy(view.squads[static_cast<std::size_t>(team_)].keeper, dice_.Uniform(1, 2.2));
        break;
      }
      for (const int team : {0, 1}) {
        const std::vector<int> near = view.Nearest(team, ball);
        if (near.empty() || (view.at(near[0]).place_m - ball).norm() > kReach_m) continue;
        if (view.Freedom(near[0], 1 - team) < 2) {
          StartFight(view);
        } else {
          team_ = team;
          HoldBy(near[0], dice_.Uniform(0.8, 3));
        }
        break;
      }
      break;
    }
    case State::kFight:
      if (clock_secs_ > until_secs_) EndFight(view);
      break;
  }
}

void Play::SetWishes(const View& view) {
  for (const int team : {0, 1}) {
    const Squad& squad = view.squads[static_cast<std::size_t>(team)];
    WishOfKeeper(team, view.at(squad.keeper));
    for (int slot = 0; slot < 5; ++slot) {
      const int player = squad.slots[static_cast<std::size_t>(slot)];
      if (!view.Plays(player)) continue;
      Walker& walker = view.at(player);
      Roam& roam = roams_[static_cast<std::size_t>(team)][static_cast<std::size_t>(slot)];
      if (clock_secs_ > roam.until_secs) {
        roam.until_secs = clock_secs_ + dice_.Uniform(1.2, 4);
        const double angle = dice_.Uniform(0, 2 * std::numbers::pi);
        roam.offset_m = dice_.Uniform(0.3, 3.2) * Vector2d(std::cos(angle), std::sin(angle));
        roam.pace_m_s = dice_.Uniform(2.5, 6.5);
      }
      walker.look_at_m = ball_m_.head<2>();
      walker.arm_reach = 0;
      walker.crouch = 0.16;
      walker.pace_m_s = roam.pace_m_s;
      if (team == team_) {
        WishOfAttacker(view, team, slot, walker);
      } else {
        WishOfDefender(view, team, slot, walker);
      }
      walker.target_m = BesideGoals(WithinBoards(walker.target_m, 0.6));
    }
  }
  if (state_ == State::kFight) {
    // They stand around the ball, each where there is room.
    double turn = 0.6 * std::sin(1.3 * clock_secs_);
    if (!fighters_.empty()) {
      const Vector2d first = view.at(fighters_[0]).place_m - spot_m_;
      turn += std::atan2(first.y(), first.x());
    }
    std::vector<int> order = fighters_;
    const auto angle_of = [&](int player) {
      const Vector2d way = view.at(player).place_m - spot_m_;
      const double angle = std::atan2(way.y(), way.x()) - turn;
      return angle - 2 * std::numbers::pi * std::floor(angle / (2 * std::numbers::pi));
    };
    std::sort(order.begin() + (order.empty() ? 0 : 1), order.end(),
              [&](int a, int b) { return angle_of(a) < angle_of(b); });
    for (std::size_t i = 0; i < order.size(); ++i) {
      if (!view.Plays(order[i])) continue;
      const double angle =
          turn + 2 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(order.size());
      Walker& walker = view.at(order[i]);
      const double radius = 0.5 + 0.08 * std::sin(2.1 * clock_secs_ + static_cast<double>(i));
      walker.target_m =
          WithinBoards(spot_m_ + radius * Vector2d(std::cos(angle), std::sin(angle)), 0.4);
      walker.pace_m_s = 4;
      walker.crouch = 0.42;
    }
  }
}

void Play::WishOfAttacker(const View& view, int team, int slot, Walker& walker) {
  const int player =
      view.squads[static_cast<std::size_t>(team)].slots[static_cast<std::size_t>(slot)];
  const Vector2d ball = ball_m_.head<2>();
  const double dir = Direction(team);
  if (state_ == State::kFreeHit && view.Nearest(team, spot_m_)[0] == player) {
    walker.target_m = spot_m_ - Vector2d(0.8 * dir, 0);
    return;
  }
  if (state_ == State::kHeld && player == *holder_) {
    if (clock_secs_ > drive_until_secs_) {
      drive_until_secs_ = clock_secs_ + dice_.Uniform(0.8, 2);
      const Vector2d to_goal = Goal(1 - team) - walker.place_m;
      const double angle = std::atan2(to_goal.y(), to_goal.x()) + dice_.Uniform(-1.3, 1.3);
      drive_m_ = walker.place_m + dice_.Uniform(3, 7) * Vector2d(std::cos(angle), std::sin(angle));
      drive_m_.x() = std::clamp(drive_m_.x(), -15.0, 15.0);
    }
    walker.target_m = drive_m_;
    walker.look_at_m = drive_m_;
    walker.pace_m_s = 5.5;
    return;
  }
  if (state_ == State::kPassed && !stray_ && player == *holder_) {  // meets the ball
    walker.target_m = walker.place_m + 1.5 * (ball - walker.place_m).normalized();
    walker.pace_m_s = 3;
    return;
  }
  if (state_ == State::kLoose && view.Nearest(team, ball)[0] == player) {
    walker.target_m = ball;
    walker.pace_m_s = walker.fastest_m_s;
    return;
  }
  const auto& place = kFormation[static_cast<std::size_t>(slot)];
  const Roam& roam = roams_[static_cast<std::size_t>(team)][static_cast<std::size_t>(slot)];
  const double along = std::clamp(dir * ball.x() + place[0], -12.0, 13.5);
  walker.target_m = Vector2d(dir * along, dir * place[1] + 0.25 * ball.y()) + roam.offset_m;
}

void Play::WishOfDefender(const View& view, int team, int slot, Walker& walker) {
  const Squad& squad = view.squads[static_cast<std::size_t>(team)];
  const int player = squad.slots[static_cast<std::size_t>(slot)];
  const Vector2d ball = ball_m_.head<2>();
  const Vector2d goal = Goal(team);
  const std::vector<int> near = view.Nearest(team, ball);
  if (state_ == State::kLoose && near[0] == player) {
    walker.target_m = ball;
    walker.pace_m_s = walker.fastest_m_s;
    return;
  }
  if (state_ == State::kFreeHit && (near[0] == player || near[1] == player)) {
    // Two make a wall three metres off.
    const Vector2d to_goal = (goal - spot_m_).normalized();
    const Vector2d side(-to_goal.y(), to_goal.x());
    const double aside = near[0] == player ? 0.4 : -0.4;
    const bool swapped = (view.at(near[0]).place_m - view.at(near[1]).place_m).dot(side) < 0;
    walker.target_m = spot_m_ + 3 * to_goal + (swapped ? -aside : aside) * side;
    return;
  }
  if (state_ == State::kHeld && near[0] == player && !view.IsKeeper(*holder_)) {
    walker.target_m = ball + 0.6 * (goal - ball).normalized();
    walker.pace_m_s = 5.5;
    walker.crouch = 0.28;
    return;
  }
  const int opponent =
      view.squads[static_cast<std::size_t>(1 - team)].slots[static_cast<std::size_t>(Marked(slot))];
  const Vector2d marked = view.at(opponent).place_m;
  const Roam& roam = roams_[static_cast<std::size_t>(team)][static_cast<std::size_t>(slot)];
  walker.target_m = marked + 1.4 * (goal - marked).normalized() + 0.45 * roam.offset_m;
  walker.target_m.y() *= 0.92;
}

void Play::WishOfKeeper(int team, Walker& walker) const {
  const Vector2d ball = ball_m_.head<2>();
  const double far = (ball - Goal(team)).norm();
  const Vector2d out = Goal(team) + Vector2d(0.75 * Direction(team), 0);
  walker.target_m = out + Vector2d(0, std::clamp(0.09 * ball.y(), -0.45, 0.45));
  // Small corrections are not worth a step.
  if ((walker.target_m - walker.place_m).norm() < 0.2 && walker.velocity_m_s.norm() < 0.05) {
    walker.target_m = walker.place_m;
  }
  walker.pace_m_s = far < 9 ? 0.6 : 0.35;
  walker.look_at_m = ball;
  if (far < 20) walker.crouch = 0.9;  // on the knees, nearly
  if (far > 25) walker.crouch = 0.3;
  walker.arm_reach = walker.crouch > 0.5 ? 0.6 : 0.1;
}

}  // namespace vantage::simulation
