// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <memory>

#include "command.h"

namespace vantage::app {
namespace {

using Clock = std::chrono::steady_clock;

std::atomic<bool> interrupted{false};

extern "C" void OnInterrupt(int) { interrupted.store(true); }

std::string Duration(double seconds) {
  const long whole = std::lround(seconds);
  if (whole >= 3600)
    return fmt::format("{}:{:02}:{:02}", whole / 3600, whole / 60 % 60, whole % 60);
  return fmt::format("{}:{:02}", whole / 60, whole % 60);
}

class ProgressBar {
 public:
  ProgressBar(std::string what, std::string unit)
      : what_(std::move(what)), unit_(std::move(unit)), terminal_(::isatty(STDERR_FILENO) == 1) {}

  ~ProgressBar() {
    if (terminal_ && shown_) std::fputc('\n', stderr);
  }

  void Show(std::int64_t done, std::int64_t total) {
    const Clock::time_point now = Clock::now();
    const bool last = total > 0 && done >= total;
    const double interval_secs = terminal_ ? 0.1 : 10;
    if (shown_ && !last && Seconds(last_shown_, now) < interval_secs) return;
    if (!terminal_ && !last && !shown_ && Seconds(start_, now) < interval_secs) return;
    if (last && finished_) return;
    finished_ = last;
    shown_ = true;
    last_shown_ = now;
    const double seconds = std::max(Seconds(start_, now), 1e-9);
    const double rate = static_cast<double>(done) / seconds;
    std::string line = fmt::format("{:<12}", what_);
    if (total > 0) {
      constexpr int kWidth = 24;
      const double share = static_cast<double>(done) / static_cast<double>(total);
      const int filled = static_cast<int>(share * kWidth);
      line += fmt::format(" [{:#<{}}{:.<{}}] {:3.0f}%  {}/{} {}", "", filled, "", kWidth - filled,
                          100 * share, done, total, unit_);
    } else {
      line += fmt::format(" {} {}", done, unit_);
    }
    line += fmt::format("  {:.1f} {}/s", rate, unit_);
    if (total > 0 && rate > 0) {
      line += last ? fmt::format("  took {}", Duration(seconds))
                   : fmt::format("  {} left", Duration(static_cast<double>(total - done) / rate));
    }
    fmt::print(stderr, "{}{}{}", terminal_ ? "\r\x1b[K" : "", line, terminal_ ? "" : "\n");
    std::fflush(stderr);
  }

 private:
  static double Seconds(Clock::time_point from, Clock::time_point to) {
    return std::chrono::duration<double>(to - from).count();
  }
  std::string what_, unit_;
  bool terminal_;
  bool shown_ = false;
  bool finished_ = false;
  Clock::time_point start_ = Clock::now();
  Clock::time_point last_shown_;
};

}  // namespace

RunControl MakeRunControl(const CommonFlags& common, std::string what, std::string unit) {
  std::signal(SIGINT, &OnInterrupt);
  std::signal(SIGTERM, &OnInterrupt);
  RunControl control;
  control.stop = &interrupted;
  if (!common.quiet) {
    auto bar = std::make_shared<ProgressBar>(std::move(what), std::move(unit));
    control.progress = [bar](std::int64_t done, std::int64_t total) { bar->Show(done, total); };
  }
  return control;
}

void PrintTable(const std::vector<ReportRow>& rows) {
  std::size_t width = 0;
  for (const ReportRow& row : rows) width = std::max(width, row.name.size());
  for (const ReportRow& row : rows) fmt::print("{:<{}}  {}\n", row.name, width, row.value);
}

}  // namespace vantage::app
