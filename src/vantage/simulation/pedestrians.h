// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "vantage/simulation/walkers.h"

/// Invented people who make way for each other: the social force model (D. Helbing and P. Molnar,
/// "Social force model for pedestrian dynamics", Physical Review E 51, 1995).

namespace vantage::simulation {

/// A place to go to, and what to do there.
struct Stop {
  Eigen::Vector2d ground_m = {0, 0};
  double stay_secs = 0;                                     ///< 0: walks past
  std::optional<Eigen::Vector2d> look_at_m = std::nullopt;  ///< while staying
};

struct Pedestrian {
  double enters_secs = 0;   ///< when they set out from the first stop; may be before the film
  double speed_m_s = 1.3;   ///< wished for
  std::vector<Stop> stops;  ///< at least two; they are gone from the last one on
};

/// What everybody walks around.
struct Pillar {
  Eigen::Vector2d center_m = {0, 0};
  double radius_m = 0.3;
};

/// Where each of them is in the frames 0 to frames - 1, in their order.
std::vector<Walk> Stroll(const std::vector<Pedestrian>& people, const std::vector<Pillar>& pillars,
                         double frames_per_second, FrameIndex frames);

}  // namespace vantage::simulation
