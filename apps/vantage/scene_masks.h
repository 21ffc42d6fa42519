// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

#include "vantage/base/file.h"
#include "vantage/base/ids.h"
#include "vantage/scene/scene.h"

namespace vantage::app {

/// Masks of all cameras of a scene in one folder: FOLDER/CAMERA/000000.png ...
class SceneMaskWriter {
 public:
  /// Fails when `folder` already holds files.
  static Result<SceneMaskWriter> Create(const Scene& scene, const std::filesystem::path& folder);

  /// One mask per camera; an empty one (no picture now) is left out.
  Status Write(FrameIndex frame, const std::vector<cv::Mat>& masks) const;

  /// Makes the folder appear under its name.
  Status Finish() { return folder_.Commit(); }

 private:
  SceneMaskWriter(StagedDirectory folder, std::vector<std::string> names)
      : folder_(std::move(folder)), names_(std::move(names)) {}
  StagedDirectory folder_;
  std::vector<std::string> names_;
};

/// Makes every camera of the scene read the masks of such a folder in place of its own source;
/// their numbers are the scene's frames. Or FOLDER/CAMERA/masks.mkv, begun at frame 0 of the scene.
Status UseMasks(Scene& scene, const std::filesystem::path& folder);

}  // namespace vantage::app
