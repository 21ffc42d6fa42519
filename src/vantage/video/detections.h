// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "vantage/geometry/person.h"
#include "vantage/video/frame_source.h"

namespace vantage {

/// What a detector found in one picture. The box is in the image frame of geometry/camera.h, where
/// (0, 0) is the centre of the top-left pixel.
struct Detection {
  PixelBox box;
  double score = 1;
};

/// Detections by frame number; the last frame has at least one row in the file.
using Detections = std::vector<std::vector<Detection>>;

/// Reads a CSV file with the header `frame,xmin,ymin,xmax,ymax,score` (score may be left out and is
/// then 1). Frames count from 0 and may come in any order. Edges are continuous pixel coordinates
/// as detectors give them: (0, 0) is the outer CORNER of the top-left pixel, so that a box around
/// the whole picture is 0,0,width,height; half a pixel is subtracted on reading. Boxes are clipped
/// to the picture of `size`; those wholly outside are left out. Fails, naming file and line, on
/// another header, fields that are not finite numbers, xmax < xmin, ymax < ymin, frames below 0 or
/// beyond ten million; and on a file without rows.
Result<Detections> ReadDetections(const std::filesystem::path& path, ImageSize size);

/// Draws boxes as a mask: pixel (column, row) is 255 when its centre lies in a box, edges at the
/// minimum included and at the maximum not.
cv::Mat DrawDetections(const std::vector<Detection>& detections, ImageSize size, double min_score);

/// The detections with a score of at least `min_score` as masks of `size`, one for each frame up to
/// the last that the file names.
Result<std::unique_ptr<FrameSource>> OpenDetections(const std::filesystem::path& path,
                                                    ImageSize size, double min_score);

}  // namespace vantage
