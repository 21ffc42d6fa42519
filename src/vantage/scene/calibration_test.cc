// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/scene/calibration.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <fstream>
#include <functional>
#include <random>

#include "vantage/base/test_support.h"

namespace vantage {
namespace {

namespace fs = std::filesystem;
using Eigen::Vector3d;
using ::testing::HasSubstr;
using testing::MessageOf;
using ::testing::StartsWith;

constexpr char kTsai[] = R"(<?xml version="1.0" encoding="UTF-8"?>
<Camera name="View">
  <Geometry width="768" height="576" ncx="795" dpx="5e-3" dpy="4e-3"/>
  <Intrinsic focal="5.5" kappa1="5e-3" cx="324.5" cy="282.25" sx="1.25"/>
  <Extrinsic tx="1000" ty="-2500" tz="30000" rx="2.0" ry="-0.9" rz="-0.4"/>
</Camera>
)";

constexpr char kOpenCvXml[] = R"(<?xml version="1.0"?>
<opencv_storage>
<image_width>1920</image_width><image_height>1080</image_height>
<camera_matrix type_id="opencv-matrix"><rows>3</rows><cols>3</cols><dt>d</dt>
  <data>1700. 0. 930. 0. 1710. 440. 0. 0. 1.</data></camera_matrix>
<distortion_coefficients type_id="opencv-matrix"><rows>5</rows><cols>1</cols><dt>d</dt>
  <data>-0.4 0.6 0.008 0.0018 -0.7</data></distortion_coefficients>
<rvec>1.75 0.5 -0.25</rvec>
<tvec>-525 45.5 986</tvec>
</opencv_storage>
)";

constexpr char kOpenCvYaml[] = R"(%YAML:1.0
---
image_Width: 640
image_Height: 480
K: !!opencv-matrix
   rows: 3
   cols: 3
   dt: d
   data: [ 500., 0., 320., 0., 510., 240., 0., 0., 1. ]
dist: [ 0.1, -0.2, 0.01, 0.02 ]
R: !!opencv-matrix
   rows: 3
   cols: 3
   dt: d
   data: [ 1., 0., 0., 0., 0., -1., 0., 1., 0. ]
t: [ 0., 1.5, 2. ]
)";

constexpr char kOpenCvJson[] = R"({"image_size": [640, 480], "cameraMatrix":
 [[500, 0, 320], [0, 510, 240], [0, 0, 1]], "distCoeffs": [[0.1, -0.2, 0.01, 0.02, 0.3]],
 "rvec": [[1.5707963267948966], [0], [0]], "tvec": [[0], [1.5], [2]]})";

class CalibrationTest : public ::testing::Test {
 protected:
  fs::path Write(const std::string& name, const std::string& text) {
    std::ofstream(folder_ / name, std::ios::binary) << text;
    return folder_ / name;
  }
  /// `text` with its first `from` replaced.
  static std::string With(std::string text, const std::string& from, const std::string& to) {
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return text.replace(at, from.size(), to);
  }
  testing::TemporaryFolder folder_;
};

TEST_F(CalibrationTest, TsaiXml) {
  const Result<Camera> camera = ReadTsaiXml(Write("View.xml", kTsai));
  ASSERT_TRUE(camera) << MessageOf(camera);
  EXPECT_EQ(camera->size(), (ImageSize{768, 576}));
  const auto& lens = std::get<TsaiModel>(camera->lens());
  EXPECT_EQ(lens.focal_mm, 5.5);
  EXPECT_EQ(lens.kappa1_per_mm2, 5e-3);
  EXPECT_EQ(lens.dpx_mm, 5e-3);
  EXPECT_EQ(lens.dpy_mm, 4e-3);
  EXPECT_EQ(lens.sx, 1.25);
  EXPECT_EQ(lens.cx_px, 324.5);
  EXPECT_EQ(lens.cy_px, 282.25);
  EXPECT_TRUE(camera->pose().translation_m.isApprox(Vector3d(1, -2.5, 30), 1e-12));
  // R = Rz Ry Rx, written out.
  const double sa = std::sin(2.0), ca = std::cos(2.0), sb = std::sin(-0.9), cb = std::cos(-0.9);
  const double sg = std::sin(-0.4), cg = std::cos(-0.4);
  Eigen::Matrix3d expected;
  expected << cb * cg, cg * sa * sb - ca * sg, sa * sg + ca * cg * sb,  //
      cb * sg, sa * sb * sg + ca * cg, ca * sb * sg - cg * sa,          //
      -sb, cb * sa, ca * cb;
  EXPECT_TRUE(camera->pose().rotation.isApprox(expected, 1e-12));
}

