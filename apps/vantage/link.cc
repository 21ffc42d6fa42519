// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "command.h"
#include "identity_rows.h"
#include "link_explain.h"
#include "link_stream.h"
#include "vantage/base/file.h"
#include "vantage/identity/appearance_file.h"
#include "vantage/identity/identify.h"
#include "vantage/linking/access.h"
#include "vantage/linking/ksp_run.h"
#include "vantage/linking/link_maps.h"
#include "vantage/occupancy/map_file.h"
#include "vantage/scene/scene.h"
#include "vantage/tracks/track_file.h"

namespace vantage::app {
namespace {

struct StreamOptions {
  std::optional<double> lag_secs;  ///< none: the whole recording at once
};

void VisitOptions(StreamOptions& o, OptionVisitor& v) {
  v.NumberOr({"lag", "s",
              "as a stream: positions of a frame are final once the maps of so many seconds more "
              "(at least one frame) are known; only these are in memory; colours are not used"},
             o.lag_secs, "none", Range::Between(0, 1e6));
}

/// Where the original KSP program writes when nothing is said.
constexpr const char* kKspOutput = "ksp-out.dat";

struct Flags {
  std::filesystem::path maps, ksp, output, scene, data, explain;
  FrameRange frames;
  OptionFlags stream, linking, identity, tracks;
  bool gap = false;
};

/// Defaults, then what the scene says, then the flags given.
struct Setup {
  Scene scene;  ///< without an area, doors and obstacles when none was given
  LinkingOptions linking;
  IdentityOptions identity;
  TrackOptions tracks;
};

Result<Setup> MakeSetup(const Flags& flags) {
  Setup setup;
  if (!flags.scene.empty()) {
    VANTAGE_ASSIGN_OR_RETURN(setup.scene, LoadScene(flags.scene, flags.data));
    VANTAGE_RETURN_IF_ERROR(setup.scene.stages.Bind("linking", setup.linking));
    VANTAGE_RETURN_IF_ERROR(setup.scene.stages.Bind("identity", setup.identity));
    VANTAGE_RETURN_IF_ERROR(setup.scene.stages.Bind("tracks", setup.tracks));
  }
  flags.linking.ApplyTo(setup.linking);
  flags.identity.ApplyTo(setup.identity);
  flags.tracks.ApplyTo(setup.tracks);
  return setup;
}

void PrintReport(const OccupancyMaps& maps, const LinkMapsResult& result,
                 const IdentityReport& identity, const LinkExplanation* explanation, bool as_json) {
  const LinkingReport& linking = result.report.linking;
  std::int64_t positions = 0;
  std::int64_t inferred = 0;
  for (const Track& track : result.tracks) {
    positions += std::ssize(track.points);
    for (const TrackPoint& point : track.points) inferred += point.inferred ? 1 : 0;
  }
  if (as_json) {
    nlohmann::ordered_json json = {{"frames", maps.frame_count()},
                                   {"columns", maps.grid.columns},
                                   {"rows", maps.grid.rows},
                                   {"paths", linking.paths},
                                   {"cost", linking.cost},
                                   {"tracks", result.tracks.size()},
                                   {"dropped_paths", result.report.dropped_paths},
                                   {"positions", positions},
                                   {"inferred", inferred},
                                   {"seconds", linking.seconds}};
    json["appearances"] = identity.appearances;
    json["meetings"] = identity.meetings;
    json["exchanges"] = identity.exchanges.size();
    if (explanation != nullptr) json["explained"] = explanation->json();
    fmt::print("{}\n", json.dump(2));
    return;
  }
  std::vector<ReportRow> rows = {
      {"frames", fmt::to_string(maps.frame_count())},
      {"grid",
       fmt::format("{} x {} cells of {} m", maps.grid.columns, maps.grid.rows, maps.grid.cell_m)},
      {"paths", fmt::format("{}  (cost {:.3f})", linking.paths, linking.cost)},
      {"tracks", fmt::format("{}  ({} paths outside the area or too short)", result.tracks.size(),
                             result.report.dropped_paths)},
      {"positions", fmt::format("{}  ({} inferred)", positions, inferred)}};
  const std::vector<ReportRow> colors = IdentityRows(identity);
  rows.insert(rows.end(), colors.begin(), colors.end());
  rows.push_back({"linking", fmt::format("{:.2f} s", linking.seconds)});
  if (explanation != nullptr) {
    rows.insert(rows.end(), explanation->rows().begin(), explanation->rows().end());
  }
  PrintTable(rows);
}

/// `vantage link maps.h5 -o tracks.csv --explain DIR --frames A:B`.
Status RunMaps(const Flags& flags, const CommonFlags& common) {
  VANTAGE_ASSIGN_OR_RETURN(Setup setup, MakeSetup(flags));
  StreamOptions stream;
  flags.stream.ApplyTo(stream);
  if (stream.lag_secs) {
    return LinkStream({.maps = flags.maps,
                       .output = flags.output,
                       .lag_secs = *stream.lag_secs,
                       .gap = flags.gap,
                       .linking = setup.linking,
                       .tracks = setup.tracks,
                       .doors = setup.scene.doors,
                       .obstacles = setup.scene.obstacles,
                       .entrances_m = setup.scene.entrances_m},
                      common);
  }
  // Staged before the work, so that an output that cannot be written fails at once.
  std::optional<StagedFile> output;
  if (!flags.output.empty()) {
    VANTAGE_ASSIGN_OR_RETURN(output, StagedFile::Create(flags.output));
  }
  std::optional<LinkExplanation> explanation;
  if (!flags.explain.empty()) {
    VANTAGE_ASSIGN_OR_RETURN(explanation, LinkExplanation::Create(flags.explain, flags.frames));
  }
  VANTAGE_ASSIGN_OR_RETURN(const OccupancyMaps maps, ReadMaps(flags.maps));
  Appearances appearances;
  if (setup.identity.appearance) {
    VANTAGE_ASSIGN_OR_RETURN(appearances, ReadAppearances(flags.maps, maps));
  }
  VANTAGE_ASSIGN_OR_RETURN(
      setup.scene.doors, DoorsAndEntrances(maps.grid, setup.scene.doors, setup.scene.entrances_m));
  if (explanation) VANTAGE_RETURN_IF_ERROR(explanation->CheckFrames(maps));
  VANTAGE_ASSIGN_OR_RETURN(
      LinkMapsResult result,
      LinkMaps(maps, setup.linking, setup.tracks, setup.scene.doors, setup.scene.obstacles,
               MakeRunControl(common, "link", "steps")));
  VANTAGE_ASSIGN_OR_RETURN(const IdentityReport identity,
                           IdentifyTracks(maps, appearances, setup.identity, setup.tracks, result,
                                          MakeRunControl(common, "identify", "steps")));
  if (output) {
    VANTAGE_RETURN_IF_ERROR(
        WriteTracks(output->temporary(), result.tracks, maps.frames_per_second));
  }
  if (explanation) {
    VANTAGE_RETURN_IF_ERROR(
        explanation->Finish({setup.scene, maps, setup.linking, setup.tracks, result.paths},
                            MakeRunControl(common, "explain", "paths")));
  }
  if (output) VANTAGE_RETURN_IF_ERROR(output->Commit());
  PrintReport(maps, result, identity, explanation ? &*explanation : nullptr, common.json);
  return {};
}

/// `vantage link --ksp FILE -o out.dat`: the original KSP program's job.
Status RunKspFile(const Flags& flags, const CommonFlags& common) {
  const std::filesystem::path output = flags.output.empty() ? kKspOutput : flags.output;
  VANTAGE_ASSIGN_OR_RETURN(const KspFile file, ReadKspFile(flags.ksp));
  VANTAGE_ASSIGN_OR_RETURN(const KspReport report,
                           RunKsp(file, output, MakeRunControl(common, "link", "steps")));
  if (common.json) {
    const nlohmann::ordered_json json = {{"frames", report.frames},  {"columns", file.columns},
                                         {"rows", file.rows},        {"paths", report.paths},
                                         {"cost", report.cost},      {"seconds", report.seconds},
                                         {"output", output.string()}};
    fmt::print("{}\n", json.dump(2));
    return {};
  }
  PrintTable({{"frames", fmt::to_string(report.frames)},
              {"grid", fmt::format("{} x {} cells", file.columns, file.rows)},
              {"paths", fmt::format("{}  (cost {:.3f})", report.paths, report.cost)},
              {"seconds", fmt::format("{:.2f}", report.seconds)},
              {"output", output.string()}});
  return {};
}

/// Throws what CLI11 throws. It could itself exclude `others` and the options from --ksp, but then
/// the help of each would say so.
void CheckUsage(const Flags& flags, const std::vector<CLI::Option*>& others) {
  if (!flags.ksp.empty()) {
    for (const CLI::Option* other : others) {
      if (other->count() > 0) throw CLI::ExcludesError("--ksp", other->get_name());
    }
    for (const OptionFlags* options :
         {&flags.stream, &flags.linking, &flags.identity, &flags.tracks}) {
      const std::string given = options->AnyGiven();
      if (!given.empty()) throw CLI::ExcludesError("--ksp", given);
    }
    return;
  }
  if (flags.maps.empty()) throw CLI::RequiredError("A file of maps or --ksp");
  if (!flags.explain.empty() && !flags.stream.AnyGiven().empty()) {
    throw CLI::ExcludesError("--explain", flags.stream.AnyGiven());
  }
  if (!flags.stream.AnyGiven().empty() && !flags.identity.AnyGiven().empty()) {
    throw CLI::ExcludesError(flags.stream.AnyGiven(), flags.identity.AnyGiven());
  }
  if (flags.output.empty() && flags.explain.empty()) {
    throw CLI::RequiredError("--output or --explain");
  }
}

}  // namespace

Command LinkCommand() {
  return {
      .name = "link",
      .summary = "Tracks from occupancy maps: the optimal set of paths",
      .define = [](CLI::App& app) -> Action {
        const auto flags = std::make_shared<Flags>();
        CLI::Option* maps =
            app.add_option("maps", flags->maps, "Occupancy maps (HDF5)")->type_name("FILE");
        app.add_option("-o,--output", flags->output,
                       "File of tracks to write (CSV); with --ksp that program's output, default "
                       "ksp-out.dat")
            ->type_name("FILE");
        CLI::Option* scene =
            app.add_option(
                   "--scene", flags->scene,
                   "Scene file whose doors, entrances, obstacles and tables [linking], [identity] "
                   "and [tracks] apply; flags win over its tables")
                ->type_name("FILE");
        app.add_option("--data", flags->data,
                       "Folder that paths in the scene are relative to; default: the scene's "
                       "own")
            ->type_name("DIR")
            ->needs(scene);
        flags->stream = AddOptionFlags(app, StreamOptions{}, "", "Stream");
        app.add_flag("--gap", flags->gap,
                     "Link the whole recording too, and report how far the stream's cost is from "
                     "that optimum")
            ->group("Stream")
            ->needs("--lag");
        flags->linking = AddOptionFlags(app, LinkingOptions{}, "", "Linking");
        flags->identity = AddOptionFlags(app, IdentityOptions{}, "identity-", "Identity");
        flags->tracks = AddOptionFlags(app, TrackOptions{}, "", "Tracks");
        app.add_option("--ksp", flags->ksp,
                       "Configuration of the original KSP program, in place of maps; its frames "
                       "are read, relative to its folder, and linked by its rules")
            ->type_name("FILE");
        CLI::Option* explain =
            app.add_option(
                   "--explain", flags->explain,
                   "Folder for pictures and figures that explain the paths of --frames: the "
                   "map with its paths, where they are weakest, and what other solutions "
                   "would have cost; must not hold anything yet; without -o nothing but "
                   "that is made")
                ->type_name("DIR");
        CLI::Option* frames = app.add_option(
                                     "--frames", [](const CLI::results_t&) { return true; },
                                     "The frames of --explain, both included")
                                  ->check([flags](const std::string& text) {
                                    return ParseFrameRange(text, flags->frames);
                                  })
                                  ->type_name("A:B")
                                  ->needs(explain);
        explain->needs(frames);
        app.parse_complete_callback(
            [flags, others = std::vector{maps, scene, explain}] { CheckUsage(*flags, others); });
        return [flags](const CommonFlags& common) {
          return flags->ksp.empty() ? RunMaps(*flags, common) : RunKspFile(*flags, common);
        };
      }};
}

}  // namespace vantage::app
