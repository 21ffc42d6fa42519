// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/experiments/cell.h"

#include <algorithm>
#include <atomic>
#include <mutex>
#include <optional>
#include <set>
#include <utility>

#include "vantage/base/file.h"
#include "vantage/base/parallel.h"
#include "vantage/base/stopwatch.h"
#include "vantage/base/version.h"

namespace vantage {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

std::string Dump(const Json& json, int indent = -1) {
  return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

/// All that decides about a result.
Json Fingerprint(const Cell& cell) {
  Json json = {{"inputs", cell.inputs}};
  for (const CellPtr& need : cell.needs) json["needs"][need->name] = Fingerprint(*need);
  return json;
}

bool IsName(const std::string& name) {
  const auto good = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '.' || c == '-' || c == '_';
  };
  return !name.empty() && name.size() <= 100 && name[0] >= 'a' && name[0] <= 'z' &&
         std::all_of(name.begin(), name.end(), good);
}

class CellRunner {
 public:
  CellRunner(fs::path folder, int threads, bool force, const RunControl& control)
      : folder_(std::move(folder)), threads_(threads), force_(force), control_(control) {}

  Result<CellsReport> Run(const std::vector<CellPtr>& cells) {
    for (const CellPtr& cell : cells) VANTAGE_RETURN_IF_ERROR(Add(*cell));
    for (const CellPtr& cell : cells) {
      if (!Kept(*cell)) Plan(cell);
    }
    VANTAGE_RETURN_IF_ERROR(RunPlanned());
    CellsReport report;
    std::set<std::string> asked;
    for (const CellPtr& cell : cells) {
      if (!asked.insert(cell->name).second) continue;
      report.results[cell->name] = std::move(results_.at(cell->name));
      report.kept += planned_.contains(cell->name) ? 0 : 1;
    }
    report.computed = std::ssize(planned_);
    report.notes = std::move(notes_);
    return report;
  }

 private:
  fs::path FileOf(const Cell& cell) const { return folder_ / "cells" / (cell.name + ".json"); }

  /// Checks the names of a cell and of all that it needs.
  Status Add(const Cell& cell) {
    if (!IsName(cell.name)) {
      return Fail("cell '{}': a name has small letters, digits, '.', '-' and '_'", cell.name);
    }
    Json fingerprint = Fingerprint(cell);
    const auto [place, is_new] = fingerprints_.try_emplace(cell.name, fingerprint);
    if (!is_new && place->second != fingerprint) {
      return Fail("cell {}: two that differ have this name", cell.name);
    }
    if (!is_new) return {};
    for (const CellPtr& need : cell.needs) VANTAGE_RETURN_IF_ERROR(Add(*need));
    return {};
  }

  /// Whether the folder holds the result; it is then in results_.
  bool Kept(const Cell& cell) {
    if (results_.contains(cell.name)) return true;
    if (force_ || planned_.contains(cell.name)) return false;
    const fs::path file = FileOf(cell);
    std::error_code code;
    if (!fs::exists(file, code)) return false;
    const auto unusable = [&](std::string_view why) {
      notes_.push_back(fmt::format("{}: {}; computed anew", file.string(), why));
      return false;
    };
    const Result<std::string> text = ReadTextFile(file);
    if (!text) return unusable(text.error().message);
    Json json = Json::parse(*text, nullptr, false);
    if (!json.is_object() || !json.contains("result") || !json.contains("fingerprint")) {
      return unusable("is damaged");
    }
    if (json["vantage"] != kVersion || json["results_version"] != kResultsVersion) {
      return unusable("is of another version of the program");
    }
    if (Dump(json["fingerprint"]) != Dump(fingerprints_.at(cell.name))) {
      return unusable("is of other options or data");
    }
    if (!cell.product.empty() && !fs::is_directory(folder_ / cell.product, code)) {
      return unusable(fmt::format("{} is not there any more", cell.product.string()));
    }
    results_[cell.name] = std::move(json["result"]);
    return true;
  }

