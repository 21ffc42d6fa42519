// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/scene/scene_text.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "vantage/base/file.h"
#include "vantage/base/test_support.h"
#include "vantage/geometry/test_cameras.h"

namespace vantage {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::MessageOf;

Camera Pinhole() {
  const PinholeModel lens{.fx_px = 500.1,
                          .fy_px = 510,
                          .cx_px = 319.5,
                          .cy_px = 240,
                          .distortion = {-0.1, 0.02, 1e-5, 0, 0.003}};
  return Camera::Create({640, 480}, lens, testing::LookAt({0, -10, 5}, {1, 2, 0})).value();
}

Camera Tsai() {
  const TsaiModel lens{.focal_mm = 5.5,
                       .kappa1_per_mm2 = 5.1e-3,
                       .dpx_mm = 5.1e-3,
                       .dpy_mm = 4.65e-3,
                       .sx = 1.09,
                       .cx_px = 324.2,
                       .cy_px = 282.6};
  return Camera::Create({768, 576}, lens, testing::LookAt({20, 3, 6}, {0, 0, 1})).value();
}

Scene SomeScene() {
  Scene scene;
  scene.name = "A \"hall\" \\ \n of glass";
  scene.frames_per_second = 29.97;
  scene.first_frame = 3;
  scene.frame_count = 40;
  scene.area = Polygon::Rectangle({-20, -10}, {20.1, 10}).value();
  scene.doors = {Polygon::Rectangle({0, 0}, {1, 1}).value()};
  scene.obstacles = {Polygon::Rectangle({3, 3}, {4, 5}).value()};
  scene.entrances_m = {{1.0 / 3, 2}};
  scene.grid.cell_m = 0.3;
  scene.person.width_m = 0.6;
  scene.cameras = {
      {.name = "one",
       .source = {.path = "one.mp4", .size = {}, .offset_frames = -2},
       .camera = Pinhole().Scaled({320, 243}).value()},
      {.name = "two",
       .source = {.kind = SourceSpec::Kind::kMasks, .path = "masks/two", .size = {}},
       .camera = Tsai().Scaled({300, 200}).value()},
      {.name = "three",
       .source = {.kind = SourceSpec::Kind::kDetections, .path = "boxes.csv", .size = {1920, 1080}},
       .camera = Tsai()}};
  return scene;
}

TEST(SceneText, ReadsBackAsTheSameScene) {
  const Scene scene = SomeScene();
  const testing::TemporaryFolder folder;
  const auto text = SceneText(scene);
  ASSERT_TRUE(text) << MessageOf(text);
  ASSERT_TRUE(WriteTextFile(folder / "scene.toml", *text));
  const auto read = LoadScene(folder / "scene.toml");
  ASSERT_TRUE(read) << MessageOf(read) << *text;
  EXPECT_EQ(read->name, scene.name);
  EXPECT_EQ(read->frames_per_second, scene.frames_per_second);
  EXPECT_EQ(read->first_frame, 3);
  EXPECT_EQ(read->frame_count, 40);
  EXPECT_EQ(read->area.corners_m(), scene.area.corners_m());
  ASSERT_EQ(read->doors.size(), 1U);
  EXPECT_EQ(read->doors[0].corners_m(), scene.doors[0].corners_m());
  ASSERT_EQ(read->obstacles.size(), 1U);
  EXPECT_EQ(read->obstacles[0].corners_m(), scene.obstacles[0].corners_m());
  EXPECT_THAT(read->entrances_m, ElementsAre(scene.entrances_m[0]));
  EXPECT_EQ(read->grid.cell_m, 0.3);
  EXPECT_EQ(read->grid.extension_m, std::nullopt);
  EXPECT_EQ(read->person.width_m, 0.6);
  EXPECT_EQ(read->person.height_m, std::nullopt);
  ASSERT_EQ(read->cameras.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    const SceneCamera& was = scene.cameras[i];
    const SceneCamera& is = read->cameras[i];
    EXPECT_EQ(is.name, was.name);
    EXPECT_EQ(is.source.kind, was.source.kind);
    EXPECT_EQ(is.source.path, folder / was.source.path);
    EXPECT_EQ(is.source.offset_frames, was.source.offset_frames);
    EXPECT_EQ(is.camera.size(), was.camera.size());
    for (const Eigen::Vector3d& point : {Eigen::Vector3d(0, 0, 0), {2, 1, 1.7}, {-1, 3, 0.4}}) {
      const auto pixel = was.camera.ImageFromWorld(point);
      ASSERT_TRUE(pixel);
      EXPECT_LT((*is.camera.ImageFromWorld(point) - *pixel).norm(), 1e-9) << was.name;
    }
  }
  EXPECT_EQ(read->cameras[2].source.size, scene.cameras[2].source.size);
}

TEST(SceneText, RefusesWhatItCannotSay) {
  Scene scene = SomeScene();
  scene.cameras[1].blind = cv::Mat(200, 300, CV_8UC1);
  EXPECT_THAT(MessageOf(SceneText(scene)), HasSubstr("camera two: blind pixels"));
}

}  // namespace
}  // namespace vantage
