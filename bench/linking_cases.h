// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "vantage/linking/test_scenes.h"
#include "vantage/metrics/clear_mot.h"
#include "vantage/occupancy/maps.h"
#include "vantage/tracks/track.h"

namespace vantage::bench {

/// Simulated scenes are taken to have cells of half a metre and 20 frames a second.
constexpr double kSceneCell_m = 0.5;
constexpr double kSceneFramesPerSecond = 20;

OccupancyMaps MapsOf(const testing::RecordedScene& scene);
/// `people` by frame.
Tracks TruthOf(const std::vector<std::vector<testing::ScenePerson>>& people);
/// On the whole grid; a match is nearer than 1 m.
TrackMeasures Evaluate(const Tracks& truth, const Tracks& results);

}  // namespace vantage::bench
