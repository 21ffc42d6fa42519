// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <map>
#include <vector>

#include "vantage/base/result.h"
#include "vantage/simulation/walkers.h"

namespace vantage::simulation {

/// The ways of the people of WILDTRACK, by id (personID + 1, so that ids begin at 1), from
/// `folder`/annotations_positions/NNNNNNNN.json: lists of {"personID", "positionID", ...}, the
/// file's number being the frame at 10 frames a second. positionID p is the cell
/// (p mod 480, p div 480) of 2.5 cm from (-3, -9) m on. Fails, naming file and field, where a file
/// cannot be read or has something else in it.
Result<std::map<int, std::vector<Waypoint>>> ReadCrowdPeople(const std::filesystem::path& folder);

}  // namespace vantage::simulation
