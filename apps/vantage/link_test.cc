// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
// Runs `vantage link` as a user does.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>

#include "test_program.h"
#include "vantage/occupancy/map_file.h"

namespace vantage {
namespace {

using testing::Entries;
using testing::ExpectOneLine;
using ::testing::HasSubstr;
using testing::Outcome;
using testing::RunProgram;
using testing::TemporaryFolder;
using Strings = std::vector<std::string>;

/// Maps of 16 x 10 cells of 0.5 m at 10 frames per second, frames 50 to 89, all area but the outer
/// ring; and a scene for them.
struct SmallMaps {
  TemporaryFolder folder;
  OccupancyMaps maps;
  std::string area;     // further keys of [area]
  std::string linking;  // of [linking]

  SmallMaps() {
    maps.grid = {.min_x_m = 0, .min_y_m = 0, .cell_m = 0.5, .columns = 16, .rows = 10};
    maps.first_frame = 50;
    maps.frames_per_second = 10;
    maps.visible.assign(160, 1);
    maps.values.assign(160 * 40, 0.001F);
    for (CellIndex cell = 0; cell < 160; ++cell) {
      const int column = maps.grid.Column(cell);
      const int row = maps.grid.Row(cell);
      maps.in_area.push_back(column > 0 && column < 15 && row > 0 && row < 9);
    }
  }

  void Put(int frame, int column, int row, float q = 0.98F) {
    maps.values[static_cast<std::size_t>(frame * 160 + maps.grid.Index(column, row))] = q;
  }
  /// Somebody who walks from the left border to the right one.
  void AddWalker(int row) {
    for (int frame = 0; frame < 40; ++frame) Put(frame, frame * 16 / 40, row);
  }

