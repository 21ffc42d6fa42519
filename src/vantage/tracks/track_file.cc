// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/tracks/track_file.h"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "vantage/base/file.h"
#include "vantage/base/text.h"

namespace vantage {
namespace fs = std::filesystem;
namespace {

constexpr std::int64_t kLastFrame = 1'000'000'000;
constexpr std::int64_t kLastId = std::int64_t{1} << 53;  // whole numbers are exact up to here

/// One line of a file, cut at its commas.
struct Row {
  std::string place;  // file:line
  std::size_t number = 0;
  std::vector<std::string_view> fields;
};

Result<double> ParseFinite(const Row& row, std::size_t column, std::string_view name) {
  if (column >= row.fields.size()) {
    return Fail("{}: has {} columns; '{}' is column {}", row.place, row.fields.size(), name,
                column + 1);
  }
  double value = 0;
  if (!ParseNumber(row.fields[column], value) || !std::isfinite(value)) {
    return Fail("{}: {} is '{}'; it must be a finite number", row.place, name, row.fields[column]);
  }
  return value;
}

/// Some tools write whole numbers as 1.0.
Result<std::int64_t> ParseWhole(const Row& row, std::size_t column, std::string_view name,
                                std::int64_t low, std::int64_t high) {
  VANTAGE_ASSIGN_OR_RETURN(const double value, ParseFinite(row, column, name));
  if (value != std::floor(value) || value < static_cast<double>(low) ||
      value > static_cast<double>(high)) {
    return Fail("{}: {} is {}; it must be a whole number from {} to {}", row.place, name,
                row.fields[column], low, high);
  }
  return static_cast<std::int64_t>(value);
}

/// A frame of a file that counts from `first`, as one that counts from 0.
Result<FrameIndex> ParseFrame(const Row& row, std::size_t column, FrameIndex first) {
  VANTAGE_ASSIGN_OR_RETURN(const std::int64_t frame,
                           ParseWhole(row, column, "frame", first, kLastFrame));
  return frame - first;
}

Result<std::int64_t> ParseId(const Row& row, std::size_t column) {
  return ParseWhole(row, column, "id", -kLastId, kLastId);
}

/// The lines of a file that are not blank; at least one.
Result<std::vector<Row>> Rows(const fs::path& path, std::string_view text) {
  std::vector<Row> rows;
  VANTAGE_RETURN_IF_ERROR(ForEachLine(text, [&](std::string_view line, std::size_t number) {
    if (!line.empty()) {
      rows.push_back({.place = fmt::format("{}:{}", path.string(), number),
                      .number = number,
                      .fields = Fields(line)});
    }
    return Status();
  }));
  if (!rows.empty()) return rows;
  return Fail(
      "{}: is empty; a track file begins with the header frame,id,x,y or is MOTChallenge's "
      "text",
      path.string());
}

/// MOTChallenge's text has none: its lines are numbers throughout.
bool IsHeader(const Row& row) {
  double number = 0;
  return !ParseNumber(row.fields.front(), number);
}

/// Collects points by id and checks that no id comes twice in a frame.
template <class Point>
class Collector {
 public:
  Status Add(const Row& row, std::int64_t id, const Point& point) {
    const auto [known, added] = points_[id].emplace(point.frame, Read{point, row.number});
    if (added) return {};
    return Fail(
        "{}: id {} comes twice in this frame, first in line {}; ids must be unique within a "
        "frame",
        row.place, id, known->second.line);
  }

  template <class AnyTrack>
  std::vector<AnyTrack> Finish(TrackLines* lines) const {
    std::vector<AnyTrack> tracks;
    for (const auto& [id, points] : points_) {
      AnyTrack& track = tracks.emplace_back();
      track.id = TrackId{id};
      for (const auto& [frame, read] : points) {
        track.points.push_back(read.point);
        if (lines != nullptr) lines->emplace(std::pair(track.id, frame), read.line);
      }
    }
    return tracks;
  }

