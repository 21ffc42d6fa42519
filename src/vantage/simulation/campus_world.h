// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "vantage/simulation/dice.h"
#include "vantage/simulation/pedestrians.h"
#include "vantage/simulation/play.h"
#include "vantage/simulation/stage.h"
#include "vantage/simulation/walkers.h"

namespace vantage::simulation {

/// The campus of PETS 2009 as View 1 shows it (ground points back-projected from its picture):
/// lawns, roads with markings, a parking bay, brick houses, lamp post with its sign, the tripods
/// of the near cameras, cones with a tape; trees and lights. Adds what moves to the rehearsal.
void BuildCampus(Stage& stage, Rehearsal& rehearsal, double seconds, Dice& dice);

/// What people walk around, and where they come from unseen.
std::vector<Pillar> CampusPillars();
std::vector<Gate> CampusGates();

}  // namespace vantage::simulation
