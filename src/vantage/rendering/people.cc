// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/rendering/people.h"

#include <algorithm>
#include <cmath>

namespace vantage {

std::vector<Person> PeopleAt(const Tracks& tracks, FrameIndex frame, FrameIndex trail_frames) {
  std::vector<Person> people;
  for (const Track& track : tracks) {
    if (track.points.empty() || track.points.front().frame > frame ||
        track.points.back().frame < frame) {
      continue;
    }
    const auto now = std::lower_bound(
        track.points.begin(), track.points.end(), frame,
        [](const TrackPoint& point, FrameIndex wanted) { return point.frame < wanted; });
    if (now->frame != frame || !std::isfinite(now->x_m) || !std::isfinite(now->y_m)) continue;
    Person person{track.id, {now->x_m, now->y_m}, now->inferred, {}};
    auto point = now;
    while (point != track.points.begin() && std::prev(point)->frame >= frame - trail_frames)
      --point;
    for (; point <= now; ++point) {
      if (!std::isfinite(point->x_m) || !std::isfinite(point->y_m)) continue;
      const double age = trail_frames > 0 ? static_cast<double>(frame - point->frame) /
                                                static_cast<double>(trail_frames)
                                          : 0;
      person.trail.push_back({{point->x_m, point->y_m}, age});
    }
    people.push_back(std::move(person));
  }
  return people;
}

}  // namespace vantage
