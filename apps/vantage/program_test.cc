// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
// Runs the program as a user does.
#include <gmock/gmock.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "test_program.h"
#include "vantage/base/file.h"
#include "vantage/base/test_support.h"
#include "vantage/video/mask_writer.h"
#include "vantage/video/open.h"

namespace vantage {
namespace {

using testing::Entries;
using testing::ExpectOneLine;
using ::testing::HasSubstr;
using testing::Outcome;
using testing::RunProgram;
using testing::TemporaryFolder;

/// A scene that a test spoils: one camera 10 m up that looks down on a person who walks across,
/// as ready masks of 160 x 120 pixels.
struct SmallScene {
  TemporaryFolder folder;
  std::string camera = R"(
[cameras.calibration.pinhole]
size_px = [160, 120]
focal_px = [120.0, 120.0]
center_px = [79.5, 59.5]
rotation = [[1.0, 0.0, 0.0], [0.0, -0.6, -0.8], [0.0, 0.8, -0.6]]
translation_m = [0.0, 4.8, 10.4]
)";
  std::string area = "[[-3.0, -2.0], [3.0, -2.0], [3.0, 4.0], [-3.0, 4.0]]";
  std::string source = R"({ masks = "masks/%06d.png" })";
  std::string more;  // further tables

  SmallScene() {
    std::filesystem::create_directories(folder / "masks");
    for (int frame = 0; frame < 20; ++frame) {
      cv::Mat mask(120, 160, CV_8UC1, cv::Scalar(0));
      cv::rectangle(mask, cv::Rect(48 + 3 * frame, 92, 7, 13), cv::Scalar(255), cv::FILLED);
      cv::imwrite((folder / fmt::format("masks/{:06d}.png", frame)).string(), mask);
    }
  }
  std::string Write() const {
    const std::string text = fmt::format(
        "name = \"small\"\nframes_per_second = 10.0\n[area]\npolygon = {}\n[grid]\ncell = 0.5\n"
        "extension = 1.0\n[person]\nwidth = 0.8\n{}\n[[cameras]]\nname = \"one\"\nsource = {}\n{}",
        area, more, source, camera);
    EXPECT_TRUE(WriteTextFile(folder / "scene.toml", text));
    return (folder / "scene.toml").string();
  }
  std::filesystem::path out() const { return folder / "out"; }
  Outcome Track() const {
    return RunProgram(fmt::format("track '{}' -o '{}' --quiet", Write(), out().string()));
  }
};

TEST(Program, HelpAndVersionSucceed) {
  EXPECT_EQ(RunProgram("--version").status, 0);
  const Outcome help = RunProgram("--help");
  EXPECT_EQ(help.status, 0);
  for (const char* command : {"track", "background", "occupancy", "link", "evaluate", "render"}) {
    EXPECT_THAT(help.out, HasSubstr(command));
    EXPECT_EQ(RunProgram(std::string(command) + " --help").status, 0) << command;
  }
}

TEST(Program, WrongUsageIsStatusTwo) {
  ExpectOneLine(RunProgram(""), 2, "subcommand");
  ExpectOneLine(RunProgram("track"), 2, "required");
  ExpectOneLine(RunProgram("track scene.toml -o out --no-such-flag"), 2, "--no-such-flag");
  ExpectOneLine(RunProgram("track scene.toml -o out --occupancy-variance nan"), 2, "variance");
  ExpectOneLine(RunProgram("track scene.toml -o out --threads -3"), 2, "threads");
}

TEST(Program, TracksEvaluatesAndRendersOnePerson) {
  const SmallScene scene;
  const Outcome track = scene.Track();
  ASSERT_EQ(track.status, 0) << track.err;
  EXPECT_EQ(Entries(scene.out()), (std::vector<std::string>{"summary.json", "tracks.csv"}));
  const auto summary =
      nlohmann::json::parse(ReadTextFile(scene.out() / "summary.json").value_or("{}"));
  EXPECT_EQ(summary["counts"]["frames"], 20);
  EXPECT_EQ(summary["counts"]["tracks"], 1);
  EXPECT_EQ(summary["options"]["person"]["width"], 0.8);

  const std::string tracks = (scene.out() / "tracks.csv").string();
  const Outcome evaluation =
      RunProgram(fmt::format("evaluate tracks --truth '{0}' '{0}' --json", tracks));
  ASSERT_EQ(evaluation.status, 0) << evaluation.err;
  EXPECT_EQ(nlohmann::json::parse(evaluation.out)["mota"], 1.0);

  const Outcome render = RunProgram(fmt::format("render '{}' -o '{}' --quiet", scene.out().string(),
                                                (scene.folder / "video.mp4").string()));
  EXPECT_EQ(render.status, 0) << render.err;
  EXPECT_TRUE(std::filesystem::exists(scene.folder / "video.mp4"));
}

TEST(Program, SameBytesWhateverTheThreadCount) {
  const SmallScene scene;
  ASSERT_EQ(scene.Track().status, 0);
  const std::string first = ReadTextFile(scene.out() / "tracks.csv").value();
  const Outcome again = RunProgram(fmt::format("track '{}' -o '{}' --quiet --threads 3",
                                               scene.Write(), (scene.folder / "again").string()));
  ASSERT_EQ(again.status, 0) << again.err;
  EXPECT_EQ(ReadTextFile(scene.folder / "again/tracks.csv").value(), first);
}

TEST(Program, StagesAloneGiveWhatTheWholeWayGives) {
  const SmallScene scene;
  ASSERT_EQ(scene.Track().status, 0);
  const std::string maps = (scene.folder / "maps.h5").string();
  const std::string tracks = (scene.folder / "linked.csv").string();
  const Outcome occupancy =
      RunProgram(fmt::format("occupancy '{}' -o '{}' --quiet", scene.Write(), maps));
  ASSERT_EQ(occupancy.status, 0) << occupancy.err;
  const Outcome link = RunProgram(fmt::format("link '{}' -o '{}' --quiet", maps, tracks));
  ASSERT_EQ(link.status, 0) << link.err;
  EXPECT_EQ(ReadTextFile(tracks).value(), ReadTextFile(scene.out() / "tracks.csv").value());
}

TEST(Program, MapsFromMasksAsPicturesAndAsVideo) {
  const SmallScene scene;
  std::vector<std::string> maps;
  for (const MaskFormat format : {MaskFormat::kPng, MaskFormat::kVideo}) {
    const std::filesystem::path masks = scene.folder / fmt::format("masks{}", maps.size());
    auto writer = MaskWriter::Create(masks / "one", format, {160, 120}, 10, false);
    ASSERT_TRUE(writer) << testing::MessageOf(writer);
    auto source = OpenMasks(scene.folder / "masks");
    ASSERT_TRUE(source) << testing::MessageOf(source);
    cv::Mat mask;
    for (int frame = 0; (*source)->Read(mask).value(); ++frame) {
      ASSERT_TRUE(writer->Write(frame, mask));
    }
    ASSERT_TRUE(writer->Finish());
    const std::string out = (masks / "maps.h5").string();
    const Outcome outcome = RunProgram(fmt::format("occupancy '{}' --masks '{}' -o '{}' --quiet",
                                                   scene.Write(), masks.string(), out));
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    maps.push_back(ReadTextFile(out).value());
  }
  EXPECT_EQ(maps[0], maps[1]);
}

TEST(Program, ExplainsTheGroundAndOneFrame) {
  const SmallScene scene;
  const std::string folder = (scene.folder / "why").string();
  const std::string maps = (scene.folder / "maps.h5").string();
  const std::vector<std::string> pictures = {"plan_ground.png", "plan_map.png",
                                             "view_one_ground.png", "view_one_map.png"};
  // Alone, nothing beyond the frame is read.
  const Outcome alone = RunProgram(
      fmt::format("occupancy '{}' --explain '{}' --frame 5 --extension auto --json --quiet",
                  scene.Write(), folder));
  ASSERT_EQ(alone.status, 0) << alone.err;
  EXPECT_EQ(Entries(folder), pictures);
  const auto json = nlohmann::json::parse(alone.out);
  EXPECT_EQ(json["frames"], 6);
  EXPECT_FALSE(json.contains("maps"));
  EXPECT_EQ(json["explained"]["frame"], 5);
  ASSERT_EQ(json["explained"]["peaks"].size(), 1u);
  EXPECT_GT(json["explained"]["peaks"][0]["probability"], 0.5);
  EXPECT_EQ(json["extension"]["max_y"]["camera"], "one");
  EXPECT_GT(json["extension"]["max_y"]["metres"], 0);
  for (const std::string& name : pictures) {
    EXPECT_FALSE(cv::imread(folder + "/" + name).empty()) << name;
  }

  // Beside the maps, the same pictures, whatever the number of threads; into an empty folder too.
  const std::filesystem::path again = scene.folder / "again";
  std::filesystem::create_directories(again);
  const Outcome both = RunProgram(fmt::format(
      "occupancy '{}' --explain '{}' --frame 5 --extension auto -o '{}' --quiet --threads 3",
      scene.Write(), again.string(), maps));
  ASSERT_EQ(both.status, 0) << both.err;
  EXPECT_THAT(both.out, HasSubstr("frame 5, 1 found"));
  EXPECT_THAT(both.out, HasSubstr("extension min_x"));
  EXPECT_TRUE(std::filesystem::exists(maps));
  for (const std::string& name : pictures) {
    EXPECT_EQ(ReadTextFile(again / name).value(), ReadTextFile(folder + "/" + name).value())
        << name;
  }
}

TEST(Program, FlagsWinOverTheScene) {
  SmallScene scene;
  scene.more = "[occupancy]\nvariance = 0.002";
  const Outcome outcome = RunProgram(
      fmt::format("track '{}' -o '{}' --quiet --json --occupancy-variance 0.004 --person-width 0.7",
                  scene.Write(), scene.out().string()));
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const auto options = nlohmann::json::parse(outcome.out)["options"];
  EXPECT_EQ(options["occupancy"]["variance"], 0.004);
  EXPECT_EQ(options["person"]["width"], 0.7);
}

// --- Hostile input: one clear line, status 1, and nothing left behind
// ---------------------------------

void ExpectFailure(const SmallScene& scene, const std::string& part) {
  ExpectOneLine(scene.Track(), 1, part);
  EXPECT_EQ(Entries(scene.out()), std::vector<std::string>());
}

TEST(HostileScene, MissingFiles) {
  const TemporaryFolder folder;
  ExpectOneLine(
      RunProgram(fmt::format("track '{0}/none.toml' -o '{0}/out'", folder.path().string())), 1,
      "none.toml: no such file");
  SmallScene scene;
  scene.source = R"({ video = "none.avi" })";
  ExpectFailure(scene, "none.avi");
}

TEST(HostileScene, UnknownKeyNamesFileLineAndKey) {
  SmallScene scene;
  scene.more = "[occupancy]\nvarience = 0.01";
  ExpectFailure(scene, "scene.toml:11: ");
  ExpectFailure(scene, "varience");
}

TEST(HostileScene, EmptyAndTruncatedInputs) {
  SmallScene scene;
  scene.source = R"({ video = "empty.avi" })";
  std::ofstream(scene.folder / "empty.avi").flush();
  ExpectFailure(scene, "empty.avi");

  scene.source = R"({ video = "text.mp4" })";
  std::ofstream(scene.folder / "text.mp4") << "this is no video";
  ExpectFailure(scene, "text.mp4");

  scene.source = R"({ masks = "masks/%06d.png" })";
  std::filesystem::resize_file(scene.folder / "masks/000007.png", 60);
  ExpectFailure(scene, "000007.png");
}

TEST(HostileScene, WrongSizes) {
  SmallScene scene;
  cv::imwrite((scene.folder / "masks/000005.png").string(), cv::Mat::zeros(90, 160, CV_8UC1));
  ExpectFailure(scene, "000005.png");
  scene.camera.replace(scene.camera.find("[160, 120]"), 10, "[320, 240]");
  ExpectFailure(scene, "320 x 240");
}

TEST(HostileScene, CalibrationThatIsNotANumber) {
  SmallScene scene;
  scene.camera.replace(scene.camera.find("120.0, 120.0"), 12, "nan, 120.0");
  ExpectFailure(scene, "focal");
}

TEST(HostileScene, CameraThatLooksAtTheSky) {
  SmallScene scene;
  const std::string rotation = "[[1.0, 0.0, 0.0], [0.0, -0.6, -0.8], [0.0, 0.8, -0.6]]";
  scene.camera.replace(scene.camera.find(rotation), rotation.size(),
                       "[[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]");
  ExpectFailure(scene, "one");
}

TEST(HostileScene, AreaOutsideEveryView) {
  SmallScene scene;
  scene.area = "[[100.0, 100.0], [106.0, 100.0], [106.0, 106.0], [100.0, 106.0]]";
  ExpectFailure(scene, "no camera sees");
}

/// A limit on the size of files (in blocks of 512 bytes), its signal ignored, fails like a full
/// disk: in the middle of a write.
std::string FullDiskAfter(int blocks) { return fmt::format("trap '' XFSZ; ulimit -f {}", blocks); }

TEST(HostileScene, FolderThatCannotHoldAnExplanation) {
  const SmallScene scene;
  const std::string path = scene.Write();
  const auto explain = [&](const std::string& folder, const std::string& more, int status,
                           const std::string& part) {
    ExpectOneLine(
        RunProgram(fmt::format("occupancy '{}' --explain '{}' {} --quiet", path, folder, more)),
        status, part);
  };
  const std::vector<std::string> before = Entries(scene.folder.path());
  const std::string out = scene.out().string();
  explain("/dev/null/why", "", 1, "/dev/null");
  explain((scene.folder / "masks").string(), "", 1, "masks");
  explain(path, "", 1, "scene.toml");
  explain(out, "--frame 20", 1, "end at frame 19");
  explain(out, "--frame 999999999", 1, "end at frame 19");
  explain(out, "--frame -1", 2, "--frame");
  explain(out, "--frame one", 2, "--frame");
  explain(out, "--frame 9223372036854775807", 2, "--frame");
  explain(out, fmt::format("-o '{0}/masks/000007.png/maps.h5'", scene.folder.path().string()), 1,
          "000007.png");
  ExpectOneLine(RunProgram(fmt::format("occupancy '{}' --frame 3 -o '{}'", path, out)), 2,
                "--explain");
  ExpectOneLine(RunProgram(fmt::format("occupancy --pom x.pom --explain '{}'", out)), 2, "scene");
  ExpectOneLine(
      RunProgram(fmt::format("occupancy '{}' --explain '{}' --quiet", path, out), FullDiskAfter(8)),
      1, "cannot be written");
  EXPECT_EQ(Entries(scene.folder.path()), before);
  EXPECT_FALSE(std::filesystem::exists(scene.out()));
}

TEST(HostileScene, UnwritableOutput) {
  const SmallScene scene;
  const std::string path = scene.Write();
  ExpectOneLine(RunProgram(fmt::format("track '{}' -o /dev/null/out --quiet", path)), 1,
                "/dev/null");
  ExpectOneLine(RunProgram(fmt::format("track '{0}' -o '{0}' --quiet", path)), 1, "scene.toml");
}

TEST(HostileScene, FullDisk) {
  const SmallScene scene;
  const std::string path = scene.Write();
  const std::string out = scene.out().string();
  ExpectOneLine(RunProgram(fmt::format("track '{}' -o '{}' --quiet", path, out), FullDiskAfter(1)),
                1, "cannot be written");
  ExpectOneLine(RunProgram(fmt::format("occupancy '{}' -o '{}/maps.h5' --quiet", path, out),
                           FullDiskAfter(1)),
                1, "maps");
  ExpectOneLine(RunProgram(fmt::format("track '{}' -o '{}' --quiet --save-masks", path, out),
                           FullDiskAfter(1)),
                1, "cannot be written");
  EXPECT_EQ(Entries(scene.out()), std::vector<std::string>());

  ASSERT_EQ(scene.Track().status, 0);
  ExpectOneLine(
      RunProgram(fmt::format("render '{}' -o '{}/v.mp4' --quiet", out, out), FullDiskAfter(8)), 1,
      "v.mp4");
  EXPECT_EQ(Entries(scene.out()), (std::vector<std::string>{"summary.json", "tracks.csv"}));
}

// --- The other commands, each with input that is missing, broken or of another kind
// ------------------

struct HostileCase {
  const char* name;
  const char* arguments;  // {} is a folder with good.png, text.txt, tracks.csv, empty
  int status;
  const char* part;
};
void PrintTo(const HostileCase& hostile, std::ostream* stream) { *stream << hostile.name; }

class HostileCommand : public ::testing::TestWithParam<HostileCase> {};

TEST_P(HostileCommand, GivesOneLineAndLeavesNothing) {
  const TemporaryFolder folder;
  cv::imwrite((folder / "good.png").string(), cv::Mat::zeros(20, 30, CV_8UC3));
  std::ofstream(folder / "text.txt") << "neither this nor that\n";
  std::ofstream(folder / "empty").flush();
  std::ofstream(folder / "tracks.csv") << "frame,id,x,y\n0,1,1.0,2.0\n";
  std::ofstream(folder / "nan.csv") << "frame,id,x,y\n0,1,nan,2.0\n";
  std::ofstream(folder / "room.pom") << "ROOM 10 10 1 1\nRECTANGLE 0 0 0 0 99 99\nPROCESS 0 1\n";
  const std::vector<std::string> before = Entries(folder.path());
  const HostileCase& hostile = GetParam();
  ExpectOneLine(RunProgram(fmt::format(fmt::runtime(hostile.arguments), folder.path().string())),
                hostile.status, hostile.part);
  EXPECT_EQ(Entries(folder.path()), before);
}

INSTANTIATE_TEST_SUITE_P(
    Program, HostileCommand,
    ::testing::Values(
        HostileCase{"BackgroundMissing", "background {0}/none.avi -o {0}/out", 1, "none.avi"},
        HostileCase{"BackgroundEmpty", "background {0}/empty -o {0}/out", 1, "empty"},
        HostileCase{"BackgroundText", "background {0}/text.txt -o {0}/out", 1, "text.txt"},
        HostileCase{"BackgroundUnwritable", "background {0}/good.png -o /dev/null/out", 1, ""},
        HostileCase{"BackgroundNan", "background {0}/good.png -o {0}/out --alpha nan", 2, "alpha"},
        HostileCase{"OccupancyNothing", "occupancy -o {0}/maps.h5", 2, ""},
        HostileCase{"OccupancyMissing", "occupancy {0}/none.toml -o {0}/maps.h5", 1, "none.toml"},
        HostileCase{"OccupancyText", "occupancy {0}/text.txt -o {0}/maps.h5", 1, "text.txt"},
        HostileCase{"PomMissing", "occupancy --pom {0}/none.pom", 1, "none.pom"},
        HostileCase{"PomText", "occupancy --pom {0}/text.txt", 1, "text.txt"},
        HostileCase{"PomRectangleOutside", "occupancy --pom {0}/room.pom", 1, "room.pom"},
        HostileCase{"LinkMissing", "link {0}/none.h5 -o {0}/t.csv", 1, "none.h5"},
        HostileCase{"LinkText", "link {0}/text.txt -o {0}/t.csv", 1, "text.txt"},
        HostileCase{"LinkEmpty", "link {0}/empty -o {0}/t.csv", 1, "empty"},
        HostileCase{"LinkDepth", "link {0}/none.h5 -o {0}/t.csv --depth 11", 2, "depth"},
        HostileCase{"EvaluateMissing", "evaluate tracks --truth {0}/none.csv {0}/tracks.csv", 1,
                    "none.csv"},
        HostileCase{"EvaluateNan", "evaluate tracks --truth {0}/tracks.csv {0}/nan.csv", 1,
                    "nan.csv:2"},
        HostileCase{"EvaluateText", "evaluate tracks --truth {0}/text.txt {0}/tracks.csv", 1,
                    "text.txt:1"},
        HostileCase{"EvaluateThreshold",
                    "evaluate tracks --truth {0}/tracks.csv {0}/tracks.csv --threshold -1", 2,
                    "threshold"},
        HostileCase{"RenderMissing", "render {0}/none -o {0}/v.mp4", 1, "none"},
        HostileCase{"RenderNoResult", "render {0} -o {0}/v.mp4", 1, "summary.json"}),
    [](const auto& hostile) { return std::string(hostile.param.name); });

}  // namespace
}  // namespace vantage
