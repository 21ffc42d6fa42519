// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "vantage/base/ids.h"
#include "vantage/base/options.h"
#include "vantage/base/result.h"
#include "vantage/base/run_control.h"

namespace vantage {

/// Where people may appear and vanish at every frame (doors always count besides).
enum class AccessRule {
  kBorder,    ///< seen cells on the border of the grid or beside a cell that no camera sees
  kAnywhere,  ///< every cell
  kDoors,     ///< nowhere else
};

/// Options of the linking stage (algorithms.md section 4; Berclaz et al. 2011).
struct LinkingOptions {
  /// Metres per second that a person may move at most, > 0: a fast sprint. Steps to all cells whose
  /// centre is as near as that in one frame, always to the 8 neighbours, and never more than 10
  /// cells along the axes.
  double max_speed_mps = 7;
  /// In place of max_speed, which then counts for nothing: cells that a person may move per frame,
  /// Chebyshev distance, 0 <= depth <= 10.
  std::optional<int> depth = std::nullopt;
  /// A path is added only while it earns more than this, >= 0: the total cost of the optimum counts
  /// birth_cost for each path.
  double birth_cost = 45;
  /// Probabilities are clipped to [clip, 1 - clip], 0 < clip < 0.5, before the cost
  /// -log(p / (1 - p)).
  double clip = 1e-6;
  /// Cost of moving as far in one frame as max_speed (or depth, along an axis) allows, >= 0; of
  /// shorter moves as much less as they are shorter. People who meet keep to their own, shorter
  /// ways; 0, as in the paper, leaves identities to chance there. In proportion to speed it means
  /// the same at every frame rate and size of cells: who is surely seen earns -log(clip) in every
  /// frame, about 14, and even at full speed pays less. Chosen on simulated floorball (20 frames
  /// per second), where of 2 to 8 the larger gave fewer switches, and PETS 2009 S2.L1 (View_001's
  /// video, boxes of seven views, and the simulated campus; 7 per second), where 4 to 20 differ by
  /// chance and 33 loses people; no recording was held out.
  double movement_cost = 7;
  /// What it costs a path, >= 0, to begin where people may not appear, and again to end where they
  /// may not vanish (see access). None: it cannot be for recordings; for streams 45 (a cost of
  /// kInsideCostOfStreams), since whoever cannot be told near an entrance in time would be lost
  /// until near the next. Chosen on PETS 2009 S2.L1 and a simulated hall.
  std::optional<double> inside_cost = std::nullopt;
  /// At most this many paths, >= 0; 0 means any number.
  int max_paths = 0;
  /// Where paths may begin and end; LinkPaths itself takes the cells as part of the problem.
  AccessRule access = AccessRule::kBorder;
};
void VisitOptions(LinkingOptions& options, OptionVisitor& visitor);

/// The layered graph, given by its maps. All spans are row-major, cell = column + row * columns.
struct LinkingProblem {
  int columns = 0;
  int rows = 0;
  std::int64_t frames = 0;
  /// frames * columns * rows probabilities in [0, 1].
  std::span<const float> probability;
  /// columns * rows; non-zero: people may appear and vanish here at every frame. In the first
  /// frame every cell is an entrance and in the last every cell is an exit.
  std::span<const std::uint8_t> access;
  /// columns * rows, or empty; non-zero: nobody can stand here.
  std::span<const std::uint8_t> obstacle;
  /// Side of a cell and frame rate, > 0; needed unless LinkingOptions::depth is given.
  double cell_m = 0;
  double frames_per_second = 0;
};

/// One path: a cell for each frame from first_frame on.
struct LinkedPath {
  std::int64_t first_frame = 0;
  std::vector<CellIndex> cells;

  /// The frame after its last one.
  std::int64_t end_frame() const { return first_frame + static_cast<std::int64_t>(cells.size()); }
  friend bool operator==(const LinkedPath&, const LinkedPath&) = default;
};

struct LinkingReport {
  /// Sum of the paths' costs, birth costs included; the minimum over all sets of disjoint paths.
  double cost = 0;
  std::int64_t paths = 0;
  std::int64_t nodes = 0;
  double seconds = 0;
};

struct LinkingResult {
  /// Node-disjoint; ordered by first frame, then by first cell.
  std::vector<LinkedPath> paths;
  LinkingReport report;
};

/// Finds the set of node-disjoint paths with the smallest total cost: the exact global optimum.
/// Equal inputs give equal paths on every machine (costs are integers inside, a unit being 2^-20).
/// Fails on options out of range, sizes that do not fit, and probabilities that are NaN or outside
/// [0, 1].
Result<LinkingResult> LinkPaths(const LinkingProblem& problem, const LinkingOptions& options,
                                const RunControl& control = {});

}  // namespace vantage
