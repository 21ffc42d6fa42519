// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <opencv2/core/utils/logger.hpp>

#include "command.h"
#include "vantage/base/parallel.h"
#include "vantage/base/version.h"

namespace vantage::app {
namespace {

constexpr int kDone = 0;
constexpr int kFailed = 1;
constexpr int kWrongUsage = 2;

std::vector<Command> Commands() {
  return {TrackCommand(),    BackgroundCommand(), OccupancyCommand(), LinkCommand(),
          EvaluateCommand(), RenderCommand(),     SimulateCommand(),  ReproduceCommand()};
}

int Run(int argc, char** argv) {
  // The library's own errors say what is wrong; the log lines of OpenCV and FFmpeg would only
  // repeat it.
  cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT);
  ::setenv("OPENCV_FFMPEG_LOGLEVEL", "-8", 0);
  CLI::App app("Vantage: ground-plane tracks of people from several calibrated cameras.",
               "vantage");
  app.set_version_flag("--version", std::string("vantage ") + kVersion);
  app.require_subcommand(1);
  CommonFlags common;
  common.arguments.assign(argv + 1, argv + argc);
  Action chosen;
  for (const Command& command : Commands()) {
    CLI::App* sub = app.add_subcommand(command.name, command.summary);
    Action action = command.define(*sub);
    sub->add_option("--threads", common.threads, "Threads to use; 0: one for each processor")
        ->check(CLI::Range(0, 1024))
        ->capture_default_str()
        ->group("Common");
    sub->add_flag("--quiet", common.quiet, "No progress on stderr")->group("Common");
    sub->add_flag("--json", common.json, "Print the report as JSON")->group("Common");
    sub->final_callback([&chosen, action = std::move(action)] { chosen = action; });
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& success) {
    return app.exit(success);  // --help, --version
  } catch (const CLI::ParseError& error) {
    fmt::print(stderr, "vantage: {} (see --help)\n", error.what());
    return kWrongUsage;
  }
  if (common.threads == 0) common.threads = HardwareThreads();
  if (Status status = chosen(common); !status) {
    fmt::print(stderr, "vantage: {}\n", status.error().message);
    return kFailed;
  }
  if (std::fflush(stdout) != 0) {
    fmt::print(stderr, "vantage: cannot write to standard output\n");
    return kFailed;
  }
  return kDone;
}

}  // namespace
}  // namespace vantage::app

int main(int argc, char** argv) {
  try {
    return vantage::app::Run(argc, argv);
  } catch (const std::bad_alloc&) {
    std::fputs("vantage: not enough memory for this input\n", stderr);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "vantage: unexpected failure: %s\n", error.what());
  }
  return 1;
}
