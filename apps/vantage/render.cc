// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "command.h"
#include "vantage/base/file.h"
#include "vantage/rendering/render_video.h"
#include "vantage/scene/scene.h"
#include "vantage/tracks/track_file.h"

namespace vantage::app {
namespace {

namespace fs = std::filesystem;

struct Flags {
  std::string run, output, scene, data, tracks;
  std::int64_t first_frame = -1;
  std::int64_t frames = 0;
  OptionFlags render, person;
};

/// What `vantage track` recorded of a run in its output folder.
struct RunRecord {
  fs::path scene, data;
  /// Size of a person as used.
  std::optional<double> width_m, height_m;
};

Result<RunRecord> ReadSummary(const fs::path& path) {
  auto text = ReadTextFile(path);
  if (!text) return Fail("{}; name the scene by --scene", text.error().message);
  const auto json = nlohmann::json::parse(*text, nullptr, false);
  const auto text_at = [&](const char* key) -> const std::string* {
    if (!json.is_object() || !json.contains(key)) return nullptr;
    return json[key].get_ptr<const std::string*>();
  };
  const auto length_at = [&](const char* field) -> std::optional<double> {
    const nlohmann::json::json_pointer pointer(fmt::format("/options/person/{}", field));
    if (!json.contains(pointer) || !json[pointer].is_number()) return std::nullopt;
    return json[pointer].get<double>();
  };
  const std::string* scene_text = text_at("scene");
  const std::string* data_text = text_at("data");
  if (scene_text == nullptr || data_text == nullptr) {
    return Fail(
        "{}: is not the record of a run (no \"scene\" and \"data\"); name the scene by "
        "--scene",
        path.string());
  }
  return RunRecord{.scene = *scene_text,
                   .data = *data_text,
                   .width_m = length_at("width"),
                   .height_m = length_at("height")};
}

/// Narrows the scene's frames to those that the flags ask for.
Status NarrowFrames(const Flags& flags, Scene& scene) {
  if (flags.first_frame >= 0) {
    if (scene.frame_count) {
      *scene.frame_count += scene.first_frame - flags.first_frame;
      if (*scene.frame_count <= 0) {
        return Fail("--first-frame {}: {} ends before it, after frame {}", flags.first_frame,
                    scene.name, flags.first_frame + *scene.frame_count - 1);
      }
    }
    scene.first_frame = flags.first_frame;
  }
  if (flags.frames > 0) {
    scene.frame_count = std::min(scene.frame_count.value_or(flags.frames), flags.frames);
  }
  return {};
}

Result<std::vector<SyncedSource>> OpenSources(const Scene& scene) {
  std::vector<SyncedSource> sources;
  for (const SceneCamera& camera : scene.cameras) {
    auto source = OpenSource(camera.source);
    if (!source) {
      return Fail("camera {}: {}; --no-picture renders without it", camera.name,
                  source.error().message);
    }
    sources.push_back({std::move(*source), camera.source.offset_frames});
  }
  return sources;
}

Status Run(const Flags& flags, const CommonFlags& common) {
  RunRecord run{.scene = flags.scene, .data = flags.data, .width_m = {}, .height_m = {}};
  if (run.scene.empty()) {
    VANTAGE_ASSIGN_OR_RETURN(run, ReadSummary(fs::path(flags.run) / "summary.json"));
    if (!flags.data.empty()) run.data = flags.data;
  }
  VANTAGE_ASSIGN_OR_RETURN(Scene scene, LoadScene(run.scene, run.data));
  flags.person.ApplyTo(scene.person);
  if (!scene.person.width_m) scene.person.width_m = run.width_m;
  if (!scene.person.height_m) scene.person.height_m = run.height_m;
  VANTAGE_RETURN_IF_ERROR(ValidateOptions(scene.person, "person"));
  VANTAGE_RETURN_IF_ERROR(NarrowFrames(flags, scene));
  const fs::path tracks_path =
      flags.tracks.empty() ? fs::path(flags.run) / "tracks.csv" : fs::path(flags.tracks);
  VANTAGE_ASSIGN_OR_RETURN(const Tracks tracks, ReadTracks(tracks_path));
  RenderOptions options;
  flags.render.ApplyTo(options);
  std::vector<SyncedSource> sources;
  if (options.picture) {
    VANTAGE_ASSIGN_OR_RETURN(sources, OpenSources(scene));
  }
  VANTAGE_ASSIGN_OR_RETURN(const RenderReport report,
                           RenderVideo(scene, tracks, std::move(sources), flags.output, options,
                                       common.threads, MakeRunControl(common, "render", "frames")));
  if (common.json) {
    nlohmann::ordered_json json = {
        {"video", flags.output},         {"frames", report.frames},
        {"width_px", report.size.width}, {"height_px", report.size.height},
        {"tracks", tracks.size()},       {"seconds", report.seconds}};
    RecordOptions(options, json["options"] = nlohmann::ordered_json::object());
    fmt::print("{}\n", json.dump(2));
  } else {
    PrintTable(
        {{"video", flags.output},
         {"size", fmt::format("{} x {} px", report.size.width, report.size.height)},
         {"frames", fmt::format("{}  ({:.1f} s of video)", report.frames,
                                static_cast<double>(report.frames) / scene.frames_per_second)},
         {"tracks", fmt::to_string(tracks.size())},
         {"took", fmt::format("{:.1f} s", report.seconds)}});
  }
  return {};
}

}  // namespace

Command RenderCommand() {
  return {
      "render", "All views with boxes, numbers and trails beside a plan of the ground, as a video",
      [](CLI::App& app) -> Action {
        auto flags = std::make_shared<Flags>();
        app.add_option("run", flags->run, "Output folder of `vantage track`")->required();
        app.add_option("-o,--output", flags->output, "Video to write (.mp4, H.264)")->required();
        app.add_option("--scene", flags->scene,
                       "Scene file; default: the one that the folder's summary.json names");
        app.add_option("--data", flags->data,
                       "Folder that paths in the scene are relative to; default: the run's, or the "
                       "scene's own");
        app.add_option("--tracks", flags->tracks,
                       "Tracks, CSV or MOTChallenge text; default: the folder's tracks.csv");
        app.add_option("--first-frame", flags->first_frame,
                       "First frame to render; default: the scene's")
            ->check(CLI::NonNegativeNumber);
        app.add_option("--frames", flags->frames, "Frames to render; default: to the end")
            ->check(CLI::PositiveNumber);
        flags->render = AddOptionFlags(app, RenderOptions{}, "", "Render");
        flags->person = AddOptionFlags(app, PersonSpec{}, "person-", "Person");
        return [flags](const CommonFlags& common) { return Run(*flags, common); };
      }};
}

}  // namespace vantage::app
