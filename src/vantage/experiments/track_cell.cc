// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/experiments/track_cell.h"

#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include "vantage/pipeline/flow.h"
#include "vantage/pipeline/rehearsal.h"
#include "vantage/video/mask_writer.h"

namespace vantage {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

template <class Options>
Json Recorded(const Options& options) {
  Json json = Json::object();
  RecordOptions(options, json);
  return json;
}

Result<Json> WriteMasks(const TrackRecording& recording, const BackgroundOptions& background,
                        const CellRun& run) {
  VANTAGE_ASSIGN_OR_RETURN(const Scene scene, recording.scene(run.folder));
  VANTAGE_ASSIGN_OR_RETURN(Rehearsed rehearsed,
                           Rehearse(scene, background, run.threads, run.control));
  MaskStream& stream = rehearsed.stream;
  std::vector<MaskWriter> writers;
  for (const SceneCamera& camera : scene.cameras) {
    const ImageSize size = camera.camera.size();
    const bool even = size.width % 2 == 0 && size.height % 2 == 0;
    VANTAGE_ASSIGN_OR_RETURN(
        MaskWriter writer,
        MaskWriter::Create(run.product / camera.name, even ? MaskFormat::kVideo : MaskFormat::kPng,
                           size, scene.frames_per_second, false));
    writers.push_back(std::move(writer));
  }
  MaskStages stages(stream, 1);
  const FlowStage writing = {
      .in_order = true, .work = [&](std::int64_t frame, int) -> Result<bool> {
        for (std::size_t camera = 0; camera < writers.size(); ++camera) {
          const cv::Mat& mask = stages.masks[frame][camera];
          if (mask.empty()) {
            return Fail("camera {}: has no picture at frame {}", scene.cameras[camera].name, frame);
          }
          VANTAGE_RETURN_IF_ERROR(writers[camera].Write(frame, mask));
        }
        return true;
      }};
  const FlowStage chain[] = {stages.Reading(), stages.Background(1), writing};
  VANTAGE_ASSIGN_OR_RETURN(const FlowReport flow, RunFlow(chain, run.threads, run.control));
  for (MaskWriter& writer : writers) VANTAGE_RETURN_IF_ERROR(writer.Finish());
  return Json{{"frames", flow.frames},
              {"read_secs", flow.stage_secs[0]},
              {"background_secs", flow.stage_secs[1]}};
}

Json SecondsOf(const TrackingReport& report) {
  return {{"rehearsal", report.maps.rehearsal_secs},
          {"read", report.maps.read_secs},
          {"background", report.maps.background_secs},
          {"occupancy", report.maps.occupancy_secs},
          {"hold", report.maps.hold_secs},
          {"linking", report.linking.linking.seconds},
          {"identity", report.identity.seconds},
          {"total", report.total_secs}};
}

Result<Json> TrackAndMeasure(const TrackRecording& recording, const TrackSetting& setting,
                             const CellPtr& masks, const CellRun& run) {
  VANTAGE_ASSIGN_OR_RETURN(const Scene scene, SceneFor(recording, setting, masks, run.folder));
  VANTAGE_ASSIGN_OR_RETURN(const TrackingResult tracked,
                           TrackPeople(scene, setting.options, run.threads, run.control));
  Json json;
  const auto measure = [&](FrameIndex every) -> Result<Json> {
    VANTAGE_ASSIGN_OR_RETURN(const Tracks truth, recording.Truth(run.folder, every));
    VANTAGE_ASSIGN_OR_RETURN(const TrackMeasures measures,
                             EvaluateTracks(truth, tracked.tracks, {}, &scene.area));
    return JsonOf(measures);
  };
  VANTAGE_ASSIGN_OR_RETURN(json["every"], measure(1));
  VANTAGE_ASSIGN_OR_RETURN(json["sparse"], measure(recording.sparse_truth));
  json["tracks"] = tracked.tracks.size();
  json["frames"] = tracked.report.maps.frames;
  for (const ExtensionSide& side : tracked.report.maps.extension.sides) {
    json["extension_m"].push_back(side.extension_m);
  }
  const PersonOptions& person = tracked.report.maps.person.used;
  json["person_m"] = {person.width_m, person.height_m};
  json["seconds"] = SecondsOf(tracked.report);
  return json;
}

}  // namespace