TEST_F(CalibrationTest, TsaiXmlErrors) {
  const std::pair<std::string, std::string> cases[] = {
      {"", "not valid XML"},
      {"<Camera><Geometry", "not valid XML"},
      {"<other/>", "no <Camera>"},
      {With(kTsai, "focal=\"5.5\"", ""), "Intrinsic has no attribute focal"},
      {With(kTsai, "Extrinsic", "Extra"), "Extrinsic has no attribute tx"},
      {With(kTsai, "\"5.5\"", "\"nan\""), "Intrinsic focal is 'nan'; it must be a finite number"},
      {With(kTsai, "\"5.5\"", "\"5.5mm\""), "Intrinsic focal is '5.5mm'"},
      {With(kTsai, "\"30000\"", "\"inf\""), "Extrinsic tz is 'inf'"},
      {With(kTsai, "\"5.5\"", "\"-5.5\""), "focal is -5.5 mm"},
      {With(kTsai, "\"768\"", "\"768.5\""), "Geometry width is 768.5"},
      {With(kTsai, "\"768\"", "\"1e9\""), "Geometry width is 1000000000"},
      {With(kTsai, "\"5e-3\" dpy", "\"0\" dpy"), "dpx is 0 mm"},
  };
  for (const auto& [text, message] : cases) {
    const fs::path path = Write("View.xml", text);
    const std::string found = MessageOf(ReadTsaiXml(path));
    EXPECT_THAT(found, StartsWith(path.string() + ": "));
    EXPECT_THAT(found, HasSubstr(message));
  }
  EXPECT_THAT(MessageOf(ReadTsaiXml(folder_ / "none.xml")), HasSubstr("no such file"));
}

TEST_F(CalibrationTest, OpenCvXmlOfCentimetres) {
  const Result<Camera> camera = ReadOpenCv(Write("c.xml", kOpenCvXml), {.unit_m = 0.01});
  ASSERT_TRUE(camera) << MessageOf(camera);
  EXPECT_EQ(camera->size(), (ImageSize{1920, 1080}));
  const auto& lens = std::get<PinholeModel>(camera->lens());
  EXPECT_EQ(lens.fx_px, 1700);
  EXPECT_EQ(lens.fy_px, 1710);
  EXPECT_EQ(lens.cx_px, 930);
  EXPECT_EQ(lens.cy_px, 440);
  EXPECT_EQ(lens.distortion, (std::array<double, 8>{-0.4, 0.6, 0.008, 0.0018, -0.7, 0, 0, 0}));
  EXPECT_TRUE(camera->pose().translation_m.isApprox(Vector3d(-5.25, 0.455, 9.86), 1e-12));
  const Vector3d vector(1.75, 0.5, -0.25);
  const Eigen::Matrix3d expected(Eigen::AngleAxisd(vector.norm(), vector.normalized()));
  EXPECT_TRUE(camera->pose().rotation.isApprox(expected, 1e-12));
}

TEST_F(CalibrationTest, OpenCvYamlAndJsonSayTheSame) {
  const Result<Camera> yaml = ReadOpenCv(Write("c.yml", kOpenCvYaml));
  ASSERT_TRUE(yaml) << MessageOf(yaml);
  const Result<Camera> json = ReadOpenCv(Write("c.json", With(kOpenCvJson, ", 0.3", "")));
  ASSERT_TRUE(json) << MessageOf(json);
  EXPECT_EQ(yaml->size(), (ImageSize{640, 480}));
  EXPECT_EQ(json->size(), (ImageSize{640, 480}));
  EXPECT_EQ(std::get<PinholeModel>(yaml->lens()).distortion,
            std::get<PinholeModel>(json->lens()).distortion);
  EXPECT_TRUE(yaml->pose().rotation.isApprox(json->pose().rotation, 1e-12));
  EXPECT_TRUE(yaml->pose().translation_m.isApprox(Vector3d(0, 1.5, 2)));
  EXPECT_TRUE(json->pose().translation_m.isApprox(Vector3d(0, 1.5, 2)));
  const Result<Camera> bare =
      ReadOpenCv(Write("bare.yml", With(kOpenCvYaml, "%YAML:1.0\n---\n", "")));
  EXPECT_TRUE(bare) << MessageOf(bare);
}

