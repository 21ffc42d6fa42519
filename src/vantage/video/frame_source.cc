// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/video/frame_source.h"

namespace vantage {

Result<std::int64_t> FrameSource::Skip(std::int64_t count) {
  cv::Mat dropped;
  for (std::int64_t skipped = 0; skipped < count; ++skipped) {
    VANTAGE_ASSIGN_OR_RETURN(const bool more, Read(dropped));
    if (!more) return skipped;
  }
  return count;
}

}  // namespace vantage
