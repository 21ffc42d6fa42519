// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/scene/camera_reader.h"

#include <algorithm>
#include <cctype>
#include <string>
#include <utility>

#include "vantage/scene/blind_pixels.h"
#include "vantage/scene/calibration.h"

namespace vantage::internal {
namespace {

namespace fs = std::filesystem;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr std::int64_t kMaxOffset = 1'000'000'000;

/// The one of `keys` that the table gives.
Result<std::string_view> OneOf(const TableReader& table,
                               const std::vector<std::string_view>& keys) {
  std::vector<std::string_view> given;
  for (const std::string_view key : keys) {
    if (table.Has(key)) given.push_back(key);
  }
  if (given.size() == 1) return given.front();
  return table.FailAt(
      "", fmt::format("gives {}; it must give exactly one of {}",
                      given.empty() ? "none" : fmt::format("{}", fmt::join(given, ", ")),
                      fmt::join(keys, ", ")));
}

Result<ImageSize> ReadSize(const TableReader& table) {
  VANTAGE_ASSIGN_OR_RETURN(const std::vector<double> sides, table.Numbers("size_px", {2}));
  for (const double side : sides) {
    if (side < 1 || side > 32768 || side != static_cast<int>(side)) {
      return table.FailAt("size_px",
                          fmt::format("holds {}; sides are whole numbers from 1 to 32768", side));
    }
  }
  return ImageSize{static_cast<int>(sides[0]), static_cast<int>(sides[1])};
}

Result<Vector3d> ReadVector(const TableReader& table, std::string_view key) {
  VANTAGE_ASSIGN_OR_RETURN(const std::vector<double> v, table.Numbers(key, {3}));
  return Vector3d(v[0], v[1], v[2]);
}

/// The numbers are checked by Camera::Create; its message gets the place in front.
Result<Camera> MakeCamera(const TableReader& table, ImageSize size, const LensModel& lens,
                          const CameraPose& pose) {
  Result<Camera> camera = Camera::Create(size, lens, pose);
  if (!camera) return table.FailAt("", camera.error().message);
  return camera;
}

Result<Camera> ReadTsai(const TableReader& table) {
  VANTAGE_RETURN_IF_ERROR(
      table.AllowOnly({"size_px", "focal_mm", "kappa1_per_mm2", "dpx_mm", "dpy_mm", "sx",
                       "center_px", "rotation_rad", "translation_m"}));
  VANTAGE_ASSIGN_OR_RETURN(const ImageSize size, ReadSize(table));
  TsaiModel lens;
  VANTAGE_ASSIGN_OR_RETURN(lens.focal_mm, table.Number("focal_mm", Range::Above(0), "mm"));
  VANTAGE_ASSIGN_OR_RETURN(lens.kappa1_per_mm2, table.Number("kappa1_per_mm2", Range()));
  VANTAGE_ASSIGN_OR_RETURN(lens.dpx_mm, table.Number("dpx_mm", Range::Above(0), "mm"));
  VANTAGE_ASSIGN_OR_RETURN(lens.dpy_mm, table.Number("dpy_mm", Range::Above(0), "mm"));
  if (table.Has("sx")) {
    VANTAGE_ASSIGN_OR_RETURN(lens.sx, table.Number("sx", Range::Above(0)));
  }
  VANTAGE_ASSIGN_OR_RETURN(const std::vector<double> center, table.Numbers("center_px", {2}));
  lens.cx_px = center[0];
  lens.cy_px = center[1];
  VANTAGE_ASSIGN_OR_RETURN(const Vector3d angles_rad, ReadVector(table, "rotation_rad"));
  CameraPose pose;
  pose.rotation = RotationFromAngles(angles_rad);
  VANTAGE_ASSIGN_OR_RETURN(pose.translation_m, ReadVector(table, "translation_m"));
  return MakeCamera(table, size, lens, pose);
}

Result<Camera> ReadPinhole(const TableReader& table) {
  VANTAGE_RETURN_IF_ERROR(table.AllowOnly({"size_px", "focal_px", "center_px", "distortion",
                                           "rotation", "rotation_vector_rad", "translation_m"}));
  VANTAGE_ASSIGN_OR_RETURN(const ImageSize size, ReadSize(table));
  VANTAGE_ASSIGN_OR_RETURN(const std::vector<double> focal, table.Numbers("focal_px", {2}));
  VANTAGE_ASSIGN_OR_RETURN(const std::vector<double> center, table.Numbers("center_px", {2}));
  PinholeModel lens{.fx_px = focal[0], .fy_px = focal[1], .cx_px = center[0], .cy_px = center[1]};
  if (table.Has("distortion")) {
    VANTAGE_ASSIGN_OR_RETURN(const std::vector<double> distortion,
                             table.Numbers("distortion", {0, 4, 5, 8}));
    std::copy(distortion.begin(), distortion.end(), lens.distortion.begin());
  }
  VANTAGE_ASSIGN_OR_RETURN(const std::string_view form,
                           OneOf(table, {"rotation", "rotation_vector_rad"}));
  CameraPose pose;
  if (form == "rotation") {
    VANTAGE_ASSIGN_OR_RETURN(const auto rows, table.Rows("rotation", 3));
    if (rows.size() != 3) {
      return table.FailAt("rotation", fmt::format("has {} rows; it must have 3", rows.size()));
    }
    for (int row = 0; row < 3; ++row) {
      pose.rotation.row(row) = Eigen::RowVector3d::Map(rows[static_cast<std::size_t>(row)].data());
    }
  } else {
    VANTAGE_ASSIGN_OR_RETURN(const Vector3d vector_rad, ReadVector(table, "rotation_vector_rad"));
    pose.rotation = RotationFromVector(vector_rad);
  }
  VANTAGE_ASSIGN_OR_RETURN(pose.translation_m, ReadVector(table, "translation_m"));
  return MakeCamera(table, size, lens, pose);
}

class CalibrationReader {
 public:
  CalibrationReader(const TableReader& table, const fs::path& folder, std::vector<fs::path>& inputs)
      : table_(table), folder_(folder), inputs_(inputs) {}

