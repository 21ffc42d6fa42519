// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "vantage/base/ids.h"
#include "vantage/base/result.h"
#include "vantage/base/run_control.h"
#include "vantage/linking/linker.h"

/// How sure an optimal set of paths is: what other sets would have cost. Source: the cheapest
/// change of an optimal flow that takes a unit off an arc is a shortest cycle of the residual
/// network through that arc reversed (Ahuja, Magnanti, Orlin, "Network Flows", 1993, section 3.5
/// and theorem 9.1).

namespace vantage {

/// Frames of the problem, counted from 0, that are asked about.
struct Stretch {
  std::int64_t first_frame = 0;
  std::int64_t last_frame = 0;  ///< included
  /// Only changes from this many frames before the stretch to this many after it are looked at;
  /// whatever lies outside stays as it is in the optimum, paths that cross the bounds included.
  /// Costs of alternatives are exact for such changes, and thus never too low when changes farther
  /// away are allowed too; they are exact for the whole problem when it has no frames beyond.
  std::int64_t margin_frames = 0;
};

/// A step of a path that might as well have gone another way.
struct WeakStep {
  std::int64_t frame = 0;  ///< the step leads from this frame to the next
  CellIndex from = 0;
  CellIndex to = 0;
  /// What the cheapest solution without this step costs more than the optimum, >= 0.
  double margin = 0;
};

/// What a path does in the stretch.
struct PathInStretch {
  std::size_t path = 0;  ///< its number in the optimum
  std::int64_t first_frame = 0;
  std::vector<CellIndex> cells;
  /// Of its cells, of the steps between them and of beginning and ending, if they are in the
  /// stretch. A path that earns something has a cost below 0.
  double cost = 0;
  /// The step of lowest margin, the first of several, among those that begin or end in the stretch;
  /// none when every step is without an alternative (or there is no step).
  std::optional<WeakStep> weakest;
};

/// One further path, among the others.
struct FurtherPath {
  /// What the cheapest solution with one path more costs more than the optimum. Below 0 only where
  /// LinkingOptions::max_paths has forbidden a path that pays.
  double missing = 0;
  /// The frames in which that solution differs from the optimum.
  std::int64_t first_frame = 0;
  std::int64_t last_frame = 0;
};

struct Alternatives {
  /// What the cheapest solution that differs from the optimum in the stretch (in a cell, a step to
  /// or from a cell, a beginning or an end there) costs more; none when there is no other. 0: the
  /// optimum is not the only one.
  std::optional<double> next_best;
  /// Paths with a cell in the stretch, in the order of the optimum.
  std::vector<PathInStretch> paths;
  /// None when no further path fits between the others, within the margin.
  std::optional<FurtherPath> further;
};

/// `problem` and `options` as given to LinkPaths, `optimum` the paths of its answer. Memory grows
/// with the frames of stretch and margin, about 90 bytes a node. Fails on a stretch that is not in
/// the problem, and when `optimum` is not a solution of the problem, or not an optimal one.
Result<Alternatives> FindAlternatives(const LinkingProblem& problem, const LinkingOptions& options,
                                      const std::vector<LinkedPath>& optimum,
                                      const Stretch& stretch, const RunControl& control = {});

}  // namespace vantage
