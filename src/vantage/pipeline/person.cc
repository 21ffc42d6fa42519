// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/pipeline/person.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numeric>
#include <utility>

#include "vantage/base/ids.h"
#include "vantage/base/stopwatch.h"
#include "vantage/pipeline/mask_stream.h"

namespace vantage {
namespace {

constexpr std::int64_t kMaskQueue = 4;  // frames that wait to be measured

Result<PersonSizeReport> Measure(const Scene& scene, const BackgroundOptions& background,
                                 int threads, const RunControl& control,
                                 const PersonSample& sample) {
  VANTAGE_ASSIGN_OR_RETURN(MaskStream stream, MaskStream::Create(scene, background, threads));
  std::vector<Camera> cameras;
  for (const SceneCamera& camera : scene.cameras) cameras.push_back(camera.camera);
  PersonSizeMeter meter(std::move(cameras), scene.area, scene.person.shape);
  const double rate = scene.frames_per_second;
  const auto interval = std::max<FrameIndex>(1, std::lround(sample.interval_secs * rate));
  const double least_frames = sample.least_secs * rate;
  const double most_frames = sample.most_secs * rate;
  MaskStages stages(stream, kMaskQueue);
  const FlowStage measuring{.work = [&](std::int64_t frame, int) -> Result<bool> {
    bool enough = false;
    if (frame % interval == 0) {
      VANTAGE_RETURN_IF_ERROR(meter.Add(stages.masks[frame]));
      const std::int64_t counted = meter.Report().TotalCounted();
      enough = counted >= sample.plenty ||
               (counted >= sample.enough && static_cast<double>(frame) >= least_frames);
    }
    return !enough && static_cast<double>(frame + 1) < most_frames;
  }};
  const std::vector chain{stages.Reading(), stages.Background(kMaskQueue), measuring};
  if (const auto flow = RunFlow(chain, threads, control); !flow) {
    return tl::unexpected(flow.error());
  }
  return meter.Report();
}

}  // namespace

Result<PersonReport> ResolvePerson(const Scene& scene, const BackgroundOptions& background,
                                   int threads, const RunControl& control,
                                   const PersonSample& sample) {
  PersonReport report;
  report.used = scene.person.OrDefault();
  if (scene.person.IsGiven()) return report;
  const Stopwatch stopwatch;
  VANTAGE_ASSIGN_OR_RETURN(report.measured, Measure(scene, background, threads, control, sample));
  if (report.measured->width) {
    report.found = true;
    report.used = scene.person.Or(report.measured->RectangleWidth_m(scene.grid.cell_m),
                                  report.measured->RectangleHeight_m());
  } else if (!scene.person.width_m) {
    report.used.width_m += CellAllowance_m(scene.grid.cell_m);
  }
  report.seconds = stopwatch.Seconds();
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
