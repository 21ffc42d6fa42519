// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/identity/identify.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "vantage/base/stopwatch.h"
#include "vantage/identity/meetings.h"
#include "vantage/identity/person_model.h"

namespace vantage {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// Colours were seen of somebody on a path when they stood as near as this: who is refined to
// another cell is the same, who stands beside is not.
constexpr double kReach_m = 0.5;
// Two meetings of the same people are apart by this at least.
constexpr double kMeetingsApart_secs = 0.5;

// What tells people apart is learnt anew from what it has put together, so many times at most; it
// settles after two or three.
constexpr int kMostRounds = 10;

constexpr auto kColors = static_cast<Index>(BandColors().size());

/// The colours of one person at one frame, all cameras together; 0 where nothing is known.
struct Sight {
  std::int64_t frame = 0;
  CellIndex cell = 0;
  VectorXd colors;
};

/// Whose colours they are.
struct Look {
  std::size_t path = 0;
  std::int64_t frame = 0;
  const VectorXd* colors = nullptr;
};

/// For each camera the usual value of each colour, so that what is left of a colour is the person
/// and not the camera.
std::vector<BandColors> UsualColors(const Appearances& appearances) {
  std::map<int, std::vector<const BandColors*>> of_camera;
  for (const Appearance& seen : appearances) of_camera[seen.camera].push_back(&seen.colors);
  std::vector<BandColors> usual(
      of_camera.empty() ? 0 : static_cast<std::size_t>(of_camera.rbegin()->first) + 1);
  for (const auto& [camera, seen] : of_camera) {
    for (std::size_t i = 0; i < BandColors().size(); ++i) {
      std::vector<float> values;
      for (const BandColors* colors : seen) {
        if (!std::isnan((*colors)[i])) values.push_back((*colors)[i]);
      }
      if (values.empty()) continue;
      const auto middle = values.begin() + std::ssize(values) / 2;
      std::ranges::nth_element(values, middle);
      usual[static_cast<std::size_t>(camera)][i] = *middle;
    }
  }
  return usual;
}

/// The means over cameras of what is known, 0 where nothing is.
VectorXd MeanColors(std::span<const Appearance* const> seen, const std::vector<BandColors>& usual) {
  VectorXd colors = VectorXd::Zero(kColors);
  for (Index i = 0; i < kColors; ++i) {
    const auto at = static_cast<std::size_t>(i);
    int known = 0;
    for (const Appearance* one : seen) {
      const float value = one->colors[at] - usual[static_cast<std::size_t>(one->camera)][at];
      if (std::isnan(value)) continue;
      colors[i] += value;
      ++known;
    }
    if (known > 1) colors[i] /= known;
  }
  return colors;
}

/// In ascending order of frames.
std::vector<Sight> SightsOf(const Appearances& appearances) {
  const std::vector<BandColors> usual = UsualColors(appearances);
  std::map<std::pair<std::int64_t, CellIndex>, std::vector<const Appearance*>> together;
  for (const Appearance& seen : appearances) together[{seen.frame, seen.cell}].push_back(&seen);
  std::vector<Sight> sights;
  for (const auto& [at, seen] : together) {
    sights.push_back({.frame = at.first, .cell = at.second, .colors = MeanColors(seen, usual)});
  }
  return sights;
}

/// What was seen of each path: of all pairs of a path and a sight within reach the nearest first,
/// each in one pair only. Refers to `sights`.
std::vector<Look> LooksAlong(std::span<const LinkedPath> paths, const GroundGrid& grid,
                             std::span<const Sight> sights) {
  struct Pair {
    double distance_m = 0;
    std::size_t path = 0;
    const Sight* sight = nullptr;
  };
  std::vector<Look> looks;
  for (auto begin = sights.begin(); begin != sights.end();) {
    const std::int64_t frame = begin->frame;
    const auto end =
        std::find_if(begin, sights.end(), [&](const Sight& sight) { return sight.frame != frame; });
    std::vector<Pair> pairs;
    for (std::size_t i = 0; i < paths.size(); ++i) {
      const std::int64_t step = frame - paths[i].first_frame;
      if (step < 0 || step >= std::ssize(paths[i].cells)) continue;
      const Eigen::Vector2d at = grid.Center(paths[i].cells[static_cast<std::size_t>(step)]);
      for (const Sight& sight : std::span(begin, end)) {
        const double distance_m = (grid.Center(sight.cell) - at).norm();
        if (distance_m > kReach_m) continue;
        pairs.push_back({.distance_m = distance_m, .path = i, .sight = &sight});
      }
    }
    std::ranges::stable_sort(pairs, {}, &Pair::distance_m);
    std::set<std::size_t> paths_taken;
    std::set<const Sight*> sights_taken;
    for (const Pair& pair : pairs) {
      if (paths_taken.contains(pair.path) || sights_taken.contains(pair.sight)) continue;
      paths_taken.insert(pair.path);
      sights_taken.insert(pair.sight);
      looks.push_back({.path = pair.path, .frame = frame, .colors = &pair.sight->colors});
    }
    begin = end;
  }
  return looks;
}

/// Frames between two looks: however people were missed, the least there is.
std::int64_t FramesBetween(std::span<const Sight> sights) {
  std::int64_t least = std::numeric_limits<std::int64_t>::max();
  for (std::size_t i = 1; i < sights.size(); ++i) {
    const std::int64_t gap = sights[i].frame - sights[i - 1].frame;
    if (gap > 0) least = std::min(least, gap);
  }
  return least;
}

/// The independent observations of each path: means over as many frames as hardly differ.
std::vector<MatrixXd> IndependentObservations(std::span<const Look> looks, double frames) {
  struct Mean {
    VectorXd sum = VectorXd::Zero(kColors);
    int count = 0;
  };
  std::map<std::size_t, std::map<std::int64_t, Mean>> of_path;
  for (const Look& look : looks) {
    Mean& mean =
        of_path[look.path][static_cast<std::int64_t>(static_cast<double>(look.frame) / frames)];
    mean.sum += *look.colors;
    ++mean.count;
  }
  std::vector<MatrixXd> observations;
  for (const auto& [path, means] : of_path) {
    MatrixXd& rows = observations.emplace_back(std::ssize(means), kColors);
    Index row = 0;
    for (const auto& [block, mean] : means) rows.row(row++) = mean.sum / mean.count;
  }
  return observations;
}

}  // namespace

