// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "extension_rows.h"

namespace vantage::app {

std::vector<ReportRow> ExtensionRows(const ExtensionReport& report, const Scene& scene) {
  if (report.sides[0].reason == ExtensionReason::kGiven) {
    return {{"extension", fmt::format("{:.6g} m on each side", report.sides[0].extension_m)}};
  }
  std::vector<ReportRow> rows;
  for (std::size_t i = 0; i < report.sides.size(); ++i) {
    const ExtensionSide& side = report.sides[i];
    const std::string camera =
        side.camera ? fmt::format(" ({})", scene.cameras[*side.camera].name) : "";
    rows.push_back({fmt::format("extension {}", kSideNames[i]),
                    fmt::format("{:.6g} m: {}{}", side.extension_m, TextOf(side.reason), camera)});
  }
  return rows;
}

}  // namespace vantage::app