TEST_F(CalibrationTest, OpenCvErrors) {
  const std::string yaml = kOpenCvYaml;
  const std::pair<std::string, std::string> cases[] = {
      {"", "is empty"},
      {"plain text", "c.yml: "},
      {"{\"K\": [1, 2", "c.yml: "},
      {"<?xml version=\"1.0\"?><opencv_storage><K>", "not a calibration file of OpenCV"},
      {With(yaml, "K:", "L:"), "camera_matrix is missing"},
      {With(yaml, "\nt: [", "\ns: ["), "T is missing"},
      {With(yaml, "R:", "S:"), "R is missing"},
      {With(yaml, "image_Width", "wide"), "size of the pictures is missing"},
      {With(yaml, "image_Height", "high"), "image_Height is missing"},
      {With(yaml, "640", "0"), "a side of the pictures is 0"},
      {With(yaml, "640", "1000000"), "a side of the pictures is 1000000"},
      {With(yaml, "500.", ".Nan"), "K must hold finite numbers only"},
      {With(yaml, "1.5, 2.", "1.5, .Inf"), "t must hold finite numbers only"},
      {With(yaml, "500., 0.,", "500.,"), "K has 8 numbers; it must have 9"},
      {With(yaml, "500., 0.", "500., 3."), "the camera matrix must be fx 0 cx"},
      {With(yaml, "500.", "-500."), "fx"},
      {With(yaml, "0., 1.5, 2.", "0., 1.5"), "t has 2 numbers; it must have 3"},
      {With(yaml, "0., 1.5, 2.", "a, b, c"), "t must hold finite numbers only"},
      {With(yaml, "0.1, -0.2, 0.01, 0.02", "0.1, 1"), "dist has 2 numbers"},
      {With(yaml, "0.1, -0.2, 0.01, 0.02", "0,0,0,0,0,0,0,0,1,0,0,0"), "thin-prism"},
      {With(yaml, "data: [ 1.,", "data: [ 2.,"), "the rotation is not a proper orthonormal matrix"},
  };
  for (const auto& [text, message] : cases) {
    const fs::path path = Write("c.yml", text);
    const std::string found = MessageOf(ReadOpenCv(path));
    EXPECT_THAT(found, StartsWith(path.string() + ": ")) << text;
    EXPECT_THAT(found, HasSubstr(message)) << text;
    EXPECT_EQ(found.find('\n'), std::string::npos);
  }
  const fs::path good = Write("good.yml", yaml);
  EXPECT_THAT(MessageOf(ReadOpenCv(good, {.size = ImageSize{641, 480}})),
              HasSubstr("640 x 480 px here and 641 x 480 px in the scene"));
  for (const double unit : {0.0, -1.0, std::nan("")}) {
    EXPECT_THAT(MessageOf(ReadOpenCv(good, {.unit_m = unit})), HasSubstr("unit_m"));
  }
}

