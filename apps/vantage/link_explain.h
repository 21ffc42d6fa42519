// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "command.h"
#include "vantage/base/file.h"
#include "vantage/linking/alternatives.h"
#include "vantage/linking/link_maps.h"
#include "vantage/scene/scene.h"

namespace vantage::app {

/// Frames "A:B" of a recording, both included.
struct FrameRange {
  FrameIndex first = 0;
  FrameIndex last = 0;
};

/// Empty when `text` is a range A:B with 0 <= A <= B, else what is wrong.
std::string ParseFrameRange(const std::string& text, FrameRange& range);

/// What the paths of `vantage link` were found from.
struct LinkedMaps {
  const Scene& scene;  ///< without an area when no scene was given
  const OccupancyMaps& maps;
  const LinkingOptions& linking;
  const TrackOptions& tracks;
  const std::vector<LinkedPath>& paths;
};

/// `vantage link --explain DIR --frames A:B`: a folder of pictures and figures of a stretch of
/// time, which appears whole or not at all.
class LinkExplanation {
 public:
  /// Fails when the folder cannot be made or holds something already.
  static Result<LinkExplanation> Create(const std::filesystem::path& folder,
                                        const FrameRange& range);

  /// Fails when the maps do not have the frames: call it before the work.
  Status CheckFrames(const OccupancyMaps& maps) const;

  /// Draws and writes everything and puts the folder in its place.
  Status Finish(const LinkedMaps& linked, const RunControl& control);

  /// After Finish: what was found, as explanation.json has it.
  const nlohmann::ordered_json& json() const { return json_; }
  /// A row for the stretch and one for each path.
  const std::vector<ReportRow>& rows() const { return rows_; }

 private:
  LinkExplanation(StagedDirectory folder, const FrameRange& range)
      : folder_(std::move(folder)), range_(range) {}
  void Record(const LinkedMaps& linked, const Stretch& stretch, const Alternatives& alternatives);

  StagedDirectory folder_;
  FrameRange range_;
  nlohmann::ordered_json json_;
  std::vector<ReportRow> rows_;
};

}  // namespace vantage::app
