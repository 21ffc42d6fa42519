// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/occupancy/pom_run.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>
#include <opencv2/core.hpp>

#include "vantage/base/file.h"
#include "vantage/base/parallel.h"
#include "vantage/base/stopwatch.h"
#include "vantage/video/picture.h"

namespace vantage {
namespace fs = std::filesystem;
namespace {

struct FrameResult {
  Result<SolveReport> report;
  std::vector<float> q;
};

std::vector<std::int64_t> FrameNumbers(const PomFile& file) {
  std::vector<std::int64_t> numbers;
  for (const PomFile::Frames& range : file.frames) {
    for (std::int64_t i = 0; i < range.count; ++i) numbers.push_back(range.first + i);
  }
  return numbers;
}

Result<cv::Mat> ReadMask(const fs::path& path, ImageSize size) {
  VANTAGE_ASSIGN_OR_RETURN(const cv::Mat picture, internal::ReadPicture(path));
  if (picture.cols != size.width || picture.rows != size.height) {
    return Fail("{}: the picture is {} x {} px; the configuration says {} x {}", path.string(),
                picture.cols, picture.rows, size.width, size.height);
  }
  cv::Mat mask;
  cv::transform(picture, mask, cv::Matx13f(1.0F / 3, 1.0F / 3, 1.0F / 3));
  return mask;
}

Result<SolveReport> SolveFrame(const PomFile& file, const OccupancySolver& solver,
                               std::int64_t frame, std::vector<float>& q) {
  std::vector<cv::Mat> masks;
  for (std::size_t c = 0; c < file.views.size(); ++c) {
    VANTAGE_ASSIGN_OR_RETURN(cv::Mat mask,
                             ReadMask(file.InputPath(c, frame), file.views[c].mask_size));
    masks.push_back(mask);
  }
  q.resize(solver.cell_count());
  return solver.Solve(masks, q);
}

std::string ResultText(std::span<const float> q) {
  std::string text;
  for (std::size_t i = 0; i < q.size(); ++i) {
    fmt::format_to(std::back_inserter(text), "{} {:.6g}\n", i, q[i]);
  }
  return text;
}

/// All files or none.
Status WriteResults(const PomFile& file, const fs::path& output_folder,
                    std::span<const std::int64_t> frames,
                    std::span<const std::vector<float>> maps) {
  std::vector<StagedFile> staged;
  for (std::size_t i = 0; i < maps.size(); ++i) {
    const fs::path path = file.ResultPath(frames[i], output_folder);
    VANTAGE_ASSIGN_OR_RETURN(StagedFile result, StagedFile::Create(path));
    std::ofstream stream(result.temporary(), std::ios::binary);
    stream << ResultText(maps[i]);
    stream.close();
    if (!stream) return Fail("{}: cannot be written: {}", path.string(), std::strerror(errno));
    staged.push_back(std::move(result));
  }
  for (StagedFile& result : staged) VANTAGE_RETURN_IF_ERROR(result.Commit());
  return {};
}

}  // namespace

Result<PomReport> RunPom(const PomFile& file, const fs::path& output_folder, int threads,
                         const RunControl& control) {
  const Stopwatch stopwatch;
  VANTAGE_ASSIGN_OR_RETURN(const OccupancySolver solver,
                           OccupancySolver::Create(file.views, file.options));
  const std::vector<std::int64_t> frames = FrameNumbers(file);
  const auto total = std::ssize(frames);
  const std::int64_t batch = 2 * std::max(threads, 1);
  PomReport report;
  std::vector<std::vector<float>> maps;
  while (report.frames < total) {
    if (control.Stopped()) return Cancelled();
    std::vector<FrameResult> results(
        static_cast<std::size_t>(std::min(batch, total - report.frames)));
    ParallelFor(threads, std::ssize(results), [&](std::int64_t i) {
      FrameResult& result = results[static_cast<std::size_t>(i)];
      const std::int64_t frame = frames[static_cast<std::size_t>(report.frames + i)];
      result.report = SolveFrame(file, solver, frame, result.q);
    });
    for (FrameResult& result : results) {
      VANTAGE_ASSIGN_OR_RETURN(const SolveReport solved, std::move(result.report));
      report.iterations += solved.iterations;
      report.not_converged += solved.converged ? 0 : 1;
      maps.push_back(std::move(result.q));
    }
    report.frames += std::ssize(results);
    control.Report(report.frames, total);
  }
  VANTAGE_RETURN_IF_ERROR(WriteResults(file, output_folder, frames, maps));
  report.seconds = stopwatch.Seconds();
  return report;
}

}  // namespace vantage
