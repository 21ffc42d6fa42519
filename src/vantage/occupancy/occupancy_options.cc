// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/occupancy/occupancy_options.h"

namespace vantage {

void VisitOptions(OccupancyOptions& o, OptionVisitor& v) {
  v.Choice({"evidence", "", "what pixels are counted in: person, or picture as the POM program"},
           o.evidence, {{"person", Evidence::kPerson}, {"picture", Evidence::kPicture}});
  v.Choice({"mode", "", "fast, or exact: every cell and pixel in double precision"}, o.mode,
           {{"fast", SolveMode::kFast}, {"exact", SolveMode::kExact}});
  v.Number({"prior", "", "probability that a cell is occupied before anything is seen"}, o.prior,
           Range::Inside(0, 1));
  v.Number({"worth", "", "evidence person: log-likelihood of a wholly seen person in a camera"},
           o.worth, Range::AboveUpTo(0, 1000));
  v.Number({"background_cost", "", "evidence person: what a background pixel in a person counts"},
           o.background_cost, Range::Between(0, 10));
  v.Number({"variance", "", "evidence picture: variance of the share explained wrongly"},
           o.variance, Range::Between(1e-7, 10));
  v.Number({"noise", "", "evidence picture: share of the picture that counts as covered"}, o.noise,
           Range::Between(1e-6, 1));
  v.Choice({"damping", "", "step of a cell in an iteration: adaptive, or fixed by smoothing"},
           o.damping, {{"adaptive", Damping::kAdaptive}, {"fixed", Damping::kFixed}});
  v.Number({"smoothing", "", "share of its old value that a cell keeps in an iteration"},
           o.smoothing, {.low = 0, .high = 1, .high_open = true});
  v.Number({"max_iterations", "", "iterations at most"}, o.max_iterations,
           Range::Between(1, 100000));
  v.Number({"tolerance", "", "an iteration that changes no cell by this much is stable"},
           o.tolerance, Range::Between(0, 1));
  v.Number({"stable_iterations", "", "stable iterations in a row before the end"},
           o.stable_iterations, Range::Between(1, 1000));
  v.Number({"ignored", "", "cells with a greater probability of absence are left out"}, o.ignored,
           Range::Between(0.9, 1));
  v.Flag({"warm_start", "", "begin a frame at the map of the one before"}, o.warm_start);
  v.Choice(
      {"visibility", "", "which cells a camera speaks for: ground, complete, centre or continuous"},
      o.visibility,
      {{"ground", Visibility::kGround},
       {"complete", Visibility::kComplete},
       {"centre", Visibility::kCentre},
       {"continuous", Visibility::kContinuous}});
  v.NumberOr({"reduction", "", "the sides of a mask are divided by this before use"}, o.reduction,
             "auto", Range::Between(1, 64));
}

OccupancyOptions OriginalPomOptions() {
  OccupancyOptions options;
  options.evidence = Evidence::kPicture;
  options.mode = SolveMode::kExact;
  options.prior = 0.01;
  options.damping = Damping::kFixed;
  options.smoothing = 0.8;
  options.tolerance = 1e-4;
  options.stable_iterations = 5;
  return options;
}

}  // namespace vantage
