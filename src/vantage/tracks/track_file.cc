// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/tracks/track_file.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <tuple>
#include <utility>

#include "vantage/base/file.h"
#include "vantage/base/text.h"

namespace vantage {
namespace {

constexpr FrameIndex kMaxFrame = 1'000'000'000;

/// A line of a table: where it stands, for messages, and its fields.
struct Row {
  std::string where;  // file:line
  std::vector<std::string_view> fields;

  Result<double> Number(std::size_t column, const char* name) const {
    double value = 0;
    if (!ParseNumber(fields[column], value) || !std::isfinite(value)) {
      return Fail("{}: {} is '{}'; it must be a finite number", where, name, fields[column]);
    }
    return value;
  }

  /// Some tools write whole numbers as 1.0.
  Result<std::int64_t> Whole(std::size_t column, const char* name, std::int64_t low) const {
    VANTAGE_ASSIGN_OR_RETURN(const double value, Number(column, name));
    if (value != std::floor(value) || value < static_cast<double>(low) ||
        value > static_cast<double>(kMaxFrame)) {
      return Fail("{}: {} is {}; it must be a whole number from {} to {}", where, name,
                  fields[column], low, kMaxFrame);
    }
    return static_cast<std::int64_t>(value);
  }
};

/// Points of each id by frame; refuses two in one frame.
template <class Point>
class TrackCollector {
 public:
  Status Add(const Row& row, std::int64_t id, const Point& point) {
    if (!tracks_[id].emplace(point.frame, point).second) {
      return Fail("{}: id {} has a second position in frame {}", row.where, id, row.fields[0]);
    }
    return {};
  }

  template <class TrackType>
  std::vector<TrackType> Take() {
    std::vector<TrackType> tracks;
    for (auto& [id, points] : tracks_) {
      TrackType& track = tracks.emplace_back();
      track.id = static_cast<TrackId>(id);
      for (auto& [frame, point] : points) track.points.push_back(point);
    }
    return tracks;
  }