void VisitOptions(IdentityOptions& o, OptionVisitor& v) {
  v.Flag({"appearance", "", "colours decide who leaves a meeting of people as whom"}, o.appearance);
  v.Number(
      {"interval", "s", "time between two looks at people's colours, while there are pictures"},
      o.interval_secs, Range::AboveUpTo(0, 60));
  v.Number({"distance", "m", "people nearer to each other than this may be taken for each other"},
           o.distance_m, Range::Above(0));
  v.Number({"independent", "s", "looks at a person within this time count as one"},
           o.independent_secs, Range::Above(0));
  v.Number(
      {"margin", "", "logarithm of how many times as likely an exchange must make the colours"},
      o.margin, Range::Above(0));
}

std::int64_t LookInterval(const IdentityOptions& options, double frames_per_second) {
  return std::max<std::int64_t>(1, std::llround(options.interval_secs * frames_per_second));
}

Result<Identified> IdentifyPeople(std::vector<LinkedPath> paths, const OccupancyMaps& maps,
                                  const Appearances& appearances, const IdentityOptions& options,
                                  const RunControl& control) {
  VANTAGE_RETURN_IF_ERROR(ValidateOptions(options, "identity"));
  const Stopwatch stopwatch;
  Identified result{.paths = std::move(paths), .report = {}};
  IdentityReport& report = result.report;
  report.appearances = std::ssize(appearances);
  if (!options.appearance || appearances.empty()) return result;

  const double frames_per_second = maps.frames_per_second;
  // Not less than a frame: there is nothing within it.
  const double independent_frames = std::max(1.0, options.independent_secs * frames_per_second);
  const std::int64_t apart_frames =
      std::max<std::int64_t>(1, std::llround(kMeetingsApart_secs * frames_per_second));
  const std::vector<Sight> sights = SightsOf(appearances);
  const double weight =
      std::min(1.0, static_cast<double>(FramesBetween(sights)) / independent_frames);
  for (int round = 0; round < kMostRounds; ++round) {
    const std::vector<Look> looks = LooksAlong(result.paths, maps.grid, sights);
    const std::optional<PersonModel> model =
        PersonModel::Learn(IndependentObservations(looks, independent_frames));
    if (!model) break;
    report.learnt = true;
    const std::vector<Meeting> meetings =
        FindMeetings(result.paths, maps.grid, options.distance_m, apart_frames);
    report.meetings = std::ssize(meetings);
    std::vector<PathObservation> observations;
    for (const Look& look : looks) {
      observations.push_back(
          {.path = look.path, .frame = look.frame, .projection = model->Project(*look.colors)});
    }
    VANTAGE_ASSIGN_OR_RETURN(Exchanged exchanged,
                             ExchangePaths(result.paths, meetings, *model, observations, weight,
                                           options.margin, control));
    if (exchanged.exchanges.empty()) break;
    result.paths = std::move(exchanged.paths);
    report.exchanges.insert(report.exchanges.end(), exchanged.exchanges.begin(),
                            exchanged.exchanges.end());
  }
  report.seconds = stopwatch.Seconds();
  return result;
}

Result<IdentityReport> IdentifyTracks(const OccupancyMaps& maps, const Appearances& appearances,
                                      const IdentityOptions& options, const TrackOptions& tracks,
                                      LinkMapsResult& linked, const RunControl& control) {
  VANTAGE_ASSIGN_OR_RETURN(Identified identified,
                           IdentifyPeople(linked.paths, maps, appearances, options, control));
  if (!identified.report.exchanges.empty()) {
    VANTAGE_ASSIGN_OR_RETURN(linked.tracks, BuildTracks(identified.paths, maps, tracks));
    linked.report.dropped_paths = std::ssize(identified.paths) - std::ssize(linked.tracks);
  }
  return std::move(identified.report);
}

}  // namespace vantage
