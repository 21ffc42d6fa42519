// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/scene/calibration.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <exception>
#include <initializer_list>
#include <memory>
#include <opencv2/core.hpp>
#include <pugixml.hpp>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include "vantage/base/file.h"

namespace vantage {
namespace {

namespace fs = std::filesystem;
using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr std::size_t kMaxFileBytes = 1 << 20;

/// The library's message about the numbers, with the file's name in front.
Result<Camera> MakeCamera(const std::string& name, ImageSize size, const LensModel& lens,
                          const CameraPose& pose) {
  Result<Camera> camera = Camera::Create(size, lens, pose);
  if (!camera) return Fail("{}: {}", name, camera.error().message);
  return camera;
}

// --- Tsai XML ------------------------------------------------------------------------------------

class AttributeReader {
 public:
  AttributeReader(const std::string& name, const pugi::xml_node& camera)
      : name_(name), camera_(camera) {}

  Result<double> Number(const char* element, const char* attribute) const {
    const pugi::xml_attribute found = camera_.child(element).attribute(attribute);
    if (!found) return Fail("{}: {} has no attribute {}", name_, element, attribute);
    const std::string_view text = found.value();
    double value = 0;
    const auto [stop, code] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (code != std::errc() || stop != text.data() + text.size() || !std::isfinite(value)) {
      return Fail("{}: {} {} is '{}'; it must be a finite number", name_, element, attribute,
                  text.substr(0, 40));
    }
    return value;
  }
  Result<int> Side(const char* attribute) const {
    VANTAGE_ASSIGN_OR_RETURN(const double value, Number("Geometry", attribute));
    if (value != std::floor(value) || value < 1 || value > 32768) {
      return Fail("{}: Geometry {} is {}; it must be a whole number from 1 to 32768", name_,
                  attribute, value);
    }
    return static_cast<int>(value);
  }

 private:
  const std::string& name_;
  const pugi::xml_node& camera_;
};

// --- OpenCV's FileStorage ------------------------------------------------------------------------

/// OpenCV's parsers call themselves for each level of nesting; no calibration nests deeply.
bool NestsDeeply(std::string_view text) {
  constexpr int kMaxDepth = 32;
  int brackets = 0;
  int tags = 0;
  int dashes = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char next = i + 1 < text.size() ? text[i + 1] : '\0';
    if (text[i] == '[' || text[i] == '{') ++brackets;
    if (text[i] == ']' || text[i] == '}') --brackets;
    if (text[i] == '<' && next != '?' && next != '!') tags += next == '/' ? -1 : 1;
    if (text[i] == '/' && next == '>') --tags;
    // YAML nests within a line by "- - -" and "a: b: c:", without commas.
    if (text[i] == '\n' || text[i] == ',') dashes = 0;
    if ((text[i] == '-' || text[i] == ':') && next == ' ') ++dashes;
    if (brackets > kMaxDepth || tags > kMaxDepth || dashes > kMaxDepth) return true;
  }
  return false;
}

class StorageReader {
 public:
  static Result<StorageReader> Open(const fs::path& path) {
    VANTAGE_ASSIGN_OR_RETURN(std::string text, ReadTextFile(path, kMaxFileBytes));
    StorageReader reader;
    reader.name_ = path.string();
    if (text.empty()) return Fail("{}: is empty; a calibration is needed", reader.name_);
    if (text.find('\0') != std::string::npos || NestsDeeply(text)) {
      return Fail("{}: not a calibration file of OpenCV (YAML, XML or JSON)", reader.name_);
    }
    // OpenCV asks for a first line that other writers of YAML leave out.
    if (text[0] != '%' && text[0] != '<' && text[0] != '{') text.insert(0, "%YAML:1.0\n---\n");
    try {
      if (!reader.storage_->open(text, cv::FileStorage::READ | cv::FileStorage::MEMORY)) {
        return Fail("{}: not a calibration file of OpenCV (YAML, XML or JSON)", reader.name_);
      }
    } catch (const cv::Exception& error) {
      return Fail("{}: not a calibration file of OpenCV (YAML, XML or JSON): {}", reader.name_,
                  error.err);
    }
    return reader;
  }

  using Names = std::initializer_list<const char*>;
  const std::string& name() const { return name_; }
  bool Has(Names names) const { return !Find(names).empty(); }

  /// Numbers of a matrix, a list, or a list of lists, in row order.
  Result<std::vector<double>> Numbers(Names names,
                                      std::initializer_list<std::size_t> counts) const {
    const cv::FileNode node = Find(names);
    if (node.empty()) return Fail("{}: {} is missing", name_, *names.begin());
    std::vector<double> numbers;
    if (!Flatten(node.isMap() ? node["data"] : node, 0, numbers)) {
      return Fail("{}: {} must hold finite numbers only", name_, node.name());
    }
    if (std::find(counts.begin(), counts.end(), numbers.size()) == counts.end()) {
      return Fail("{}: {} has {} numbers; it must have {}", name_, node.name(), numbers.size(),
                  fmt::join(counts, " or "));
    }
    return numbers;
  }

