// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/background/report.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

namespace vantage {
namespace {

const char* NameOf(DisturbanceKind kind) {
  switch (kind) {
    case DisturbanceKind::kLight:
      return "light";
    case DisturbanceKind::kFreeze:
      return "freeze";
    case DisturbanceKind::kBlack:
      return "black";
    case DisturbanceKind::kMoved:
      return "moved";
    case DisturbanceKind::kLost:
      return "lost";
  }
  return "";
}

nlohmann::ordered_json JsonOf(const DisturbanceEvent& event) {
  nlohmann::ordered_json json = {
      {"kind", NameOf(event.kind)}, {"frame", event.frame}, {"frames", event.frames}};
  if (event.kind == DisturbanceKind::kLight) json["factor"] = event.factor;
  if (event.kind == DisturbanceKind::kMoved) json["length_px"] = event.length_px;
  return json;
}

}  // namespace

nlohmann::ordered_json JsonOf(const BackgroundReport& report) {
  nlohmann::ordered_json events = nlohmann::ordered_json::array();
  for (const DisturbanceEvent& event : report.disturbances.events) events.push_back(JsonOf(event));
  return {{"rehearsed_frames", report.rehearsed},
          {"frames", report.frames},
          {"ghost_frames", report.ghost_frames},
          {"ghosts_px", report.ghosts_px},
          {"shadows_px", report.shadows_px},
          {"unreliable_frames", report.unreliable},
          {"skipped_frames", report.disturbances.skipped},
          {"relit", report.disturbances.relit},
          {"restarts", report.disturbances.restarts},
          {"events", events},
          {"method_seconds", report.method_secs},
          {"disturbance_seconds", report.disturbance_secs},
          {"shadow_seconds", report.shadow_secs},
          {"ghost_seconds", report.ghost_secs},
          {"cleanup_seconds", report.cleanup_secs}};
}

std::string TextOf(const DisturbanceEvent& event, std::int64_t first_frame) {
  const auto what = [&]() -> std::string {
    switch (event.kind) {
      case DisturbanceKind::kLight:
        return fmt::format("light changed, levels x {:.2f}", event.factor);
      case DisturbanceKind::kFreeze:
        return "camera frozen";
      case DisturbanceKind::kBlack:
        return "picture black or of one colour";
      case DisturbanceKind::kMoved:
        return fmt::format("camera moved, picture shifted by {:.1f} px", event.length_px);
      case DisturbanceKind::kLost:
        return "background lost, learnt anew";
    }
    return "";
  };
  return fmt::format("{}: frame {}, {} frame{} unreliable", what(), first_frame + event.frame,
                     event.frames, event.frames == 1 ? "" : "s");
}

}  // namespace vantage
