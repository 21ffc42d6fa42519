// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "vantage/base/result.h"
#include "vantage/scene/scene.h"

namespace vantage {

/// The text of a scene file that LoadScene reads back to the same scene: every number to its last
/// bit, calibrations as tables of their own. Paths of sources stand as they are in `scene`. Fails
/// on what the text cannot say: blind pixels, which are a picture, and tables of stages.
Result<std::string> SceneText(const Scene& scene);

}  // namespace vantage
