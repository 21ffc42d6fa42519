// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include "vantage/simulation/dice.h"
#include "vantage/simulation/play.h"
#include "vantage/simulation/stage.h"

namespace vantage::simulation {

/// The forecourt of an office, in metres from its middle, y away from the camera: the office's wall
/// along y = 12.5 with a door at x = -2.4 (people vanish behind it), a bench before it, parking
/// places, checks on the ground, and in front a tree and a sign that hide parts of people. Adds
/// swaying trees and the lights' courses (cloud, and the lamp over the door that is switched on).
void BuildForecourt(Stage& stage, Rehearsal& rehearsal, Dice& dice);

/// Where people sit down on the bench: to its left and right as the camera sees it.
const Eigen::Vector2d kBenchLeft = {-6.45, 8.55};
const Eigen::Vector2d kBenchRight = {-5.55, 8.55};

/// The bag and the car, about their own origins.
Shape BagShape(Stage& stage, Dice& dice);
Shape GhostCarShape(Stage& stage);

}  // namespace vantage::simulation
