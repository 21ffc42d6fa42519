// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/experiments/cell.h"

#include <gmock/gmock.h>

#include <atomic>
#include <fstream>
#include <limits>

#include "vantage/base/file.h"
#include "vantage/base/test_support.h"

namespace vantage {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using testing::MessageOf;
using ::testing::SizeIs;
using testing::TemporaryFolder;
using Json = nlohmann::ordered_json;

/// Cells that square a number, and count how often they run.
struct Squares {
  TemporaryFolder folder;
  std::shared_ptr<std::atomic<int>> runs = std::make_shared<std::atomic<int>>(0);

  CellPtr Cell(const std::string& name, double number) const {
    return std::make_shared<const vantage::Cell>(
        vantage::Cell{.name = name,
                      .inputs = {{"number", number}},
                      .run = [runs = runs, number](const CellRun&) -> Result<Json> {
                        ++*runs;
                        return Json{{"square", number * number}};
                      }});
  }
  std::vector<CellPtr> Several(int count) const {
    std::vector<CellPtr> cells;
    for (int i = 0; i < count; ++i) cells.push_back(Cell(fmt::format("square-{}", i), i));
    return cells;
  }
  CellsReport Run(const std::vector<CellPtr>& cells, int threads = 1, bool force = false) const {
    return RunCells(folder.path(), cells, threads, force).value();
  }
  fs::path File(const std::string& name) const {
    return folder.path() / "cells" / (name + ".json");
  }
};

TEST(RunCells, ASecondRunComputesNothing) {
  const Squares squares;
  const CellsReport first = squares.Run(squares.Several(5));
  EXPECT_EQ(first.computed, 5);
  EXPECT_EQ(first.kept, 0);
  EXPECT_EQ(first.results.at("square-3").at("square"), 9);
  const CellsReport second = squares.Run(squares.Several(5));
  EXPECT_EQ(second.computed, 0);
  EXPECT_EQ(second.kept, 5);
  EXPECT_EQ(*squares.runs, 5);
  EXPECT_EQ(second.results, first.results);
  EXPECT_THAT(second.notes, SizeIs(0));
}

TEST(RunCells, ForceComputesAll) {
  const Squares squares;
  squares.Run(squares.Several(3));
  EXPECT_EQ(squares.Run(squares.Several(3), 1, true).computed, 3);
}

TEST(RunCells, AChangedInputComputesThatCell) {
  const Squares squares;
  squares.Run(squares.Several(3));
  std::vector<CellPtr> cells = squares.Several(3);
  cells[1] = squares.Cell("square-1", 1.5);
  const CellsReport report = squares.Run(cells);
  EXPECT_EQ(report.computed, 1);
  EXPECT_EQ(report.kept, 2);
  EXPECT_EQ(report.results.at("square-1").at("square"), 2.25);
  ASSERT_THAT(report.notes, SizeIs(1));
  EXPECT_THAT(report.notes[0], HasSubstr("square-1.json: is of other options or data"));
}

TEST(RunCells, ADamagedFileIsComputedAnewAndSaidSo) {
  const Squares squares;
  squares.Run(squares.Several(4));
  fs::resize_file(squares.File("square-0"), 40);
  std::ofstream(squares.File("square-1")) << "[1, 2]";
  Json other = Json::parse(ReadTextFile(squares.File("square-2")).value());
  other["vantage"] = "0.0.0";
  std::ofstream(squares.File("square-2")) << other;
  const CellsReport report = squares.Run(squares.Several(4));
  EXPECT_EQ(report.computed, 3);
  EXPECT_EQ(report.results.at("square-2").at("square"), 4);
  ASSERT_THAT(report.notes, SizeIs(3));
  EXPECT_THAT(report.notes[0], HasSubstr("square-0.json: is damaged; computed anew"));
  EXPECT_THAT(report.notes[1], HasSubstr("square-1.json: is damaged"));
  EXPECT_THAT(report.notes[2], HasSubstr("square-2.json: is of another version"));
  EXPECT_EQ(squares.Run(squares.Several(4)).computed, 0);
}

TEST(RunCells, NumbersThatAreNoneAreNullNowAndLater) {
  const Squares squares;
  const std::vector<CellPtr> cells = {
      squares.Cell("nothing", std::numeric_limits<double>::quiet_NaN())};
  EXPECT_TRUE(squares.Run(cells).results.at("nothing").at("square").is_null());
  const CellsReport second = squares.Run(cells);
  EXPECT_EQ(second.kept, 1);
  EXPECT_TRUE(second.results.at("nothing").at("square").is_null());
}

/// A cell that makes a file, and one that doubles the number in it.
struct Chain {
  TemporaryFolder folder;
  std::shared_ptr<std::atomic<int>> made = std::make_shared<std::atomic<int>>(0);
  std::shared_ptr<std::atomic<int>> used = std::make_shared<std::atomic<int>>(0);
  CellPtr User(int number, const std::string& name = "user") const {
    const auto maker = std::make_shared<const Cell>(
        Cell{.name = "maker",
             .inputs = {{"number", number}},
             .product = "data/numbers",
             .alone = true,
             .run = [made = made, number](const CellRun& run) -> Result<Json> {
               ++*made;
               std::ofstream(run.product / "number.txt") << number;
               return Json{{"threads", run.threads}};
             }});
    return std::make_shared<const Cell>(
        Cell{.name = name,
             .inputs = {{"factor", 2}},
             .needs = {maker},
             .run = [used = used](const CellRun& run) -> Result<Json> {
               ++*used;
               VANTAGE_ASSIGN_OR_RETURN(const std::string text,
                                        ReadTextFile(run.folder / "data/numbers/number.txt"));
               return Json{{"double", 2 * std::stoi(text)}, {"threads", run.threads}};
             }});
  }
};

TEST(RunCells, NeedsComeFirstAndOnce) {
  const Chain chain;
  const CellsReport report =
      RunCells(chain.folder.path(), {chain.User(21), chain.User(21, "other")}, 2, false).value();
  EXPECT_EQ(*chain.made, 1);
  EXPECT_EQ(report.computed, 3);
  EXPECT_EQ(report.results.at("user").at("double"), 42);
  EXPECT_EQ(report.results.at("user").at("threads"), 1);
  EXPECT_FALSE(report.results.contains("maker"));
}

TEST(RunCells, AChangedNeedComputesWhatNeedsIt) {
  const Chain chain;
  ASSERT_TRUE(RunCells(chain.folder.path(), {chain.User(21)}, 1, false));
  const CellsReport report = RunCells(chain.folder.path(), {chain.User(4)}, 1, false).value();
  EXPECT_EQ(report.results.at("user").at("double"), 8);
  EXPECT_EQ(*chain.made, 2);
}

TEST(RunCells, AProductIsMadeAnewOnlyForThoseWhoNeedIt) {
  const Chain chain;
  ASSERT_TRUE(RunCells(chain.folder.path(), {chain.User(21)}, 1, false));
  fs::remove_all(chain.folder / "data");
  EXPECT_EQ(RunCells(chain.folder.path(), {chain.User(21)}, 1, false)->computed, 0);
  EXPECT_EQ(*chain.made, 1);
  const CellsReport report =
      RunCells(chain.folder.path(), {chain.User(21), chain.User(21, "other")}, 1, false).value();
  EXPECT_EQ(report.computed, 2);
  EXPECT_EQ(*chain.made, 2);
  EXPECT_EQ(*chain.used, 2);
}

TEST(RunCells, AFailedCellLeavesTheOthersAndNoProduct) {
  const Squares squares;
  std::vector<CellPtr> cells = squares.Several(2);
  cells.push_back(std::make_shared<const Cell>(Cell{
      .name = "bad", .inputs = {}, .product = "bad", .run = [](const CellRun& run) -> Result<Json> {
        std::ofstream(run.product / "half") << "half";
        return Fail("no luck");
      }}));
  EXPECT_EQ(MessageOf(RunCells(squares.folder.path(), cells, 1, false)), "bad: no luck");
  EXPECT_FALSE(fs::exists(squares.folder / "bad"));
  EXPECT_TRUE(fs::exists(squares.File("square-0")));
  EXPECT_EQ(std::distance(fs::directory_iterator(squares.folder.path()), {}), 1);
}

TEST(RunCells, AnInterruptedRunKeepsWhatIsFinished) {
  const Squares squares;
  std::atomic<bool> stop = false;
  RunControl control;
  control.stop = &stop;
  control.progress = [&](std::int64_t done, std::int64_t) { stop = done == 3; };
  const std::vector<CellPtr> cells = squares.Several(6);
  EXPECT_THAT(MessageOf(RunCells(squares.folder.path(), cells, 1, false, control)),
              HasSubstr("interrupted; the finished cells are kept"));
  EXPECT_EQ(*squares.runs, 3);
  const CellsReport report = squares.Run(cells);
  EXPECT_EQ(report.kept, 3);
  EXPECT_EQ(report.computed, 3);
}

TEST(RunCells, ThreadsDoNotMatter) {
  const Squares sequential, parallel;
  const std::vector<CellPtr> cells = sequential.Several(30);
  std::int64_t last = 0;
  RunControl control;
  control.progress = [&](std::int64_t done, std::int64_t total) {
    EXPECT_EQ(total, 30);
    EXPECT_GE(done, last);
    last = done;
  };
  const CellsReport report =
      RunCells(parallel.folder.path(), parallel.Several(30), 4, false, control).value();
  EXPECT_EQ(report.results, sequential.Run(cells).results);
  EXPECT_EQ(last, 30);
}

TEST(RunCells, NamesThatAreNone) {
  const Squares squares;
  for (const char* name : {"", "../up", "Upper", "a b", "9", "a/b"}) {
    EXPECT_THAT(MessageOf(RunCells(squares.folder.path(), {squares.Cell(name, 1)}, 1, false)),
                HasSubstr("a name has small letters"));
  }
  EXPECT_THAT(MessageOf(RunCells(squares.folder.path(),
                                 {squares.Cell("same", 1), squares.Cell("same", 2)}, 1, false)),
              HasSubstr("cell same: two that differ"));
  EXPECT_EQ(squares.Run({squares.Cell("same", 1), squares.Cell("same", 1)}).computed, 1);
}

TEST(RunCells, AFolderThatCannotBeWritten) {
  const Squares squares;
  EXPECT_THAT(MessageOf(RunCells("/dev/null/out", squares.Several(1), 1, false)),
              HasSubstr("/dev/null"));
}

}  // namespace
}  // namespace vantage
