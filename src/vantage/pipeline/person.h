// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "vantage/geometry/person.h"
#include "vantage/occupancy/person_size.h"
#include "vantage/scene/scene.h"

namespace vantage {

/// The person of a run.
struct PersonReport {
  /// As used.
  PersonOptions used;
  /// None when the scene gives both lengths.
  std::optional<PersonSizeReport> measured;
  /// What the scene leaves open was found from the recording; false: too few people were seen, and
  /// the default stands in.
  bool found = false;
};

/// The lengths that the scene leaves open, from what was measured, if anything was. Where too few
/// people were seen the lengths of PersonOptions are used, the width with CellAllowance_m.
PersonReport ResolvePerson(const Scene& scene, std::optional<PersonSizeReport> measured);

/// E.g. "0.59 x 1.80 m, measured on 446 of 512 figures"; the rest of the report is in the JSON.
std::string TextOf(const PersonReport& report);
/// Every number of the report; cameras by their names.
nlohmann::ordered_json JsonOf(const PersonReport& report, const Scene& scene);

}  // namespace vantage
