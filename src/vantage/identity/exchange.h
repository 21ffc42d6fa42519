// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "vantage/base/result.h"
#include "vantage/base/run_control.h"
#include "vantage/identity/meetings.h"
#include "vantage/identity/person_model.h"
#include "vantage/linking/linker.h"

namespace vantage {

/// What was seen of whoever walks along a path at one frame, along the axes of a PersonModel.
struct PathObservation {
  std::size_t path = 0;
  std::int64_t frame = 0;
  Eigen::VectorXd projection;
};

/// A meeting that two people leave as each other.
struct Exchange {
  Meeting meeting;
  /// A later one, at which they are exchanged back.
  std::optional<Meeting> back = std::nullopt;
  /// How many times as likely the observations are with it than without, as a logarithm.
  double evidence = 0;
};

struct Exchanged {
  /// The same cells in the same frames, put together otherwise; a path begins where it began.
  std::vector<LinkedPath> paths;
  std::vector<Exchange> exchanges;  ///< in the order in which they were decided
};

/// Decides at each meeting who leaves it as whom: of all observations of all people the evidence
/// that those put together are of one person (PersonModel::Evidence, each observation counting
/// `weight` of an independent one) is maximised by exchanging what follows of two paths at a
/// meeting, the best exchange first, until none is left that gains `margin` or more; then there and
/// back at two meetings of the same people, in the same way, and so on until neither is left.
/// Meetings are in ascending order of frames, as FindMeetings gives them.
Result<Exchanged> ExchangePaths(std::span<const LinkedPath> paths,
                                std::span<const Meeting> meetings, const PersonModel& model,
                                std::span<const PathObservation> observations, double weight,
                                double margin, const RunControl& control = {});

}  // namespace vantage
