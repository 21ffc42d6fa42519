// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <vector>

#include "vantage/scene/scene.h"
#include "vantage/scene/toml_table.h"

namespace vantage::internal {

/// Reads one [[cameras]] table. Paths are relative to `folder`; files read are added to `inputs`.
Result<SceneCamera> ReadCamera(const TableReader& table, const std::filesystem::path& folder,
                               std::vector<std::filesystem::path>& inputs);

}  // namespace vantage::internal
