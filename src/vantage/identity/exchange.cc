// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/identity/exchange.h"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

namespace vantage {
namespace {

using Eigen::VectorXd;

constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();

/// Observations put together.
struct Sum {
  double count = 0;
  VectorXd projections;
};

/// A piece of a path between two of its meetings: nobody is taken for somebody else within.
struct Tracklet {
  std::size_t path = 0;
  std::int64_t begin = 0;  ///< frames [begin, end)
  std::int64_t end = 0;
  Sum seen;
  // Of the chain of tracklets that make one person:
  std::size_t next = kNone;
  std::size_t chain = 0;
  Sum until;  ///< all observations of the chain up to and including this tracklet
};

/// A meeting in the graph of tracklets: the two that end there, whose next ones may be exchanged.
struct Crossing {
  std::size_t first = 0;
  std::size_t second = 0;
  double gain = 0;
};

class Chains {
 public:
  Chains(std::span<const LinkedPath> paths, std::span<const Meeting> meetings,
         const PersonModel& model)
      : paths_(paths), model_(model) {
    std::vector<std::vector<std::int64_t>> cuts(paths.size());
    for (const Meeting& meeting : meetings) {
      cuts[meeting.first].push_back(meeting.frame);
      cuts[meeting.second].push_back(meeting.frame);
    }
    first_of_path_.reserve(paths.size());
    for (std::size_t i = 0; i < paths.size(); ++i) {
      first_of_path_.push_back(tracklets_.size());
      cuts[i].erase(std::ranges::unique(cuts[i]).begin(), cuts[i].end());
      std::int64_t begin = paths[i].first_frame;
      for (const std::int64_t cut : cuts[i]) {
        Append(i, begin, cut);
        tracklets_.back().next = tracklets_.size();
        begin = cut;
      }
      Append(i, begin, paths[i].first_frame + std::ssize(paths[i].cells));
    }
    for (const Meeting& meeting : meetings) {
      crossings_.push_back({.first = TrackletAt(meeting.first, meeting.frame - 1),
                            .second = TrackletAt(meeting.second, meeting.frame - 1)});
      crossings_at_[crossings_.back().first].push_back(crossings_.size() - 1);
      crossings_at_[crossings_.back().second].push_back(crossings_.size() - 1);
    }
    totals_.resize(paths.size());
  }

  void Observe(std::size_t path, std::int64_t frame, const VectorXd& projection, double weight) {
    Sum& seen = tracklets_[TrackletAt(path, frame)].seen;
    seen.count += weight;
    seen.projections += weight * projection;
  }

  /// To be called once all is observed.
  void Begin() {
    for (std::size_t chain = 0; chain < paths_.size(); ++chain) SumUp(chain);
    for (Crossing& crossing : crossings_) crossing.gain = Gain(crossing);
  }

  /// The crossing whose exchange gains most; kNone without any.
  std::size_t Best() const {
    if (crossings_.empty()) return kNone;
    return static_cast<std::size_t>(std::ranges::max_element(crossings_, {}, &Crossing::gain) -
                                    crossings_.begin());
  }
  double gain(std::size_t crossing) const { return crossings_[crossing].gain; }

  void ExchangeAt(std::size_t index) {
    Tracklet& first = tracklets_[crossings_[index].first];
    Tracklet& second = tracklets_[crossings_[index].second];
    std::swap(first.next, second.next);
    const std::array<std::size_t, 2> chains = {first.chain, second.chain};
    for (const std::size_t chain : chains) SumUp(chain);
    for (const std::size_t chain : chains) {
      for (std::size_t i = first_of_path_[chain]; i != kNone; i = tracklets_[i].next) {
        for (const std::size_t crossing : crossings_at_[i]) {
          crossings_[crossing].gain = Gain(crossings_[crossing]);
        }
      }
    }
  }

