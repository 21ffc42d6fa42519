// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/experiments/labelled_sequence.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <opencv2/core.hpp>
#include <utility>

#include "vantage/scene/scene.h"
#include "vantage/video/open.h"
#include "vantage/video/sequence.h"

namespace vantage {
namespace {

namespace fs = std::filesystem;

/// The last frame that counts where every frame does.
FrameIndex LastOf(const FrameSpan& span) {
  const FrameIndex first = std::max(span.first, span.begin);
  return span.most > span.last - first ? span.last : first + span.most - 1;
}

/// The first frame that is seen when `first` is the first that counts.
FrameIndex BeginOf(const FrameSpan& span, FrameIndex first) {
  return std::max(span.begin, first - std::min<std::int64_t>(span.lead, first));
}

}  // namespace

Result<LabelledSequence> LabelledSequence::OpenSequence(const fs::path& folder,
                                                        const FrameSpan& span) {
  if (!IsSequenceFolder(folder)) {
    return Fail("{}: is no sequence; it must hold the folders input and groundtruth",
                folder.string());
  }
  VANTAGE_ASSIGN_OR_RETURN(TruthSequence truth, OpenTruth(folder));
  const FrameIndex first = std::max(span.first, span.begin);
  std::map<FrameIndex, fs::path> masks(truth.masks.lower_bound(first),
                                       truth.masks.upper_bound(std::max(span.last, first)));
  if (std::ssize(masks) > span.most) masks.erase(std::next(masks.begin(), span.most), masks.end());
  if (masks.empty()) {
    return Fail("{}: has no truth that counts in frames {} to {}", folder.string(), span.first,
                span.last);
  }
  LabelledSequence opened;
  VANTAGE_ASSIGN_OR_RETURN(opened.pictures_, OpenInput(folder));
  const ImageSize size = opened.size();
  if (size != truth.size) {
    return Fail("{}: the pictures have {} x {} px, the truth {} x {}", folder.string(), size.width,
                size.height, truth.size.width, truth.size.height);
  }
  opened.next_ = BeginOf(span, masks.begin()->first);
  VANTAGE_RETURN_IF_ERROR(opened.pictures_->Skip(opened.next_));
  opened.last_ = masks.rbegin()->first;
  opened.last_is_known_ = true;
  opened.roi_ = truth.roi;
  opened.notes_ = std::move(truth.notes);
  opened.frames_without_truth_ = truth.frames_without_truth;
  opened.truth_ = [masks, size](FrameIndex frame) -> Result<cv::Mat> {
    const auto mask = masks.find(frame);
    if (mask == masks.end()) return cv::Mat();
    return ReadTruthMask(mask->second, size);
  };
  return opened;
}

Result<LabelledSequence> LabelledSequence::OpenRecording(const fs::path& folder, int camera,
                                                         const FrameSpan& span) {
  VANTAGE_ASSIGN_OR_RETURN(const Scene scene, LoadScene(folder / "scene.toml"));
  if (camera < 0 || camera >= std::ssize(scene.cameras)) {
    return Fail("{}: has no camera {}; it has {}", folder.string(), camera + 1,
                scene.cameras.size());
  }
  const SceneCamera& filmed = scene.cameras[static_cast<std::size_t>(camera)];
  const std::string& name = filmed.name;
  LabelledSequence opened;
  VANTAGE_ASSIGN_OR_RETURN(opened.pictures_, OpenVideo(filmed.source.path));
  VANTAGE_ASSIGN_OR_RETURN(std::shared_ptr<FrameSource> masks,
                           OpenMasks(folder / "truth" / "masks" / name));
  const ImageSize size = opened.size();
  if (size != masks->info().size) {
    return Fail("{}: the pictures of {} have {} x {} px, the true masks {} x {}", folder.string(),
                name, size.width, size.height, masks->info().size.width, masks->info().size.height);
  }
  opened.next_ = BeginOf(span, std::max(span.first, span.begin));
  VANTAGE_RETURN_IF_ERROR(opened.pictures_->Skip(opened.next_));
  VANTAGE_RETURN_IF_ERROR(masks->Skip(opened.next_));
  opened.last_ = LastOf(span);
  opened.truth_ = [masks, span](FrameIndex frame) -> Result<cv::Mat> {
    cv::Mat labels;  // 0 and 255 mean the same in masks and labels
    VANTAGE_ASSIGN_OR_RETURN(const bool more, masks->Read(labels));
    if (!more) return Fail("{}: ends before frame {}", masks->info().name, frame);
    return frame < span.first ? cv::Mat() : labels;
  };
  return opened;
}

Result<LabelledSequence> LabelledSequence::OpenUnlabelled(const fs::path& path,
                                                          const FrameSpan& span) {
  LabelledSequence opened;
  VANTAGE_ASSIGN_OR_RETURN(opened.pictures_, OpenInput(path));
  VANTAGE_RETURN_IF_ERROR(opened.pictures_->Skip(span.begin));
  opened.next_ = span.begin;
  opened.last_ = LastOf(span);
  opened.truth_ = [](FrameIndex) -> Result<cv::Mat> { return cv::Mat(); };
  return opened;
}

Result<bool> LabelledSequence::Next(LabelledFrame& frame) {
  if (next_ > last_) return false;
  frame.frame = next_;
  VANTAGE_ASSIGN_OR_RETURN(const bool more, pictures_->Read(frame.bgr));
  if (!more && last_is_known_) {
    return Fail("{}: ends before frame {}, which has truth", pictures_->info().name, last_);
  }
  if (!more) return false;
  VANTAGE_ASSIGN_OR_RETURN(frame.labels, truth_(next_));
  if (!frame.labels.empty() && has_roi()) frame.labels.setTo(TruthLabel::kOutside, roi_ < 128);
  ++next_;
  return true;
}

}  // namespace vantage
