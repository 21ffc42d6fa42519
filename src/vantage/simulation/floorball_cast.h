// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "vantage/simulation/floorball_game.h"
#include "vantage/simulation/stage.h"

namespace vantage::simulation {

/// Clothes for everybody: dark blue against black shirts, shorts of all colours, so that players
/// look alike. Adds the materials; figures in the order of the people.
std::vector<Figure> DressPeople(const std::vector<FloorballGame::Person>& people,
                                std::uint64_t seed, Stage& stage);

}  // namespace vantage::simulation
