// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
// People's colours beside the maps: `vantage link` as a user runs it after `vantage track`.
#include <gmock/gmock.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "test_program.h"
#include "vantage/geometry/person.h"
#include "vantage/occupancy/map_file.h"
#include "vantage/scene/scene.h"

namespace vantage {
namespace {

using testing::Entries;
using testing::ExpectOneLine;
using ::testing::HasSubstr;
using testing::MessageOf;
using testing::Outcome;
using testing::RunProgram;
using testing::TemporaryFolder;

/// Six people in six colours who walk to and fro in lanes, the last two nearly in one: 18 s of one
/// camera 10 m up.
class LinkIdentity : public ::testing::Test {
 protected:
  static constexpr int kFrames = 180;

  void SetUp() override {
    ASSERT_TRUE(WriteTextFile(folder_ / "scene.toml", R"(name = "lanes"
frames_per_second = 10.0
[area]
polygon = [[-5.0, -3.0], [5.0, -3.0], [5.0, 5.0], [-5.0, 5.0]]
[grid]
cell = 0.25
extension = 0.5
[person]
width = 0.6
height = 1.75
[[cameras]]
name = "one"
source = { pictures = "one/%06d.png" }
[cameras.calibration.pinhole]
size_px = [320, 240]
focal_px = [200.0, 200.0]
center_px = [159.5, 119.5]
rotation = [[1.0, 0.0, 0.0], [0.0, -0.6, -0.8], [0.0, 0.8, -0.6]]
translation_m = [0.0, 4.8, 10.4]
)"));
    std::filesystem::create_directories(folder_ / "one");
    const Result<Scene> scene = LoadScene(folder_ / "scene.toml");
    ASSERT_TRUE(scene) << MessageOf(scene);
    const Camera& camera = scene->cameras.front().camera;
    cv::RNG random(4);
    for (int frame = 0; frame < kFrames; ++frame) {
      cv::Mat picture(240, 320, CV_8UC3, cv::Scalar(120, 130, 125));
      for (int person = 5; person >= 0; --person) Draw(camera, person, frame, picture);
      cv::Mat noise(picture.size(), CV_8UC3);
      random.fill(noise, cv::RNG::UNIFORM, 0, 7);
      ASSERT_TRUE(
          cv::imwrite((folder_ / fmt::format("one/{:06d}.png", frame)).string(), picture + noise));
    }
  }

  static void Draw(const Camera& camera, int person, int frame, cv::Mat& picture) {
    constexpr int kColors[6][3] = {{30, 30, 200},  {200, 40, 30}, {40, 190, 40},
                                   {30, 210, 220}, {20, 20, 20},  {235, 235, 235}};
    constexpr double kLanes_m[6] = {-2.2, -0.4, 1.2, 2.8, 4.4, 4.6};
    const double way_m = (0.8 + 0.05 * person) * 0.1 * frame + 3 * person;
    const double x_m = std::abs(std::fmod(way_m, 16) - 8) - 4;
    const auto box = PersonBox(camera, {x_m, kLanes_m[person]}, {.width_m = 0.6, .height_m = 1.75});
    ASSERT_TRUE(box);
    const int* color = kColors[person];
    cv::rectangle(picture, cv::Point(cvRound(box->min_x), cvRound(box->min_y)),
                  cv::Point(cvRound(box->max_x) - 1, cvRound(box->max_y) - 1),
                  cv::Scalar(color[0], color[1], color[2]), cv::FILLED);
  }

  std::string Path(const std::string& name) const { return (folder_ / name).string(); }
  Outcome Track(const std::string& flags = "", const std::string& shell_setup = ":") const {
    return RunProgram(fmt::format("track '{}' -o '{}' --save-maps --quiet {}", Path("scene.toml"),
                                  Path("out"), flags),
                      shell_setup);
  }
  Outcome Link(const std::string& flags = "") const {
    return RunProgram(fmt::format("link '{}' --scene '{}' -o '{}' --quiet {}", Path("out/maps.h5"),
                                  Path("scene.toml"), Path("linked.csv"), flags));
  }
  std::string Bytes(const std::string& name) const {
    return ReadTextFile(folder_ / name).value_or("no file " + name);
  }
  /// Whether `vantage link` gives these bytes; a test that fails does not print them.
  bool LinkGives(const std::string& tracks, const std::string& flags = "") const {
    const Outcome outcome = Link(flags);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return Bytes("linked.csv") == tracks;
  }
  void AddToScene(const std::string& table) const {
    ASSERT_TRUE(WriteTextFile(folder_ / "scene.toml", Bytes("scene.toml") + table));
  }

  TemporaryFolder folder_;
};

TEST_F(LinkIdentity, GivesTheTracksOfTheWholeWay) {
  const Outcome track = Track("--json");
  ASSERT_EQ(track.status, 0) << track.err;
  const auto counts = nlohmann::json::parse(track.out)["counts"];
  ASSERT_GT(counts["exchanges"], 0) << "otherwise nothing is tested";
  const std::string tracks = Bytes("out/tracks.csv");
  EXPECT_TRUE(LinkGives(tracks));
  const auto report = nlohmann::json::parse(Link("--json").out);
  for (const char* count : {"appearances", "meetings", "exchanges", "paths", "tracks"}) {
    EXPECT_EQ(report[count], counts[count]) << count;
  }
  const std::string row = fmt::format("{} exchanges by colours at {} meetings",
                                      counts["exchanges"].dump(), counts["meetings"].dump());
  EXPECT_THAT(Link().out, HasSubstr(row));

  // Options decide, and flags win over the scene.
  EXPECT_FALSE(LinkGives(tracks, "--no-identity-appearance"));
  const std::string without = Bytes("linked.csv");
  EXPECT_EQ(nlohmann::json::parse(Link("--no-identity-appearance --json").out)["exchanges"], 0);
  EXPECT_FALSE(LinkGives(tracks, "--identity-margin 1e9"));
  AddToScene("[identity]\nappearance = false\n");
  EXPECT_TRUE(LinkGives(without));
  EXPECT_THAT(Link().out, ::testing::Not(HasSubstr("identity")));
  EXPECT_TRUE(LinkGives(tracks, "--identity-appearance"));
  // The whole way without colours, whose maps have none.
  ASSERT_EQ(Track().status, 0);
  EXPECT_TRUE(Bytes("out/tracks.csv") == without);
  EXPECT_TRUE(LinkGives(without, "--identity-appearance"));
}

TEST_F(LinkIdentity, MapsAndColoursAreTheSameBytesWhoeverMakesThem) {
  ASSERT_EQ(Track("--threads 1").status, 0);
  const Outcome occupancy = RunProgram(fmt::format("occupancy '{}' -o '{}' --quiet --threads 3",
                                                   Path("scene.toml"), Path("alone.h5")));
  ASSERT_EQ(occupancy.status, 0) << occupancy.err;
  EXPECT_TRUE(Bytes("alone.h5") == Bytes("out/maps.h5"));
}

TEST_F(LinkIdentity, StreamsAndExplanationsAreThoseOfLinking) {
  ASSERT_EQ(Track().status, 0);
  ExpectOneLine(Link("--lag 2 --identity-margin 3"), 2, "--identity-margin");
  ASSERT_EQ(Link("--inside-cost 10 --no-identity-appearance").status, 0);
  EXPECT_TRUE(LinkGives(Bytes("linked.csv"), "--inside-cost 10 --lag 60"));
  const auto explain = [&](const std::string& name, const std::string& flags) {
    const Outcome outcome =
        Link(fmt::format("--explain '{}' --frames 40:60 {}", Path(name), flags));
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return Bytes(name + "/explanation.json");
  };
  EXPECT_EQ(explain("with", ""), explain("without", "--no-identity-appearance"));
}

TEST_F(LinkIdentity, ADiskThatIsFullAmidTheColoursLeavesNothing) {
  ASSERT_EQ(Track().status, 0);
  const Result<OccupancyMaps> maps = ReadMaps(folder_ / "out/maps.h5");
  ASSERT_TRUE(maps) << MessageOf(maps);
  ASSERT_TRUE(WriteMaps(folder_ / "without.h5", *maps));
  const std::uintmax_t without = std::filesystem::file_size(folder_ / "without.h5");
  const std::uintmax_t with = std::filesystem::file_size(folder_ / "out/maps.h5");
  std::filesystem::remove_all(folder_ / "out");
  const std::uintmax_t blocks = (without + with) / 2 / 512;
  ASSERT_GT(blocks * 512, without);
  ExpectOneLine(Track("", fmt::format("trap '' XFSZ; ulimit -f {}", blocks)), 1,
                "/appearances cannot be written");
  EXPECT_THAT(Entries(folder_ / "out"), ::testing::IsEmpty());
}

}  // namespace
}  // namespace vantage
