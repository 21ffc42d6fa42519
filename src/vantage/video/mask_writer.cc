// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/video/mask_writer.h"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <vector>

namespace vantage {

Status WritePng(const std::filesystem::path& path, const cv::Mat& picture) {
  const std::string name = path.string();
  // Encoded in memory first: cv::imwrite does not notice that the last block found no room.
  std::vector<unsigned char> bytes;
  try {
    if (!cv::imencode(".png", picture, bytes)) return Fail("{}: cannot be encoded as PNG", name);
  } catch (const cv::Exception& error) {
    return Fail("{}: cannot be encoded as PNG: {}", name, error.err);
  }
  std::ofstream stream(name, std::ios::binary);
  stream.write(reinterpret_cast<const char*>(bytes.data()),
               static_cast<std::streamsize>(bytes.size()));
  stream.flush();
  if (!stream) return Fail("{}: cannot be written: {}", name, std::strerror(errno));
  return {};
}

Status WriteMask(const std::filesystem::path& folder, FrameIndex frame, const cv::Mat& mask) {
  const std::filesystem::path path = folder / fmt::format("{:06}.png", frame);
  if (frame < 0) return Fail("{}: the frame is {}; it must be at least 0", path.string(), frame);
  if (mask.type() != CV_8UC1 || mask.empty()) {
    return Fail("{}: the picture is not a mask (one channel of 8 bits)", path.string());
  }
  return WritePng(path, mask);
}

Result<MaskWriter> MaskWriter::Create(const std::filesystem::path& folder, MaskFormat format,
                                      ImageSize size, double frames_per_second, bool replace) {
  VANTAGE_ASSIGN_OR_RETURN(StagedDirectory staged, StagedDirectory::Create(folder, replace));
  MaskWriter writer(std::move(staged));
  if (format == MaskFormat::kVideo) {
    VANTAGE_ASSIGN_OR_RETURN(
        writer.video_, VideoWriter::CreateForMasks(writer.folder_.temporary() / kMaskVideoName,
                                                   size, frames_per_second));
  }
  return writer;
}

Status MaskWriter::Write(FrameIndex frame, const cv::Mat& mask) {
  return video_ ? video_->Write(mask) : WriteMask(folder_.temporary(), frame, mask);
}

Status MaskWriter::Finish() {
  if (video_) VANTAGE_RETURN_IF_ERROR(video_->Finish());
  return folder_.Commit();
}

}  // namespace vantage
