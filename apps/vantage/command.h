// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "vantage/base/options.h"
#include "vantage/base/result.h"
#include "vantage/base/run_control.h"

/// The program is a table of commands, one file each. A command declares its flags on a CLI::App
/// and returns what to do once they are parsed.

namespace vantage::app {

/// Flags that every command has.
struct CommonFlags {
  int threads = 0;  ///< 0: all processors; resolved to at least 1 before the command runs
  bool quiet = false;
  bool json = false;
  std::vector<std::string> arguments;  ///< as typed, without the program's name
};

using Action = std::function<Status(const CommonFlags& common)>;

struct Command {
  std::string name;
  std::string summary;
  /// Adds the command's flags to `app`; `common` is filled by the time the action runs.
  std::function<Action(CLI::App& app)> define;
};

Command BackgroundCommand();
Command EvaluateCommand();
Command LinkCommand();
Command OccupancyCommand();
Command RenderCommand();
Command ReproduceCommand();
Command SimulateCommand();
Command TrackCommand();

/// The flags of one options struct. Flags given on the command line win over what a scene file
/// says, so a command that reads a scene calls `Apply` again after binding its tables.
class OptionFlags {
 public:
  using Visit = std::function<void(OptionVisitor&)>;

  OptionFlags() = default;
  OptionFlags(OptionFlags&&) = default;
  OptionFlags& operator=(OptionFlags&&) = default;

  /// Adds one flag per field, "--<prefix><name>" with '_' as '-', with help, unit, rule and
  /// default. Values out of range are usage errors (exit status 2).
  static OptionFlags Add(CLI::App& app, const Visit& visit, const std::string& prefix,
                         const std::string& group);

  /// A flag that was given, "--depth"; empty when none was.
  std::string AnyGiven() const;

  /// Sets the fields whose flags were given.
  void Apply(const Visit& visit) const;

  template <class Options>
  void ApplyTo(Options& options) const {
    Apply([&options](OptionVisitor& visitor) { VisitOptions(options, visitor); });
  }

 private:
  std::map<std::string, CLI::Option*, std::less<>> flags_;
};

/// Flags of `options`, which hold the defaults that the help shows; `ApplyTo` sets what was given.
template <class Options>
OptionFlags AddOptionFlags(CLI::App& app, Options options, const std::string& prefix,
                           const std::string& group) {
  return OptionFlags::Add(
      app, [&options](OptionVisitor& visitor) { VisitOptions(options, visitor); }, prefix, group);
}

/// Progress bar on stderr with rate (units per second) and time left; silent when `quiet`. On a
/// terminal it redraws a line; otherwise it prints a line every ten seconds. Also carries Ctrl-C.
RunControl MakeRunControl(const CommonFlags& common, std::string what, std::string unit);

/// Prints a report on stdout: a table of "name  value" rows, or one JSON object with --json.
struct ReportRow {
  std::string name;
  std::string value;
};
void PrintTable(const std::vector<ReportRow>& rows);

}  // namespace vantage::app
