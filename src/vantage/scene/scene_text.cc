// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/scene/scene_text.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <string_view>
#include <vector>

namespace vantage {
namespace {

/// As a basic string of TOML.
std::string Quoted(std::string_view text) {
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') {
      quoted += '\\';
      quoted += c;
    } else if (static_cast<unsigned char>(c) < 0x20 || c == 0x7F) {
      quoted += fmt::format("\\u{:04X}", static_cast<unsigned char>(c));
    } else {
      quoted += c;
    }
  }
  return quoted + '"';
}

/// The shortest digits that read back to the same number, as a float of TOML: 3 becomes 3.0.
std::string Text(double value) {
  const std::string text = fmt::to_string(value);
  return text.find_first_of(".e") == std::string::npos ? text + ".0" : text;
}

template <class Values>
std::string List(const Values& values) {
  std::string text;
  for (const double value : values) text += (text.empty() ? "" : ", ") + Text(value);
  return '[' + text + ']';
}

template <class Points>
std::string PointList(const Points& points) {
  std::string text;
  for (const Eigen::Vector2d& point : points) text += (text.empty() ? "" : ", ") + List(point);
  return '[' + text + ']';
}

std::string PolygonList(const std::vector<Polygon>& polygons) {
  std::string text;
  for (const Polygon& polygon : polygons) {
    text += (text.empty() ? "" : ", ") + PointList(polygon.corners_m());
  }
  return '[' + text + ']';
}

std::string SourceText(const SourceSpec& source) {
  const std::string path = Quoted(source.path.string());
  switch (source.kind) {
    case SourceSpec::Kind::kVideo:
      return fmt::format("{{ video = {} }}", path);
    case SourceSpec::Kind::kPictures:
      return fmt::format("{{ pictures = {} }}", path);
    case SourceSpec::Kind::kMasks:
      return fmt::format("{{ masks = {} }}", path);
    case SourceSpec::Kind::kDetections:
      break;
  }
  return fmt::format("{{ detections = {}, min_score = {}, size_px = [{}, {}] }}", path,
                     Text(source.min_score), source.size.width, source.size.height);
}

std::string LensText(const PinholeModel& lens, const CameraPose& pose) {
  std::string rows;
  for (int row = 0; row < 3; ++row) {
    const Eigen::Vector3d values = pose.rotation.row(row);
    rows += (row > 0 ? ", " : "") + List(values);
  }
  return fmt::format(
      "focal_px = [{}, {}]\ncenter_px = [{}, {}]\ndistortion = {}\nrotation = [{}]\n",
      Text(lens.fx_px), Text(lens.fy_px), Text(lens.cx_px), Text(lens.cy_px), List(lens.distortion),
      rows);
}

std::string LensText(const TsaiModel& lens, const CameraPose& pose) {
  const Eigen::Vector3d zyx = pose.rotation.eulerAngles(2, 1, 0);
  return fmt::format(
      "focal_mm = {}\nkappa1_per_mm2 = {}\ndpx_mm = {}\ndpy_mm = {}\nsx = {}\n"
      "center_px = [{}, {}]\nrotation_rad = {}\n",
      Text(lens.focal_mm), Text(lens.kappa1_per_mm2), Text(lens.dpx_mm), Text(lens.dpy_mm),
      Text(lens.sx), Text(lens.cx_px), Text(lens.cy_px),
      List(Eigen::Vector3d(zyx.z(), zyx.y(), zyx.x())));
}

std::string CameraText(const SceneCamera& camera) {
  const LensModel lens = camera.camera.ScaledLens();
  const CameraPose& pose = camera.camera.pose();
  std::string text = fmt::format("\n[[cameras]]\nname = {}\nsource = {}\n", Quoted(camera.name),
                                 SourceText(camera.source));
  if (camera.source.offset_frames != 0) {
    text += fmt::format("offset_frames = {}\n", camera.source.offset_frames);
  }
  text += fmt::format("\n[cameras.calibration.{}]\nsize_px = [{}, {}]\n",
                      std::holds_alternative<TsaiModel>(lens) ? "tsai" : "pinhole",
                      camera.camera.size().width, camera.camera.size().height);
  text += std::visit([&](const auto& model) { return LensText(model, pose); }, lens);
  return text + fmt::format("translation_m = {}\n", List(pose.translation_m));
}

class OptionWriter final : public OptionVisitor {
 public:
  explicit OptionWriter(std::string& text) : text_(text) {}
  void Flag(const OptionInfo& info, bool& value) override {
    text_ += fmt::format("{} = {}\n", info.name, value);
  }
  void Number(const OptionInfo& info, int& value, const Range&) override {
    text_ += fmt::format("{} = {}\n", info.name, value);
  }
  void Number(const OptionInfo& info, double& value, const Range&) override {
    text_ += fmt::format("{} = {}\n", info.name, Text(value));
  }
  void NumberOr(const OptionInfo& info, std::optional<int>& value, std::string_view word,
                const Range&) override {
    text_ += fmt::format("{} = {}\n", info.name, value ? fmt::to_string(*value) : Quoted(word));
  }
  void NumberOr(const OptionInfo& info, std::optional<double>& value, std::string_view word,
                const Range&) override {
    text_ += fmt::format("{} = {}\n", info.name, value ? Text(*value) : Quoted(word));
  }

 protected:
  void ChoiceIndex(const OptionInfo& info, int& index,
                   const std::vector<std::string_view>& names) override {
    text_ += fmt::format("{} = {}\n", info.name, Quoted(names[static_cast<std::size_t>(index)]));
  }

 private:
  std::string& text_;
};

template <class Options>
std::string OptionsText(std::string_view table, Options options) {
  std::string text = fmt::format("\n[{}]\n", table);
  OptionWriter visitor(text);
  VisitOptions(options, visitor);
  return text;
}

}  // namespace

Result<std::string> SceneText(const Scene& scene) {
  if (const std::vector<std::string> given = scene.stages.given(); !given.empty()) {
    return Fail("{}: the table [{}] cannot be written; leave it out", scene.name, given.front());
  }
  std::string text = fmt::format("name = {}\nframes_per_second = {}\n", Quoted(scene.name),
                                 Text(scene.frames_per_second));
  if (scene.first_frame != 0) text += fmt::format("first_frame = {}\n", scene.first_frame);
  if (scene.frame_count) text += fmt::format("frame_count = {}\n", *scene.frame_count);
  text += fmt::format("\n[area]\npolygon = {}\n", PointList(scene.area.corners_m()));
  if (!scene.doors.empty()) text += fmt::format("doors = {}\n", PolygonList(scene.doors));
  if (!scene.entrances_m.empty()) {
    text += fmt::format("entrances = {}\n", PointList(scene.entrances_m));
  }
  if (!scene.obstacles.empty())
    text += fmt::format("obstacles = {}\n", PolygonList(scene.obstacles));
  text += OptionsText("grid", scene.grid) + OptionsText("person", scene.person);
  for (const SceneCamera& camera : scene.cameras) {
    if (!camera.blind.empty()) {
      return Fail("camera {}: blind pixels cannot be written; leave them out", camera.name);
    }
    text += CameraText(camera);
  }
  return text;
}

}  // namespace vantage
