// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>

#include "command.h"

namespace vantage::app {
namespace {

using ::testing::HasSubstr;

struct Options {
  std::optional<double> margin_m = std::nullopt;
  std::optional<int> reach = std::nullopt;
  double size_m = 1;
};

void VisitOptions(Options& o, OptionVisitor& v) {
  v.NumberOr({"margin", "m", "a margin"}, o.margin_m, "auto", Range::Between(0, 50));
  v.NumberOr({"reach", "cells", "a reach"}, o.reach, "none", Range::Between(0, 5));
  v.Number({"size", "m", "a size"}, o.size_m, Range::Above(0));
}

/// What the flags make of `options`; the message of a usage error in `error`.
Options Parsed(const std::string& arguments, Options options, std::string& error) {
  CLI::App app("test", "test");
  const OptionFlags flags = AddOptionFlags(app, options, "grid-", "Grid");
  error.clear();
  try {
    app.parse(arguments);
  } catch (const CLI::ParseError& failure) {
    error = failure.what();
  }
  if (error.empty()) flags.ApplyTo(options);
  return options;
}

TEST(OptionFlags, ANumberOrAWordTakesBothAndKeepsWhatIsNotGiven) {
  std::string error;
  EXPECT_EQ(Parsed("--grid-margin 4", {}, error).margin_m, 4.0) << error;
  EXPECT_EQ(Parsed("--grid-margin 0", {}, error).margin_m, 0.0) << error;
  EXPECT_EQ(Parsed("--grid-margin=auto", {.margin_m = 3.0}, error).margin_m, std::nullopt) << error;
  EXPECT_EQ(Parsed("--grid-size 2", {.margin_m = 3.0}, error).margin_m, 3.0) << error;
  EXPECT_EQ(Parsed("--grid-size 2", {}, error).margin_m, std::nullopt) << error;
  EXPECT_EQ(Parsed("--grid-reach 4", {}, error).reach, 4) << error;
  EXPECT_EQ(Parsed("--grid-reach 0", {}, error).reach, 0) << error;
  EXPECT_EQ(Parsed("--grid-reach none", {.reach = 3}, error).reach, std::nullopt) << error;
  EXPECT_EQ(Parsed("--grid-size 2", {.reach = 3}, error).reach, 3) << error;
}

TEST(OptionFlags, ANumberOrAWordRefusesTheRest) {
  std::string error;
  Parsed("--grid-margin automatic", {}, error);
  EXPECT_THAT(error, HasSubstr("'automatic' is neither a number nor auto"));
  Parsed("--grid-margin -1", {}, error);
  EXPECT_THAT(error, HasSubstr("is -1; it must be between 0 and 50, or auto"));
  for (const char* wrong : {"51", "nan", "inf", "''", "4m", "Auto"}) {
    Parsed(std::string("--grid-margin=") + wrong, {}, error);
    EXPECT_THAT(error, HasSubstr("--grid-margin")) << wrong;
  }
  for (const char* wrong : {"6", "-1", "1.5", "''", "None", "99999999999"}) {
    Parsed(std::string("--grid-reach=") + wrong, {}, error);
    EXPECT_THAT(error, HasSubstr("--grid-reach")) << wrong;
  }
}

TEST(OptionFlags, TheHelpSaysTheWordAndTheDefault) {
  const auto help = [](const Options& options) {
    CLI::App app("test", "test");
    const OptionFlags flags = AddOptionFlags(app, options, "", "Grid");
    return app.help();
  };
  EXPECT_THAT(help({}), HasSubstr("--margin NUMBER|auto=auto"));
  EXPECT_THAT(help({.margin_m = 2.5}), HasSubstr("--margin NUMBER|auto=2.5"));
  EXPECT_THAT(help({}), HasSubstr("between 0 and 50, or auto"));
  EXPECT_THAT(help({}), HasSubstr("--reach NUMBER|none=none"));
  EXPECT_THAT(help({.reach = 2}), HasSubstr("--reach NUMBER|none=2"));
}

}  // namespace
}  // namespace vantage::app