  std::vector<LinkedPath> Paths() const {
    std::vector<LinkedPath> result;
    for (std::size_t chain = 0; chain < paths_.size(); ++chain) {
      LinkedPath path{.first_frame = paths_[chain].first_frame, .cells = {}};
      for (std::size_t i = first_of_path_[chain]; i != kNone; i = tracklets_[i].next) {
        const Tracklet& piece = tracklets_[i];
        const LinkedPath& whole = paths_[piece.path];
        path.cells.insert(path.cells.end(), whole.cells.begin() + (piece.begin - whole.first_frame),
                          whole.cells.begin() + (piece.end - whole.first_frame));
      }
      result.push_back(std::move(path));
    }
    return result;
  }

 private:
  void Append(std::size_t path, std::int64_t begin, std::int64_t end) {
    tracklets_.push_back(
        {.path = path, .begin = begin, .end = end, .seen = Nothing(), .until = Nothing()});
    crossings_at_.emplace_back();
  }

  Sum Nothing() const { return {.projections = VectorXd::Zero(model_.axes())}; }

  /// The tracklet of a path that holds a frame of it.
  std::size_t TrackletAt(std::size_t path, std::int64_t frame) const {
    const auto begin = tracklets_.begin() + static_cast<std::ptrdiff_t>(first_of_path_[path]);
    const auto end =
        path + 1 < paths_.size()
            ? tracklets_.begin() + static_cast<std::ptrdiff_t>(first_of_path_[path + 1])
            : tracklets_.end();
    const auto after = std::upper_bound(
        begin, end, frame,
        [](std::int64_t value, const Tracklet& tracklet) { return value < tracklet.begin; });
    return static_cast<std::size_t>(after - tracklets_.begin()) - 1;
  }

  /// Puts down for each tracklet of a chain what has been seen of it until then.
  void SumUp(std::size_t chain) {
    Sum sum = Nothing();
    for (std::size_t i = first_of_path_[chain]; i != kNone; i = tracklets_[i].next) {
      sum.count += tracklets_[i].seen.count;
      sum.projections += tracklets_[i].seen.projections;
      tracklets_[i].chain = chain;
      tracklets_[i].until = sum;
    }
    totals_[chain] = std::move(sum);
  }

  double Gain(const Crossing& crossing) const {
    const Tracklet& first = tracklets_[crossing.first];
    const Tracklet& second = tracklets_[crossing.second];
    const Sum& whole_first = totals_[first.chain];
    const Sum& whole_second = totals_[second.chain];
    const auto evidence = [&](const Sum& before, const Sum& other_whole, const Sum& other_before) {
      return model_.Evidence(
          before.projections + other_whole.projections - other_before.projections,
          before.count + other_whole.count - other_before.count);
    };
    return evidence(first.until, whole_second, second.until) +
           evidence(second.until, whole_first, first.until) -
           model_.Evidence(whole_first.projections, whole_first.count) -
           model_.Evidence(whole_second.projections, whole_second.count);
  }

  std::span<const LinkedPath> paths_;
  const PersonModel& model_;
  std::vector<Tracklet> tracklets_;         // of a path one after another, in order of time
  std::vector<std::size_t> first_of_path_;  // also where the chain of the same number begins
  std::vector<Crossing> crossings_;         // one for each meeting
  std::vector<std::vector<std::size_t>> crossings_at_;  // of a tracklet: those at its end
  std::vector<Sum> totals_;                             // of each chain
};

}  // namespace

Result<Exchanged> ExchangePaths(std::span<const LinkedPath> paths,
                                std::span<const Meeting> meetings, const PersonModel& model,
                                std::span<const PathObservation> observations, double weight,
                                double margin, const RunControl& control) {
  Chains chains(paths, meetings, model);
  for (const PathObservation& seen : observations) {
    chains.Observe(seen.path, seen.frame, seen.projection, weight);
  }
  chains.Begin();
  Exchanged result;
  for (std::size_t best = chains.Best(); best != kNone && chains.gain(best) >= margin;
       best = chains.Best()) {
    if (control.Stopped()) return Cancelled();
    result.exchanges.push_back({.meeting = meetings[best], .evidence = chains.gain(best)});
    chains.ExchangeAt(best);
  }
  result.paths = chains.Paths();
  return result;
}

}  // namespace vantage
