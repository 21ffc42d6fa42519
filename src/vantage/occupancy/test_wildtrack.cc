// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/occupancy/test_wildtrack.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <opencv2/calib3d.hpp>
#include <opencv2/core.hpp>
#include <string>

namespace vantage::testing {
namespace {

namespace fs = std::filesystem;

constexpr ImageSize kPictureSize{1920, 1080};
constexpr const char* kCameras[] = {"CVLab1", "CVLab2", "CVLab3", "CVLab4",
                                    "IDIAP1", "IDIAP2", "IDIAP3"};

ImageSize MaskSize(int reduction) {
  return {kPictureSize.width / reduction, kPictureSize.height / reduction};
}

Eigen::Vector3d Vector(const cv::FileNode& node) {
  return {static_cast<double>(node[0]), static_cast<double>(node[1]), static_cast<double>(node[2])};
}

Camera ReadCamera(const fs::path& folder, const std::string& name) {
  const cv::FileStorage inner(folder / "calibrations/intrinsic_zero" / ("intr_" + name + ".xml"),
                              cv::FileStorage::READ);
  const cv::FileStorage outer(folder / "calibrations/extrinsic" / ("extr_" + name + ".xml"),
                              cv::FileStorage::READ);
  const cv::Mat_<double> k = inner["camera_matrix"].mat();
  const Eigen::Vector3d turn = Vector(outer["rvec"]);
  const Eigen::Vector3d shift_cm = Vector(outer["tvec"]);
  cv::Matx33d rotation;
  cv::Rodrigues(cv::Vec3d(turn.x(), turn.y(), turn.z()), rotation);
  CameraPose pose;
  pose.rotation = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(rotation.val);
  pose.translation_m = shift_cm / 100;
  const PinholeModel lens{.fx_px = k(0, 0), .fy_px = k(1, 1), .cx_px = k(0, 2), .cy_px = k(1, 2)};
  return Camera::Create(kPictureSize, lens, pose).value();
}

/// Grows a matching by augmenting paths.
class Matching {
 public:
  Matching(std::span<const Peak> peaks, std::span<const Eigen::Vector2d> people_m,
           double distance_m)
      : peaks_(peaks),
        people_m_(people_m),
        distance_m_(distance_m),
        peak_of_(people_m.size(), -1) {}

  bool Augment(std::size_t peak) {
    tried_.assign(people_m_.size(), false);
    return FindPerson(peak);
  }

 private:
  bool FindPerson(std::size_t peak) {
    for (std::size_t j = 0; j < people_m_.size(); ++j) {
      if (tried_[j] || (peaks_[peak].position_m - people_m_[j]).norm() >= distance_m_) continue;
      tried_[j] = true;
      if (peak_of_[j] < 0 || FindPerson(static_cast<std::size_t>(peak_of_[j]))) {
        peak_of_[j] = static_cast<int>(peak);
        return true;
      }
    }
    return false;
  }
  std::span<const Peak> peaks_;
  std::span<const Eigen::Vector2d> people_m_;
  double distance_m_;
  std::vector<int> peak_of_;
  std::vector<bool> tried_;
};

}  // namespace

WildtrackData::WildtrackData(const fs::path& folder, int reduction) : reduction_(reduction) {
  for (const char* name : kCameras) {
    cameras_.push_back(ReadCamera(folder, name).Scaled(MaskSize(reduction)).value());
  }
  for (const auto& entry : fs::directory_iterator(folder / "annotations_positions")) {
    files_.push_back(entry.path());
  }
  std::sort(files_.begin(), files_.end());
}

WildtrackFrame WildtrackData::Frame(std::size_t index) const {
  WildtrackFrame frame;
  const ImageSize size = MaskSize(reduction_);
  for (std::size_t i = 0; i < cameras_.size(); ++i) {
    frame.masks.push_back(cv::Mat::zeros(size.height, size.width, CV_8UC1));
  }
  const auto json = nlohmann::json::parse(std::ifstream(files_.at(index)));
  for (const auto& person : json) {
    const int position = person["positionID"];
    const int column = position % 480, row = position / 480;
    frame.people_m.emplace_back(-3.0 + 0.025 * column, -9.0 + 0.025 * row);
    for (const auto& view : person["views"]) {
      const int x0 = view["xmin"], y0 = view["ymin"], x1 = view["xmax"], y1 = view["ymax"];
      if (x1 <= x0 || y1 <= y0) continue;  // -1: not seen
      // Pixels of the mask that the box touches.
      const int up = reduction_ - 1;
      const cv::Rect box(cv::Point(x0 / reduction_, y0 / reduction_),
                         cv::Point((x1 + up) / reduction_, (y1 + up) / reduction_));
      cv::Mat& mask = frame.masks.at(view["viewNum"].get<std::size_t>());
      mask(box & cv::Rect(0, 0, mask.cols, mask.rows)) = 255;
    }
  }
  return frame;
}

GroundGrid WildtrackData::Grid(double cell_m) {
  return {-3, -9, cell_m, static_cast<int>(std::lround(12 / cell_m)),
          static_cast<int>(std::lround(36 / cell_m))};
}

int CountMatches(std::span<const Peak> peaks, std::span<const Eigen::Vector2d> people_m,
                 double distance_m) {
  Matching matching(peaks, people_m, distance_m);
  int matches = 0;
  for (std::size_t i = 0; i < peaks.size(); ++i) matches += matching.Augment(i) ? 1 : 0;
  return matches;
}

}  // namespace vantage::testing
