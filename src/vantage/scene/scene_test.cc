// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/scene/scene.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "vantage/base/test_support.h"

namespace vantage {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::MessageOf;

// The camera stands 10 m high at (0, -10) and looks along y, down by the angle of 3-4-5.
constexpr char kScene[] = R"(name = "Square"
frames_per_second = 25
first_frame = 10
frame_count = 100

[area]
polygon = [[0, 0], [6, 0], [6, 4.5], [0, 4.5]]
doors = [[[0, 0], [1, 0], [1, 1]]]
obstacles = [[[3, 3], [4, 3], [4, 4]], [[5, 1], [5.5, 1], [5.5, 2]]]
entrances = [[2.5, 1], [6, 4.5]]

[grid]
cell = 0.25
extension = 1

[person]
width = 0.7
shape = "box"

[linking]
depth = 2

[[cameras]]
name = "left"
source = { video = "left.avi" }
offset_frames = -3
[cameras.calibration.pinhole]
size_px = [640, 480]
focal_px = [500, 510]
center_px = [319.5, 239.5]
distortion = [0.01, 0.02, 0.001, 0.002, 0.003]
rotation = [[1, 0, 0], [0, -0.6, -0.8], [0, 0.8, -0.6]]
translation_m = [0, 2, 14]

[[cameras]]
name = "right"
source = { detections = "right.csv", min_score = 0.25 }
[cameras.calibration.tsai]
size_px = [720, 576]
focal_mm = 5
kappa1_per_mm2 = 0.005
dpx_mm = 0.005
dpy_mm = 0.005
center_px = [360, 288]
rotation_rad = [2.2142974355881810, 0, 0]
translation_m = [0, 2, 14]
)";

struct LinkingLike {
  int depth = 1;
  double cost = 4;
};
void VisitOptions(LinkingLike& o, OptionVisitor& v) {
  v.Number({"depth", "cells", "reach"}, o.depth, Range::Between(0, 10));
  v.Number({"cost", "", "cost"}, o.cost, Range::AtLeast(0));
}

class SceneTest : public ::testing::Test {
 protected:
  Result<Scene> Load(const std::string& text) {
    Write("scene.toml", text);
    return LoadScene(folder_ / "scene.toml");
  }
  std::string ErrorOf(const std::string& text) {
    std::string message = MessageOf(Load(text));
    const std::string folder = folder_.path().string() + "/";
    for (std::size_t at; (at = message.find(folder)) != std::string::npos;) {
      message.erase(at, folder.size());
    }
    return message;
  }
  /// The scene with the first `from` replaced.
  static std::string With(const std::string& from, const std::string& to) {
    std::string text = kScene;
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return text.replace(at, from.size(), to);
  }
  fs::path Write(const std::string& name, const std::string& text) {
    std::ofstream(folder_ / name, std::ios::binary) << text;
    return folder_ / name;
  }
  testing::TemporaryFolder folder_;
};

TEST_F(SceneTest, ReadsEveryField) {
  const Result<Scene> scene = Load(kScene);
  ASSERT_TRUE(scene) << MessageOf(scene);
  EXPECT_EQ(scene->name, "Square");
  EXPECT_EQ(scene->frames_per_second, 25);
  EXPECT_EQ(scene->first_frame, 10);
  EXPECT_EQ(scene->frame_count, 100);
  EXPECT_DOUBLE_EQ(scene->area.area_m2(), 27);
  EXPECT_EQ(scene->doors.size(), 1u);
  EXPECT_EQ(scene->obstacles.size(), 2u);
  EXPECT_THAT(scene->entrances_m, ElementsAre(Eigen::Vector2d(2.5, 1), Eigen::Vector2d(6, 4.5)));
  EXPECT_EQ(scene->grid.cell_m, 0.25);
  EXPECT_EQ(scene->grid.extension_m, 1);
  EXPECT_EQ(scene->person.width_m, 0.7);
  EXPECT_EQ(scene->person.height_m, std::nullopt);
  EXPECT_EQ(scene->person.shape, PersonOptions::Shape::kBox);
  EXPECT_THAT(scene->inputs, ElementsAre(folder_ / "scene.toml"));

  ASSERT_EQ(scene->cameras.size(), 2u);
  const SceneCamera& left = scene->cameras[0];
  EXPECT_EQ(left.name, "left");
  EXPECT_EQ(left.source.kind, SourceSpec::Kind::kVideo);
  EXPECT_EQ(left.source.path, folder_ / "left.avi");
  EXPECT_EQ(left.source.offset_frames, -3);
  EXPECT_EQ(left.camera.size(), (ImageSize{640, 480}));
  const auto& lens = std::get<PinholeModel>(left.camera.lens());
  EXPECT_EQ(lens.fy_px, 510);
  EXPECT_EQ(lens.cx_px, 319.5);
  EXPECT_EQ(lens.distortion, (std::array<double, 8>{0.01, 0.02, 0.001, 0.002, 0.003, 0, 0, 0}));
  EXPECT_TRUE(left.camera.center_m().isApprox(Eigen::Vector3d(0, -10, 10), 1e-9));

  const SceneCamera& right = scene->cameras[1];
  EXPECT_EQ(right.source.kind, SourceSpec::Kind::kDetections);
  EXPECT_EQ(right.source.size, (ImageSize{720, 576}));
  EXPECT_EQ(right.source.min_score, 0.25);
  EXPECT_EQ(right.source.offset_frames, 0);
  EXPECT_EQ(std::get<TsaiModel>(right.camera.lens()).sx, 1);
  EXPECT_TRUE(right.camera.center_m().isApprox(Eigen::Vector3d(0, -10, 10), 1e-9));
  EXPECT_TRUE(right.camera.pose().rotation.isApprox(left.camera.pose().rotation, 1e-9));
}

