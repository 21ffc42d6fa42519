// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <vector>

#include "vantage/simulation/floorball_walkers.h"

namespace vantage::simulation {

/// Where the goals' lines are, and the players of one side by index among the walkers.
inline constexpr double kGoalLine_m = 16.5;

struct Squad {
  int keeper = 0;
  /// Two defenders, the centre, two forwards.
  std::array<int, 5> slots = {};
  /// A player on the way to the bench no longer takes part: index among the walkers, or none.
  std::optional<int> leaving;
};

/// The game: who has the ball, where it goes, and what everybody on the field wants to do about it.
/// Team 0 plays towards +x.
class Play {
 public:
  explicit Play(std::uint64_t seed);

  /// Sets the wishes of keepers and players in the rink and moves the ball.
  void Step(std::vector<Walker>& walkers, const std::array<Squad, 2>& squads, double seconds);

  const Eigen::Vector3d& ball_m() const { return ball_m_; }
  /// Index of the player who has the ball or is about to get it.
  std::optional<int> holder() const { return holder_; }
  /// Begins the game: the free hit has been set up.
  void Whistle();

 private:
  enum class State { kFreeHit, kHeld, kPassed, kLoose, kFight };

  struct View;  // walkers and squads of one step
  void MoveBall(const View& view, double seconds);
  void Decide(const View& view, double seconds);
  void HoldBy(int player, double secs);
  void Pass(const View& view);
  void StartFight(const View& view);
  void EndFight(const View& view);
  void SetWishes(const View& view);
  void WishOfAttacker(const View& view, int team, int slot, Walker& walker);
  void WishOfDefender(const View& view, int team, int slot, Walker& walker);
  void WishOfKeeper(int team, Walker& walker) const;

  Dice dice_;
  double clock_secs_ = 0;
  State state_ = State::kFreeHit;
  double until_secs_ = 1e9;  // end of the free hit, the hold or the fight
  int team_ = 0;             // that attacks
  std::optional<int> holder_;
  std::vector<int> fighters_;
  Eigen::Vector3d ball_m_ = {2, -3, 0.036};
  Eigen::Vector2d spot_m_ = {2, -3};  // of the free hit, the fight, or where a pass goes
  double ball_speed_m_s_ = 0;
  bool stray_ = false;                // a pass that reaches nobody
  Eigen::Vector2d drive_m_ = {0, 0};  // where the holder runs
  double drive_until_secs_ = 0;
  // Everyone on the field keeps changing place around where the formation wants them.
  struct Roam {
    Eigen::Vector2d offset_m = {0, 0};
    double until_secs = 0;
    double pace_m_s = 3;
  };
  std::array<std::array<Roam, 5>, 2> roams_;
};

}  // namespace vantage::simulation
