// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/pipeline/person.h"

#include <nlohmann/json.hpp>
#include <numeric>
#include <utility>

#include "vantage/base/ids.h"

namespace vantage {
PersonReport ResolvePerson(const Scene& scene, std::optional<PersonSizeReport> measured) {
  PersonReport report;
  report.used = scene.person.OrDefault();
  if (!measured) return report;
  report.measured = std::move(measured);
  if (report.measured->width) {
    report.found = true;
    report.used = scene.person.Or(report.measured->RectangleWidth_m(scene.grid.cell_m),
                                  report.measured->RectangleHeight_m());
  } else if (!scene.person.width_m) {
    report.used.width_m += CellAllowance_m(scene.grid.cell_m);
  }
  return report;
}

std::string TextOf(const PersonReport& report) {
  std::string text =
      fmt::format("{:.2f} m wide, {:.2f} m high", report.used.width_m, report.used.height_m);
  if (!report.measured) return text;
  const PersonSizeReport& measured = *report.measured;
  const auto seen =
      std::accumulate(measured.figures.begin(), measured.figures.end(), FrameIndex{0});
  if (!report.found) {
    return text + fmt::format(" (default: {} figures in the first {} masks are too few to measure)",
                              measured.TotalCounted(), measured.frames);
  }
  return text + fmt::format(" (measured on {} of {} figures)", measured.TotalCounted(), seen);
}

nlohmann::ordered_json JsonOf(const PersonReport& report, const Scene& scene) {
  using Json = nlohmann::ordered_json;
  Json json = Json::object();
  RecordOptions(report.used, json);
  const auto source = [&](const std::optional<double>& given) {
    return given ? "given" : report.found ? "measured" : "default";
  };
  json["width_source"] = source(scene.person.width_m);
  json["height_source"] = source(scene.person.height_m);
  if (!report.measured) return json;
  const PersonSizeReport& measured = *report.measured;
  Json& record = json["measured"];
  const auto add = [&](const std::string& name, const std::optional<RobustLength>& length) {
    if (!length) return;
    record[name] = length->value_m;
    record[name + "_spread"] = length->spread_m;
  };
  add("width", measured.width);
  add("height", measured.height);
  record["moments"] = measured.frames;
  record["confirmed_by_other_cameras"] = measured.confirmed;
  for (std::size_t i = 0; i < scene.cameras.size(); ++i) {
    record["cameras"][scene.cameras[i].name] = {{"figures", measured.figures[i]},
                                                {"counted", measured.counted[i]}};
  }
  return json;
}

}  // namespace vantage
