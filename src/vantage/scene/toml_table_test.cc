// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/scene/toml_table.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "vantage/base/test_support.h"

namespace vantage::internal {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::MessageOf;

struct Options {
  bool flag = false;
  int count = 3;
  double size_m = 0.5;
  std::optional<double> margin_m = 1.0;
  std::optional<int> reach = 1;
  enum class Kind { kRound, kFlat } kind = Kind::kRound;
};
void VisitOptions(Options& o, OptionVisitor& v) {
  v.Flag({"flag", "", "a flag"}, o.flag);
  v.Number({"count", "", "a count"}, o.count, Range::Between(1, 8));
  v.Number({"size", "m", "a length"}, o.size_m, Range::AboveUpTo(0, 10));
  v.NumberOr({"margin", "m", "a margin"}, o.margin_m, "auto", Range::AtLeast(0));
  v.NumberOr({"reach", "cells", "a reach"}, o.reach, "none", Range::Between(0, 5));
  v.Choice({"kind", "", "a kind"}, o.kind,
           {{"round", Options::Kind::kRound}, {"flat", Options::Kind::kFlat}});
}

class TomlTableTest : public ::testing::Test {
 protected:
  TableReader Parse(const std::string& text) {
    Result<TomlValue> parsed = ParseToml(file_, text);
    EXPECT_TRUE(parsed) << MessageOf(parsed);
    value_ = std::move(*parsed);
    return TableReader(file_, "", value_);
  }
  std::string BindError(const std::string& text) {
    Options options;
    return MessageOf(Parse("[stage]\n" + text).Table("stage").value().Bind([&](OptionVisitor& v) {
      VisitOptions(options, v);
    }));
  }
  const std::string file_ = "s.toml";
  TomlValue value_;
};

TEST_F(TomlTableTest, SyntaxErrorsHaveALine) {
  const std::string message = MessageOf(ParseToml("s.toml", "a = 1\nb = [1, 2\n\nc = 3\n"));
  EXPECT_THAT(message, ::testing::MatchesRegex("s.toml:[234]: not valid TOML: .*"));
  EXPECT_THAT(MessageOf(ParseToml("s.toml", "a = 1\na = 2\n")),
              HasSubstr("s.toml:2: not valid TOML"));
  EXPECT_THAT(MessageOf(ParseToml("s.toml", std::string(100'000, '['))),
              HasSubstr("not valid TOML"));
  const std::string deep = std::string("a = ") + std::string(100'000, '[');
  EXPECT_THAT(MessageOf(ParseToml("s.toml", deep)), HasSubstr("not valid TOML"));
}

TEST_F(TomlTableTest, BindSetsWhatIsGiven) {
  const TableReader root = Parse("[stage]\nflag = true\ncount = 8\nkind = \"flat\"\n");
  Options options;
  ASSERT_TRUE(
      root.Table("stage").value().Bind([&](OptionVisitor& v) { VisitOptions(options, v); }));
  EXPECT_TRUE(options.flag);
  EXPECT_EQ(options.count, 8);
  EXPECT_EQ(options.size_m, 0.5);
  EXPECT_EQ(options.kind, Options::Kind::kFlat);
}

TEST_F(TomlTableTest, BindTakesWholeNumbersForNumbers) {
  const TableReader root = Parse("[stage]\nsize = 2\n");
  Options options;
  ASSERT_TRUE(
      root.Table("stage").value().Bind([&](OptionVisitor& v) { VisitOptions(options, v); }));
  EXPECT_EQ(options.size_m, 2.0);
}

TEST_F(TomlTableTest, BindTakesTheWordOfANumberThatHasOne) {
  const auto margin = [&](const std::string& text) {
    Options options;
    const TableReader root = Parse("[stage]\n" + text);
    EXPECT_TRUE(
        root.Table("stage").value().Bind([&](OptionVisitor& v) { VisitOptions(options, v); }));
    return options.margin_m;
  };
  EXPECT_EQ(margin("margin = \"auto\""), std::nullopt);
  EXPECT_EQ(margin("margin = 2"), 2.0);
  EXPECT_EQ(margin(""), 1.0);
  EXPECT_EQ(BindError("margin = -1"),
            "s.toml:2: stage.margin: is -1; it must be at least 0 m, or \"auto\"");
  EXPECT_EQ(BindError("margin = \"Auto\""),
            "s.toml:2: stage.margin: is \"Auto\"; it must be a number, at least 0 m, or \"auto\"");
  EXPECT_THAT(BindError("margin = nan"), HasSubstr("is nan; it must be at least 0 m"));
  EXPECT_THAT(BindError("margin = [2]"), HasSubstr("is an array of 1; it must be a number"));
}

TEST_F(TomlTableTest, BindTakesTheWordOfAWholeNumberThatHasOne) {
  const auto reach = [&](const std::string& text) {
    Options options;
    const TableReader root = Parse("[stage]\n" + text);
    EXPECT_TRUE(
        root.Table("stage").value().Bind([&](OptionVisitor& v) { VisitOptions(options, v); }));
    return options.reach;
  };
  EXPECT_EQ(reach("reach = \"none\""), std::nullopt);
  EXPECT_EQ(reach("reach = 0"), 0);
  EXPECT_EQ(reach("reach = 5"), 5);
  EXPECT_EQ(reach(""), 1);
  EXPECT_EQ(BindError("reach = 6"),
            "s.toml:2: stage.reach: is 6; it must be between 0 and 5 cells, or \"none\"");
  EXPECT_THAT(BindError("reach = 1.5"), HasSubstr("stage.reach: is 1.5; it must be a whole"));
  EXPECT_THAT(BindError("reach = 99999999999"), HasSubstr("it must be between 0 and 5 cells"));
}

TEST_F(TomlTableTest, BindErrorsNamePlaceAndRule) {
  EXPECT_EQ(BindError("count = 9"), "s.toml:2: stage.count: is 9; it must be between 1 and 8");
  EXPECT_THAT(BindError("\ncount = 1.5"),
              HasSubstr("s.toml:3: stage.count: is 1.5; it must be a whole"));
  EXPECT_THAT(BindError("count = 99999999999"),
              HasSubstr("is 99999999999; it must be a whole number"));
  EXPECT_EQ(BindError("size = 0"),
            "s.toml:2: stage.size: is 0; it must be above 0 and at most 10 m");
  EXPECT_EQ(BindError("size = nan"),
            "s.toml:2: stage.size: is nan; it must be above 0 and at most 10 m");
  EXPECT_THAT(BindError("size = inf"), HasSubstr("stage.size: is inf"));
  EXPECT_THAT(BindError("size = \"1\""), HasSubstr("is \"1\"; it must be a number, above 0"));
  EXPECT_THAT(BindError("size = 1979-05-27"), HasSubstr("is a date or time"));
  EXPECT_EQ(BindError("flag = 1"), "s.toml:2: stage.flag: is 1; it must be true or false");
  EXPECT_EQ(BindError("kind = \"square\""),
            "s.toml:2: stage.kind: is \"square\"; it must be one of round, flat");
  EXPECT_EQ(BindError("cuont = 3"),
            "s.toml:2: stage.cuont: unknown key, did you mean count?; allowed are flag, count, "
            "size, margin, reach, kind");
  EXPECT_EQ(BindError("elephant = 3"),
            "s.toml:2: stage.elephant: unknown key; allowed are flag, count, size, margin, "
            "reach, kind");
}

TEST_F(TomlTableTest, TypedAccess) {
  const TableReader root = Parse(R"(numbers = [1, 2.5]
rows = [[1, 2], [3, 4]]
lists = [[[1, 2]], []]
text = ""
[[tables]]
a = 1
[[tables]]
a = 2
)");
  EXPECT_THAT(root.Numbers("numbers", {2}).value(), ElementsAre(1, 2.5));
  EXPECT_EQ(MessageOf(root.Numbers("numbers", {3, 4})),
            "s.toml:1: numbers: has 2 numbers; it must have 3 or 4");
  EXPECT_THAT(root.Rows("rows", 2).value(), ElementsAre(ElementsAre(1, 2), ElementsAre(3, 4)));
  EXPECT_EQ(MessageOf(root.Rows("rows", 3)),
            "s.toml:2: rows: row 1 has 2 numbers; each row must have 3");
  EXPECT_THAT(MessageOf(root.Rows("numbers", 2)), HasSubstr("it must be an array of numbers"));
  EXPECT_EQ(root.ListOfRows("lists", 2).value().size(), 2u);
  EXPECT_THAT(MessageOf(root.Text("text")), HasSubstr("s.toml:4: text: is \"\""));
  EXPECT_EQ(MessageOf(root.Text("none")), "s.toml:1: none: is missing");
  const std::vector<TableReader> tables = root.Tables("tables").value();
  ASSERT_EQ(tables.size(), 2u);
  EXPECT_EQ(tables[1].Integer("a", 0, 9).value(), 2);
  EXPECT_EQ(MessageOf(tables[1].Integer("a", 5, 9)),
            "s.toml:8: tables[1].a: is 2; it must be a whole number from 5 to 9");
  EXPECT_THAT(MessageOf(root.Tables("numbers")), HasSubstr("one or more tables [[numbers]]"));
  EXPECT_THAT(MessageOf(root.Table("text")), HasSubstr("it must be a table"));
}

TEST(NearestName, IsTheLeastEditAway) {
  EXPECT_EQ(NearestName("widht", {"height", "width"}), "width");
  EXPECT_EQ(NearestName("cells", {"cell", "extension"}), "cell");
  EXPECT_EQ(NearestName("zebra", {"cell", "extension"}), std::nullopt);
}

}  // namespace
}  // namespace vantage::internal