  /// The arguments of `vantage link` with a scene, before others.
  std::string Arguments() const {
    EXPECT_TRUE(WriteMaps(folder / "maps.h5", maps));
    const std::string scene = fmt::format(
        "name = \"small\"\nframes_per_second = 10.0\n[area]\n"
        "polygon = [[0.5, 0.5], [7.5, 0.5], [7.5, 4.5], [0.5, 4.5]]\n{}\n[grid]\ncell = 0.5\n"
        "[linking]\n{}\n[[cameras]]\nname = \"one\"\nsource = {{ masks = \"m/%d.png\" }}\n"
        "[cameras.calibration.pinhole]\nsize_px = [160, 120]\nfocal_px = [120.0, 120.0]\n"
        "center_px = [79.5, 59.5]\n"
        "rotation = [[1.0, 0.0, 0.0], [0.0, -0.6, -0.8], [0.0, 0.8, -0.6]]\n"
        "translation_m = [0.0, 4.8, 10.4]\n",
        area, linking);
    EXPECT_TRUE(WriteTextFile(folder / "scene.toml", scene));
    return fmt::format("link '{0}/maps.h5' --scene '{0}/scene.toml' --quiet",
                       folder.path().string());
  }
  /// The program's report.
  nlohmann::json Link(const std::string& flags = "") const {
    const Outcome outcome = RunProgram(
        fmt::format("{} -o '{}/tracks.csv' --json {}", Arguments(), folder.path().string(), flags));
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return nlohmann::json::parse(outcome.out.empty() ? "{}" : outcome.out);
  }
};

TEST(Link, AccessIsTheBorderDoorsAListOrAnywhere) {
  // Somebody who comes out of nowhere at frame 7 and is gone at frame 34, amid the area.
  SmallMaps small;
  small.linking = "movement_cost = 0.0";
  for (int frame = 7; frame < 34; ++frame) small.Put(frame, 8, 5);
  const double border = small.Link()["cost"];
  const double anywhere = small.Link("--access anywhere")["cost"];
  EXPECT_NEAR(anywhere, 45 - 27 * std::log(49.0), 0.01);
  // From row 9 and back, four cells at 0.001 each way.
  EXPECT_NEAR(border, anywhere + 8 * std::log(999.0), 0.01);
  EXPECT_EQ(small.Link("--access doors")["paths"], 0);
  small.area = "doors = [[[4, 2.5], [4.5, 2.5], [4.5, 3], [4, 3]]]";
  EXPECT_NEAR(small.Link("--access doors")["cost"], anywhere, 1e-6);
  small.linking = "movement_cost = 0.0\naccess = \"doors\"";
  small.area = "entrances = [[1.2, 1.2], [4.4, 2.6]]";
  EXPECT_NEAR(small.Link()["cost"], anywhere, 1e-6);
  small.area = "entrances = [[1.2, 1.2]]";
  EXPECT_EQ(small.Link()["paths"], 0);
  small.area = "entrances = [[8.1, 1]]";
  const Strings before = Entries(small.folder.path());
  ExpectOneLine(RunProgram(small.Arguments() +
                           fmt::format(" -o '{}/none.csv'", small.folder.path().string())),
                1, "area.entrances: (8.1, 1) is outside the grid");
  EXPECT_EQ(Entries(small.folder.path()), before);
}

TEST(Link, NobodyStandsInObstacles) {
  SmallMaps small;
  small.linking = "movement_cost = 2.0";
  small.AddWalker(5);
  const auto free = small.Link();
  EXPECT_EQ(free["tracks"], 1);
  EXPECT_EQ(free["inferred"], 0);
  // A wall with a way round: the person must walk there unseen.
  small.area = "obstacles = [[[3.5, 1.5], [4.5, 1.5], [4.5, 3.5], [3.5, 3.5]]]";
  const auto around = small.Link("--depth 2");
  EXPECT_EQ(around["tracks"], 1);
  EXPECT_GT(around["cost"], free["cost"]);
  EXPECT_GT(around["inferred"], 0);
}

TEST(Link, DepthOrSpeedLimitsMoves) {
  // A jump of 3 cells, 1.5 m, amid the way.
  SmallMaps small;
  for (int frame = 0; frame < 40; ++frame) {
    small.Put(frame, frame < 20 ? 4 : 7, 5);
  }
  EXPECT_EQ(small.Link("--depth 3 --movement-cost 0")["inferred"], 0);
  const double jumped = small.Link("--depth 3 --movement-cost 0")["cost"];
  EXPECT_NEAR(jumped, 45 - 40 * std::log(49.0), 0.01);
  EXPECT_GT(small.Link("--depth 1 --movement-cost 0")["cost"], jumped + 5);
  EXPECT_GT(small.Link("--max-speed 14.9 --movement-cost 0")["cost"], jumped + 5);
  EXPECT_NEAR(small.Link("--max-speed 15.1 --movement-cost 0")["cost"], jumped, 1e-6);
  EXPECT_GT(small.Link("--movement-cost 0")["cost"], jumped + 5) << "7 m/s";
  small.linking = "max_speed = 15.1\nmovement_cost = 0.0";
  EXPECT_NEAR(small.Link()["cost"], jumped, 1e-6);
  EXPECT_GT(small.Link("--depth 1")["cost"], jumped + 5) << "in place of the speed";
  small.linking = "depth = 3\nmovement_cost = 0.0";
  EXPECT_NEAR(small.Link("--max-speed 1")["cost"], jumped, 1e-6);
  EXPECT_GT(small.Link("--max-speed 1 --depth none")["cost"], jumped + 5);
  small.linking = "depth = \"none\"\nmovement_cost = 0.0";
  ExpectOneLine(RunProgram(small.Arguments() + " -o x.csv --max-speed 0"), 2, "max-speed");
}

TEST(Link, CostsAndTheCapDecideHowManyPaths) {
  SmallMaps small;
  small.AddWalker(3);
  small.AddWalker(6);
  for (int frame = 0; frame < 40; ++frame) small.Put(frame, 8, 8, 0.7F);  // weak, earns 33.9
  EXPECT_EQ(small.Link()["paths"], 2);
  EXPECT_EQ(small.Link("--birth-cost 30")["paths"], 3);
  EXPECT_EQ(small.Link("--birth-cost 160")["paths"], 0);
  EXPECT_EQ(small.Link("--max-paths 1")["paths"], 1);
  small.linking = "birth_cost = 30.0\nmax_paths = 3";
  EXPECT_EQ(small.Link()["paths"], 3);
  EXPECT_EQ(small.Link("--max-paths 2")["paths"], 2);
  // 15 moves of one cell each; 7 m/s is 1.4 cells in a frame.
  const double still = small.Link("--max-paths 1 --movement-cost 0")["cost"];
  EXPECT_NEAR(small.Link("--max-paths 1 --movement-cost 1.4")["cost"], still + 15, 1e-3);
}

TEST(Link, TheExtensionIsLinkedOnAndCroppedAfter) {
  SmallMaps small;
  small.AddWalker(5);
  const auto report = small.Link("--smoothing 0");
  EXPECT_EQ(report["tracks"], 1);
  // Columns 0 and 15 are extension; of the 40 frames, 3 and 2 are spent in each.
  EXPECT_EQ(report["positions"], 35);
  // Somebody who stays in the extension has a path and no track.
  for (int frame = 0; frame < 40; ++frame) small.Put(frame, 8, 9);
  const auto both = small.Link();
  EXPECT_EQ(both["paths"], 2);
  EXPECT_EQ(both["tracks"], 1);
  EXPECT_EQ(both["dropped_paths"], 1);
}

TEST(LinkExplain, WritesPicturesAndFigures) {
  SmallMaps small;
  small.linking = "movement_cost = 2.0";
  small.AddWalker(2);
  small.AddWalker(7);
  small.Put(20, 8, 6, 0.9F);  // beside the second one
  const std::string why = (small.folder / "why").string();
  const auto report = small.Link(fmt::format("--explain '{}' --frames 60:85", why));
  EXPECT_EQ(Entries(why), (Strings{"explanation.json", "frame_000060.png", "frame_000070.png",
                                   "frame_000080.png", "stretch.png"}));
  const auto json = nlohmann::json::parse(ReadTextFile(why + "/explanation.json").value());
  EXPECT_EQ(json, report["explained"]);
  EXPECT_EQ(json["first_frame"], 60);
  EXPECT_EQ(json["last_frame"], 85);
  ASSERT_EQ(json["paths"].size(), 2U);
  for (const auto& path : json["paths"]) {
    EXPECT_EQ(path["first_frame"], 60);
    EXPECT_EQ(path["last_frame"], 85);
    EXPECT_EQ(path["cells"].size(), 26U);
    EXPECT_LT(path["cost"], -70);
    EXPECT_GE(path["weakest"]["margin"], json["next_best"]);
  }
  // By the cell beside, at the price of two longer moves, 2 (sqrt 2 - 1) or 2 (sqrt 5 - 1) at most.
  const auto& weakest = json["paths"][1]["weakest"];
  EXPECT_GE(weakest["frame"], 69);
  EXPECT_LE(weakest["frame"], 70);
  EXPECT_GT(weakest["margin"], std::log(49.0 / 9));
  EXPECT_LT(weakest["margin"], std::log(49.0 / 9) + 4);
  EXPECT_GT(json["further_path"]["missing"], 40);
  const cv::Mat picture = cv::imread(why + "/stretch.png");
  EXPECT_EQ(picture.cols, 1100);

  // The table says the same, and -o may be left out.
  const Outcome table =
      RunProgram(fmt::format("{} --explain '{}2' --frames 60:60", small.Arguments(), why));
  EXPECT_EQ(table.status, 0) << table.err;
  EXPECT_THAT(table.out, HasSubstr("next-best solution"));
  EXPECT_THAT(table.out, HasSubstr("weakest step at frame"));
  EXPECT_EQ(Entries(why + "2"), (Strings{"explanation.json", "frame_000060.png", "stretch.png"}));
}

TEST(LinkExplain, HostileFlagsGiveOneLineAndLeaveNothing) {
  SmallMaps small;
  small.AddWalker(5);
  const std::string arguments = small.Arguments();
  const std::string folder = small.folder.path().string();
  const Strings before = Entries(folder);
  const auto expect = [&](const std::string& flags, int status, const std::string& part) {
    SCOPED_TRACE(flags);
    ExpectOneLine(RunProgram(arguments + " " + fmt::format(fmt::runtime(flags), folder)), status,
                  part);
    EXPECT_EQ(Entries(folder), before);
    EXPECT_FALSE(std::filesystem::exists(small.folder / "why"));
  };
  expect("--explain '{0}/why'", 2, "--frames");
  expect("-o '{0}/t.csv' --frames 60:70", 2, "--explain");
  expect("--explain '{0}/why' --frames 60", 2, "'60' is no range of frames");
  expect("--explain '{0}/why' --frames 70:60", 2, "A:B");
  expect("--explain '{0}/why' --frames=-1:60", 2, "A:B");
  expect("--explain '{0}/why' --frames 60:nan", 2, "A:B");
  expect("--explain '{0}/why' --frames 60:99999999999999999999", 2, "A:B");
  expect("--explain '{0}/why' --frames 0:999999999", 2, "more than 10000 frames");
  expect("--explain '{0}/why' --frames 49:60", 1, "the maps have the frames 50 to 89");
  expect("--explain '{0}/why' --frames 60:90", 1, "the maps have the frames 50 to 89");
  expect("--explain '{0}' --frames 60:70", 1, folder);
  expect("--explain '{0}/maps.h5' --frames 60:70", 1, "maps.h5");
  expect("--explain /dev/null/why --frames 60:70", 1, "/dev/null");
  expect("--explain '{0}/why' --frames 60:70 -o /dev/null/t.csv", 1, "/dev/null");
}

// --- The original KSP program's files

/// One person in a corridor of 4 cells for 5 frames, at the clip.
void WriteKsp(const TemporaryFolder& folder) {
  for (int frame = 0; frame < 5; ++frame) {
    const int cell = std::min(frame, 3);
    std::string text;
    for (int i = 0; i < 4; ++i) text += fmt::format("{} {}\n", i, i == cell ? "1" : "0.001");
    ASSERT_TRUE(WriteTextFile(folder.path() / fmt::format("{}.dat", frame), text));
  }
  ASSERT_TRUE(WriteTextFile(folder / "x.ksp", "GRID 4 1\nFRAMES 0 4\nINPUT_FORMAT %d.dat\n"));
}

TEST(LinkKsp, ReplacesTheOriginalProgram) {
  const TemporaryFolder folder;
  WriteKsp(folder);
  const std::string expected = "1\n0\t0\t\n1\t1\t\n2\t2\t\n3\t3\t\n4\t3\t\n";
  const std::string in_folder = fmt::format("cd '{}'", folder.path().string());
  // As that program is called: the result goes to ksp-out.dat in the current folder.
  const Outcome plain = RunProgram("link --ksp x.ksp --quiet", in_folder);
  ASSERT_EQ(plain.status, 0) << plain.err;
  EXPECT_EQ(ReadTextFile(folder / "ksp-out.dat").value(), expected);
  EXPECT_THAT(plain.out, HasSubstr("paths    1"));
  const Outcome json = RunProgram(
      fmt::format("link --ksp '{0}/x.ksp' -o '{0}/out/o.dat' --json", folder.path().string()));
  ASSERT_EQ(json.status, 0) << json.err;
  EXPECT_EQ(ReadTextFile(folder / "out/o.dat").value(), expected);
  const auto report = nlohmann::json::parse(json.out);
  EXPECT_EQ(report["paths"], 1);
  EXPECT_NEAR(report["cost"], -5 * std::log(999999.0), 1e-3);
}

TEST(LinkKsp, HostileFilesAndFlagsGiveOneLineAndLeaveNothing) {
  const TemporaryFolder folder;
  WriteKsp(folder);
  const std::string path = folder.path().string();
  ASSERT_TRUE(WriteTextFile(folder / "text.ksp", "neither this nor that\n"));
  ASSERT_TRUE(WriteTextFile(folder / "far.ksp", "GRID 4 1\nFRAMES 0 5\nINPUT_FORMAT %d.dat\n"));
  ASSERT_TRUE(WriteTextFile(folder / "wide.ksp", "GRID 5 1\nFRAMES 0 4\nINPUT_FORMAT %d.dat\n"));
  const Strings before = Entries(folder.path());
  const auto expect = [&](const std::string& arguments, int status, const std::string& part) {
    SCOPED_TRACE(arguments);
    ExpectOneLine(RunProgram("link --quiet " + fmt::format(fmt::runtime(arguments), path),
                             fmt::format("cd '{}'", path)),
                  status, part);
    EXPECT_EQ(Entries(folder.path()), before);
  };
  expect("--ksp none.ksp", 1, "none.ksp");
  expect("--ksp {0}", 1, path);
  expect("--ksp text.ksp", 1, "text.ksp:1: unknown keyword");
  expect("--ksp far.ksp", 1, "5.dat");
  expect("--ksp wide.ksp", 1, "0.dat: has 4 lines; it needs one for each of the 5 cells");
  expect("--ksp x.ksp -o /dev/null/out.dat", 1, "/dev/null");
  expect("--ksp x.ksp -o '{0}'", 1, path);
  expect("--ksp x.ksp maps.h5", 2, "--ksp");
  expect("--ksp x.ksp --scene s.toml", 2, "--ksp");
  expect("--ksp x.ksp --depth 2", 2, "--ksp");
  expect("--ksp x.ksp --smoothing 1", 2, "--ksp");
  expect("--ksp x.ksp --identity-margin 3", 2, "--ksp");
  expect("--ksp x.ksp --explain why --frames 0:1", 2, "--ksp");
  expect("-o t.csv", 2, "--ksp");
  expect("maps.h5", 2, "--output or --explain");
  expect("maps.h5 -o t.csv --data d", 2, "--scene");
}

}  // namespace
}  // namespace vantage
