// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>

#include "vantage/background/mixture.h"
#include "vantage/metrics/mask_measures.h"

/// What the tables and bars of a ghost experiment are made of. Internal to the pages.

namespace vantage {

struct GhostSetting {
  const char* name;
  ColorSpace color;
  LearningRate rate;
};
/// As the thesis's figures have them: M and O for the modified and the original rate.
inline constexpr std::array<GhostSetting, 4> kGhostSettings = {
    {{"LUV M", ColorSpace::kLuv, LearningRate::kModified},
     {"LUV O", ColorSpace::kLuv, LearningRate::kOriginal},
     {"RGB M", ColorSpace::kRgb, LearningRate::kModified},
     {"RGB O", ColorSpace::kRgb, LearningRate::kOriginal}}};

struct GhostMeasure {
  const char* name;
  const char* key;  ///< in files
  double MaskMeasures::*value;
};
inline constexpr std::array<GhostMeasure, 3> kGhostMeasures = {
    {{"Recall", "recall", &MaskMeasures::recall},
     {"Precision", "precision", &MaskMeasures::precision},
     {"F1", "f1", &MaskMeasures::f1}}};

}  // namespace vantage
