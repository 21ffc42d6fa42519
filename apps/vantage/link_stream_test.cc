// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
// `vantage link --lag` as a user runs it.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "test_program.h"
#include "vantage/base/file.h"
#include "vantage/base/test_support.h"
#include "vantage/occupancy/map_file.h"
#include "vantage/tracks/track_file.h"

namespace vantage {
namespace {

using testing::Entries;
using testing::ExpectOneLine;
using ::testing::HasSubstr;
using testing::MessageOf;
using testing::Outcome;
using testing::RunProgram;
using testing::TemporaryFolder;

/// A file of 200 maps at 10 frames per second: three people cross one after another and at once,
/// and are not seen in every ninth frame.
class LinkStream : public ::testing::Test {
 protected:
  LinkStream() {
    OccupancyMaps maps;
    maps.grid = {.min_x_m = 0, .min_y_m = 0, .cell_m = 0.5, .columns = 24, .rows = 12};
    maps.first_frame = 30;
    maps.frames_per_second = 10;
    maps.in_area.assign(288, 1);
    maps.visible.assign(288, 1);
    for (int frame = 0; frame < 200; ++frame) {
      std::vector<float> map(288, 0.002F);
      const auto put = [&](int first_frame, int row) {
        const int column = (frame - first_frame) / 3;
        if (frame < first_frame || column >= 24 || frame % 9 == 0) return;
        map[static_cast<std::size_t>(maps.grid.Index(column, row))] = 0.999F;
      };
      put(0, 2);
      put(60, 6);
      put(100, 10);
      maps.values.insert(maps.values.end(), map.begin(), map.end());
    }
    EXPECT_TRUE(WriteMaps(maps_, maps));
  }

  Outcome Link(const std::string& arguments, const std::string& shell_setup = ":") const {
    return RunProgram(
        fmt::format("link '{}' -o '{}' --quiet {}", maps_.string(), tracks_.string(), arguments),
        shell_setup);
  }
  std::string Csv() const { return ReadTextFile(tracks_).value_or("no file"); }

  TemporaryFolder folder_;
  std::filesystem::path maps_ = folder_ / "maps.h5";
  std::filesystem::path tracks_ = folder_ / "tracks.csv";
};

TEST_F(LinkStream, ALagOfTheWholeRecordingGivesTheSameBytes) {
  ASSERT_EQ(Link("").status, 0);
  const std::string whole = Csv();
  EXPECT_THAT(whole, HasSubstr("\n31,1,"));
  const Outcome stream = Link("--lag 20 --gap --json");
  ASSERT_EQ(stream.status, 0) << stream.err;
  EXPECT_EQ(Csv(), whole);
  const auto json = nlohmann::json::parse(stream.out);
  EXPECT_EQ(json["lag_frames"], 200);
  EXPECT_EQ(json["tracks"], 3);
  EXPECT_EQ(json["paths"], json["whole"]["paths"]);
  EXPECT_EQ(json["gap"]["absolute"], 0);
  EXPECT_EQ(json["gap"]["relative"], 0);
}

TEST_F(LinkStream, AShortLagReportsItsGap) {
  const Outcome stream = Link("--lag 1.2 --gap --json");
  ASSERT_EQ(stream.status, 0) << stream.err;
  const auto json = nlohmann::json::parse(stream.out);
  EXPECT_EQ(json["frames"], 200);
  EXPECT_EQ(json["lag_frames"], 12);
  const double cost = json["cost"];
  const double whole = json["whole"]["cost"];
  EXPECT_LT(whole, -500);
  EXPECT_GE(cost, whole) << "the optimum bounds it";
  EXPECT_NEAR(json["gap"]["absolute"], cost - whole, 1e-9);
  EXPECT_NEAR(json["gap"]["relative"], (cost - whole) / -whole, 1e-9);
  const Result<Tracks> tracks = ReadTracks(tracks_);
  ASSERT_TRUE(tracks) << MessageOf(tracks);
  EXPECT_EQ(json["tracks"], tracks->size());
  EXPECT_EQ(tracks->size(), 3u);
  std::size_t positions = 0;
  for (const Track& track : *tracks) positions += track.points.size();
  EXPECT_EQ(json["positions"], positions);
  EXPECT_GT(positions, 180u);

  const Outcome table = Link("--lag 1.2 --gap");
  EXPECT_THAT(table.out, HasSubstr("lag        1.2 s  (12 frames)"));
  EXPECT_THAT(table.out, HasSubstr("gap "));
  EXPECT_EQ(Link("--lag 1.2").out.find("gap"), std::string::npos);
}

TEST_F(LinkStream, FailsWithOneLineAndLeavesNothing) {
  const std::vector<std::string> before = Entries(folder_.path());
  ExpectOneLine(Link("--gap"), 2, "--lag");
  ExpectOneLine(Link("--lag nan"), 2, "--lag");
  ExpectOneLine(Link("--lag -1"), 2, "--lag");
  ExpectOneLine(Link("--lag 1e7"), 2, "--lag");
  ExpectOneLine(Link("--lag 1 --max-paths 2"), 1, "max_paths");
  ExpectOneLine(Link("--lag 1", "trap '' XFSZ; ulimit -f 1"), 1, "cannot be written");
  ExpectOneLine(
      RunProgram(fmt::format("link '{0}/none.h5' -o '{0}/t.csv' --lag 1", folder_.path().string())),
      1, "none.h5: no such file");
  ExpectOneLine(RunProgram(fmt::format("link '{}' -o /dev/null/t.csv --lag 1", maps_.string())), 1,
                "/dev/null");
  EXPECT_EQ(Entries(folder_.path()), before);

  // Damaged in the middle, where some positions are written already.
  std::string bytes = ReadTextFile(maps_).value();
  for (std::size_t i = bytes.size() / 2; i < bytes.size() * 3 / 4; ++i) bytes[i] ^= 0x5a;
  ASSERT_TRUE(WriteTextFile(maps_, bytes));
  ExpectOneLine(Link("--lag 1"), 1, "maps.h5: ");
  EXPECT_EQ(Entries(folder_.path()), before);
}

}  // namespace
}  // namespace vantage
