// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "vantage/background/subtractor.h"
#include "vantage/base/result.h"
#include "vantage/base/run_control.h"
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
  double seconds = 0;
};

/// How much of a recording people are measured in.
struct PersonSample {
  /// Masks are measured at this interval,
  double interval_secs = 0.5;
  /// for at least this long,
  double least_secs = 15;
  /// then until this many figures count,
  std::int64_t enough = 200;
  /// or until this moment. Many cameras see more in less time: not for longer than it takes until
  /// this many count.
  double most_secs = 60;
  std::int64_t plenty = 600;
};

/// The lengths that the scene leaves open, measured in a first pass over the beginning of the
/// recording (PersonSizeMeter), which opens the sources for itself. Where too few people are seen
/// there the lengths of PersonOptions are used, the width with CellAllowance_m. Does nothing when
/// the scene gives both. What it finds does not depend on `threads`.
Result<PersonReport> ResolvePerson(const Scene& scene, const BackgroundOptions& background,
                                   int threads, const RunControl& control = {},
                                   const PersonSample& sample = {});

/// E.g. "0.59 x 1.80 m, measured on 446 of 512 figures"; the rest of the report is in the JSON.
std::string TextOf(const PersonReport& report);
/// Every number of the report; cameras by their names.
nlohmann::ordered_json JsonOf(const PersonReport& report, const Scene& scene);

}  // namespace vantage
