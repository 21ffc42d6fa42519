// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "scene_masks.h"

#include <algorithm>
#include <optional>

#include "vantage/base/text.h"
#include "vantage/video/mask_writer.h"

namespace vantage::app {
namespace {

/// The number of the first mask in a folder of masks.
Result<FrameIndex> LowestNumber(const std::filesystem::path& folder) {
  std::error_code code;
  if (!std::filesystem::is_directory(folder, code)) {
    return Fail("{}: no such folder; masks are FOLDER/CAMERA/000000.png ...", folder.string());
  }
  std::optional<FrameIndex> lowest;
  for (const auto& entry : std::filesystem::directory_iterator(folder, code)) {
    const std::string stem = entry.path().stem().string();
    FrameIndex number = 0;
    if (!ParseNumber(stem, number)) continue;
    lowest = std::min(lowest.value_or(number), number);
  }
  if (!lowest) return Fail("{}: holds no masks named 000000.png ...", folder.string());
  return *lowest;
}

}  // namespace

Result<SceneMaskWriter> SceneMaskWriter::Create(const Scene& scene,
                                                const std::filesystem::path& folder) {
  VANTAGE_ASSIGN_OR_RETURN(StagedDirectory staged, StagedDirectory::Create(folder, false));
  std::vector<std::string> names;
  for (const SceneCamera& camera : scene.cameras) {
    std::error_code code;
    std::filesystem::create_directory(staged.temporary() / camera.name, code);
    if (code) {
      return Fail("{}: cannot be made: {}", (folder / camera.name).string(), code.message());
    }
    names.push_back(camera.name);
  }
  return SceneMaskWriter(std::move(staged), std::move(names));
}

Status SceneMaskWriter::Write(FrameIndex frame, const std::vector<cv::Mat>& masks) const {
  for (std::size_t camera = 0; camera < masks.size(); ++camera) {
    if (masks[camera].empty()) continue;
    VANTAGE_RETURN_IF_ERROR(WriteMask(folder_.temporary() / names_[camera], frame, masks[camera]));
  }
  return {};
}

Status UseMasks(Scene& scene, const std::filesystem::path& folder) {
  for (SceneCamera& camera : scene.cameras) {
    const std::filesystem::path masks = folder / camera.name;
    camera.source.kind = SourceSpec::Kind::kMasks;
    std::error_code code;
    if (std::filesystem::exists(masks / kMaskVideoName, code)) {
      camera.source.path = masks / kMaskVideoName;
      camera.source.offset_frames = 0;
      continue;
    }
    VANTAGE_ASSIGN_OR_RETURN(const FrameIndex first, LowestNumber(masks));
    camera.source.path = masks / "%06d.png";
    camera.source.offset_frames = -first;
  }
  return {};
}

}  // namespace vantage::app
