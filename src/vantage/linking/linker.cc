// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/linking/linker.h"

#include <new>

#include "vantage/base/stopwatch.h"
#include "vantage/linking/flow_solver.h"
#include "vantage/linking/network.h"

namespace vantage {
namespace {

// Sums of costs stay exact in double precision, which the sweeps use: 2^29 nodes of 2^24 units, the
// cost at the default clip.
constexpr double kLargestSum = 0x1p53;

Status CheckSizes(const LinkingProblem& problem, const linking::Network& network) {
  if (problem.frames < 0) {
    return Fail("linking: there are {} frames; there must be at least 0", problem.frames);
  }
  const double nodes = static_cast<double>(problem.frames) * static_cast<double>(network.cells());
  if (nodes * network.node_cost.largest() > kLargestSum) {
    return Fail(
        "linking: {} frames of {} x {} cells are more than can be linked at once; link a shorter "
        "stretch, use larger cells, or link as a stream",
        problem.frames, problem.columns, problem.rows);
  }
  if (problem.probability.size() != static_cast<std::size_t>(problem.frames) * network.cells()) {
    return Fail("linking: probability has {} values; it must have {}", problem.probability.size(),
                static_cast<std::size_t>(problem.frames) * network.cells());
  }
  return {};
}

Result<LinkingResult> Link(const LinkingProblem& problem, const LinkingOptions& options,
                           const RunControl& control) {
  VANTAGE_ASSIGN_OR_RETURN(const linking::Network network,
                           linking::MakeNetwork(linking::GridOf(problem), options));
  VANTAGE_RETURN_IF_ERROR(CheckSizes(problem, network));
  linking::FlowSolver solver(network);
  for (std::int64_t frame = 0; frame < problem.frames; ++frame) {
    const std::span<const float> map = problem.probability.subspan(
        static_cast<std::size_t>(frame) * network.cells(), network.cells());
    VANTAGE_RETURN_IF_ERROR(linking::CheckFrame(network, map, frame));
    solver.AddFrame(map);
  }
  if (!solver.Settle(control)) return Cancelled();
  if (options.max_paths > 0 && !solver.KeepAtMost(options.max_paths, control)) return Cancelled();
  LinkingResult result;
  result.paths = solver.Paths();
  result.report.cost = static_cast<double>(solver.TotalCost()) / linking::kUnitsPerCost;
  result.report.paths = std::ssize(result.paths);
  result.report.nodes = problem.frames * static_cast<std::int64_t>(network.cells());
  return result;
}

}  // namespace

void VisitOptions(LinkingOptions& options, OptionVisitor& visitor) {
  visitor.Number({"max_speed", "m/s", "Speed that a person may have"}, options.max_speed_mps,
                 Range::AboveUpTo(0, 1000));
  visitor.NumberOr({"depth", "cells",
                    "Cells that a person may move per frame, rows and columns alike, in place of "
                    "max_speed"},
                   options.depth, "none", Range::Between(0, 10));
  visitor.Number({"birth_cost", "", "A path is added only while it earns more than this"},
                 options.birth_cost, Range::Between(0, 1e6));
  visitor.Number({"clip", "", "Probabilities are clipped to [clip, 1 - clip]"}, options.clip,
                 Range::Inside(0, 0.5));
  visitor.Number(
      {"movement_cost", "", "Cost of moving at max_speed, or by depth; in proportion below"},
      options.movement_cost, Range::Between(0, 1000));
  visitor.NumberOr({"inside_cost", "",
                    "Cost of a path's beginning, and of its end, where people may not appear or "
                    "vanish; auto: 45 for streams, never for recordings"},
                   options.inside_cost, "auto", Range::Between(0, 1e6));
  visitor.Number({"max_paths", "", "At most this many paths; 0: any number"}, options.max_paths,
                 Range::AtLeast(0));
  visitor.Choice({"access", "", "Where people may appear and vanish, besides doors"},
                 options.access,
                 {{"border", AccessRule::kBorder},
                  {"anywhere", AccessRule::kAnywhere},
                  {"doors", AccessRule::kDoors}});
}

Result<LinkingResult> LinkPaths(const LinkingProblem& problem, const LinkingOptions& options,
                                const RunControl& control) {
  const Stopwatch stopwatch;
  try {
    Result<LinkingResult> result = Link(problem, options, control);
    if (result) result->report.seconds = stopwatch.Seconds();
    return result;
  } catch (const std::bad_alloc&) {
    return Fail("linking: not enough memory for {} frames of {} x {} cells; link a shorter stretch",
                problem.frames, problem.columns, problem.rows);
  }
}

}  // namespace vantage
