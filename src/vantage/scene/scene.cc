// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/scene/scene.h"

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <utility>

#include "vantage/base/file.h"
#include "vantage/scene/camera_reader.h"
#include "vantage/scene/toml_table.h"
#include "vantage/video/detections.h"
#include "vantage/video/open.h"

namespace vantage {
namespace {

namespace fs = std::filesystem;
using internal::TableReader;

constexpr std::size_t kMaxFileBytes = 1 << 24;
constexpr std::int64_t kMaxFrames = 1'000'000'000;
constexpr std::array<std::string_view, 6> kStages = {"background", "hold",     "occupancy",
                                                     "linking",    "identity", "tracks"};

Result<Polygon> MakePolygon(const TableReader& area, std::string_view key,
                            const std::vector<std::vector<double>>& corners) {
  // Polygon::Create compares all pairs of edges.
  constexpr std::size_t kMaxCorners = 1000;
  if (corners.size() > kMaxCorners) {
    return area.FailAt(
        key, fmt::format("has {} corners; a polygon may have {}", corners.size(), kMaxCorners));
  }
  std::vector<Eigen::Vector2d> corners_m;
  for (const std::vector<double>& corner : corners) corners_m.emplace_back(corner[0], corner[1]);
  Result<Polygon> polygon = Polygon::Create(std::move(corners_m));
  if (!polygon) return area.FailAt(key, polygon.error().message);
  return polygon;
}

Result<std::vector<Polygon>> ReadPolygons(const TableReader& area, std::string_view key) {
  std::vector<Polygon> polygons;
  if (!area.Has(key)) return polygons;
  VANTAGE_ASSIGN_OR_RETURN(const auto lists, area.ListOfRows(key, 2));
  for (const auto& corners : lists) {
    VANTAGE_ASSIGN_OR_RETURN(Polygon polygon, MakePolygon(area, key, corners));
    polygons.push_back(std::move(polygon));
  }
  return polygons;
}

Status ReadArea(const TableReader& root, Scene& scene) {
  VANTAGE_ASSIGN_OR_RETURN(const TableReader area, root.Table("area"));
  VANTAGE_RETURN_IF_ERROR(area.AllowOnly({"polygon", "doors", "entrances", "obstacles"}));
  VANTAGE_ASSIGN_OR_RETURN(const auto corners, area.Rows("polygon", 2));
  VANTAGE_ASSIGN_OR_RETURN(scene.area, MakePolygon(area, "polygon", corners));
  VANTAGE_ASSIGN_OR_RETURN(scene.doors, ReadPolygons(area, "doors"));
  VANTAGE_ASSIGN_OR_RETURN(scene.obstacles, ReadPolygons(area, "obstacles"));
  if (area.Has("entrances")) {
    VANTAGE_ASSIGN_OR_RETURN(const auto points, area.Rows("entrances", 2));
    for (const std::vector<double>& point : points) {
      scene.entrances_m.emplace_back(point[0], point[1]);
    }
  }
  return {};
}

Status ReadFrames(const TableReader& root, Scene& scene) {
  VANTAGE_ASSIGN_OR_RETURN(scene.frames_per_second,
                           root.Number("frames_per_second", Range::AboveUpTo(0, 1000)));
  if (root.Has("first_frame")) {
    VANTAGE_ASSIGN_OR_RETURN(scene.first_frame, root.Integer("first_frame", 0, kMaxFrames));
  }
  if (root.Has("frame_count")) {
    VANTAGE_ASSIGN_OR_RETURN(scene.frame_count, root.Integer("frame_count", 1, kMaxFrames));
  }
  return {};
}

Status ReadCameras(const TableReader& root, const fs::path& folder, Scene& scene) {
  VANTAGE_ASSIGN_OR_RETURN(const std::vector<TableReader> tables, root.Tables("cameras"));
  std::set<std::string> names;
  for (const TableReader& table : tables) {
    VANTAGE_ASSIGN_OR_RETURN(SceneCamera camera, internal::ReadCamera(table, folder, scene.inputs));
    if (!names.insert(camera.name).second) {
      return table.FailAt(
          "name", fmt::format("is \"{}\" as another camera's is; names must differ", camera.name));
    }
    scene.cameras.push_back(std::move(camera));
  }
  return {};
}

template <class Options>
Status BindTable(const TableReader& root, std::string_view key, Options& options) {
  if (!root.Has(key)) return {};
  VANTAGE_ASSIGN_OR_RETURN(const TableReader table, root.Table(key));
  return table.Bind([&](OptionVisitor& visitor) { VisitOptions(options, visitor); });
}

}  // namespace

void VisitOptions(GridOptions& o, OptionVisitor& v) {
  v.Number({"cell", "m", "side of a cell of the ground"}, o.cell_m, Range::Between(0.02, 10));
  v.NumberOr({"extension", "m", "how far the grid goes beyond the area"}, o.extension_m, "auto",
             Range::Between(0, 100));
  v.Number({"max_extension", "m", "how far an extension of auto goes at most"}, o.max_extension_m,
           Range::Between(0, 100));
  v.Number({"covering_share", "", "who covers less of a person inside needs no cell (auto)"},
           o.covering_share, Range::Between(0.01, 1));
}

Result<std::unique_ptr<FrameSource>> OpenSource(const SourceSpec& source) {
  switch (source.kind) {
    case SourceSpec::Kind::kVideo:
      return OpenVideo(source.path);
    case SourceSpec::Kind::kPictures:
      return OpenPictures(source.path);
    case SourceSpec::Kind::kMasks:
      return OpenMasks(source.path);
    case SourceSpec::Kind::kDetections:
      return OpenDetections(source.path, source.size, source.min_score);
  }
  return Fail("{}: this kind of source is not known", source.path.string());
}

struct StageTables::Content {
  std::string file;
  std::map<std::string, internal::TomlValue, std::less<>> tables;
};

StageTables::StageTables() = default;
StageTables::~StageTables() = default;
StageTables::StageTables(StageTables&&) noexcept = default;
StageTables& StageTables::operator=(StageTables&&) noexcept = default;
StageTables::StageTables(std::unique_ptr<Content> content) : content_(std::move(content)) {}

bool StageTables::Has(std::string_view name) const {
  return content_ != nullptr && content_->tables.contains(name);
}

std::vector<std::string> StageTables::given() const {
  std::vector<std::string> names;
  if (content_ == nullptr) return names;
  for (const auto& [name, table] : content_->tables) names.push_back(name);
  return names;
}

Status StageTables::BindWith(std::string_view name,
                             const std::function<void(OptionVisitor&)>& visit) const {
  if (!Has(name)) return {};
  const auto found = content_->tables.find(name);
  return TableReader(content_->file, found->first, found->second).Bind(visit);
}

Result<Scene> LoadScene(const fs::path& path, const fs::path& data_folder) {
  VANTAGE_ASSIGN_OR_RETURN(const std::string text, ReadTextFile(path, kMaxFileBytes));
  const std::string file = path.string();
  VANTAGE_ASSIGN_OR_RETURN(const internal::TomlValue document, internal::ParseToml(file, text));
  const TableReader root(file, "", document);
  std::vector<std::string_view> keys = {
      "name",   "frames_per_second", "first_frame", "frame_count", "area", "grid", "person",
      "cameras"};
  keys.insert(keys.end(), kStages.begin(), kStages.end());
  VANTAGE_RETURN_IF_ERROR(root.AllowOnly(keys));

  Scene scene;
  scene.file = path;
  scene.inputs.push_back(path);
  VANTAGE_ASSIGN_OR_RETURN(scene.name, root.Text("name"));
  VANTAGE_RETURN_IF_ERROR(ReadFrames(root, scene));
  VANTAGE_RETURN_IF_ERROR(ReadArea(root, scene));
  VANTAGE_RETURN_IF_ERROR(BindTable(root, "grid", scene.grid));
  VANTAGE_RETURN_IF_ERROR(BindTable(root, "person", scene.person));
  VANTAGE_RETURN_IF_ERROR(
      ReadCameras(root, data_folder.empty() ? path.parent_path() : data_folder, scene));

  auto stages = std::make_unique<StageTables::Content>();
  stages->file = file;
  for (const std::string_view stage : kStages) {
    if (!root.Has(stage)) continue;
    VANTAGE_RETURN_IF_ERROR(root.Table(stage));  // it is a table
    const auto& entries = std::get<internal::TomlEntries>(document.value);
    stages->tables.emplace(stage, entries.find(stage)->second);
  }
  scene.stages = StageTables(std::move(stages));
  return scene;
}

}  // namespace vantage
