// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <gtest/gtest.h>

#include <opencv2/core.hpp>

#include "vantage/base/file.h"
#include "vantage/experiments/experiment.h"
#include "vantage/experiments/test_ghost_sequence.h"
#include "vantage/rendering/test_scene.h"
#include "vantage/scene/scene_text.h"
#include "vantage/video/mask_writer.h"
#include "vantage/video/video_writer.h"

/// For tests only: what a simulator would write, drawn.

namespace vantage::testing {

/// GhostSequence as a recording with true masks; each camera sees the same.
inline void WriteMaskRecording(const std::filesystem::path& folder, int cameras = 1,
                               int frames = GhostSequence::kFrames) {
  const ImageSize size{GhostSequence::kWidth, GhostSequence::kHeight};
  Scene scene = CornerScene(std::vector<ImageSize>(static_cast<std::size_t>(cameras), size));
  for (SceneCamera& camera : scene.cameras) {
    const std::string& name = camera.name;
    VideoWriter video = VideoWriter::Create(folder / (name + ".mp4"), size, 20).value();
    MaskWriter masks =
        MaskWriter::Create(folder / "truth/masks" / name, MaskFormat::kVideo, size, 20, true)
            .value();
    for (int frame = 0; frame < frames; ++frame) {
      ASSERT_TRUE(video.Write(GhostSequence::Picture(frame)));
      ASSERT_TRUE(masks.Write(frame, GhostSequence::Truth(frame)));
    }
    ASSERT_TRUE(video.Finish());
    ASSERT_TRUE(masks.Finish());
    camera.source.path = name + ".mp4";
  }
  ASSERT_TRUE(WriteTextFile(folder / "scene.toml", SceneText(scene).value()));
}

/// A study in `output` whose simulator draws. Recordings count into `recorded`.
inline Study DrawnStudy(const std::filesystem::path& output, int& recorded) {
  Study study;
  study.output = output;
  study.quick = true;
  study.threads = 2;
  study.record = [&recorded](const simulation::RecordOptions& options,
                             const std::filesystem::path& folder, int,
                             const RunControl&) -> Result<simulation::RecordReport> {
    ++recorded;
    const int frames = std::min<int>(GhostSequence::kFrames,
                                     static_cast<int>(options.stage.frames.value_or(1000)));
    WriteMaskRecording(folder, options.stage.cameras.value_or(1), frames);
    return simulation::RecordReport{};
  };
  return study;
}

}  // namespace vantage::testing
