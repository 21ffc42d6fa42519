// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/linking/alternatives.h"

#include <algorithm>
#include <limits>
#include <new>

#include "vantage/linking/residual_network.h"

namespace vantage {
namespace {

using linking::Cost;

double FromUnits(Cost cost) { return static_cast<double>(cost) / linking::kUnitsPerCost; }

/// The frames of `path` in the stretch, their cost, beginning and end included.
PathInStretch Within(const LinkedPath& path, const Stretch& stretch,
                     const linking::ResidualNetwork& network) {
  PathInStretch part;
  const std::int64_t path_end = path.end_frame();
  part.first_frame = std::max(path.first_frame, stretch.first_frame);
  const std::int64_t end = std::min(path_end, stretch.last_frame + 1);
  Cost cost = 0;
  for (std::int64_t frame = part.first_frame; frame < end; ++frame) {
    const CellIndex cell = path.cells[static_cast<std::size_t>(frame - path.first_frame)];
    cost += network.NodeCostAt(network.NodeAt(frame, cell));
    if (!part.cells.empty()) cost += network.MoveCost(part.cells.back(), cell);
    part.cells.push_back(cell);
  }
  if (part.first_frame == path.first_frame)
    cost += network.EntryCost(network.NodeAt(part.first_frame, part.cells.front()));
  if (end == path_end) cost += network.ExitCost(network.NodeAt(end - 1, part.cells.back()));
  part.cost = FromUnits(cost);
  return part;
}

/// The step of lowest margin of `path` among those that begin or end in the stretch. Only margins
/// below the lowest so far matter, so the search for each ends there.
std::optional<WeakStep> WeakestStep(const LinkedPath& path, const Stretch& stretch,
                                    std::int64_t first, std::int64_t last,
                                    linking::ResidualNetwork& network) {
  std::optional<WeakStep> weakest;
  Cost lowest = std::numeric_limits<Cost>::max() / 2;
  const std::int64_t begin = std::max({path.first_frame, stretch.first_frame - 1, first});
  const std::int64_t end = std::min({path.end_frame() - 1, stretch.last_frame + 1, last});
  for (std::int64_t frame = begin; frame < end; ++frame) {
    const auto step = static_cast<std::size_t>(frame - path.first_frame);
    const CellIndex from = path.cells[step];
    const CellIndex to = path.cells[step + 1];
    const std::optional<Cost> margin =
        network.MarginOfMove(network.NodeAt(frame, from), network.NodeAt(frame + 1, to), lowest);
    if (!margin) continue;
    lowest = *margin;
    weakest = WeakStep{.frame = frame, .from = from, .to = to, .margin = FromUnits(*margin)};
  }
  return weakest;
}

Result<Alternatives> Find(const LinkingProblem& problem, const LinkingOptions& options,
                          const std::vector<LinkedPath>& optimum, const Stretch& stretch,
                          const RunControl& control) {
  if (stretch.first_frame < 0 || stretch.first_frame > stretch.last_frame ||
      stretch.last_frame >= problem.frames || stretch.margin_frames < 0) {
    return Fail(
        "linking: the stretch from frame {} to {} with a margin of {} is not in a problem of {} "
        "frames",
        stretch.first_frame, stretch.last_frame, stretch.margin_frames, problem.frames);
  }
  const std::int64_t first =
      stretch.first_frame - std::min(stretch.margin_frames, stretch.first_frame);
  const std::int64_t last =
      stretch.last_frame + std::min(stretch.margin_frames, problem.frames - 1 - stretch.last_frame);
  VANTAGE_ASSIGN_OR_RETURN(
      linking::ResidualNetwork network,
      linking::ResidualNetwork::Create(problem, options, optimum, first, last, control));
  Alternatives alternatives;
  // Every residual cycle through a vertex of the stretch takes a move there back in time, or passes
  // source or sink: otherwise it would only go forward in time.
  Cost next_best = std::numeric_limits<Cost>::max() / 2;
  for (std::size_t i = 0; i < optimum.size(); ++i) {
    if (control.Stopped()) return Cancelled();
    const LinkedPath& path = optimum[i];
    if (path.first_frame > stretch.last_frame || path.end_frame() <= stretch.first_frame) {
      continue;
    }
    const auto weakest = WeakestStep(path, stretch, first, last, network);
    if (weakest) next_best = std::min(next_best, linking::ToUnits(weakest->margin));
    PathInStretch part = Within(path, stretch, network);
    part.path = i;
    part.weakest = weakest;
    alternatives.paths.push_back(std::move(part));
    control.Report(static_cast<std::int64_t>(i), std::ssize(optimum));
  }
  if (const auto cycle =
          network.CycleThroughEdgeAndFrames(stretch.first_frame, stretch.last_frame, next_best)) {
    next_best = *cycle;
  }
  if (next_best < std::numeric_limits<Cost>::max() / 2) {
    alternatives.next_best = FromUnits(next_best);
  }
  if (const auto walk = network.OneMorePath()) {
    alternatives.further = FurtherPath{.missing = FromUnits(walk->cost),
                                       .first_frame = walk->first_frame,
                                       .last_frame = walk->last_frame};
  }
  control.Report(std::ssize(optimum), std::ssize(optimum));
  return alternatives;
}

}  // namespace

Result<Alternatives> FindAlternatives(const LinkingProblem& problem, const LinkingOptions& options,
                                      const std::vector<LinkedPath>& optimum,
                                      const Stretch& stretch, const RunControl& control) {
  try {
    return Find(problem, options, optimum, stretch, control);
  } catch (const std::bad_alloc&) {
    return Fail("linking: not enough memory for alternatives of frames {} to {}; ask for fewer",
                stretch.first_frame, stretch.last_frame);
  }
}

}  // namespace vantage
