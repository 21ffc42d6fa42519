// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/linking/linker.h"

#include <new>

#include "vantage/base/stopwatch.h"
#include "vantage/linking/flow_solver.h"
#include "vantage/linking/layered_graph.h"

namespace vantage {
namespace {

Result<LinkingResult> Link(const LinkingProblem& problem, const LinkingOptions& options,
                           const RunControl& control) {
  VANTAGE_ASSIGN_OR_RETURN(const linking::LayeredGraph graph,
                           linking::MakeLayeredGraph(problem, options));
  linking::FlowSolver solver(graph);
  if (!solver.Solve(control)) return Cancelled();
  if (options.max_paths > 0 && !solver.KeepAtMost(options.max_paths, control)) return Cancelled();
  LinkingResult result;
  result.paths = solver.Paths();
  result.report.cost = static_cast<double>(solver.TotalCost()) / linking::kUnitsPerCost;
  result.report.paths = std::ssize(result.paths);
  result.report.nodes = graph.node_count();
  return result;
}

}  // namespace

void VisitOptions(LinkingOptions& options, OptionVisitor& visitor) {
  visitor.Number({"depth", "cells", "Cells that a person may move per frame"}, options.depth,
                 Range::Between(0, 10));
  visitor.NumberOr({"max_speed", "m/s", "Speed that a person may have, in place of depth"},
                   options.max_speed_mps, "none", Range::AboveUpTo(0, 1000));
  visitor.Number({"birth_cost", "", "A path is added only while it earns more than this"},
                 options.birth_cost, Range::Between(0, 1e6));
  visitor.Number({"clip", "", "Probabilities are clipped to [clip, 1 - clip]"}, options.clip,
                 Range::Inside(0, 0.5));
  visitor.Number({"movement_cost", "1/cell", "Cost of a move per cell of distance"},
                 options.movement_cost, Range::Between(0, 1000));
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
