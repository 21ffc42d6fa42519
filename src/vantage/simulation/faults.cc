// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/simulation/faults.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "vantage/base/text.h"

namespace vantage::simulation {

Result<CameraFault> ParseCameraFault(std::string_view text) {
  using Kind = CameraFault::Kind;
  const auto wrong = [&] {
    return Fail(
        "{}: is not a fault; it is drop, freeze or black:CAMERA:FIRST:COUNT, or "
        "drift:CAMERA:FIRST:FRAMES with frames a second between -10 and 10",
        text);
  };
  const std::vector<std::string_view> fields = Fields(text, ':');
  CameraFault fault;
  if (fields.size() != 4 || !ParseNumber(fields[1], fault.camera) ||
      !ParseNumber(fields[2], fault.first) || fault.camera < 1 || fault.first < 0) {
    return wrong();
  }
  --fault.camera;
  if (fields[0] == "drift") {
    fault.kind = Kind::kDrift;
    if (!ParseNumber(fields[3], fault.drift_per_s) || !(std::abs(fault.drift_per_s) <= 10)) {
      return wrong();
    }
    return fault;
  }
  if (!ParseNumber(fields[3], fault.count) || fault.count < 1) return wrong();
  if (fields[0] == "drop") {
    fault.kind = Kind::kDrop;
  } else if (fields[0] == "black") {
    fault.kind = Kind::kBlack;
  } else if (fields[0] == "freeze" && fault.first >= 1) {
    fault.kind = Kind::kFreeze;
  } else {
    return wrong();
  }
  return fault;
}

std::vector<std::optional<FrameIndex>> DeliveredFrames(FrameIndex frames, double frames_per_second,
                                                       int camera,
                                                       const std::vector<CameraFault>& faults) {
  using Kind = CameraFault::Kind;
  struct Picture {
    FrameIndex shows;
    bool black = false, dropped = false;
  };
  std::vector<Picture> pictures(static_cast<std::size_t>(frames));
  for (FrameIndex t = 0; t < frames; ++t) {
    double drifted = static_cast<double>(t);
    for (const CameraFault& fault : faults) {
      if (fault.camera != camera || fault.kind != Kind::kDrift || t < fault.first) continue;
      drifted += fault.drift_per_s * static_cast<double>(t - fault.first) / frames_per_second;
    }
    const auto shows = static_cast<FrameIndex>(std::llround(drifted));
    Picture& picture = pictures[static_cast<std::size_t>(t)];
    // Several clocks' errors added up, or one that runs backward, still show no frame before the
    // last one shown.
    picture.shows = std::max(shows, t == 0 ? 0 : std::prev(&picture)->shows);
    picture.dropped = picture.shows >= frames;
  }
  for (const CameraFault& fault : faults) {
    if (fault.camera != camera || fault.kind == Kind::kDrift || fault.first >= frames) continue;
    const FrameIndex end = fault.first + std::min(fault.count, frames - fault.first);
    for (FrameIndex t = fault.first; t < end; ++t) {
      Picture& picture = pictures[static_cast<std::size_t>(t)];
      switch (fault.kind) {
        case Kind::kFreeze:
          picture.shows = pictures[static_cast<std::size_t>(fault.first - 1)].shows;
          break;
        case Kind::kBlack:
          picture.black = true;
          break;
        case Kind::kDrop:
        case Kind::kDrift:
          picture.dropped = true;
          break;
      }
    }
  }
  std::vector<std::optional<FrameIndex>> delivered;
  for (const Picture& picture : pictures) {
    if (picture.dropped) continue;
    delivered.push_back(picture.black ? std::nullopt : std::optional(picture.shows));
  }
  return delivered;
}

}  // namespace vantage::simulation
