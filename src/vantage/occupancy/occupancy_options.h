// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "vantage/base/options.h"
#include "vantage/occupancy/views.h"

namespace vantage {

/// What the masks of one camera say of a person at a cell: r, the logarithm of how much likelier
/// they are with somebody there than without (see OccupancySolver).
enum class Evidence {
  kPerson,   ///< pixels counted in persons: what the person alone explains, by the person's size
  kPicture,  ///< the original POM program's: a share of the whole picture's difference
};

/// How the fixed point is computed.
enum class SolveMode {
  kFast,   ///< only cells that the foreground can raise, only pixels that they cover, float
  kExact,  ///< every cell and every pixel, double
};

/// How far a cell goes towards its new value in one iteration.
enum class Damping {
  kAdaptive,  ///< each cell for itself: less after it turned back, more while it goes on
  kFixed,     ///< always 1 - smoothing, as in the original POM program
};

/// Options of the occupancy maps (table [occupancy]).
struct OccupancyOptions {
  Evidence evidence = Evidence::kPerson;
  SolveMode mode = SolveMode::kFast;
  /// Probability that a cell is occupied before anything is seen, 0 < prior < 1.
  double prior = 0.003;
  /// Evidence "person": what a wholly seen person whom nobody else explains is worth in one camera,
  /// natural logarithm, 0 < worth <= 1000.
  double worth = 40;
  /// Evidence "person": what a background pixel inside a person counts against a foreground pixel,
  /// 0 <= background_cost <= 10. Below 1, for silhouettes do not fill their rectangles.
  double background_cost = 0.35;
  /// Evidence "picture": variance of the ratio between the pixels that a map explains wrongly and
  /// those that it covers, 1e-7 <= variance <= 10. Smaller: smaller people count, and noise too.
  double variance = 0.01;
  /// Evidence "picture": share of the picture that counts as covered whatever the map says,
  /// 1e-6 <= noise <= 1.
  double noise = 0.01;
  Damping damping = Damping::kAdaptive;
  /// Share of the old value that a cell keeps in an iteration (adaptive: in the first),
  /// 0 <= smoothing < 1.
  double smoothing = 0.7;
  /// Iterations at most, 1 <= max_iterations <= 100000.
  int max_iterations = 100;
  /// An iteration that changes no cell by this much is stable, 0 <= tolerance <= 1.
  double tolerance = 1e-3;
  /// Iterations in a row that must be stable before the end, 1 <= stable_iterations <= 1000.
  int stable_iterations = 3;
  /// Cells whose probability of absence is above this do not enter the expected picture,
  /// 0.9 <= ignored <= 1. 0.99 is what the original program uses for speed; 1 leaves out none.
  double ignored = 1.0;
  /// A frame begins at the map of the one before instead of at the prior. Faster, but then a map
  /// depends on all frames before it, and frames cannot be solved side by side.
  bool warm_start = false;
  /// Which cells a camera speaks for.
  Visibility visibility = Visibility::kContinuous;
  /// The sides of a mask are divided by this before use (exact area averages),
  /// 1 <= reduction <= 64; none: as AutomaticReduction says in the fast mode, 1 in the exact one.
  std::optional<double> reduction = std::nullopt;
};
void VisitOptions(OccupancyOptions& options, OptionVisitor& visitor);

/// The original POM program's evidence, iteration and defaults, computed exactly: its answers.
OccupancyOptions OriginalPomOptions();

}  // namespace vantage
