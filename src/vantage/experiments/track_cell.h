// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "vantage/experiments/cell.h"
#include "vantage/experiments/track_recording.h"
#include "vantage/metrics/clear_mot.h"
#include "vantage/pipeline/track.h"

/// Cells of experiments on tracks: from a recording to measures.

namespace vantage {

/// One way to track.
struct TrackSetting {
  std::string name;      ///< for cells; together with the recording's unique
  StageOptions options;  ///< the defaults, but for what is compared
  /// In place of what the scene says.
  std::optional<double> cell_m = std::nullopt;
  std::optional<double> extension_m = std::nullopt;
  std::optional<PersonOptions> person = std::nullopt;
};

/// The defaults. On reduced pictures, lengths and areas that the background stage counts in pixels
/// are reduced with them: people would be cleaned away.
StageOptions DefaultsFor(const TrackRecording& recording);

/// The same with nobody held (HoldOptions::standing) and nobody told apart by colours
/// (IdentityOptions::appearance): the thesis knows neither, and masks made once, which have no
/// colours, serve several settings.
StageOptions PlainOptionsFor(const TrackRecording& recording);

/// Masks of all cameras of a recording, without the way back from the tracks, in masks/NAME-SETTING
/// of the working folder, a folder a camera, without loss.
CellPtr MasksCell(const TrackRecording& recording, const std::string& setting,
                  const BackgroundOptions& background);

/// Tracks of a recording, compared with the truth inside its area at 1 m. `masks`: made by
/// MasksCell; none: from the pictures. Its result:
///   every, sparse   measures at every frame with truth, and at every sparse_truth-th
///   tracks, frames, extension_m (four sides), person_m (width and height), seconds (by stage)
CellPtr TrackCell(const TrackRecording& recording, const TrackSetting& setting,
                  const CellPtr& masks = nullptr);

/// The scene of a recording with a setting's grid, and with masks in place of its pictures.
Result<Scene> SceneFor(const TrackRecording& recording, const TrackSetting& setting,
                       const CellPtr& masks, const std::filesystem::path& folder);

/// What a cell on this recording with this setting depends on.
nlohmann::ordered_json InputsOf(const TrackRecording& recording, const TrackSetting& setting,
                                bool from_masks);

nlohmann::ordered_json JsonOf(const TrackMeasures& measures);

/// A number of a result; NaN where it is null or absent.
double NumberAt(const nlohmann::ordered_json& json, const std::string& key);

}  // namespace vantage
