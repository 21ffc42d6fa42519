// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "vantage/base/file.h"
#include "vantage/base/test_support.h"

/// For tests only: runs the program as a user does.

namespace vantage::testing {

struct Outcome {
  int status = -1;
  std::string out, err;
};

/// `shell_setup` runs first in the shell that becomes the program.
inline Outcome RunProgram(const std::string& arguments, const std::string& shell_setup = ":") {
  const TemporaryFolder folder;
  const std::string command =
      fmt::format("{}; exec '{}' {} >'{}' 2>'{}' </dev/null", shell_setup, VANTAGE_PROGRAM,
                  arguments, (folder / "out").string(), (folder / "err").string());
  const int status = std::system(command.c_str());
  Outcome outcome;
  outcome.status = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  outcome.out = ReadTextFile(folder / "out").value_or("");
  outcome.err = ReadTextFile(folder / "err").value_or("");
  return outcome;
}

/// Everything in a folder, temporaries included.
inline std::vector<std::string> Entries(const std::filesystem::path& folder) {
  std::vector<std::string> names;
  if (!std::filesystem::exists(folder)) return names;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    if (!entry.is_directory()) names.push_back(entry.path().filename().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

/// The program failed with this status and one line on stderr that holds `part`.
inline void ExpectOneLine(const Outcome& outcome, int status, const std::string& part) {
  EXPECT_EQ(outcome.status, status) << outcome.err;
  EXPECT_THAT(outcome.err, ::testing::StartsWith("vantage: "));
  EXPECT_THAT(outcome.err, ::testing::HasSubstr(part));
  EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
}

}  // namespace vantage::testing