TEST_F(SceneTest, StageTablesAreBoundLater) {
  const Result<Scene> scene = Load(kScene);
  ASSERT_TRUE(scene) << MessageOf(scene);
  EXPECT_THAT(scene->stages.given(), ElementsAre("linking"));
  EXPECT_TRUE(scene->stages.Has("linking"));
  EXPECT_FALSE(scene->stages.Has("tracks"));
  LinkingLike options;
  ASSERT_TRUE(scene->stages.Bind("linking", options));
  EXPECT_EQ(options.depth, 2);
  EXPECT_EQ(options.cost, 4);
  EXPECT_TRUE(scene->stages.Bind("tracks", options));
  EXPECT_TRUE(StageTables().Bind("linking", options));
  EXPECT_TRUE(StageTables().given().empty());

  const Result<Scene> wrong = Load(With("depth = 2", "depth = 20"));
  ASSERT_TRUE(wrong);
  EXPECT_THAT(MessageOf(wrong->stages.Bind("linking", options)),
              HasSubstr("scene.toml:21: linking.depth: is 20; it must be between 0 and 10 cells"));
}

TEST_F(SceneTest, PathsAreRelativeToTheSceneOrToTheData) {
  Write("scene.toml", With("right.csv", "/abs/right.csv"));
  const Result<Scene> beside = LoadScene(folder_ / "scene.toml");
  ASSERT_TRUE(beside) << MessageOf(beside);
  EXPECT_EQ(beside->cameras[0].source.path, folder_ / "left.avi");
  EXPECT_EQ(beside->cameras[1].source.path, "/abs/right.csv");
  const Result<Scene> elsewhere = LoadScene(folder_ / "scene.toml", "/data");
  ASSERT_TRUE(elsewhere) << MessageOf(elsewhere);
  EXPECT_EQ(elsewhere->cameras[0].source.path, "/data/left.avi");
}

TEST_F(SceneTest, CalibrationFilesAreInputs) {
  const fs::path file =
      Write("cam.yml",
            "K: [500, 0, 320, 0, 510, 240, 0, 0, 1]\nrvec: [2.214297435588181, 0, 0]\n"
            "t: [0, 200, 1400]\n");
  std::string text = kScene;
  const std::size_t at = text.find("[cameras.calibration.pinhole]");
  text = text.substr(0, at) +
         "calibration = { opencv = \"cam.yml\", unit_m = 0.01, size_px = [640, 480] }\n";
  const Result<Scene> scene = Load(text);
  ASSERT_TRUE(scene) << MessageOf(scene);
  EXPECT_THAT(scene->inputs, ElementsAre(folder_ / "scene.toml", file));
  EXPECT_TRUE(scene->cameras[0].camera.center_m().isApprox(Eigen::Vector3d(0, -10, 10), 1e-6));
}