 private:
  cv::FileNode Find(Names names) const {
    for (const char* candidate : names) {
      const cv::FileNode node = (*storage_)[candidate];
      if (!node.empty()) return node;
    }
    return {};
  }

  static bool Flatten(const cv::FileNode& node, int depth, std::vector<double>& numbers) {
    constexpr std::size_t kMany = 64;
    if (node.isInt() || node.isReal()) {
      numbers.push_back(node.real());
      return std::isfinite(numbers.back());
    }
    if (!node.isSeq() || depth > 2) return false;
    for (const cv::FileNode& child : node) {
      if (numbers.size() > kMany || !Flatten(child, depth + 1, numbers)) return false;
    }
    return true;
  }

  std::string name_;
  // Its nodes point to it, so it must stay where it is when the reader moves.
  std::unique_ptr<cv::FileStorage> storage_ = std::make_unique<cv::FileStorage>();
};

Result<PinholeModel> ReadLens(const StorageReader& file) {
  VANTAGE_ASSIGN_OR_RETURN(
      const std::vector<double> k,
      file.Numbers({"camera_matrix", "K", "cameraMatrix", "Camera_Matrix", "intrinsic_matrix"},
                   {9}));
  if (k[1] != 0 || k[3] != 0 || k[6] != 0 || k[7] != 0 || std::abs(k[8] - 1) > 1e-9) {
    return Fail("{}: the camera matrix must be fx 0 cx, 0 fy cy, 0 0 1", file.name());
  }
  PinholeModel lens{.fx_px = k[0], .fy_px = k[4], .cx_px = k[2], .cy_px = k[5]};
  const StorageReader::Names distortion = {"distortion_coefficients", "distCoeffs", "dist_coeffs",
                                           "Distortion_Coefficients", "dist",       "D"};
  if (!file.Has(distortion)) return lens;
  VANTAGE_ASSIGN_OR_RETURN(const std::vector<double> d,
                           file.Numbers(distortion, {4, 5, 8, 12, 14}));
  const std::size_t used = std::min(d.size(), lens.distortion.size());
  std::copy_n(d.begin(), used, lens.distortion.begin());
  if (std::any_of(d.begin() + static_cast<std::ptrdiff_t>(used), d.end(),
                  [](double x) { return x != 0; })) {
    return Fail("{}: thin-prism and tilt distortion (the coefficients from the ninth on) must be 0",
                file.name());
  }
  return lens;
}

Result<CameraPose> ReadPose(const StorageReader& file, const OpenCvConventions& conventions) {
  VANTAGE_ASSIGN_OR_RETURN(
      const std::vector<double> r,
      file.Numbers({"R", "rotation_matrix", "rotation", "rvec", "rotation_vector"}, {9, 3}));
  VANTAGE_ASSIGN_OR_RETURN(
      const std::vector<double> t,
      file.Numbers({"T", "t", "tvec", "translation", "translation_vector"}, {3}));
  CameraPose pose;
  if (r.size() == 9) {
    pose.rotation = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(r.data());
  } else {
    pose.rotation = RotationFromVector({r[0], r[1], r[2]});
  }
  pose.translation_m = conventions.unit_m * Vector3d(t[0], t[1], t[2]);
  if (conventions.left_handed) {
    // p = R (x, y, z) + t = R diag(1, -1, 1) (x, -y, z) + t, a mirrored camera. Its negative shows
    // the same pixels, has positive depths, and is a rotation.
    pose.rotation = -pose.rotation * Vector3d(1, -1, 1).asDiagonal();
    pose.translation_m = -pose.translation_m;
  }
  return pose;
}

Result<ImageSize> ReadSize(const StorageReader& file, const std::optional<ImageSize>& given) {
  std::vector<double> sides;
  for (const auto& [width, height] :
       {std::pair("image_width", "image_height"), std::pair("image_Width", "image_Height"),
        std::pair("width", "height")}) {
    if (sides.empty() && file.Has({width})) {
      VANTAGE_ASSIGN_OR_RETURN(const std::vector<double> w, file.Numbers({width}, {1}));
      VANTAGE_ASSIGN_OR_RETURN(const std::vector<double> h, file.Numbers({height}, {1}));
      sides = {w[0], h[0]};
    }
  }
  if (sides.empty() && file.Has({"image_size", "imageSize"})) {
    VANTAGE_ASSIGN_OR_RETURN(sides, file.Numbers({"image_size", "imageSize"}, {2}));
  }
  if (sides.empty()) {
    if (given) return *given;
    return Fail("{}: the size of the pictures is missing (image_width and image_height)",
                file.name());
  }
  for (const double side : sides) {
    if (side != std::floor(side) || side < 1 || side > 32768) {
      return Fail("{}: a side of the pictures is {}; it must be a whole number from 1 to 32768",
                  file.name(), side);
    }
  }
  const ImageSize size{static_cast<int>(sides[0]), static_cast<int>(sides[1])};
  if (given && *given != size) {
    return Fail("{}: the pictures are {} x {} px here and {} x {} px in the scene", file.name(),
                size.width, size.height, given->width, given->height);
  }
  return size;
}

Result<Camera> ReadCamera(const StorageReader& lens_file, const StorageReader& pose_file,
                          const OpenCvConventions& conventions) {
  if (!std::isfinite(conventions.unit_m) || conventions.unit_m <= 0) {
    return Fail("{}: unit_m is {}; it must be above 0", pose_file.name(), conventions.unit_m);
  }
  VANTAGE_ASSIGN_OR_RETURN(const PinholeModel lens, ReadLens(lens_file));
  VANTAGE_ASSIGN_OR_RETURN(const CameraPose pose, ReadPose(pose_file, conventions));
  VANTAGE_ASSIGN_OR_RETURN(const ImageSize size, ReadSize(lens_file, conventions.size));
  return MakeCamera(lens_file.name(), size, lens, pose);
}

/// Damaged files make OpenCV throw not only its own exceptions.
template <class Read>
Result<Camera> Guarded(const fs::path& path, const Read& read) {
  try {
    return read();
  } catch (const std::exception&) {
    return Fail("{}: not a calibration file of OpenCV (YAML, XML or JSON)", path.string());
  }
}

}  // namespace

