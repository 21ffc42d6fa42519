// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

#include "vantage/base/ids.h"
#include "vantage/base/result.h"
#include "vantage/geometry/camera.h"
#include "vantage/video/frame_source.h"

/// Change-detection sequences: pictures of one fixed camera, and for all or some of them a mask
/// labelled by hand. The published layouts, CDnet (Goyette et al., 2012; Wang et al., 2014) and SBI
/// (Maddalena and Petrosino, 2015), are read by the same rules:
///
///     input/in000001.jpg ...        pictures, in the order of their names: frames 0, 1, ...
///     groundtruth/gt000001.png ...  labels; each belongs to the picture with the same number
///     ROI.bmp, ROI.png, ROI.jpg     optional: white where pixels count
///     temporalROI.txt               optional: numbers of the first and last picture that count

namespace vantage {

/// What a pixel of a truth mask says. Other values are errors.
struct TruthLabel {
  static constexpr std::uint8_t kStatic = 0;
  static constexpr std::uint8_t kShadow = 50;    ///< moving shadow: counts as background
  static constexpr std::uint8_t kOutside = 85;   ///< outside the region of interest: not counted
  static constexpr std::uint8_t kUnknown = 170;  ///< edges of motion: not counted
  static constexpr std::uint8_t kMoving = 255;
};

/// The truth of one sequence.
struct TruthSequence {
  std::filesystem::path folder;
  /// Folder of the pictures; empty for a plain folder of truth masks.
  std::filesystem::path input;
  /// Truth masks of the frames that count (those in the temporal range), by frame; never empty.
  std::map<FrameIndex, std::filesystem::path> masks;
  /// Frames in the temporal range that have no truth: they do not count.
  std::int64_t frames_without_truth = 0;
  /// Of the truth masks.
  ImageSize size;
  /// Pixels that count, CV_8UC1 of `size`, 255 or 0; empty: all. Label 85 is left out besides.
  cv::Mat roi;
  /// What a user should know about how the folder was understood, one line each.
  std::vector<std::string> notes;
};

/// True for a folder that holds the folders `input` and `groundtruth`.
bool IsSequenceFolder(const std::filesystem::path& folder);

/// Sequence folders in `root` up to three levels deep, in the order of their paths; `root` itself
/// when it is one.
std::vector<std::filesystem::path> FindSequences(const std::filesystem::path& root);

/// Reads the layout of a sequence folder; or of a plain folder of truth masks, where the number in
/// a mask's name is its frame ("000000.png" on).
///
/// A region of interest is used when it is a grey picture of the truth's size, 128 and above
/// inside. Others are passed over with a note: CDnet ships some of another size, and coloured
/// ROI.jpg pictures that only show the region as a tint. The truth's own label 85 leaves the same
/// pixels out. A temporal range may reach beyond the pictures (SBI's do). Fails, naming the file,
/// on names without numbers or with the same number, truth that belongs to no picture, a temporal
/// range that is not two numbers in order, and when no truth is left.
Result<TruthSequence> OpenTruth(const std::filesystem::path& folder);

/// One truth mask as CV_8UC1 labels. Fails on a picture that is coloured or has not this size.
/// The labels themselves are checked where they are counted.
Result<cv::Mat> ReadTruthMask(const std::filesystem::path& path, ImageSize size);

/// Masks with the numbers of their frames.
struct NumberedMasks {
  std::unique_ptr<FrameSource> source;
  /// Number in the name of each picture, ascending; empty for a video, whose frames are 0, 1, ...
  std::vector<FrameIndex> numbers;
};

/// Opens masks as OpenMasks does. Fails on pictures whose names have no number or the same.
Result<NumberedMasks> OpenNumberedMasks(const std::filesystem::path& path);

}  // namespace vantage
