// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <vector>

#include "command.h"
#include "vantage/geometry/polygon.h"
#include "vantage/linking/linker.h"
#include "vantage/linking/track_builder.h"

namespace vantage::app {

struct LinkStreamJob {
  std::filesystem::path maps, output;
  double lag_secs = 0;
  bool gap = false;  ///< link the whole recording too, and report how far the stream is from it
  LinkingOptions linking;
  TrackOptions tracks;
  std::vector<Polygon> doors, obstacles;
  std::vector<Eigen::Vector2d> entrances_m;
};

/// `vantage link --lag`: reads one map after another, writes positions as they become final, and
/// prints the report.
Status LinkStream(LinkStreamJob job, const CommonFlags& common);

}  // namespace vantage::app
