// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <memory>

#include "vantage/video/frame_source.h"

/// Recorded pictures as FrameSources. Each function fails, naming the file, on what is missing,
/// empty, not of its kind, or larger than 32768 pixels a side or 100 million pixels.

namespace vantage {

/// A video file that FFmpeg decodes; frames are CV_8UC3. The frame count is known where the file's
/// structure vouches for it (AVI with an index, MP4 and MOV without hidden frames). A file that is
/// shorter than its own structure says fails at the first frame that is not there.
Result<std::unique_ptr<FrameSource>> OpenVideo(const std::filesystem::path& path);

/// Numbered pictures by a pattern whose last part holds one %d or %0Nd ("view1/%06d.png"), from the
/// lowest number that exists, without gaps; or all pictures of a folder in the order of their
/// names. PNG, JPEG, BMP, PGM and PPM; grey and 16-bit pictures become 8-bit BGR (CV_8UC3).
Result<std::unique_ptr<FrameSource>> OpenPictures(const std::filesystem::path& path);

/// The above by what `path` is: a video file, a pattern, or a folder; of the folder of a
/// change-detection sequence (sequence.h) the pictures in its folder `input`.
Result<std::unique_ptr<FrameSource>> OpenInput(const std::filesystem::path& path);

/// Ready-made masks from whatever OpenInput reads, or the masks.mkv in a folder (MaskWriter):
/// values of 128 and above are foreground (255), the rest is background (0). Coloured pictures are
/// refused: the channels may differ by at most 16, the noise of lossy compression.
Result<std::unique_ptr<FrameSource>> OpenMasks(const std::filesystem::path& path);

}  // namespace vantage