TEST_F(SceneTest, ErrorsNameFileLineAndKey) {
  const std::pair<std::string, std::string> cases[] = {
      {"", "scene.toml:1: name: is missing"},
      {With("name = \"Square\"", "nmae = \"Square\""),
       "scene.toml:1: nmae: unknown key, did you mean name?"},
      {With("frames_per_second = 25", "frames_per_second = 0"),
       "scene.toml:2: frames_per_second: is 0; it must be above 0 and at most 1000"},
      {With("first_frame = 10", "first_frame = -1"), "scene.toml:3: first_frame: is -1"},
      {With("frame_count = 100", "frame_count = 0"), "scene.toml:4: frame_count: is 0"},
      {With("[area]", "[aera]"), "scene.toml:6: aera: unknown key, did you mean area?"},
      {With("[6, 0]", "[6, nan]"), "scene.toml:7: area.polygon: holds nan"},
      {With("[6, 0]", "[6, 0, 1]"), "scene.toml:7: area.polygon: row 2 has 3 numbers"},
      {With("[6, 0], [6, 4.5]", "[6, 4.5], [6, 0]"), "scene.toml:7: area.polygon: area: the edges"},
      {With("[[0, 0], [6, 0], [6, 4.5], [0, 4.5]]", "[[0, 0], [6, 0]]"), "2 corners"},
      {With("[1, 0], [1, 1]]]", "[1, 0]]]"), "scene.toml:8: area.doors: "},
      {With("[[2.5, 1], [6, 4.5]]", "[2.5, 1]"), "scene.toml:10: area.entrances: "},
      {With("[2.5, 1]", "[2.5, inf]"), "scene.toml:10: area.entrances: holds inf"},
      {With("cell = 0.25", "cell = 0"),
       "scene.toml:13: grid.cell: is 0; it must be between 0.02 and 10 m"},
      {With("cell = 0.25", "size = 1"),
       "scene.toml:13: grid.size: unknown key; allowed are cell, extension, max_extension, "
       "covering_share"},
      {With("shape = \"box\"", "shape = \"cone\""),
       "scene.toml:18: person.shape: is \"cone\"; it must be one"},
      {With("width = 0.7", "width = nan"),
       "scene.toml:17: person.width: is nan; it must be between 0.05 and 5 m, or \"auto\""},
      {With("width = 0.7", "width = \"wide\""),
       "scene.toml:17: person.width: is \"wide\"; it must"},
      {"linking = 3\n" + With("[linking]\ndepth = 2", ""),
       "scene.toml:1: linking: is 3; it must be a table"},
      {With("\"left\"", "\"right\""), "cameras[1].name: is \"right\" as another camera's is"},
      {With("\"left\"", "\"../left\""),
       "scene.toml:24: cameras[0].name: is \"../left\"; a name has"},
      {With("video", "vidoe"), "cameras[0].source.vidoe: unknown key, did you mean video?"},
      {With("video = \"left.avi\"", ""),
       "cameras[0].source: gives none; it must give exactly one of"},
      {With("video = \"left.avi\"", "video = \"a\", masks = \"b\""),
       "gives video, masks; it must give"},
      {With("\"left.avi\"", "\"left.avi\", min_score = 1"), "min_score: goes with detections only"},
      {With("min_score = 0.25", "min_score = nan"), "min_score: is nan"},
      {With("offset_frames = -3", "offset_frames = 0.5"),
       "offset_frames: is 0.5; it must be a whole"},
      {With("[cameras.calibration.pinhole]", "[cameras.calibration.fisheye]"),
       "calibration.fisheye: unknown key; allowed are tsai, pinhole"},
      {With("focal_px = [500, 510]", "focal_px = [500]"),
       "focal_px: has 1 numbers; it must have 2"},
      {With("focal_px = [500, 510]", "focal_px = [500, -510]"),
       "calibration.pinhole: calibration: focal"},
      {With("size_px = [640, 480]", "size_px = [640, 1e9]"), "size_px: holds 1000000000"},
      {With("[0, -0.6, -0.8]", "[0, -0.6, -0.9]"), "not a proper orthonormal matrix"},
      {With("[0, -0.6, -0.8], ", ""), "rotation: has 2 rows; it must have 3"},
      {With("0.002, 0.003]", "0.002, inf]"), "distortion: holds inf"},
      {With("translation_m = [0, 2, 14]", "translation_m = [0, 2]"),
       "translation_m: has 2 numbers"},
  };
  for (const auto& [text, message] : cases) {
    const std::string found = ErrorOf(text);
    EXPECT_THAT(found, HasSubstr(message));
    EXPECT_THAT(found, ::testing::StartsWith("scene.toml:")) << found;
    EXPECT_EQ(found.find('\n'), std::string::npos);
  }
  EXPECT_THAT(MessageOf(LoadScene(folder_ / "none.toml")), HasSubstr("none.toml: no such file"));
  EXPECT_THAT(MessageOf(LoadScene(folder_.path())), HasSubstr("is a folder"));
}

