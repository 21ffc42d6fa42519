// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdlib>
#include <filesystem>
#include <string>

#include "vantage/base/result.h"

/// Helpers for tests only; not installed.

namespace vantage::testing {

/// Folder of the research data that some tests measure on: VANTAGE_TEST_DATA, else ../shared/data
/// beside the checkout. Empty where it is absent: such a test calls GTEST_SKIP() << "...".
inline std::filesystem::path DataFolder() {
  const char* given = std::getenv("VANTAGE_TEST_DATA");
  const std::filesystem::path folder =
      given != nullptr
          ? std::filesystem::path(given)
          : std::filesystem::path(VANTAGE_SOURCE_DIR).parent_path() / "shared" / "data";
  std::error_code code;
  return std::filesystem::is_directory(folder, code) ? folder : std::filesystem::path();
}

/// A folder of its own for one test, removed at the end.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "vantage-test-XXXXXX").string();
    path_ = ::mkdtemp(name.data());
  }
  ~TemporaryFolder() {
    std::error_code code;
    std::filesystem::remove_all(path_, code);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }

 private:
  std::filesystem::path path_;
};

/// The message of a failed result; empty when it succeeded.
template <class T>
std::string MessageOf(const Result<T>& result) {
  return result ? std::string() : result.error().message;
}

}  // namespace vantage::testing
