// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/linking/ksp_run.h"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>

#include "vantage/base/file.h"
#include "vantage/base/stopwatch.h"

namespace vantage {

LinkingOptions OriginalKspOptions(const KspFile& file) {
  return {.depth = file.depth,
          .birth_cost = 45,
          .clip = 1e-6,
          .movement_cost = 0,
          .max_paths = file.max_paths};
}

std::string KspResultText(const KspFile& file, const std::vector<LinkedPath>& paths) {
  std::string text = fmt::format("{}\n", paths.size());
  const auto out = std::back_inserter(text);
  for (std::int64_t frame = 0; frame < file.frame_count(); ++frame) {
    fmt::format_to(out, "{}\t", file.first_frame + frame);
    for (const LinkedPath& path : paths) {
      const std::int64_t step = frame - path.first_frame;
      const bool there = step >= 0 && step < std::ssize(path.cells);
      fmt::format_to(out, "{}\t", there ? path.cells[static_cast<std::size_t>(step)] : -1);
    }
    text += '\n';
  }
  return text;
}

Result<KspReport> RunKsp(const KspFile& file, const std::filesystem::path& output,
                         const RunControl& control) {
  const Stopwatch stopwatch;
  // Staged before the work, so that an output that cannot be written fails at once.
  VANTAGE_ASSIGN_OR_RETURN(StagedFile staged, StagedFile::Create(output));
  VANTAGE_ASSIGN_OR_RETURN(const std::vector<float> maps, ReadKspMaps(file, control));
  std::vector<std::uint8_t> access(static_cast<std::size_t>(file.cell_count()), 0);
  for (const CellIndex cell : file.access_points) access[static_cast<std::size_t>(cell)] = 1;
  const LinkingOptions options = OriginalKspOptions(file);
  VANTAGE_ASSIGN_OR_RETURN(const LinkingResult linked, LinkPaths({.columns = file.columns,
                                                                  .rows = file.rows,
                                                                  .frames = file.frame_count(),
                                                                  .probability = maps,
                                                                  .access = access,
                                                                  .obstacle = {}},
                                                                 options, control));
  std::ofstream stream(staged.temporary(), std::ios::binary);
  stream << KspResultText(file, linked.paths);
  stream.close();
  if (!stream) return Fail("{}: cannot be written: {}", output.string(), std::strerror(errno));
  VANTAGE_RETURN_IF_ERROR(staged.Commit());
  KspReport report;
  report.frames = file.frame_count();
  report.cells = file.cell_count();
  report.paths = linked.report.paths;
  // LinkPaths counts the birth cost of each path.
  report.cost = linked.report.cost - options.birth_cost * static_cast<double>(linked.report.paths);
  report.seconds = stopwatch.Seconds();
  return report;
}

}  // namespace vantage
