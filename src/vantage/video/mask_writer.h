// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <utility>

#include "vantage/base/file.h"
#include "vantage/base/ids.h"
#include "vantage/base/result.h"
#include "vantage/video/video_writer.h"

namespace vantage {

/// Writes a picture of 8 bits a channel as a PNG file. Fails when the bytes cannot be written.
Status WritePng(const std::filesystem::path& path, const cv::Mat& picture);

/// Writes a mask (CV_8UC1) as the PNG file <folder>/<frame as %06d>.png, which OpenMasks reads
/// back. The folder must exist; give a StagedDirectory's so that a set of masks appears whole or
/// not at all. Fails on another type of picture, a negative frame, and when the bytes cannot be
/// written.
Status WriteMask(const std::filesystem::path& folder, FrameIndex frame, const cv::Mat& mask);

enum class MaskFormat {
  kPng,    ///< one picture a frame, named by its number: WriteMask
  kVideo,  ///< one lossless video of frames in order: masks.mkv
};
constexpr const char* kMaskVideoName = "masks.mkv";

/// The masks of one camera as a folder, which appears whole or not at all. OpenMasks reads back
/// either format, bit for bit.
class MaskWriter {
 public:
  /// `replace`: whether the folder may hold something already, which goes. For kVideo the sides
  /// must be even (VideoWriter::CreateForMasks); `frames_per_second` matters to it only.
  static Result<MaskWriter> Create(const std::filesystem::path& folder, MaskFormat format,
                                   ImageSize size, double frames_per_second, bool replace);

  /// Masks are CV_8UC1 of the size given to Create, 0 or 255; frames are given in order. A video
  /// keeps the order only.
  Status Write(FrameIndex frame, const cv::Mat& mask);

  /// Puts the folder in its place. To be called once.
  Status Finish();

 private:
  explicit MaskWriter(StagedDirectory folder) : folder_(std::move(folder)) {}
  StagedDirectory folder_;
  std::optional<VideoWriter> video_;  // its file is in folder_: destroyed before it
};

}  // namespace vantage
