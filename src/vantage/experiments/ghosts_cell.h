// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include "vantage/experiments/experiment.h"

namespace vantage {

/// RunGhostExperiment on the sequences that are in the data folder as one cell, whose product
/// ghosts/ holds the four files of WriteGhostReport. Its part of the page is a table of F1 at the
/// defaults.
Experiment GhostsExperiment();

}  // namespace vantage
