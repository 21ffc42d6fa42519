// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "vantage/simulation/dice.h"
#include "vantage/simulation/play.h"
#include "vantage/simulation/stage.h"
#include "vantage/simulation/walkers.h"

namespace vantage::simulation {

/// First id of what is no person.
constexpr int kFirstThingId = 1000001;

/// Plants trees of heights in [low_m, high_m): wood into the world, leaves into the rehearsal with
/// ids from kFirstThingId on.
void AddTrees(Stage& stage, Rehearsal& rehearsal, const std::vector<Eigen::Vector2f>& places_m,
              double low_m, double high_m, int clusters, Dice& dice);

struct NumberedWalk {
  int id = 0;
  Walk walk;
};

/// Adds people who walk so, in clothes as the dice want.
void AddWalkers(Stage& stage, Rehearsal& rehearsal, const std::vector<NumberedWalk>& people,
                Dice& dice);

}  // namespace vantage::simulation
