// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "vantage/simulation/stage.h"

/// The hall of the floorball preset: floor, lines, boards, goals, benches, walls and lamps.

namespace vantage::simulation {

inline constexpr double kHallHalfLength_m = 24, kHallHalfWidth_m = 14;

/// Adds to the stage's materials.
MaterialIndex AddMaterial(Stage& stage, const Material& material);

/// Adds what never moves, and the lamps.
void BuildHall(Stage& stage);

/// A board on the wall whose picture changes, and a curtain that sways: scenery that moves.
class HallScenery {
 public:
  /// Adds the materials.
  explicit HallScenery(Stage& stage);
  Thing Board(int id, double secs) const;
  Thing Curtain(int id, double secs) const;

 private:
  std::vector<MaterialIndex> pictures_;
  MaterialIndex cloth_ = 0;
};

}  // namespace vantage::simulation
