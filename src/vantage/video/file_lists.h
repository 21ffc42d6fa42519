// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <vector>

#include "vantage/base/result.h"

/// Internal to the video module: which files make a sequence of pictures.

namespace vantage::internal {

/// Files of a pattern with one %d or %0Nd in its last component, in the order of their numbers from
/// the lowest that exists. Fails on any other use of '%', when none exists, and on a gap.
Result<std::vector<std::filesystem::path>> ListNumbered(const std::filesystem::path& pattern);

/// Pictures in a folder by name; runs of digits compare by value ("p9.png" before "p10.png"). Other
/// files are passed over. Fails when there are none.
Result<std::vector<std::filesystem::path>> ListPictures(const std::filesystem::path& folder);

}  // namespace vantage::internal
