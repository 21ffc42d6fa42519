// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "command.h"
#include "vantage/base/file.h"
#include "vantage/experiments/ghost_experiment.h"
#include "vantage/experiments/ghost_report.h"

namespace vantage::app {
namespace {

namespace fs = std::filesystem;

/// Flags of every experiment.
struct Flags {
  fs::path data, output;
  bool force = false;
};

std::string F1Text(const GhostRun* run) {
  if (run == nullptr || std::isnan(run->measures.f1)) return fmt::format("{:>9}", "-");
  return fmt::format("{:>9.4f}", run->measures.f1);
}

void PrintGhosts(const GhostResults& results, const Flags& flags, const CommonFlags& common) {
  if (common.json) {
    fmt::print("{}\n",
               GhostJson(results).dump(2, ' ', false, nlohmann::json::error_handler_t::replace));
    return;
  }
  const std::vector<std::string> variants = {"none", "fep-plain", DefaultVariantName(), "mog2",
                                             "knn"};
  const MixtureOptions defaults;
  std::string head;
  for (const std::string& variant : variants) head += fmt::format("{:>9}", variant);
  std::vector<ReportRow> rows = {{"F1 at defaults", head}};
  for (const GhostCaseResult& in : results.cases) {
    std::string line;
    for (const std::string& variant : variants) {
      line += F1Text(results.Find(in, variant, defaults.color, defaults.rate, defaults.alpha));
    }
    rows.push_back({in.used.name, line});
  }
  for (const std::string& skipped : results.skipped) rows.push_back({"not run", skipped});
  rows.push_back({"page", (flags.output / "ghosts.html").string()});
  PrintTable(rows);
}

Status ReproduceGhosts(const Flags& flags, const CommonFlags& common) {
  for (const GhostCase& one : StandardGhostCases()) {
    if (IsInside(flags.data / one.sequence, flags.output)) {
      return Fail("{}: the output would replace the data; name another folder",
                  flags.output.string());
    }
  }
  VANTAGE_ASSIGN_OR_RETURN(StagedDirectory folder,
                           StagedDirectory::Create(flags.output, flags.force));
  VANTAGE_ASSIGN_OR_RETURN(
      const GhostResults results,
      RunGhostExperiment(flags.data, StandardGhostCases(), StandardGhostVariants(), common.threads,
                         MakeRunControl(common, "ghosts", "frames")));
  VANTAGE_RETURN_IF_ERROR(WriteGhostReport(results, folder.temporary()));
  VANTAGE_RETURN_IF_ERROR(folder.Commit());
  PrintGhosts(results, flags, common);
  return {};
}

}  // namespace

Command ReproduceCommand() {
  return {.name = "reproduce",
          .summary = "The thesis's experiments on the data at hand, as a page with plots and CSV",
          .define = [](CLI::App& app) -> Action {
            const auto flags = std::make_shared<Flags>();
            app.require_subcommand(1);
            CLI::App* ghosts = app.add_subcommand(
                "ghosts",
                "Ghost detection (figures 8 to 11): every criterion in both colour spaces at both "
                "learning rates, beside OpenCV's MOG2 and KNN");
            ghosts->fallthrough();  // the flags that every command has
            ghosts
                ->add_option("--data", flags->data,
                             "Folder that holds the sequences cdnet/office, cdnet/traffic, "
                             "sbi/CaVignal and sbi/IBMtest2; those that are absent are left out")
                ->type_name("DIR")
                ->required();
            ghosts
                ->add_option("-o,--output", flags->output,
                             "Folder for ghosts.html, ghosts.csv, ghosts_frames.csv and "
                             "ghosts.json")
                ->type_name("DIR")
                ->required();
            ghosts->add_flag("--force", flags->force, "Replace what the folder holds");
            return [flags](const CommonFlags& common) { return ReproduceGhosts(*flags, common); };
          }};
}

}  // namespace vantage::app
