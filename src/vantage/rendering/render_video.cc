// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/rendering/render_video.h"

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <optional>
#include <utility>

#include "vantage/base/stopwatch.h"
#include "vantage/video/video_writer.h"

namespace vantage {
namespace {

Status CheckSources(const Scene& scene, const std::vector<SyncedSource>& sources) {
  if (sources.size() != scene.cameras.size()) {
    return Fail("rendering: {} sources for the {} cameras of {}; each camera has one",
                sources.size(), scene.cameras.size(), scene.name);
  }
  for (std::size_t i = 0; i < sources.size(); ++i) {
    const SourceInfo& info = sources[i].source->info();
    const ImageSize size = scene.cameras[i].camera.size();
    const double proportion = static_cast<double>(info.size.width) / info.size.height /
                              (static_cast<double>(size.width) / size.height);
    if (std::abs(proportion - 1) > 0.02) {
      return Fail(
          "{}: its pictures are {} x {} px, camera {} is calibrated for {} x {} px; the "
          "proportions must be the same",
          info.name, info.size.width, info.size.height, scene.cameras[i].name, size.width,
          size.height);
    }
  }
  return {};
}

/// Frames to render, where known: those that the scene names, up to the end of the sources or,
/// without sources, of the tracks.
std::optional<std::int64_t> FrameCount(const Scene& scene, const Tracks& tracks,
                                       const std::optional<MultiCameraReader>& reader) {
  if (reader) {
    const auto available = reader->frame_count();
    if (!available || !scene.frame_count) return available ? available : scene.frame_count;
    return std::min(*available, *scene.frame_count);
  }
  if (scene.frame_count) return scene.frame_count;
  std::int64_t count = 0;
  for (const Track& track : tracks) {
    if (track.points.empty()) continue;
    count = std::max(count, track.points.back().frame + 1 - scene.first_frame);
  }
  return count;
}

Result<RenderReport> Render(const Scene& scene, const Tracks& tracks,
                            std::vector<SyncedSource> sources, const std::filesystem::path& output,
                            const RenderOptions& options, int threads, const RunControl& control) {
  const Stopwatch stopwatch;
  std::optional<MultiCameraReader> reader;
  if (options.picture) {
    VANTAGE_RETURN_IF_ERROR(CheckSources(scene, sources));
    VANTAGE_ASSIGN_OR_RETURN(reader,
                             MultiCameraReader::Create(std::move(sources), scene.first_frame));
  }
  const std::optional<std::int64_t> count = FrameCount(scene, tracks, reader);
  const Composition composition(scene, options);
  RenderReport report{.size = composition.size()};
  VANTAGE_ASSIGN_OR_RETURN(VideoWriter writer,
                           VideoWriter::Create(output, {report.size.width, report.size.height},
                                               scene.frames_per_second));
  std::vector<cv::Mat> pictures;
  while (!count || report.frames < *count) {
    if (control.Stopped()) return Cancelled();
    if (reader) {
      VANTAGE_ASSIGN_OR_RETURN(const bool read, reader->Read(pictures, threads));
      if (!read) break;
    }
    const FrameIndex frame = scene.first_frame + report.frames;
    VANTAGE_RETURN_IF_ERROR(writer.Write(composition.Draw(tracks, frame, pictures)));
    control.Report(++report.frames, count.value_or(0));
  }
  if (report.frames == 0) {
    return Fail("{}: no frame to render from frame {} on", scene.name, scene.first_frame);
  }
  VANTAGE_RETURN_IF_ERROR(writer.Finish());
  report.seconds = stopwatch.Seconds();
  return report;
}

}  // namespace

Result<RenderReport> RenderVideo(const Scene& scene, const Tracks& tracks,
                                 std::vector<SyncedSource> sources,
                                 const std::filesystem::path& output, const RenderOptions& options,
                                 int threads, const RunControl& control) {
  VANTAGE_RETURN_IF_ERROR(ValidateOptions(options, "render"));
  try {
    return Render(scene, tracks, std::move(sources), output, options, threads, control);
  } catch (const cv::Exception& error) {
    return Fail("{}: cannot be rendered: {}", scene.name, error.err);
  }
}

}  // namespace vantage
