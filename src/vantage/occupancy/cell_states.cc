// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/occupancy/cell_states.h"

#include <algorithm>
#include <cmath>

namespace vantage::internal {
namespace {

constexpr double kMinStep = 0.02;
constexpr double kMaxStep = 0.6;
constexpr double kShorter = 0.5;
constexpr double kLonger = 1.1;
/// A smaller distance to the new value has no direction.
constexpr double kAtRest = 1e-4;

}  // namespace

CellStates::CellStates(const OccupancyOptions& options, const std::vector<double>& priors)
    : adaptive_(options.damping == Damping::kAdaptive),
      step_(priors.size(), 1 - options.smoothing),
      direction_(adaptive_ ? priors.size() : 0, 0) {
  logit_prior_.reserve(priors.size());
  absence_.reserve(priors.size());
  for (const double prior : priors) {
    logit_prior_.push_back(std::log(prior / (1 - prior)));
    absence_.push_back(1 - prior);
  }
}

void CellStates::StartAt(std::size_t cell, double presence) {
  absence_[cell] = std::clamp(1 - presence, kMinAbsence, absence_[cell]);
}

double CellStates::Step(std::size_t cell, double score) {
  const double old = absence_[cell];
  const double way = 1 / (1 + std::exp(logit_prior_[cell] + score)) - old;
  if (adaptive_) {
    const int direction = std::abs(way) < kAtRest ? 0 : way > 0 ? 1 : -1;
    const int turn = direction * direction_[cell];
    if (turn < 0) step_[cell] = std::max(step_[cell] * kShorter, kMinStep);
    if (turn > 0) step_[cell] = std::min(step_[cell] * kLonger, kMaxStep);
    direction_[cell] = static_cast<signed char>(direction);
  }
  absence_[cell] = std::max(old + step_[cell] * way, kMinAbsence);
  return std::abs(absence_[cell] - old);
}

}  // namespace vantage::internal
