// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "bench/linking_cases.h"

#include <cstddef>
#include <map>
#include <utility>

namespace vantage::bench {

OccupancyMaps MapsOf(const testing::RecordedScene& scene) {
  OccupancyMaps maps;
  maps.grid = {.min_x_m = 0,
               .min_y_m = 0,
               .cell_m = kSceneCell_m,
               .columns = scene.options.columns,
               .rows = scene.options.rows};
  maps.frames_per_second = kSceneFramesPerSecond;
  maps.in_area.assign(scene.access.size(), 1);
  maps.visible.assign(scene.access.size(), 1);
  maps.values = scene.probability;
  return maps;
}

Tracks TruthOf(const std::vector<std::vector<testing::ScenePerson>>& people) {
  std::map<TrackId, Track> by_id;
  for (std::size_t frame = 0; frame < people.size(); ++frame) {
    for (const testing::ScenePerson& person : people[frame]) {
      Track& track = by_id[TrackId{person.id + 1}];
      track.id = TrackId{person.id + 1};
      track.points.push_back({.frame = static_cast<FrameIndex>(frame),
                              .x_m = person.column * kSceneCell_m,
                              .y_m = person.row * kSceneCell_m});
    }
  }
  Tracks tracks;
  for (auto& [id, track] : by_id) tracks.push_back(std::move(track));
  return tracks;
}

TrackMeasures Evaluate(const Tracks& truth, const Tracks& results) {
  return EvaluateTracks(truth, results, {.threshold_m = 1}).value();
}

}  // namespace vantage::bench