StageOptions DefaultsFor(const TrackRecording& recording) {
  StageOptions options;
  const double scale = recording.picture_scale;
  const auto reduced = [](int& pixels, double factor) {
    pixels = static_cast<int>(std::floor(pixels * factor));
  };
  CleanupOptions& cleanup = options.background.cleanup;
  reduced(cleanup.open_px, scale);
  reduced(cleanup.close_px, scale);
  reduced(cleanup.min_area_px, scale * scale);
  reduced(options.background.ghosts.min_area_px, scale * scale);
  return options;
}

StageOptions PlainOptionsFor(const TrackRecording& recording) {
  StageOptions options = DefaultsFor(recording);
  options.hold.standing = false;
  options.identity.appearance = false;
  return options;
}

Json InputsOf(const TrackRecording& recording, const TrackSetting& setting, bool from_masks) {
  Json inputs = {{"recording", recording.inputs},
                 {"cell_m", setting.cell_m ? Json(*setting.cell_m) : Json("scene")},
                 {"extension_m", setting.extension_m ? Json(*setting.extension_m) : Json("scene")},
                 {"person", setting.person ? Recorded(*setting.person) : Json("scene")},
                 {"sparse_truth", recording.sparse_truth},
                 {"grid", Recorded(GridOptions())},
                 {"occupancy", Recorded(setting.options.occupancy)},
                 {"linking", Recorded(setting.options.linking)},
                 {"tracks", Recorded(setting.options.tracks)},
                 {"evaluation", Recorded(EvaluationOptions())}};
  // Ready masks are neither subtracted nor held, and have no colours.
  if (!from_masks) {
    inputs["background"] = Recorded(setting.options.background);
    inputs["hold"] = Recorded(setting.options.hold);
    inputs["identity"] = Recorded(setting.options.identity);
  }
  return inputs;
}

CellPtr MasksCell(const TrackRecording& recording, const std::string& setting,
                  const BackgroundOptions& background) {
  const std::string name = recording.name + "-" + setting;
  return std::make_shared<const Cell>(
      Cell{.name = "masks-" + name,
           .inputs = {{"recording", recording.inputs}, {"background", Recorded(background)}},
           .needs = recording.Needs(),
           .product = fs::path("masks") / name,
           .run = [recording, background](const CellRun& run) {
             return WriteMasks(recording, background, run);
           }});
}

CellPtr TrackCell(const TrackRecording& recording, const TrackSetting& setting,
                  const CellPtr& masks) {
  std::vector<CellPtr> needs = recording.Needs();
  if (masks) needs.push_back(masks);
  return std::make_shared<const Cell>(
      Cell{.name = fmt::format("tracks-{}-{}", recording.name, setting.name),
           .inputs = InputsOf(recording, setting, masks != nullptr),
           .needs = std::move(needs),
           .run = [recording, setting, masks](const CellRun& run) {
             return TrackAndMeasure(recording, setting, masks, run);
           }});
}

Result<Scene> SceneFor(const TrackRecording& recording, const TrackSetting& setting,
                       const CellPtr& masks, const fs::path& folder) {
  VANTAGE_ASSIGN_OR_RETURN(Scene scene, recording.scene(folder));
  if (setting.cell_m) scene.grid.cell_m = *setting.cell_m;
  if (setting.extension_m) scene.grid.extension_m = *setting.extension_m;
  if (setting.person) {
    scene.person = {.width_m = setting.person->width_m,
                    .height_m = setting.person->height_m,
                    .shape = setting.person->shape};
  }
  if (!masks) return scene;
  for (SceneCamera& camera : scene.cameras) {
    camera.source = {.kind = SourceSpec::Kind::kMasks,
                     .path = folder / masks->product / camera.name,
                     .size = {}};
  }
  return scene;
}

Json JsonOf(const TrackMeasures& m) {
  return {{"mota", m.mota},          {"motp", m.motp},           {"fn", m.misses},
          {"fp", m.false_positives}, {"idsw", m.switches},       {"gt", m.truth_positions},
          {"idf1", m.idf1},          {"hota", m.hota},           {"moda", m.moda},
          {"recall", m.recall},      {"precision", m.precision}, {"mt", m.mostly_tracked},
          {"ml", m.mostly_lost},     {"frag", m.fragmentations}, {"people", m.truth_tracks},
          {"frames", m.frames}};
}

double NumberAt(const Json& json, const std::string& key) {
  const auto found = json.find(key);
  if (found == json.end() || !found->is_number()) return std::numeric_limits<double>::quiet_NaN();
  return found->get<double>();
}

}  // namespace vantage
