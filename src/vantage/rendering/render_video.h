// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "vantage/base/result.h"
#include "vantage/base/run_control.h"
#include "vantage/rendering/composition.h"
#include "vantage/scene/scene.h"
#include "vantage/tracks/track.h"
#include "vantage/video/multi_camera.h"

namespace vantage {

struct RenderReport {
  std::int64_t frames = 0;
  cv::Size size;  ///< of the video
  double seconds = 0;
};

/// Renders the scene's frames with the tracks on them into an MP4 at `output` (written whole or not
/// at all). `sources` belong to the scene's cameras in their order; their pictures may be scaled
/// against the calibration's, as a whole. They are not needed, and not read, when options.picture
/// is false: the frames then are those of the scene's frame_count, or up to the last one of a
/// track. Reads on at most `threads` threads.
Result<RenderReport> RenderVideo(const Scene& scene, const Tracks& tracks,
                                 std::vector<SyncedSource> sources,
                                 const std::filesystem::path& output, const RenderOptions& options,
                                 int threads, const RunControl& control = {});

}  // namespace vantage