Matrix3d RotationFromAngles(const Vector3d& angles_rad) {
  using Eigen::AngleAxisd;
  return (AngleAxisd(angles_rad.z(), Vector3d::UnitZ()) *
          AngleAxisd(angles_rad.y(), Vector3d::UnitY()) *
          AngleAxisd(angles_rad.x(), Vector3d::UnitX()))
      .toRotationMatrix();
}

Matrix3d RotationFromVector(const Vector3d& vector_rad) {
  const double angle = vector_rad.norm();
  if (angle == 0) return Matrix3d::Identity();
  return Eigen::AngleAxisd(angle, vector_rad / angle).toRotationMatrix();
}

Result<Camera> ReadTsaiXml(const fs::path& path) {
  const std::string name = path.string();
  VANTAGE_ASSIGN_OR_RETURN(const std::string text, ReadTextFile(path, kMaxFileBytes));
  pugi::xml_document document;
  const pugi::xml_parse_result parsed = document.load_buffer(text.data(), text.size());
  if (!parsed)
    return Fail("{}: not valid XML: {} (byte {})", name, parsed.description(), parsed.offset);
  const pugi::xml_node camera = document.child("Camera");
  if (!camera)
    return Fail("{}: no <Camera> at the top; a Tsai calibration of PETS 2009 is needed", name);
  const AttributeReader reader(name, camera);
  TsaiModel lens;
  CameraPose pose;
  Vector3d angles_rad;
  const std::tuple<const char*, const char*, double*> fields[] = {
      {"Geometry", "dpx", &lens.dpx_mm},
      {"Geometry", "dpy", &lens.dpy_mm},
      {"Intrinsic", "focal", &lens.focal_mm},
      {"Intrinsic", "kappa1", &lens.kappa1_per_mm2},
      {"Intrinsic", "cx", &lens.cx_px},
      {"Intrinsic", "cy", &lens.cy_px},
      {"Intrinsic", "sx", &lens.sx},
      {"Extrinsic", "tx", &pose.translation_m.x()},
      {"Extrinsic", "ty", &pose.translation_m.y()},
      {"Extrinsic", "tz", &pose.translation_m.z()},
      {"Extrinsic", "rx", &angles_rad.x()},
      {"Extrinsic", "ry", &angles_rad.y()},
      {"Extrinsic", "rz", &angles_rad.z()},
  };
  for (const auto& [element, attribute, value] : fields) {
    VANTAGE_ASSIGN_OR_RETURN(*value, reader.Number(element, attribute));
  }
  ImageSize size;
  VANTAGE_ASSIGN_OR_RETURN(size.width, reader.Side("width"));
  VANTAGE_ASSIGN_OR_RETURN(size.height, reader.Side("height"));
  pose.translation_m *= 1e-3;  // the files are in millimetres
  pose.rotation = RotationFromAngles(angles_rad);
  return MakeCamera(name, size, lens, pose);
}

Result<Camera> ReadOpenCv(const fs::path& path, const OpenCvConventions& conventions) {
  return Guarded(path, [&]() -> Result<Camera> {
    VANTAGE_ASSIGN_OR_RETURN(const StorageReader file, StorageReader::Open(path));
    return ReadCamera(file, file, conventions);
  });
}

Result<Camera> ReadIntrinsicExtrinsic(const fs::path& intrinsic, const fs::path& extrinsic,
                                      const OpenCvConventions& conventions) {
  return Guarded(intrinsic, [&]() -> Result<Camera> {
    VANTAGE_ASSIGN_OR_RETURN(const StorageReader lens_file, StorageReader::Open(intrinsic));
    VANTAGE_ASSIGN_OR_RETURN(const StorageReader pose_file, StorageReader::Open(extrinsic));
    return ReadCamera(lens_file, pose_file, conventions);
  });
}

}  // namespace vantage
