// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "link_stream.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

#include "vantage/linking/access.h"
#include "vantage/linking/link_maps.h"
#include "vantage/linking/live_tracks.h"
#include "vantage/occupancy/map_file.h"
#include "vantage/occupancy/map_reader.h"
#include "vantage/tracks/track_file.h"

namespace vantage::app {
namespace {

Status Write(TrackWriter& writer, const std::vector<TrackRow>& rows) {
  for (const TrackRow& row : rows) VANTAGE_RETURN_IF_ERROR(writer.Write(row.track, row.point));
  return {};
}

/// The optimum over all frames at once, for which all maps must be in memory; by the rules of the
/// stream.
Result<LinkingReport> LinkWhole(const LinkStreamJob& job, const CommonFlags& common) {
  VANTAGE_ASSIGN_OR_RETURN(const OccupancyMaps maps, ReadMaps(job.maps));
  LinkingOptions linking = job.linking;
  linking.inside_cost = linking.inside_cost.value_or(kInsideCostOfStreams);
  VANTAGE_ASSIGN_OR_RETURN(const LinkMapsResult result,
                           LinkMaps(maps, linking, job.tracks, job.doors, job.obstacles,
                                    MakeRunControl(common, "link whole", "steps")));
  return result.report.linking;
}

void PrintReport(const GroundGrid& grid, const LinkStreamJob& job, const LiveReport& live,
                 const std::optional<LinkingReport>& whole, bool as_json) {
  const StreamReport& linking = live.linking;
  const double gap = whole ? linking.cost - whole->cost : 0;
  const double relative_gap = gap == 0 ? 0 : gap / std::abs(whole->cost);
  if (as_json) {
    nlohmann::ordered_json json = {{"frames", linking.frames},
                                   {"columns", grid.columns},
                                   {"rows", grid.rows},
                                   {"lag", job.lag_secs},
                                   {"lag_frames", live.lag_frames},
                                   {"paths", linking.paths},
                                   {"cost", linking.cost},
                                   {"tracks", live.tracks},
                                   {"dropped_paths", linking.paths - live.tracks},
                                   {"positions", live.positions},
                                   {"inferred", live.inferred},
                                   {"seconds", live.seconds}};
    if (whole) {
      json["whole"] = {{"paths", whole->paths}, {"cost", whole->cost}, {"seconds", whole->seconds}};
      json["gap"] = {{"absolute", gap}, {"relative", relative_gap}};
    }
    fmt::print("{}\n", json.dump(2));
    return;
  }
  std::vector<ReportRow> rows = {
      {"frames", fmt::to_string(linking.frames)},
      {"grid", fmt::format("{} x {} cells of {} m", grid.columns, grid.rows, grid.cell_m)},
      {"lag", fmt::format("{} s  ({} frames)", job.lag_secs, live.lag_frames)},
      {"paths", fmt::format("{}  (cost {:.3f})", linking.paths, linking.cost)},
      {"tracks", fmt::format("{}  ({} paths outside the area or too short)", live.tracks,
                             linking.paths - live.tracks)},
      {"positions", fmt::format("{}  ({} inferred)", live.positions, live.inferred)},
      {"linking", fmt::format("{:.2f} s", live.seconds)}};
  if (whole) {
    rows.push_back({"whole", fmt::format("{} paths  (cost {:.3f}), {:.2f} s", whole->paths,
                                         whole->cost, whole->seconds)});
    rows.push_back({"gap", fmt::format("{:.3f}  ({:.3f} %)", gap, 100 * relative_gap)});
  }
  PrintTable(rows);
}

}  // namespace

Status LinkStream(LinkStreamJob job, const CommonFlags& common) {
  VANTAGE_ASSIGN_OR_RETURN(const MapReader reader, MapReader::Open(job.maps));
  const OccupancyMaps& header = reader.header();
  VANTAGE_ASSIGN_OR_RETURN(job.doors, DoorsAndEntrances(header.grid, job.doors, job.entrances_m));
  VANTAGE_ASSIGN_OR_RETURN(
      LiveTracks live,
      LiveTracks::Create(header, job.linking, job.tracks, job.lag_secs, job.doors, job.obstacles));
  VANTAGE_ASSIGN_OR_RETURN(TrackWriter writer,
                           TrackWriter::Create(job.output, header.frames_per_second));
  {
    const RunControl control = MakeRunControl(common, "link", "frames");
    std::vector<float> map(static_cast<std::size_t>(header.grid.count()));
    for (std::int64_t frame = 0; frame < reader.frame_count(); ++frame) {
      if (control.Stopped()) return Cancelled();
      VANTAGE_RETURN_IF_ERROR(reader.Read(frame, map));
      VANTAGE_ASSIGN_OR_RETURN(const std::vector<TrackRow> rows, live.Add(map));
      VANTAGE_RETURN_IF_ERROR(Write(writer, rows));
      control.Report(frame + 1, reader.frame_count());
    }
    VANTAGE_RETURN_IF_ERROR(Write(writer, live.Finish()));
  }
  std::optional<LinkingReport> whole;
  if (job.gap) {
    VANTAGE_ASSIGN_OR_RETURN(whole, LinkWhole(job, common));
  }
  VANTAGE_RETURN_IF_ERROR(writer.Commit());
  PrintReport(header.grid, job, live.report(), whole, common.json);
  return {};
}

}  // namespace vantage::app
