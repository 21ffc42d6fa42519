// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/identity/meetings.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace vantage {
namespace {

struct Distance {
  std::int64_t frame = 0;
  double metres = 0;
};

/// Distances of pairs of paths while they are below a limit, in ascending order of frames.
using PairDistances = std::map<std::pair<std::size_t, std::size_t>, std::vector<Distance>>;

PairDistances DistancesBelow(std::span<const LinkedPath> paths, const GroundGrid& grid,
                             double limit_m) {
  std::int64_t end = 0;
  for (const LinkedPath& path : paths) {
    end = std::max(end, path.end_frame());
  }
  struct Standing {
    int column = 0;
    int row = 0;
    std::size_t path = 0;
  };
  PairDistances distances;
  std::vector<Standing> people;
  std::vector<std::size_t> waiting(paths.size());  // by descending first frame
  for (std::size_t i = 0; i < paths.size(); ++i) waiting[i] = i;
  std::ranges::stable_sort(waiting, std::greater<>(),
                           [&](std::size_t i) { return paths[i].first_frame; });
  std::vector<std::size_t> present;
  for (std::int64_t frame = 0; frame < end; ++frame) {
    while (!waiting.empty() && paths[waiting.back()].first_frame <= frame) {
      present.push_back(waiting.back());
      waiting.pop_back();
    }
    people.clear();
    std::erase_if(present, [&](std::size_t i) { return paths[i].end_frame() <= frame; });
    for (const std::size_t i : present) {
      const CellIndex cell = paths[i].cells[static_cast<std::size_t>(frame - paths[i].first_frame)];
      people.push_back({.column = grid.Column(cell), .row = grid.Row(cell), .path = i});
    }
    std::ranges::sort(people, {}, [](const Standing& s) { return std::pair(s.column, s.path); });
    for (std::size_t i = 0; i < people.size(); ++i) {
      for (std::size_t j = i + 1; j < people.size(); ++j) {
        // From whole cells, so that equal distances are equal wherever on the grid they are.
        const double columns = people[j].column - people[i].column;
        const double rows = people[j].row - people[i].row;
        if (grid.cell_m * columns >= limit_m) break;
        const double metres = grid.cell_m * std::sqrt(columns * columns + rows * rows);
        if (metres >= limit_m) continue;
        distances[std::minmax({people[i].path, people[j].path})].push_back(
            {.frame = frame, .metres = metres});
      }
    }
  }
  return distances;
}

/// True when nothing within `apart_frames` of `at` is nearer.
bool IsNearest(std::span<const Distance> distances, std::size_t at, std::int64_t apart_frames) {
  const Distance& here = distances[at];
  for (std::size_t i = at; i-- > 0 && here.frame - distances[i].frame <= apart_frames;) {
    if (distances[i].metres < here.metres) return false;
  }
  for (std::size_t i = at + 1;
       i < distances.size() && distances[i].frame - here.frame <= apart_frames; ++i) {
    if (distances[i].metres < here.metres) return false;
  }
  return true;
}

}  // namespace

std::vector<Meeting> FindMeetings(std::span<const LinkedPath> paths, const GroundGrid& grid,
                                  double distance_m, std::int64_t apart_frames) {
  std::vector<Meeting> meetings;
  for (const auto& [pair, distances] : DistancesBelow(paths, grid, distance_m)) {
    const auto [first, second] = pair;
    const std::int64_t both = std::max(paths[first].first_frame, paths[second].first_frame);
    std::int64_t next = both + 1;  // no meeting before this frame
    for (std::size_t i = 0; i < distances.size(); ++i) {
      const std::int64_t frame = distances[i].frame;
      if (frame < next || !IsNearest(distances, i, apart_frames)) continue;
      meetings.push_back({.frame = frame, .first = first, .second = second});
      next = frame + apart_frames + 1;
    }
  }
  std::ranges::stable_sort(meetings, {}, &Meeting::frame);
  return meetings;
}

}  // namespace vantage
