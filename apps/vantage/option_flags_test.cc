// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>

#include "command.h"

namespace vantage::app {
namespace {

using ::testing::HasSubstr;

struct Options {
  std::optional<double> margin_m;
  double size_m = 1;
};

void VisitOptions(Options& o, OptionVisitor& v) {
  v.NumberOr({"margin", "m", "a margin"}, o.margin_m, "auto", Range::Between(0, 50));
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
}

}  // namespace
}  // namespace vantage::app
