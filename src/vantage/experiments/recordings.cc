// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/experiments/recordings.h"

#include <algorithm>
#include <cstdint>
#include <utility>

#include "vantage/base/file.h"

namespace vantage {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

Result<Json> DescribeFolder(const fs::path& folder) {
  std::error_code code;
  std::int64_t files = 0;
  std::uintmax_t bytes = 0;
  for (fs::recursive_directory_iterator it(folder, code), end; !code && it != end;
       it.increment(code)) {
    if (!it->is_regular_file(code)) continue;
    ++files;
    bytes += it->file_size(code);
  }
  if (code) return Fail("{}: cannot be read: {}", folder.string(), code.message());
  return Json{{"files", files}, {"bytes", bytes}};
}

}  // namespace

Result<CellPtr> SimulatedRecording(const Study& study, const std::string& name,
                                   simulation::RecordOptions options) {
  if (study.frames) {
    options.stage.frames = std::min(options.stage.frames.value_or(*study.frames), *study.frames);
  }
  Json people;
  if (!options.stage.people.empty()) {
    VANTAGE_ASSIGN_OR_RETURN(people, DescribeData(options.stage.people));
  }
  Json inputs = {{"preset", options.preset},
                 {"seed", options.stage.seed},
                 {"frames", options.stage.frames ? Json(*options.stage.frames) : Json()},
                 {"cameras", options.stage.cameras ? Json(*options.stage.cameras) : Json()},
                 {"scale", options.stage.scale},
                 {"people", people},
                 {"masks", options.masks},
                 {"faults", Json::array()}};
  for (const simulation::CameraFault& fault : options.faults) {
    inputs["faults"].push_back(
        {static_cast<int>(fault.kind), fault.camera, fault.first, fault.count, fault.drift_per_s});
  }
  const auto run = [record = study.record, options](const CellRun& cell) -> Result<Json> {
    VANTAGE_ASSIGN_OR_RETURN(const simulation::RecordReport report,
                             record(options, cell.product, cell.threads, cell.control));
    return Json{{"frames", report.frames},
                {"cameras", report.cameras},
                {"people", report.people},
                {"seconds", report.total_secs}};
  };
  return std::make_shared<const Cell>(Cell{.name = "data-" + name,
                                           .inputs = std::move(inputs),
                                           .product = fs::path("data") / name,
                                           .alone = true,
                                           .run = run});
}

Result<Json> DescribeData(const fs::path& path) {
  std::error_code code;
  if (fs::is_directory(path, code)) return DescribeFolder(path);
  VANTAGE_ASSIGN_OR_RETURN(const std::string sha256, Sha256OfFile(path));
  const auto bytes = fs::file_size(path, code);
  return Json{{"bytes", bytes}, {"sha256", sha256}};
}

}  // namespace vantage
