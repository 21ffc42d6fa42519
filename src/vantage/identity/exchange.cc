// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/identity/exchange.h"

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <utility>

namespace vantage {
namespace {

using Eigen::VectorXd;

constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();

// Two people who are exchanged and exchanged back meet at most so many times more in between. Who
// walk side by side for an hour meet thousands of times, and pairs of those would be millions.
constexpr std::size_t kMostBetween = 32;

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

/// What may be done at once: an exchange at a crossing, or there and back at two of the same
/// chains.
struct Move {
  std::size_t there = kNone;
  std::size_t back = kNone;
  double gain = 0;
};

/// The smaller number first.
using ChainPair = std::pair<std::size_t, std::size_t>;

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
      cuts[i].erase(std::unique(cuts[i].begin(), cuts[i].end()), cuts[i].end());
      std::int64_t begin = paths[i].first_frame;
      for (const std::int64_t cut : cuts[i]) {
        Append(i, begin, cut);
        tracklets_.back().next = tracklets_.size();
        begin = cut;
      }
      Append(i, begin, paths[i].end_frame());
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

  /// The exchange that gains most; none gains 0.
  Move BestExchange() const {
    Move best;
    for (std::size_t i = 0; i < crossings_.size(); ++i) {
      const double gain = crossings_[i].gain;
      if (gain > best.gain) best = {.there = i, .gain = gain};
    }
    return best;
  }

  /// The same of exchanges there and back, which gain where neither of the two does: without the
  /// other it would leave everything after it, or before it, to the wrong person.
  Move BestReturn() {
    std::map<ChainPair, std::vector<std::size_t>> of_chains;
    for (std::size_t i = 0; i < crossings_.size(); ++i) {
      const Crossing& crossing = crossings_[i];
      of_chains[std::minmax(tracklets_[crossing.first].chain, tracklets_[crossing.second].chain)]
          .push_back(i);
    }
    Move best;
    for (const auto& [chains, crossings] : of_chains) {
      const auto [known, is_new] = returns_.try_emplace(chains);
      if (is_new) known->second = BestReturn(chains, crossings);
      if (known->second.gain > best.gain) best = known->second;
    }
    return best;
  }

  void Make(const Move& move) {
    ExchangeAt(move.there);
    if (move.back != kNone) ExchangeAt(move.back);
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
  void ExchangeAt(std::size_t index) {
    Tracklet& first = tracklets_[crossings_[index].first];
    Tracklet& second = tracklets_[crossings_[index].second];
    std::swap(first.next, second.next);
    const std::array<std::size_t, 2> chains = {first.chain, second.chain};
    for (const std::size_t chain : chains) SumUp(chain);
    std::erase_if(returns_, [&](const auto& known) {
      return std::ranges::find(chains, known.first.first) != chains.end() ||
             std::ranges::find(chains, known.first.second) != chains.end();
    });
    for (const std::size_t chain : chains) {
      for (std::size_t i = first_of_path_[chain]; i != kNone; i = tracklets_[i].next) {
        for (const std::size_t crossing : crossings_at_[i]) {
          crossings_[crossing].gain = Gain(crossings_[crossing]);
        }
      }
    }
  }

  Move BestReturn(const ChainPair& chains, const std::vector<std::size_t>& crossings) const {
    Move best;
    for (std::size_t i = 0; i < crossings.size(); ++i) {
      const std::size_t end = std::min(crossings.size(), i + kMostBetween + 2);
      for (std::size_t j = i + 1; j < end; ++j) {
        const double gain = ReturnGain(chains, crossings_[crossings[i]], crossings_[crossings[j]]);
        if (gain > best.gain) best = {.there = crossings[i], .back = crossings[j], .gain = gain};
      }
    }
    return best;
  }

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
    return GainOf(
        first.chain, second.chain,
        Less(Less(totals_[second.chain], second.until), Less(totals_[first.chain], first.until)));
  }

  /// `there` and `back` are crossings of both chains, in this order.
  double ReturnGain(const ChainPair& chains, const Crossing& there, const Crossing& back) const {
    const auto between = [&](std::size_t chain) {
      const auto until = [&](const Crossing& crossing) -> const Sum& {
        const Tracklet& tracklet = tracklets_[crossing.first];
        return tracklet.chain == chain ? tracklet.until : tracklets_[crossing.second].until;
      };
      return Less(until(back), until(there));
    };
    const auto [first, second] = chains;
    return GainOf(first, second, Less(between(second), between(first)));
  }

  /// What the evidence gains when the first chain gets `moved` and the second loses it.
  double GainOf(std::size_t first, std::size_t second, const Sum& moved) const {
    const Sum& a = totals_[first];
    const Sum& b = totals_[second];
    return model_.Evidence(a.projections + moved.projections, a.count + moved.count) +
           model_.Evidence(b.projections - moved.projections, b.count - moved.count) -
           model_.Evidence(a.projections, a.count) - model_.Evidence(b.projections, b.count);
  }

  static Sum Less(const Sum& a, const Sum& b) {
    return {.count = a.count - b.count, .projections = a.projections - b.projections};
  }

  std::span<const LinkedPath> paths_;
  const PersonModel& model_;
  std::vector<Tracklet> tracklets_;         // of a path one after another, in order of time
  std::vector<std::size_t> first_of_path_;  // also where the chain of the same number begins
  std::vector<Crossing> crossings_;         // one for each meeting
  std::vector<std::vector<std::size_t>> crossings_at_;  // of a tracklet: those at its end
  std::vector<Sum> totals_;                             // of each chain
  std::map<ChainPair, Move> returns_;                   // the best of two chains, if known
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
  while (true) {
    if (control.Stopped()) return Cancelled();
    Move move = chains.BestExchange();
    if (move.gain < margin) move = chains.BestReturn();
    if (move.gain < margin) break;
    Exchange& exchange = result.exchanges.emplace_back();
    exchange.meeting = meetings[move.there];
    if (move.back != kNone) exchange.back = meetings[move.back];
    exchange.evidence = move.gain;
    chains.Make(move);
  }
  result.paths = chains.Paths();
  return result;
}

}  // namespace vantage
