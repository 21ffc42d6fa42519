// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/base/options.h"

#include <gmock/gmock.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "vantage/base/parallel.h"
#include "vantage/base/test_support.h"

namespace vantage {
namespace {

using testing::MessageOf;

enum class Mode { kFast, kExact };

struct ExampleOptions {
  int count = 3;
  double side_m = 0.5;
  std::optional<double> margin_m;
  std::optional<int> reach;
  bool on = true;
  Mode mode = Mode::kExact;
};

void VisitOptions(ExampleOptions& o, OptionVisitor& v) {
  v.Number({"count", "", "how many"}, o.count, Range::Between(1, 8));
  v.Number({"side", "m", "side of a cell"}, o.side_m, Range::Above(0));
  v.NumberOr({"margin", "m", "how far"}, o.margin_m, "auto", Range::AtLeast(0));
  v.NumberOr({"reach", "cells", "how many cells"}, o.reach, "none", Range::Between(0, 5));
  v.Flag({"on", "", "whether"}, o.on);
  v.Choice({"mode", "", "which"}, o.mode, {{"fast", Mode::kFast}, {"exact", Mode::kExact}});
}

TEST(Options, MessagesNameFieldValueAndRule) {
  ExampleOptions options;
  EXPECT_EQ(MessageOf(ValidateOptions(options, "stage")), "");
  options.count = 9;
  EXPECT_EQ(MessageOf(ValidateOptions(options, "stage")),
            "stage.count is 9; it must be between 1 and 8");
  options.count = 1;
  options.side_m = 0;
  EXPECT_EQ(MessageOf(ValidateOptions(options, "stage")), "stage.side is 0; it must be above 0 m");
  options.side_m = std::nan("");
  EXPECT_EQ(MessageOf(ValidateOptions(options, "stage")),
            "stage.side is nan; it must be above 0 m");
  options.side_m = 1;
  options.margin_m = -1;
  EXPECT_EQ(MessageOf(ValidateOptions(options, "stage")),
            "stage.margin is -1; it must be at least 0 m, or \"auto\"");
  options.margin_m = std::nan("");
  EXPECT_EQ(MessageOf(ValidateOptions(options, "stage")),
            "stage.margin is nan; it must be at least 0 m, or \"auto\"");
  options.margin_m = 0;
  options.reach = 5;
  EXPECT_EQ(MessageOf(ValidateOptions(options, "stage")), "");
  options.reach = 6;
  EXPECT_EQ(MessageOf(ValidateOptions(options, "stage")),
            "stage.reach is 6; it must be between 0 and 5 cells, or \"none\"");
  options.reach.reset();
  options.mode = static_cast<Mode>(7);
  EXPECT_EQ(MessageOf(ValidateOptions(options, "")),
            "mode has no valid value; it must be one of fast, exact");
}

TEST(Options, RecordHoldsEveryField) {
  nlohmann::ordered_json json;
  RecordOptions(ExampleOptions{}, json);
  EXPECT_EQ(json.dump(),
            R"({"count":3,"side":0.5,"margin":"auto","reach":"none","on":true,"mode":"exact"})");
  RecordOptions(ExampleOptions{.margin_m = 2.5, .reach = 2}, json);
  EXPECT_EQ(json.dump(),
            R"({"count":3,"side":0.5,"margin":2.5,"reach":2,"on":true,"mode":"exact"})");
}

TEST(ParallelFor, VisitsEveryIndexOnceWhateverTheThreadCount) {
  for (const int threads : {0, 1, 2, 5}) {
    std::vector<int> visits(1000, 0);
    ParallelFor(threads, 1000, [&](std::int64_t i) { ++visits[static_cast<size_t>(i)]; });
    EXPECT_EQ(visits, std::vector<int>(1000, 1)) << threads << " threads";
  }
}

}  // namespace
}  // namespace vantage
