// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/video/multi_camera.h"

#include <algorithm>
#include <utility>

#include "vantage/base/parallel.h"

namespace vantage {

Result<MultiCameraReader> MultiCameraReader::Create(std::vector<SyncedSource> sources,
                                                    std::int64_t first_frame) {
  // Far beyond any recording, and sums of two of them cannot overflow.
  constexpr std::int64_t kMaxFrames = 1'000'000'000;
  if (sources.empty()) return Fail("there is no camera to read; at least one is needed");
  if (first_frame < 0 || first_frame > kMaxFrames) {
    return Fail("the first frame is {}; it must be 0 to {}", first_frame, kMaxFrames);
  }
  for (const SyncedSource& synced : sources) {
    const std::string& name = synced.source->info().name;
    const std::int64_t offset = synced.offset_frames;
    if (offset < -kMaxFrames || offset > kMaxFrames) {
      return Fail("{}: the offset is {} frames; it must be {} to {}", name, offset, -kMaxFrames,
                  kMaxFrames);
    }
    const std::int64_t start = std::max<std::int64_t>(0, first_frame + offset);
    VANTAGE_ASSIGN_OR_RETURN(const std::int64_t skipped, synced.source->Skip(start));
    if (skipped < start) {
      return Fail("{}: ends after {} frames; frame {} of the scene is its frame {}", name, skipped,
                  first_frame, start);
    }
  }
  MultiCameraReader reader;
  reader.frames_read_.resize(sources.size());
  reader.next_frames_.resize(sources.size(), first_frame);
  reader.sources_ = std::move(sources);
  reader.first_frame_ = first_frame;
  reader.next_frame_ = first_frame;
  return reader;
}

Result<bool> MultiCameraReader::Advance(std::size_t camera, cv::Mat& frame) {
  const SyncedSource& synced = sources_[camera];
  if (next_frames_[camera]++ + synced.offset_frames >= 0) return synced.source->Read(frame);
  frame.release();
  return true;
}

Result<bool> MultiCameraReader::ReadCamera(std::size_t camera, cv::Mat& frame) {
  VANTAGE_ASSIGN_OR_RETURN(const bool more, Advance(camera, frame));
  if (more && !frame.empty()) ++frames_read_[camera];
  return more;
}

Status MultiCameraReader::SkipCamera(std::size_t camera, std::int64_t count) {
  const SyncedSource& synced = sources_[camera];
  std::int64_t& next = next_frames_[camera];
  // What lies before the source's first frame is not in the source.
  const std::int64_t before = std::clamp<std::int64_t>(-(next + synced.offset_frames), 0, count);
  next += count;
  if (before < count) VANTAGE_RETURN_IF_ERROR(synced.source->Skip(count - before));
  return {};
}

Result<bool> MultiCameraReader::Read(std::vector<cv::Mat>& frames, int threads) {
  if (ended_) return false;
  frames.resize(sources_.size());
  std::vector<Result<bool>> more(sources_.size(), true);
  ParallelFor(threads, static_cast<std::int64_t>(sources_.size()), [&](std::int64_t index) {
    const auto camera = static_cast<std::size_t>(index);
    more[camera] = Advance(camera, frames[camera]);
  });
  for (const Result<bool>& result : more) VANTAGE_RETURN_IF_ERROR(result);
  ended_ =
      std::any_of(more.begin(), more.end(), [](const Result<bool>& result) { return !*result; });
  if (ended_) return false;
  for (std::size_t camera = 0; camera < frames.size(); ++camera) {
    frames_read_[camera] += frames[camera].empty() ? 0 : 1;
  }
  ++next_frame_;
  return true;
}

std::optional<std::int64_t> MultiCameraReader::frame_count() const {
  std::optional<std::int64_t> count;
  for (const SyncedSource& synced : sources_) {
    if (const auto own = synced.source->info().frame_count) {
      const std::int64_t left =
          std::max<std::int64_t>(0, *own - synced.offset_frames - first_frame_);
      count = std::min(count.value_or(left), left);
    }
  }
  return count;
}

std::vector<SourceInfo> MultiCameraReader::infos() const {
  std::vector<SourceInfo> infos;
  for (const SyncedSource& synced : sources_) infos.push_back(synced.source->info());
  return infos;
}

std::vector<CameraFrames> MultiCameraReader::report() const {
  std::vector<CameraFrames> report;
  for (std::size_t camera = 0; camera < sources_.size(); ++camera) {
    const SourceInfo& info = sources_[camera].source->info();
    report.push_back({.name = info.name,
                      .offset_frames = sources_[camera].offset_frames,
                      .frame_count = info.frame_count,
                      .frames_read = frames_read_[camera]});
  }
  return report;
}

}  // namespace vantage
