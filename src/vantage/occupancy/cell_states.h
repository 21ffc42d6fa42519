// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <vector>

#include "vantage/occupancy/occupancy_options.h"

namespace vantage::internal {

/// The probabilities of absence, n, of some cells on their way to the fixed point.
///
/// Every cell moves towards its new value at once, and cells that explain the same pixels overshoot
/// together: where evidence is strong the plain iteration swings for ever between "both" and
/// "neither". With adaptive damping a cell that turns back halves its step, and one that goes on
/// lengthens it by a tenth (the sign rule of M. Riedmiller and H. Braun, "A Direct Adaptive Method
/// for Faster Backpropagation Learning: The RPROP Algorithm", ICNN 1993): the swinging dies out
/// where it is, and all others arrive sooner. The fixed points stay the same.
class CellStates {
 public:
  /// Absence never falls below this: its logarithm and its inverse stay within what double sums of
  /// a picture resolve.
  static constexpr double kMinAbsence = 1e-10;

  /// `priors`: probability of presence of each cell, strictly between 0 and 1.
  CellStates(const OccupancyOptions& options, const std::vector<double>& priors);

  /// Begins at this probability of presence instead of at the prior.
  void StartAt(std::size_t cell, double presence);

  std::size_t size() const { return absence_.size(); }
  double absence(std::size_t cell) const { return absence_[cell]; }

  /// One iteration of a cell: `score` is the sum over the cameras of r. Returns |change of n|.
  double Step(std::size_t cell, double score);

 private:
  bool adaptive_;
  std::vector<double> logit_prior_;
  std::vector<double> absence_;
  std::vector<double> step_;
  std::vector<signed char> direction_;  // of the last change: -1, 0, 1
};

/// Tells when the iteration may end.
class Convergence {
 public:
  explicit Convergence(const OccupancyOptions& options)
      : tolerance_(options.tolerance), needed_(options.stable_iterations) {}

  /// After an iteration whose largest change this was.
  void Add(double change) { stable_ = change < tolerance_ ? stable_ + 1 : 0; }
  bool reached() const { return stable_ >= needed_; }

 private:
  double tolerance_;
  int needed_;
  int stable_ = 0;
};

}  // namespace vantage::internal