TEST_F(CalibrationTest, HostileFilesAreRefused) {
  const auto repeat = [](const std::string& text, int times) {
    std::string all;
    for (int i = 0; i < times; ++i) all += text;
    return all;
  };
  const std::string hostile[] = {
      repeat("[", 100'000),
      std::string("{\"K\": ") + repeat("[", 100'000),
      std::string("{") + repeat("\"a\": {", 100'000),
      std::string("%YAML:1.0\n---\nK: ") + repeat("- ", 100'000),
      std::string("%YAML:1.0\n---\n") + repeat("a: ", 100'000),
      std::string("<?xml version=\"1.0\"?><opencv_storage>") + repeat("<a>", 100'000),
      "<?xml version=\"1.0\"?><!DOCTYPE x [<!ENTITY a \"" + repeat("b", 1000) +
          "\">]><opencv_storage><K>&a;</K></opencv_storage>",
      std::string(2 << 20, 'x'),
      std::string("\0\1\2\3", 4),
      With(kOpenCvXml, "<rows>3</rows><cols>3</cols>", "<rows>1000000</rows><cols>1000000</cols>") +
          "x",
  };
  for (const std::string& text : hostile) {
    const fs::path path = Write("hostile", text);
    for (const Result<Camera>& camera : {ReadOpenCv(path), ReadTsaiXml(path)}) {
      if (camera) continue;  // a wrong count of rows beside the right numbers does no harm
      EXPECT_THAT(MessageOf(camera), StartsWith(path.string() + ": "));
      EXPECT_LT(MessageOf(camera).size(), 600u);
    }
  }
}

TEST_F(CalibrationTest, DamagedFilesNeverCrash) {
  std::mt19937 random(1);
  const std::pair<std::string, std::function<Result<Camera>(const fs::path&)>> readers[] = {
      {kTsai, [](const fs::path& path) { return ReadTsaiXml(path); }},
      {kOpenCvXml, [](const fs::path& path) { return ReadOpenCv(path); }},
      {kOpenCvYaml, [](const fs::path& path) { return ReadOpenCv(path); }},
      {kOpenCvJson, [](const fs::path& path) { return ReadOpenCv(path); }},
  };
  for (const auto& [whole, read] : readers) {
    for (int trial = 0; trial < 100; ++trial) {
      std::string text = whole;
      if (trial % 4 == 0) text.resize(random() % text.size());
      for (int change = 0; change < 3 && !text.empty(); ++change) {
        text[random() % text.size()] = "<>[]{}:,-\"0e \n.!&x"[random() % 18];
      }
      const fs::path path = Write("damaged", text);
      const Result<Camera> camera = read(path);
      if (!camera) {
        EXPECT_THAT(MessageOf(camera), StartsWith(path.string() + ": "));
      }
    }
  }
}

TEST_F(CalibrationTest, IntrinsicAndExtrinsicPair) {
  const fs::path intrinsic = Write("intr.xml", R"(<?xml version="1.0"?>
<opencv_storage><camera_matrix type_id="opencv-matrix"><rows>3</rows><cols>3</cols><dt>d</dt>
<data>1700. 0. 930. 0. 1710. 440. 0. 0. 1.</data></camera_matrix></opencv_storage>)");
  const fs::path extrinsic = Write("extr.xml", R"(<?xml version="1.0"?>
<opencv_storage><rvec>1.75 0.5 -0.25</rvec><tvec>-525 45.5 986</tvec></opencv_storage>)");
  const ImageSize size{1920, 1080};
  const Result<Camera> camera =
      ReadIntrinsicExtrinsic(intrinsic, extrinsic, {.unit_m = 0.01, .size = size});
  ASSERT_TRUE(camera) << MessageOf(camera);
  EXPECT_EQ(camera->size(), size);
  EXPECT_TRUE(camera->pose().translation_m.isApprox(Vector3d(-5.25, 0.455, 9.86), 1e-12));
  EXPECT_THAT(MessageOf(ReadIntrinsicExtrinsic(intrinsic, extrinsic, {.unit_m = 0.01})),
              HasSubstr("intr.xml: the size of the pictures is missing"));
  EXPECT_THAT(MessageOf(ReadIntrinsicExtrinsic(intrinsic, intrinsic, {.size = size})),
              HasSubstr("intr.xml: R is missing"));
  EXPECT_THAT(MessageOf(ReadIntrinsicExtrinsic(intrinsic, folder_ / "none.xml", {.size = size})),
              HasSubstr("none.xml: no such file"));
}

TEST_F(CalibrationTest, LeftHandedWorldIsMirrored) {
  // A camera at (3, -2, 4) that looks along -y and down, and the file that a left-handed world has
  // of it: mirrored in y, depths negative, so that the matrix is a rotation again.
  CameraPose pose;
  pose.rotation << -1, 0, 0, 0, 0.6, -0.8, 0, -0.8, -0.6;
  pose.translation_m = -pose.rotation * Vector3d(3, -2, 4);
  const Eigen::Matrix3d file = -pose.rotation * Vector3d(1, -1, 1).asDiagonal();
  const Vector3d t = -pose.translation_m;
  const std::string text = fmt::format(
      "K: [500, 0, 320, 0, 510, 240, 0, 0, 1]\nR: [{}, {}, {}, {}, {}, {}, {}, {}, {}]\n"
      "t: [{}, {}, {}]\nimage_size: [640, 480]\n",
      file(0, 0), file(0, 1), file(0, 2), file(1, 0), file(1, 1), file(1, 2), file(2, 0),
      file(2, 1), file(2, 2), t.x(), t.y(), t.z());
  const Result<Camera> camera = ReadOpenCv(Write("c.yml", text), {.left_handed = true});
  ASSERT_TRUE(camera) << MessageOf(camera);
  EXPECT_TRUE(camera->pose().rotation.isApprox(pose.rotation, 1e-12));
  EXPECT_TRUE(camera->center_m().isApprox(Vector3d(3, -2, 4), 1e-12));
}

}  // namespace
}  // namespace vantage
