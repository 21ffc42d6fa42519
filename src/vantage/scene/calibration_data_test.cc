// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT

// Measures the calibration readers on research data: annotated people must stand where their boxes
// end. Skipped where the data is absent.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <nlohmann/json.hpp>
#include <sstream>

#include "vantage/base/file.h"
#include "vantage/base/test_support.h"
#include "vantage/scene/calibration.h"

namespace vantage {
namespace {

namespace fs = std::filesystem;
using Eigen::Vector2d;
using Eigen::Vector3d;
using testing::DataFolder;
using testing::MessageOf;

double Median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

TEST(CalibrationOfData, PetsTruthStandsAtItsBoxes) {
  const fs::path folder = DataFolder() / "pets2009";
  if (DataFolder().empty() || !fs::exists(folder)) GTEST_SKIP() << "no pets2009 data";
  const Result<Camera> camera = ReadTsaiXml(folder / "calibration" / "View_001.xml");
  ASSERT_TRUE(camera) << MessageOf(camera);
  std::istringstream truth(ReadTextFile(folder / "gt-mot15-3d.txt").value());
  std::vector<double> errors;
  for (std::string line; std::getline(truth, line);) {
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream row(line);
    double frame, id, left, top, width, height, flag, x_m, y_m;
    ASSERT_TRUE(row >> frame >> id >> left >> top >> width >> height >> flag >> x_m >> y_m);
    const auto foot = camera->ImageFromWorld({x_m, y_m, 0});
    ASSERT_TRUE(foot);
    errors.push_back((*foot - Vector2d(left + width / 2, top + height)).norm());
  }
  EXPECT_GT(errors.size(), 4000u);
  RecordProperty("median_px", std::to_string(Median(errors)));
  EXPECT_LT(Median(errors), 4);
}

TEST(CalibrationOfData, AllPetsViewsAreRead) {
  const fs::path folder = DataFolder() / "pets2009" / "calibration";
  if (DataFolder().empty() || !fs::exists(folder)) GTEST_SKIP() << "no pets2009 data";
  for (int view = 1; view <= 8; ++view) {
    const Result<Camera> camera = ReadTsaiXml(folder / fmt::format("View_{:03}.xml", view));
    ASSERT_TRUE(camera) << MessageOf(camera);
    EXPECT_EQ(camera->size(), (ImageSize{view < 5 ? 768 : 720, 576}));
    EXPECT_GT(camera->center_m().z(), 1);
    EXPECT_LT(camera->center_m().z(), 20);
  }
}

/// Median distance in pixels, over all views of an annotation file, between the projected position
/// and the middle of the lower edge of the box.
double MedianFootError(const fs::path& annotations, const std::vector<Camera>& cameras,
                       const std::function<Vector2d(int)>& position_m) {
  std::vector<double> errors;
  const auto people = nlohmann::json::parse(ReadTextFile(annotations).value());
  for (const auto& person : people) {
    const Vector2d foot_m = position_m(person.at("positionID"));
    for (const auto& view : person.at("views")) {
      const Vector2d min(view.at("xmin"), view.at("ymin")), max(view.at("xmax"), view.at("ymax"));
      const Camera& camera = cameras.at(view.at("viewNum").get<std::size_t>());
      // Boxes that the picture cuts do not end at the feet.
      if (min.x() <= 0 || max.x() >= camera.size().width - 1 ||
          max.y() >= camera.size().height - 1) {
        continue;
      }
      const auto foot = camera.ImageFromWorld({foot_m.x(), foot_m.y(), 0});
      if (foot) errors.push_back((*foot - Vector2d((min.x() + max.x()) / 2, max.y())).norm());
    }
  }
  EXPECT_GT(errors.size(), 20u);
  return errors.empty() ? 1e9 : Median(errors);
}

TEST(CalibrationOfData, WildtrackIsInCentimetres) {
  const fs::path folder = DataFolder() / "wildtrack";
  if (DataFolder().empty() || !fs::exists(folder)) GTEST_SKIP() << "no wildtrack data";
  std::vector<Camera> cameras;
  for (const char* name : {"CVLab1", "CVLab2", "CVLab3", "CVLab4", "IDIAP1", "IDIAP2", "IDIAP3"}) {
    const Result<Camera> camera = ReadIntrinsicExtrinsic(
        folder / "calibrations/intrinsic_zero" / fmt::format("intr_{}.xml", name),
        folder / "calibrations/extrinsic" / fmt::format("extr_{}.xml", name),
        {.unit_m = 0.01, .left_handed = false, .size = ImageSize{1920, 1080}});
    ASSERT_TRUE(camera) << MessageOf(camera);
    EXPECT_GT(camera->center_m().z(), 1);
    EXPECT_LT(camera->center_m().z(), 10);
    cameras.push_back(*camera);
  }
  const double median = MedianFootError(
      folder / "annotations_positions" / "00000000.json", cameras, [](int position) {
        return Vector2d(-3.0 + 0.025 * (position % 480), -9.0 + 0.025 * (position / 480));
      });
  RecordProperty("median_px", std::to_string(median));
  EXPECT_LT(median, 15);
}

TEST(CalibrationOfData, MultiviewXIsInMetresAndLeftHanded) {
  const fs::path folder = DataFolder() / "multiviewx";
  if (DataFolder().empty() || !fs::exists(folder)) GTEST_SKIP() << "no multiviewx data";
  std::vector<Camera> cameras;
  for (int number = 1; number <= 6; ++number) {
    const Result<Camera> camera = ReadIntrinsicExtrinsic(
        folder / "calibrations/intrinsic" / fmt::format("intr_Camera{}.xml", number),
        folder / "calibrations/extrinsic" / fmt::format("extr_Camera{}.xml", number),
        {.unit_m = 1, .left_handed = true, .size = ImageSize{1920, 1080}});
    ASSERT_TRUE(camera) << MessageOf(camera);
    cameras.push_back(*camera);
  }
  const double median = MedianFootError(
      folder / "annotations_positions" / "00001.json", cameras,
      [](int position) { return Vector2d(0.025 * (position % 1000), -0.025 * (position / 1000)); });
  RecordProperty("median_px", std::to_string(median));
  EXPECT_LT(median, 15);
}

}  // namespace
}  // namespace vantage