 private:
  std::map<std::int64_t, std::map<FrameIndex, Point>> tracks_;
};

/// Calls `visit(row)` for each line that is not empty, after `lines_to_skip`.
template <class Visit>
Status ForEachRow(const std::filesystem::path& path, std::string_view text,
                  std::size_t lines_to_skip, std::size_t min_fields, const Visit& visit) {
  return ForEachLine(text, [&](std::string_view line, std::size_t number) -> Status {
    if (line.empty() || number <= lines_to_skip) return {};
    const Row row{fmt::format("{}:{}", path.string(), number), Fields(line)};
    if (row.fields.size() < min_fields) {
      return Fail("{}: has {} fields; at least {} are needed", row.where, row.fields.size(),
                  min_fields);
    }
    return visit(row);
  });
}

Result<Tracks> ReadCsv(const std::filesystem::path& path, std::string_view text,
                       const std::vector<std::string_view>& header) {
  const auto inferred = static_cast<std::size_t>(
      std::find(header.begin(), header.end(), "inferred") - header.begin());
  TrackCollector<TrackPoint> tracks;
  VANTAGE_RETURN_IF_ERROR(
      ForEachRow(path, text, 1, header.size(), [&](const Row& row) -> Status {
        TrackPoint point;
        VANTAGE_ASSIGN_OR_RETURN(point.frame, row.Whole(0, "frame", 0));
        VANTAGE_ASSIGN_OR_RETURN(const std::int64_t id, row.Whole(1, "id", 0));
        VANTAGE_ASSIGN_OR_RETURN(point.x_m, row.Number(2, "x"));
        VANTAGE_ASSIGN_OR_RETURN(point.y_m, row.Number(3, "y"));
        if (inferred < header.size()) {
          VANTAGE_ASSIGN_OR_RETURN(const std::int64_t flag, row.Whole(inferred, "inferred", 0));
          point.inferred = flag != 0;
        }
        return tracks.Add(row, id, point);
      }));
  return tracks.Take<Track>();
}

Result<Tracks> ReadMotChallengeGround(const std::filesystem::path& path, std::string_view text) {
  constexpr std::size_t kX = 7;
  constexpr std::size_t kY = 8;
  TrackCollector<TrackPoint> tracks;
  bool any_position = false;
  VANTAGE_RETURN_IF_ERROR(ForEachRow(path, text, 0, kY + 1, [&](const Row& row) -> Status {
    TrackPoint point;
    VANTAGE_ASSIGN_OR_RETURN(const std::int64_t frame, row.Whole(0, "frame", 1));
    point.frame = frame - 1;
    VANTAGE_ASSIGN_OR_RETURN(const std::int64_t id, row.Whole(1, "id", 0));
    VANTAGE_ASSIGN_OR_RETURN(point.x_m, row.Number(kX, "x (column 8)"));
    VANTAGE_ASSIGN_OR_RETURN(point.y_m, row.Number(kY, "y (column 9)"));
    any_position = any_position || point.x_m != -1 || point.y_m != -1;
    return tracks.Add(row, id, point);
  }));
  if (!any_position) {
    return Fail("{}: has no positions on the ground (columns 8 and 9 are all -1)", path.string());
  }
  return tracks.Take<Track>();
}

}  // namespace

Result<Tracks> ReadTracks(const std::filesystem::path& path) {
  VANTAGE_ASSIGN_OR_RETURN(const std::string text, ReadTextFile(path));
  const std::string_view first = std::string_view(text).substr(0, text.find('\n'));
  const std::vector<std::string_view> header = Fields(first);
  if (header.size() >= 4 && header[0] == "frame" && header[1] == "id" && header[2] == "x" &&
      header[3] == "y") {
    return ReadCsv(path, text, header);
  }
  double number = 0;
  if (!ParseNumber(header[0], number)) {
    return Fail("{}:1: is neither the header frame,id,x,y,... of a track file nor a line of "
                "MOTChallenge's text",
                path.string());
  }
  return ReadMotChallengeGround(path, text);
}

Result<std::vector<BoxTrack>> ReadBoxTracks(const std::filesystem::path& path) {
  VANTAGE_ASSIGN_OR_RETURN(const std::string text, ReadTextFile(path));
  TrackCollector<BoxTrackPoint> tracks;
  VANTAGE_RETURN_IF_ERROR(ForEachRow(path, text, 0, 6, [&](const Row& row) -> Status {
    BoxTrackPoint point;
    VANTAGE_ASSIGN_OR_RETURN(const std::int64_t frame, row.Whole(0, "frame", 1));
    point.frame = frame - 1;
    VANTAGE_ASSIGN_OR_RETURN(const std::int64_t id, row.Whole(1, "id", 0));
    VANTAGE_ASSIGN_OR_RETURN(point.box.left, row.Number(2, "left"));
    VANTAGE_ASSIGN_OR_RETURN(point.box.top, row.Number(3, "top"));
    VANTAGE_ASSIGN_OR_RETURN(point.box.width, row.Number(4, "width"));
    VANTAGE_ASSIGN_OR_RETURN(point.box.height, row.Number(5, "height"));
    if (point.box.width <= 0 || point.box.height <= 0) {
      return Fail("{}: the box is {} x {} px; both must be above 0", row.where, point.box.width,
                  point.box.height);
    }
    if (row.fields.size() > 6) {
      VANTAGE_ASSIGN_OR_RETURN(const double confidence, row.Number(6, "confidence"));
      if (confidence == 0) return {};
    }
    return tracks.Add(row, id, point);
  }));
  return tracks.Take<BoxTrack>();
}

Status WriteTracks(const std::filesystem::path& path, const Tracks& tracks,
                   double frames_per_second) {
  std::vector<std::tuple<FrameIndex, std::int64_t, const TrackPoint*>> rows;
  for (const Track& track : tracks) {
    for (const TrackPoint& point : track.points) {
      rows.emplace_back(point.frame, static_cast<std::int64_t>(track.id), &point);
    }
  }
  std::sort(rows.begin(), rows.end());
  std::string text = "frame,id,x,y,time,inferred\n";
  for (const auto& [frame, id, point] : rows) {
    fmt::format_to(std::back_inserter(text), "{},{},{:.4f},{:.4f},{:.4f},{}\n", frame, id,
                   point->x_m, point->y_m, static_cast<double>(frame) / frames_per_second,
                   point->inferred ? 1 : 0);
  }
  return WriteTextFile(path, text);
}

}  // namespace vantage