  /// Marks the cell, and what it needs and is not there, to be run; the level of a cell is above
  /// those of its needs.
  int Plan(const CellPtr& cell) {
    if (const auto found = planned_.find(cell->name); found != planned_.end()) return found->second;
    int level = 0;
    for (const CellPtr& need : cell->needs) {
      if (!Kept(*need)) level = std::max(level, Plan(need) + 1);
    }
    if (std::ssize(levels_) <= level) levels_.resize(static_cast<std::size_t>(level) + 1);
    levels_[static_cast<std::size_t>(level)].push_back(cell);
    planned_[cell->name] = level;
    return level;
  }

  Status RunPlanned() {
    control_.Report(0, std::ssize(planned_));
    for (const std::vector<CellPtr>& level : levels_) {
      std::vector<CellPtr> together;
      for (const CellPtr& cell : level) {
        if (!cell->alone) together.push_back(cell);
      }
      std::vector<Status> statuses(level.size());
      for (std::size_t i = 0; i < level.size(); ++i) {
        if (level[i]->alone) VANTAGE_RETURN_IF_ERROR(RunOne(*level[i], threads_));
      }
      ParallelFor(threads_, std::ssize(together), [&](std::int64_t i) {
        const auto index = static_cast<std::size_t>(i);
        if (!failed_.load()) statuses[index] = RunOne(*together[index], 1);
      });
      for (const Status& status : statuses) VANTAGE_RETURN_IF_ERROR(Status(status));
    }
    return {};
  }

  tl::unexpected<Error> Interrupted() const {
    return Fail("interrupted; the finished cells are kept in {}: the same command goes on",
                (folder_ / "cells").string());
  }

  Status RunOne(const Cell& cell, int threads) {
    Status status = RunAndWrite(cell, threads);
    if (status) return {};
    failed_.store(true);
    if (control_.Stopped()) return Interrupted();
    return Fail("{}: {}", cell.name, status.error().message);
  }

  Status RunAndWrite(const Cell& cell, int threads) {
    if (control_.Stopped()) return Cancelled();
    const Stopwatch watch;
    std::optional<StagedDirectory> product;
    CellRun run{.folder = folder_, .product = {}, .threads = threads};
    run.control.stop = control_.stop;
    if (!cell.product.empty()) {
      VANTAGE_ASSIGN_OR_RETURN(product, StagedDirectory::Create(folder_ / cell.product, true));
      run.product = product->temporary();
    }
    VANTAGE_ASSIGN_OR_RETURN(const Json result, cell.run(run));
    // Read back, so that a result is the same now and when it was kept.
    const Json file = {{"cell", cell.name},
                       {"vantage", kVersion},
                       {"results_version", kResultsVersion},
                       {"seconds", watch.Seconds()},
                       {"fingerprint", fingerprints_.at(cell.name)},
                       {"result", result}};
    const std::string text = Dump(file, 1) + "\n";
    if (product) VANTAGE_RETURN_IF_ERROR(product->Commit());
    VANTAGE_RETURN_IF_ERROR(WriteTextFile(FileOf(cell), text));
    const std::lock_guard lock(mutex_);
    results_[cell.name] = std::move(Json::parse(text)["result"]);
    control_.Report(++done_, std::ssize(planned_));
    return {};
  }

  fs::path folder_;
  int threads_;
  bool force_;
  const RunControl& control_;
  std::map<std::string, Json> fingerprints_;
  std::map<std::string, int> planned_;  // with its level
  std::vector<std::vector<CellPtr>> levels_;
  std::vector<std::string> notes_;
  std::atomic<bool> failed_ = false;
  std::mutex mutex_;  // of what follows, while cells run
  CellResults results_;
  std::int64_t done_ = 0;
};

}  // namespace

Result<CellsReport> RunCells(const fs::path& folder, const std::vector<CellPtr>& cells, int threads,
                             bool force, const RunControl& control) {
  return CellRunner(folder, threads, force, control).Run(cells);
}

}  // namespace vantage
