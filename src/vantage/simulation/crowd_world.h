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

/// A paved square between four buildings around WILDTRACK's area, with trees, benches and a board
/// with changing pictures. Adds what moves to the rehearsal.
void BuildSquare(Stage& stage, Rehearsal& rehearsal, double seconds, Dice& dice);

/// What people walk around, and the doors of the buildings, through which they come and go.
std::vector<Pillar> SquarePillars();
std::vector<Gate> SquareGates();

}  // namespace vantage::simulation