  Result<Camera> Read() {
    VANTAGE_RETURN_IF_ERROR(table_.AllowOnly({"tsai", "pinhole", "tsai_xml", "opencv", "intrinsic",
                                              "extrinsic", "unit_m", "left_handed", "size_px"}));
    VANTAGE_ASSIGN_OR_RETURN(const std::string_view kind,
                             OneOf(table_, {"tsai", "pinhole", "tsai_xml", "opencv", "intrinsic"}));
    const bool of_opencv = kind == "opencv" || kind == "intrinsic";
    for (const std::string_view key : {"unit_m", "left_handed", "size_px"}) {
      if (table_.Has(key) && !of_opencv) {
        return table_.FailAt(key, "goes with opencv, or with intrinsic and extrinsic, only");
      }
    }
    if (table_.Has("extrinsic") && kind != "intrinsic") {
      return table_.FailAt("extrinsic", "goes with intrinsic only");
    }
    if (kind == "tsai" || kind == "pinhole") {
      VANTAGE_ASSIGN_OR_RETURN(const TableReader inner, table_.Table(kind));
      return kind == "tsai" ? ReadTsai(inner) : ReadPinhole(inner);
    }
    VANTAGE_ASSIGN_OR_RETURN(const fs::path path, Path(kind));
    if (kind == "tsai_xml") return ReadTsaiXml(path);
    OpenCvConventions conventions;
    if (table_.Has("unit_m")) {
      VANTAGE_ASSIGN_OR_RETURN(conventions.unit_m, table_.Number("unit_m", Range::Above(0), "m"));
    }
    if (table_.Has("left_handed")) {
      VANTAGE_ASSIGN_OR_RETURN(conventions.left_handed, table_.Flag("left_handed"));
    }
    if (table_.Has("size_px")) {
      VANTAGE_ASSIGN_OR_RETURN(conventions.size, ReadSize(table_));
    }
    if (kind == "opencv") return ReadOpenCv(path, conventions);
    VANTAGE_ASSIGN_OR_RETURN(const fs::path extrinsic, Path("extrinsic"));
    return ReadIntrinsicExtrinsic(path, extrinsic, conventions);
  }

