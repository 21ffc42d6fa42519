// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "vantage/base/result.h"
#include "vantage/base/run_control.h"

/// Work that is kept. An experiment is made of cells: one run of one setting on one recording, or
/// what several of them need (the recording, its masks). What a cell found stays in the working
/// folder as cells/NAME.json, so that an experiment that was stopped goes on where it was.

namespace vantage {

/// What a cell may use while it runs.
struct CellRun {
  std::filesystem::path folder;   ///< the working folder, with the products of other cells
  std::filesystem::path product;  ///< where the cell's own product is made; empty: it has none
  int threads = 1;
  RunControl control = {};  ///< to be stopped; it reports no progress
};

struct Cell {
  /// Unique in a working folder; small letters, digits, '.', '-' and '_', the first a letter.
  std::string name;
  /// All that its result depends on (options, what the data are), but not what it needs.
  nlohmann::ordered_json inputs;
  /// Cells that must be done before: this one uses their products.
  std::vector<std::shared_ptr<const Cell>> needs = {};
  /// A folder of files that it makes, relative to the working folder; empty: none. It appears whole
  /// or not at all.
  std::filesystem::path product = {};
  /// Whether it uses all threads; the others run side by side, each on one.
  bool alone = false;
  /// What it finds: figures that are functions of the inputs, and seconds, which are not.
  std::function<Result<nlohmann::ordered_json>(const CellRun&)> run;
};
using CellPtr = std::shared_ptr<const Cell>;

/// What cells found, by their names. Numbers that are not finite have become null.
using CellResults = std::map<std::string, nlohmann::ordered_json, std::less<>>;

struct CellsReport {
  CellResults results;                  ///< of the cells asked for
  std::int64_t kept = 0;                ///< cells of these whose result was there already
  std::int64_t computed = 0;            ///< cells run now, those that others needed included
  std::vector<std::string> notes = {};  ///< files that were there but could not be used, and why
};

/// To be raised whenever equal inputs give other results than before, in a release or between two.
inline constexpr int kResultsVersion = 3;

/// Runs the cells whose results `folder` does not hold, first those that others need; `threads` of
/// them side by side. A result is kept when it was made by this version of the program, from the
/// same inputs and needs, and its product is there. Cells that nobody has to run any more are not
/// run, and their products need not be there. The results do not depend on `threads`.
/// `force` runs all anew. When a cell fails or `control` stops the work, finished cells stay.
/// Fails on names that are out of rule or mean two different cells, and with what the first failed
/// cell says.
Result<CellsReport> RunCells(const std::filesystem::path& folder, const std::vector<CellPtr>& cells,
                             int threads, bool force, const RunControl& control = {});

}  // namespace vantage
