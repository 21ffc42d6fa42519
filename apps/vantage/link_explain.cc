// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "link_explain.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "vantage/base/text.h"
#include "vantage/linking/access.h"
#include "vantage/rendering/linking_picture.h"
#include "vantage/video/mask_writer.h"

namespace vantage::app {
namespace {

/// How far before and after the stretch alternatives may go.
constexpr double kMargin_secs = 5;
/// Pictures take room: no more frames than this at once.
constexpr FrameIndex kMaxFrames = 10'000;

nlohmann::ordered_json Position(const GroundGrid& grid, CellIndex cell) {
  const Eigen::Vector2d center = grid.Center(cell);
  return nlohmann::ordered_json::array({center.x(), center.y()});
}

std::string Text(const Eigen::Vector2d& position_m) {
  return fmt::format("({:.2f}, {:.2f})", position_m.x(), position_m.y());
}

}  // namespace

std::string ParseFrameRange(const std::string& text, FrameRange& range) {
  const std::vector<std::string_view> ends = Fields(text, ':');
  if (ends.size() != 2 || !ParseNumber(ends[0], range.first) || !ParseNumber(ends[1], range.last) ||
      range.first < 0 || range.last < range.first) {
    return fmt::format("'{}' is no range of frames; it must be A:B with 0 <= A <= B", text);
  }
  if (range.last - range.first >= kMaxFrames) {
    return fmt::format("{} has more than {} frames; explain a shorter stretch", text, kMaxFrames);
  }
  return "";
}

Result<LinkExplanation> LinkExplanation::Create(const std::filesystem::path& folder,
                                                const FrameRange& range) {
  VANTAGE_ASSIGN_OR_RETURN(StagedDirectory staged, StagedDirectory::Create(folder, false));
  return LinkExplanation(std::move(staged), range);
}

Status LinkExplanation::CheckFrames(const OccupancyMaps& maps) const {
  const FrameIndex end = maps.first_frame + maps.frame_count();
  if (range_.first >= maps.first_frame && range_.last < end) return {};
  return Fail("--frames {}:{}: the maps have the frames {} to {}", range_.first, range_.last,
              maps.first_frame, end - 1);
}

void LinkExplanation::Record(const LinkedMaps& linked, const Stretch& stretch,
                             const Alternatives& alternatives) {
  const OccupancyMaps& maps = linked.maps;
  nlohmann::ordered_json json = {{"first_frame", range_.first},
                                 {"last_frame", range_.last},
                                 {"margin_frames", stretch.margin_frames},
                                 {"next_best", nullptr},
                                 {"further_path", nullptr}};
  rows_.push_back({"explained", fmt::format("frames {} to {}, {} paths", range_.first, range_.last,
                                            alternatives.paths.size())});
  std::string next_best = "none";
  if (alternatives.next_best) {
    json["next_best"] = *alternatives.next_best;
    next_best = fmt::format("costs {:.3f} more", *alternatives.next_best);
  }
  rows_.push_back({"next-best solution", next_best});
  std::string further = "none fits";
  if (const auto& path = alternatives.further) {
    const FrameIndex first = maps.first_frame + path->first_frame;
    const FrameIndex last = maps.first_frame + path->last_frame;
    json["further_path"] = {
        {"missing", path->missing}, {"first_frame", first}, {"last_frame", last}};
    further = fmt::format("costs {:.3f} more, at frames {} to {}", path->missing, first, last);
  }
  rows_.push_back({"one path more", further});
  json["paths"] = nlohmann::ordered_json::array();
  for (const PathInStretch& path : alternatives.paths) {
    const FrameIndex first = maps.first_frame + path.first_frame;
    const FrameIndex last = first + std::ssize(path.cells) - 1;
    nlohmann::ordered_json& entry = json["paths"].emplace_back();
    entry = {{"path", path.path + 1}, {"first_frame", first}, {"last_frame", last},
             {"cost", path.cost},     {"weakest", nullptr},   {"cells", path.cells}};
    std::string weakest = "no step has an alternative";
    if (const auto& step = path.weakest) {
      const FrameIndex frame = maps.first_frame + step->frame;
      entry["weakest"] = {{"frame", frame},
                          {"from", Position(maps.grid, step->from)},
                          {"to", Position(maps.grid, step->to)},
                          {"margin", step->margin}};
      weakest = fmt::format("weakest step at frame {} from {} to {}: margin {:.3f}", frame,
                            Text(maps.grid.Center(step->from)), Text(maps.grid.Center(step->to)),
                            step->margin);
    }
    rows_.push_back(
        {fmt::format("path {}", path.path + 1),
         fmt::format("frames {} to {}, cost {:.3f}; {}", first, last, path.cost, weakest)});
  }
  json_ = std::move(json);
}

Status LinkExplanation::Finish(const LinkedMaps& linked, const RunControl& control) {
  const OccupancyMaps& maps = linked.maps;
  VANTAGE_RETURN_IF_ERROR(CheckFrames(maps));
  const Stretch stretch = {.first_frame = range_.first - maps.first_frame,
                           .last_frame = range_.last - maps.first_frame,
                           .margin_frames = static_cast<std::int64_t>(
                               std::lround(kMargin_secs * maps.frames_per_second))};
  const std::vector<std::uint8_t> access =
      AccessCells(maps, linked.linking.access, linked.scene.doors);
  const std::vector<std::uint8_t> obstacle = CellsIn(maps.grid, linked.scene.obstacles);
  VANTAGE_ASSIGN_OR_RETURN(const Alternatives alternatives,
                           FindAlternatives(ProblemOf(maps, access, obstacle), linked.linking,
                                            linked.paths, stretch, control));
  Record(linked, stretch, alternatives);

  const LinkingPicture draw(linked.scene, maps, linked.paths, linked.tracks.support);
  const auto write = [&](const std::string& name, const cv::Mat& picture) {
    return WritePng(folder_.temporary() / name, picture);
  };
  VANTAGE_RETURN_IF_ERROR(write("stretch.png", draw.DrawStretch(stretch, alternatives)));
  // One picture a second, with the paths since the one before.
  const auto step = std::max<std::int64_t>(1, std::llround(maps.frames_per_second));
  for (std::int64_t frame = stretch.first_frame; frame <= stretch.last_frame; frame += step) {
    if (control.Stopped()) return Cancelled();
    const std::int64_t since = std::max<std::int64_t>(0, frame - step);
    VANTAGE_RETURN_IF_ERROR(write(fmt::format("frame_{:06}.png", maps.first_frame + frame),
                                  draw.DrawFrame(frame, since)));
  }
  VANTAGE_RETURN_IF_ERROR(
      WriteTextFile(folder_.temporary() / "explanation.json", json_.dump(2) + "\n"));
  return folder_.Commit();
}

}  // namespace vantage::app