 private:
  struct Read {
    Point point;
    std::size_t line;
  };
  std::map<std::int64_t, std::map<FrameIndex, Read>> points_;
};

struct CsvColumns {
  std::size_t frame = 0, id = 0, x = 0, y = 0;
  std::optional<std::size_t> inferred;
};

Result<CsvColumns> ReadHeader(const Row& header) {
  const auto find = [&](std::string_view name) -> std::optional<std::size_t> {
    const auto found = std::find(header.fields.begin(), header.fields.end(), name);
    if (found == header.fields.end()) return std::nullopt;
    return static_cast<std::size_t>(found - header.fields.begin());
  };
  CsvColumns columns;
  for (const auto& [name, column] : {std::pair{"frame", &columns.frame},
                                     {"id", &columns.id},
                                     {"x", &columns.x},
                                     {"y", &columns.y}}) {
    const std::optional<std::size_t> found = find(name);
    if (!found) {
      return Fail("{}: the header has no column '{}'; it must have frame,id,x,y", header.place,
                  name);
    }
    *column = *found;
  }
  columns.inferred = find("inferred");
  return columns;
}

Result<Tracks> ReadCsv(std::span<const Row> rows, TrackLines* lines) {
  VANTAGE_ASSIGN_OR_RETURN(const CsvColumns columns, ReadHeader(rows.front()));
  Collector<TrackPoint> collector;
  for (const Row& row : rows.subspan(1)) {
    TrackPoint point;
    VANTAGE_ASSIGN_OR_RETURN(point.frame, ParseFrame(row, columns.frame, 0));
    VANTAGE_ASSIGN_OR_RETURN(const std::int64_t id, ParseId(row, columns.id));
    VANTAGE_ASSIGN_OR_RETURN(point.x_m, ParseFinite(row, columns.x, "x"));
    VANTAGE_ASSIGN_OR_RETURN(point.y_m, ParseFinite(row, columns.y, "y"));
    if (columns.inferred) {
      VANTAGE_ASSIGN_OR_RETURN(const std::int64_t inferred,
                               ParseWhole(row, *columns.inferred, "inferred", 0, 1));
      point.inferred = inferred == 1;
    }
    VANTAGE_RETURN_IF_ERROR(collector.Add(row, id, point));
  }
  return collector.Finish<Track>(lines);
}

Result<Tracks> ReadMotChallenge(std::span<const Row> rows, TrackLines* lines) {
  Collector<TrackPoint> collector;
  for (const Row& row : rows) {
    TrackPoint point;
    VANTAGE_ASSIGN_OR_RETURN(point.frame, ParseFrame(row, 0, 1));
    VANTAGE_ASSIGN_OR_RETURN(const std::int64_t id, ParseId(row, 1));
    VANTAGE_ASSIGN_OR_RETURN(point.x_m, ParseFinite(row, 7, "x"));
    VANTAGE_ASSIGN_OR_RETURN(point.y_m, ParseFinite(row, 8, "y"));
    if (point.x_m == -1 && point.y_m == -1) {
      return Fail(
          "{}: x and y are -1, so the position is not known; ground positions in metres "
          "are needed in columns 8 and 9",
          row.place);
    }
    VANTAGE_RETURN_IF_ERROR(collector.Add(row, id, point));
  }
  return collector.Finish<Track>(lines);
}

}  // namespace

Result<Tracks> ReadTracks(const fs::path& path, TrackLines* lines) {
  VANTAGE_ASSIGN_OR_RETURN(const std::string text, ReadTextFile(path));
  VANTAGE_ASSIGN_OR_RETURN(const std::vector<Row> rows, Rows(path, text));
  return IsHeader(rows.front()) ? ReadCsv(rows, lines) : ReadMotChallenge(rows, lines);
}

Result<BoxTracks> ReadBoxTracks(const fs::path& path, TrackLines* lines) {
  VANTAGE_ASSIGN_OR_RETURN(const std::string text, ReadTextFile(path));
  VANTAGE_ASSIGN_OR_RETURN(const std::vector<Row> rows, Rows(path, text));
  if (IsHeader(rows.front())) {
    return Fail("{}: begins with a header; boxes are read from MOTChallenge's text, which has none",
                path.string());
  }
  Collector<BoxPoint> collector;
  for (const Row& row : rows) {
    BoxPoint point;
    VANTAGE_ASSIGN_OR_RETURN(point.frame, ParseFrame(row, 0, 1));
    VANTAGE_ASSIGN_OR_RETURN(const std::int64_t id, ParseId(row, 1));
    VANTAGE_ASSIGN_OR_RETURN(point.left_px, ParseFinite(row, 2, "left"));
    VANTAGE_ASSIGN_OR_RETURN(point.top_px, ParseFinite(row, 3, "top"));
    VANTAGE_ASSIGN_OR_RETURN(point.width_px, ParseFinite(row, 4, "width"));
    VANTAGE_ASSIGN_OR_RETURN(point.height_px, ParseFinite(row, 5, "height"));
    if (point.width_px <= 0 || point.height_px <= 0) {
      return Fail("{}: the box is {} x {} pixels; both must be above 0", row.place, point.width_px,
                  point.height_px);
    }
    if (row.fields.size() > 6) {
      VANTAGE_ASSIGN_OR_RETURN(const double confidence, ParseFinite(row, 6, "confidence"));
      if (confidence == 0) continue;
    }
    VANTAGE_RETURN_IF_ERROR(collector.Add(row, id, point));
  }
  return collector.Finish<BoxTrack>(lines);
}

TrackWriter::TrackWriter(StagedFile staged, double frames_per_second)
    : staged_(std::move(staged)),
      stream_(staged_.temporary(), std::ios::binary),
      frames_per_second_(frames_per_second) {
  stream_ << "frame,id,x,y,time,inferred\n";
}

Result<TrackWriter> TrackWriter::Create(const fs::path& path, double frames_per_second) {
  if (!(std::isfinite(frames_per_second) && frames_per_second > 0)) {
    return Fail("{}: {} frames per second; it must be above 0", path.string(), frames_per_second);
  }
  VANTAGE_ASSIGN_OR_RETURN(StagedFile staged, StagedFile::Create(path));
  TrackWriter writer(std::move(staged), frames_per_second);
  VANTAGE_RETURN_IF_ERROR(writer.CheckWritten());
  return writer;
}

Status TrackWriter::CheckWritten() const {
  if (stream_) return {};
  return Fail("{}: cannot be written: {}", staged_.final_path().string(), std::strerror(errno));
}

Status TrackWriter::Write(TrackId id, const TrackPoint& point) {
  const auto number = static_cast<std::int64_t>(id);
  const auto fail = [&](std::string_view rule) {
    return Fail("{}: track {} is at ({}, {}) m in frame {}; {}", staged_.final_path().string(),
                number, point.x_m, point.y_m, point.frame, rule);
  };
  if (!std::isfinite(point.x_m) || !std::isfinite(point.y_m)) {
    return fail("positions must be finite");
  }
  const std::pair here(point.frame, id);
  if (last_ && *last_ >= here) return fail("positions must come by frame, then by id");
  last_ = here;
  stream_ << fmt::format("{},{},{:.4f},{:.4f},{:.3f},{:d}\n", point.frame, number, point.x_m,
                         point.y_m, static_cast<double>(point.frame) / frames_per_second_,
                         point.inferred);
  return CheckWritten();
}

Status TrackWriter::Commit() {
  stream_.close();
  VANTAGE_RETURN_IF_ERROR(CheckWritten());
  return staged_.Commit();
}

Status WriteTracks(const fs::path& path, const Tracks& tracks, double frames_per_second) {
  std::vector<std::pair<TrackId, const TrackPoint*>> points;
  for (const Track& track : tracks) {
    for (const TrackPoint& point : track.points) points.emplace_back(track.id, &point);
  }
  std::sort(points.begin(), points.end(), [](const auto& a, const auto& b) {
    return std::pair(a.second->frame, a.first) < std::pair(b.second->frame, b.first);
  });
  VANTAGE_ASSIGN_OR_RETURN(TrackWriter writer, TrackWriter::Create(path, frames_per_second));
  for (const auto& [id, point] : points) VANTAGE_RETURN_IF_ERROR(writer.Write(id, *point));
  return writer.Commit();
}

}  // namespace vantage