 private:
  Result<fs::path> Path(std::string_view key) {
    VANTAGE_ASSIGN_OR_RETURN(const std::string text, table_.Text(key));
    inputs_.push_back(folder_ / text);
    return inputs_.back();
  }
  const TableReader& table_;
  const fs::path& folder_;
  std::vector<fs::path>& inputs_;
};

/// Fails on a camera under the ground, or of whose pixels none shows ground within 1 km.
Status CheckSeesGround(const TableReader& camera_table, const std::string& name,
                       const Camera& camera) {
  constexpr double kReach_m = 1000;
  constexpr int kSteps = 32;
  const Vector3d center = camera.center_m();
  if (!(center.z() > 0)) {
    return camera_table.FailAt(
        "calibration",
        fmt::format("camera \"{}\" stands {:.2f} m under the ground; the world's z axis "
                    "must point up",
                    name, -center.z()));
  }
  for (int i = 0; i <= kSteps; ++i) {
    for (int j = 0; j <= kSteps; ++j) {
      const Vector2d pixel(i * (camera.size().width - 1.0) / kSteps,
                           j * (camera.size().height - 1.0) / kSteps);
      const auto ground = camera.WorldFromImage(pixel);
      if (ground && (ground->head<2>() - center.head<2>()).norm() <= kReach_m) return {};
    }
  }
  return camera_table.FailAt(
      "calibration", fmt::format("camera \"{}\" sees no ground within {} m; its rotation or "
                                 "translation must be wrong",
                                 name, kReach_m));
}

Result<SourceSpec> ReadSource(const TableReader& table, const fs::path& folder,
                              ImageSize camera_size) {
  VANTAGE_RETURN_IF_ERROR(
      table.AllowOnly({"video", "pictures", "masks", "detections", "size_px", "min_score"}));
  VANTAGE_ASSIGN_OR_RETURN(const std::string_view kind,
                           OneOf(table, {"video", "pictures", "masks", "detections"}));
  SourceSpec source;
  if (kind == "pictures") source.kind = SourceSpec::Kind::kPictures;
  if (kind == "masks") source.kind = SourceSpec::Kind::kMasks;
  if (kind == "detections") {
    source.kind = SourceSpec::Kind::kDetections;
    source.size = camera_size;
    if (table.Has("size_px")) {
      VANTAGE_ASSIGN_OR_RETURN(source.size, ReadSize(table));
    }
    if (table.Has("min_score")) {
      VANTAGE_ASSIGN_OR_RETURN(source.min_score, table.Number("min_score", Range()));
    }
  }
  for (const std::string_view key : {"size_px", "min_score"}) {
    if (table.Has(key) && kind != "detections")
      return table.FailAt(key, "goes with detections only");
  }
  VANTAGE_ASSIGN_OR_RETURN(const std::string path, table.Text(kind));
  source.path = folder / path;
  return source;
}

/// Names become parts of file names.
bool IsPlainName(std::string_view name) {
  return name.size() <= 64 && name.front() != '.' &&
         std::all_of(name.begin(), name.end(), [](unsigned char c) {
           return std::isalnum(c) != 0 || c == '_' || c == '-' || c == '.';
         });
}

}  // namespace

Result<SceneCamera> ReadCamera(const TableReader& table, const fs::path& folder,
                               std::vector<fs::path>& inputs) {
  VANTAGE_RETURN_IF_ERROR(
      table.AllowOnly({"name", "source", "offset_frames", "calibration", "blind"}));
  VANTAGE_ASSIGN_OR_RETURN(const std::string name, table.Text("name"));
  if (!IsPlainName(name)) {
    return table.FailAt("name",
                        fmt::format("is \"{}\"; a name has up to 64 letters, digits, '_', '-' and "
                                    "'.', and no '.' first",
                                    name.substr(0, 80)));
  }
  VANTAGE_ASSIGN_OR_RETURN(const TableReader calibration, table.Table("calibration"));
  VANTAGE_ASSIGN_OR_RETURN(const Camera camera,
                           CalibrationReader(calibration, folder, inputs).Read());
  VANTAGE_RETURN_IF_ERROR(CheckSeesGround(table, name, camera));
  VANTAGE_ASSIGN_OR_RETURN(const TableReader source_table, table.Table("source"));
  VANTAGE_ASSIGN_OR_RETURN(SourceSpec source, ReadSource(source_table, folder, camera.size()));
  if (table.Has("offset_frames")) {
    VANTAGE_ASSIGN_OR_RETURN(source.offset_frames,
                             table.Integer("offset_frames", -kMaxOffset, kMaxOffset));
  }
  VANTAGE_ASSIGN_OR_RETURN(const cv::Mat blind,
                           ReadBlindPixels(table, folder, camera.size(), inputs));
  return SceneCamera{name, std::move(source), camera, blind};
}

}  // namespace vantage::internal