TEST_F(SceneTest, ASceneNeedsCameras) {
  const std::string text = kScene;
  const std::string without = text.substr(0, text.find("[[cameras]]"));
  EXPECT_EQ(ErrorOf(without), "scene.toml:1: cameras: is missing");
  EXPECT_THAT(ErrorOf("cameras = []\n" + without),
              HasSubstr("cameras: is an array of 0; it must be one or"));
  const std::string uncalibrated = text.substr(0, text.find("[cameras.calibration.pinhole]"));
  EXPECT_EQ(ErrorOf(uncalibrated), "scene.toml:23: cameras[0].calibration: is missing");
}

TEST_F(SceneTest, CamerasMustSeeGround) {
  // Turned to look up by the same angle, from the same place.
  std::string sky = With("[0, -0.6, -0.8], [0, 0.8, -0.6]", "[0, 0.6, -0.8], [0, 0.8, 0.6]");
  const std::string from = "translation_m = [0, 2, 14]";
  sky.replace(sky.find(from), from.size(), "translation_m = [0, 14, 2]");
  EXPECT_THAT(ErrorOf(sky), HasSubstr("camera \"left\" sees no ground within 1000 m"));
  EXPECT_THAT(ErrorOf(With("[0, 2, 14]", "[0, 2, -14]")),
              HasSubstr("camera \"left\" stands 6.80 m under"));
}

TEST_F(SceneTest, OpenSourceFollowsTheKind) {
  Write("d.csv", "frame,xmin,ymin,xmax,ymax\n4,1,1,2,2\n");
  SourceSpec spec;
  spec.kind = SourceSpec::Kind::kDetections;
  spec.path = folder_ / "d.csv";
  spec.size = {64, 48};
  const auto source = OpenSource(spec);
  ASSERT_TRUE(source) << MessageOf(source);
  EXPECT_EQ((*source)->info().frame_count, 5);
  spec.path = folder_ / "none";
  for (const auto kind : {SourceSpec::Kind::kVideo, SourceSpec::Kind::kPictures,
                          SourceSpec::Kind::kMasks, SourceSpec::Kind::kDetections}) {
    spec.kind = kind;
    EXPECT_THAT(MessageOf(OpenSource(spec)), HasSubstr("none"));
  }
}

TEST(Examples, OneViewOfPets) {
  const Result<Scene> scene =
      LoadScene(fs::path(VANTAGE_SOURCE_DIR) / "examples/pets2009/scene.toml");
  ASSERT_TRUE(scene) << MessageOf(scene);
  ASSERT_EQ(scene->cameras.size(), 1u);
  EXPECT_EQ(scene->cameras[0].camera.size(), (ImageSize{768, 576}));
  EXPECT_NEAR(scene->area.area_m2(), (4.9813 + 14.0696) * (1.7335 + 14.274), 1e-6);
  // The middle of the area lies in the picture.
  const auto pixel = scene->cameras[0].camera.ImageFromWorld({-4.5, -6.3, 0});
  ASSERT_TRUE(pixel);
  EXPECT_TRUE(scene->cameras[0].camera.InPicture(*pixel));
}

TEST(Examples, SevenViewsOfPets) {
  const fs::path data = testing::DataFolder() / "pets2009";
  if (testing::DataFolder().empty() || !fs::exists(data)) GTEST_SKIP() << "no pets2009 data";
  const fs::path folder = fs::path(VANTAGE_SOURCE_DIR) / "examples/pets2009";
  const Result<Scene> scene = LoadScene(folder / "seven-views.toml", data);
  ASSERT_TRUE(scene) << MessageOf(scene);
  ASSERT_EQ(scene->cameras.size(), 7u);
  EXPECT_EQ(scene->inputs.size(), 8u);
  for (const SceneCamera& camera : scene->cameras) {
    const auto source = OpenSource(camera.source);
    ASSERT_TRUE(source) << MessageOf(source);
    EXPECT_EQ((*source)->info().size, camera.camera.size());
    EXPECT_EQ((*source)->info().frame_count, 795);
  }
  // View_001 of the data set is what the other example says in Vantage's own form.
  const Result<Scene> one = LoadScene(folder / "scene.toml");
  ASSERT_TRUE(one) << MessageOf(one);
  const Camera& inline_form = one->cameras[0].camera;
  const Camera& file_form = scene->cameras[0].camera;
  for (const double x_m : {-14.0, -5.0, 4.0}) {
    for (const double y_m : {-14.0, -6.0, 1.0}) {
      const auto a = inline_form.ImageFromWorld({x_m, y_m, 0});
      const auto b = file_form.ImageFromWorld({x_m, y_m, 0});
      ASSERT_TRUE(a && b);
      EXPECT_LT((*a - *b).norm(), 1e-6);
    }
  }
}

}  // namespace
}  // namespace vantage
