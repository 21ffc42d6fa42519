// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "vantage/experiments/experiment.h"
#include "vantage/geometry/polygon.h"
#include "vantage/occupancy/peaks.h"
#include "vantage/rendering/people.h"

namespace vantage {

/// The area, its grid and its extension (the thesis's figure 13); maps with somebody outside the
/// area (14) and at the edge of a picture (15), at the frames where the rules differ most.
Experiment MapFiguresExperiment();

/// Detections inside the area to whom nobody belongs: each, the strongest first, takes the nearest
/// person within `distance_m` whom no other has taken. `people` are all, those outside too.
std::int64_t FalsePeaks(const std::vector<Peak>& peaks, const std::vector<Person>& people,
                        const Polygon& area, double distance_m = 1);

}  // namespace vantage
