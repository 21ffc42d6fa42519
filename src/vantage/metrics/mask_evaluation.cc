// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/metrics/mask_evaluation.h"

#include <algorithm>
#include <iterator>

namespace vantage {
namespace {

namespace fs = std::filesystem;

/// Reads masks by ascending frame, passing over those that are not asked for.
class MasksByFrame {
 public:
  MasksByFrame(NumberedMasks masks, std::int64_t offset_frames)
      : masks_(std::move(masks)), offset_frames_(offset_frames) {}

  Status Read(FrameIndex frame, cv::Mat& mask) {
    const std::int64_t number = frame - offset_frames_;
    std::int64_t position = number;  // in the source
    if (!masks_.numbers.empty()) {
      const auto found = std::lower_bound(masks_.numbers.begin(), masks_.numbers.end(), number);
      if (found == masks_.numbers.end() || *found != number) return Missing(frame);
      position = std::distance(masks_.numbers.begin(), found);
    }
    if (position < next_) return Missing(frame);
    VANTAGE_ASSIGN_OR_RETURN(const std::int64_t skipped, masks_.source->Skip(position - next_));
    next_ += skipped;
    if (next_ < position) return Missing(frame);
    VANTAGE_ASSIGN_OR_RETURN(const bool more, masks_.source->Read(mask));
    if (!more) return Missing(frame);
    ++next_;
    return {};
  }

  const std::string& name() const { return masks_.source->info().name; }

 private:
  tl::unexpected<Error> Missing(FrameIndex frame) const {
    const std::int64_t first = masks_.numbers.empty() ? 0 : masks_.numbers.front();
    const std::int64_t last = masks_.numbers.empty() ? next_ - 1 : masks_.numbers.back();
    // A video's length is known only where reading has reached its end.
    const bool video_begins_later = masks_.numbers.empty() && frame < offset_frames_;
    const std::string held =
        video_begins_later
            ? fmt::format("from frame {} on", offset_frames_)
            : fmt::format("of frames {} to {}", first + offset_frames_, last + offset_frames_);
    return Fail(
        "{}: no mask for frame {}, which has truth; the masks are {} (--frames restricts what "
        "counts, --offset shifts the masks)",
        name(), frame, held);
  }

  NumberedMasks masks_;
  std::int64_t offset_frames_;
  std::int64_t next_ = 0;  // position in the source of what Read gives next
};

}  // namespace

Result<std::vector<MaskFrameCounts>> EvaluateMasks(const TruthSequence& truth,
                                                   const fs::path& masks,
                                                   const MaskEvaluationOptions& options,
                                                   const RunControl& control) {
  if (options.first_frame < 0 || options.last_frame < options.first_frame) {
    return Fail(
        "the frames that count are {} to {}; the first must be at least 0 and at most the "
        "last",
        options.first_frame, options.last_frame);
  }
  constexpr std::int64_t kFarthest = std::int64_t{1} << 40;
  if (options.offset_frames < -kFarthest || options.offset_frames > kFarthest) {
    return Fail("the offset of the masks is {} frames; it must be between {} and {}",
                options.offset_frames, -kFarthest, kFarthest);
  }
  const auto begin = truth.masks.lower_bound(options.first_frame);
  const auto end = truth.masks.upper_bound(options.last_frame);
  if (begin == end) {
    return Fail("{}: has no truth that counts in frames {} to {}; it has some in frames {} to {}",
                truth.folder.string(), options.first_frame, options.last_frame,
                truth.masks.begin()->first, truth.masks.rbegin()->first);
  }
  VANTAGE_ASSIGN_OR_RETURN(NumberedMasks numbered, OpenNumberedMasks(masks));
  MasksByFrame source(std::move(numbered), options.offset_frames);
  const std::int64_t total = std::distance(begin, end);
  std::vector<MaskFrameCounts> frames;
  cv::Mat mask;
  for (auto entry = begin; entry != end; ++entry) {
    if (control.Stopped()) return Cancelled();
    const auto& [frame, path] = *entry;
    VANTAGE_ASSIGN_OR_RETURN(const cv::Mat labels, ReadTruthMask(path, truth.size));
    VANTAGE_RETURN_IF_ERROR(source.Read(frame, mask));
    if (mask.size() != labels.size()) {
      return Fail("{}: the masks have {} x {} px, the truth {} has {} x {}", source.name(),
                  mask.cols, mask.rows, path.string(), labels.cols, labels.rows);
    }
    const Result<MaskCounts> counts = CountMask(labels, mask, truth.roi);
    if (!counts) return Fail("{}: {}", path.string(), counts.error().message);
    frames.push_back({frame, *counts});
    control.Report(std::ssize(frames), total);
  }
  return frames;
}

MaskCounts SumOf(const std::vector<MaskFrameCounts>& frames) {
  MaskCounts sum;
  for (const MaskFrameCounts& frame : frames) sum += frame.counts;
  return sum;
}

}  // namespace vantage
