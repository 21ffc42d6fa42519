// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/identity/exchange.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <map>
#include <set>
#include <stdexcept>
#include <utility>
#include <vector>

#include "vantage/base/test_support.h"
#include "vantage/identity/test_people.h"

namespace vantage {
namespace {

using testing::Draws;
using ::testing::IsEmpty;
using testing::RandomWalks;
using testing::WalkGrid;

/// A few axes along which people differ much.
PersonModel Model(unsigned seed) {
  Draws draws(seed);
  return PersonModel::Learn(
             testing::DrawPeople(draws, 20, 10, Eigen::Vector3d(3, 2, 4), Eigen::Vector3d(1, 1, 1)))
      .value();
}

/// Paths as they are after some exchanges, in the plainest form: for each person and each frame,
/// whose path it was at first.
class Plain {
 public:
  explicit Plain(const std::vector<LinkedPath>& paths) : paths_(paths) {
    for (std::size_t i = 0; i < paths.size(); ++i) whose_.emplace_back(paths[i].cells.size(), i);
  }

  /// The two people who come to the meeting.
  std::set<std::size_t> Who(const Meeting& meeting) const {
    return {Comer(meeting.first, meeting.frame), Comer(meeting.second, meeting.frame)};
  }

  /// Those who came to the meeting along these two paths leave it as each other.
  void Exchange(const Meeting& meeting) {
    const std::size_t a = Comer(meeting.first, meeting.frame);
    const std::size_t b = Comer(meeting.second, meeting.frame);
    const auto from_a = whose_[a].begin() + (meeting.frame - paths_[a].first_frame);
    const auto from_b = whose_[b].begin() + (meeting.frame - paths_[b].first_frame);
    const std::vector<std::size_t> rest_of_a(from_a, whose_[a].end());
    const std::vector<std::size_t> rest_of_b(from_b, whose_[b].end());
    whose_[a].erase(from_a, whose_[a].end());
    whose_[b].erase(from_b, whose_[b].end());
    whose_[a].insert(whose_[a].end(), rest_of_b.begin(), rest_of_b.end());
    whose_[b].insert(whose_[b].end(), rest_of_a.begin(), rest_of_a.end());
  }

  double Evidence(const PersonModel& model, const std::vector<PathObservation>& observations,
                  double weight) const {
    std::map<std::pair<std::size_t, std::int64_t>, std::size_t> who;
    for (std::size_t person = 0; person < whose_.size(); ++person) {
      for (std::size_t step = 0; step < whose_[person].size(); ++step) {
        who[{whose_[person][step], paths_[person].first_frame + static_cast<int>(step)}] = person;
      }
    }
    std::vector<Eigen::VectorXd> sums(whose_.size(), Eigen::VectorXd::Zero(model.axes()));
    std::vector<double> counts(whose_.size(), 0);
    for (const PathObservation& seen : observations) {
      const std::size_t person = who.at({seen.path, seen.frame});
      sums[person] += weight * seen.projection;
      counts[person] += weight;
    }
    double evidence = 0;
    for (std::size_t i = 0; i < sums.size(); ++i) evidence += model.Evidence(sums[i], counts[i]);
    return evidence;
  }

  std::vector<LinkedPath> Paths() const {
    std::vector<LinkedPath> result;
    for (std::size_t person = 0; person < whose_.size(); ++person) {
      LinkedPath& path = result.emplace_back();
      path.first_frame = paths_[person].first_frame;
      for (std::size_t step = 0; step < whose_[person].size(); ++step) {
        const LinkedPath& of = paths_[whose_[person][step]];
        path.cells.push_back(
            of.cells.at(static_cast<std::size_t>(path.first_frame - of.first_frame) + step));
      }
    }
    return result;
  }

 private:
  /// Who comes to this frame along this path.
  std::size_t Comer(std::size_t path, std::int64_t frame) const {
    for (std::size_t person = 0; person < whose_.size(); ++person) {
      const std::int64_t step = frame - paths_[person].first_frame;
      if (step < 1 || step > std::ssize(whose_[person])) continue;
      if (whose_[person][static_cast<std::size_t>(step - 1)] == path) return person;
    }
    throw std::logic_error("nobody comes to the meeting along this path");
  }

  std::vector<LinkedPath> paths_;
  std::vector<std::vector<std::size_t>> whose_;
};

/// The cells in which somebody is at each frame.
std::map<std::int64_t, std::multiset<CellIndex>> CellsAt(const std::vector<LinkedPath>& paths) {
  std::map<std::int64_t, std::multiset<CellIndex>> cells;
  for (const LinkedPath& path : paths) {
    for (std::size_t step = 0; step < path.cells.size(); ++step) {
      cells[path.first_frame + static_cast<int>(step)].insert(path.cells[step]);
    }
  }
  return cells;
}

/// People on a small grid, of whom at random frames something is seen that changes now and then.
struct Scene {
  explicit Scene(unsigned seed) : model(Model(seed % 7)) {
    Draws draws(seed);
    grid = WalkGrid(draws.Int(3, 7));
    paths = RandomWalks(draws, grid, draws.Int(1, 8), 60);
    meetings = FindMeetings(paths, grid, 1.2, draws.Int(1, 6));
    weight = 0.1 + 0.9 * draws.Unit();
    margin = 0.05 + 3 * draws.Unit();
    const double often = draws.Unit();
    const double strong = 4 * draws.Unit();
    for (std::size_t i = 0; i < paths.size(); ++i) {
      Eigen::VectorXd seen = draws.Normals(model.axes());
      for (std::size_t step = 0; step < paths[i].cells.size(); ++step) {
        if (draws.Chance(0.1)) seen = draws.Normals(model.axes());
        if (!draws.Chance(often)) continue;
        observations.push_back({.path = i,
                                .frame = paths[i].first_frame + static_cast<int>(step),
                                .projection = strong * (seen + 0.3 * draws.Normals(model.axes()))});
      }
    }
  }
  Exchanged Run() const {
    return ExchangePaths(paths, meetings, model, observations, weight, margin).value();
  }
  double Evidence(const Plain& plain) const { return plain.Evidence(model, observations, weight); }

  GroundGrid grid;
  PersonModel model;
  std::vector<LinkedPath> paths;
  std::vector<Meeting> meetings;
  std::vector<PathObservation> observations;
  double weight = 0;
  double margin = 0;
};

Scene SceneOfExchanges() {
  unsigned seed = 0;
  while (Scene(seed).Run().exchanges.size() < 3) ++seed;
  return Scene(seed);
}

TEST(ExchangePaths, CellsOfEveryFrameAndBeginsOfPathsStay) {
  for (unsigned seed = 0; seed < 200; ++seed) {
    SCOPED_TRACE(seed);
    const Scene scene(seed);
    const Exchanged result = scene.Run();
    EXPECT_EQ(CellsAt(result.paths), CellsAt(scene.paths));
    ASSERT_EQ(result.paths.size(), scene.paths.size());
    std::set<std::int64_t> exchanged_at;
    for (const Exchange& exchange : result.exchanges) {
      exchanged_at.insert(exchange.meeting.frame);
      if (exchange.back) exchanged_at.insert(exchange.back->frame);
    }
    for (std::size_t i = 0; i < result.paths.size(); ++i) {
      const LinkedPath& path = result.paths[i];
      EXPECT_EQ(path.first_frame, scene.paths[i].first_frame);
      EXPECT_EQ(path.cells.front(), scene.paths[i].cells.front());
      for (std::size_t step = 1; step < path.cells.size(); ++step) {
        const Eigen::Vector2d move_m =
            scene.grid.Center(path.cells[step]) - scene.grid.Center(path.cells[step - 1]);
        if (exchanged_at.contains(path.first_frame + static_cast<int>(step))) continue;
        ASSERT_LE(move_m.cwiseAbs().maxCoeff(), 0.5) << "a jump at step " << step;
      }
    }
  }
}

TEST(ExchangePaths, EachIsTheBestOneAndItsEvidenceIsWhatItGains) {
  std::size_t exchanges = 0;
  std::size_t returns = 0;
  std::size_t together = 0;  // three people at the same frame
  for (unsigned seed = 0; seed < 200; ++seed) {
    SCOPED_TRACE(seed);
    const Scene scene(seed);
    const Exchanged result = scene.Run();
    Plain plain(scene.paths);
    double before = scene.Evidence(plain);
    const auto gain_at = [&](const Meeting& meeting) {
      Plain other = plain;
      other.Exchange(meeting);
      return scene.Evidence(other) - before;
    };
    // There and back at any two meetings of the same two people.
    const auto best_return = [&] {
      double best = 0;
      for (std::size_t i = 0; i < scene.meetings.size(); ++i) {
        const auto people = plain.Who(scene.meetings[i]);
        Plain other = plain;
        other.Exchange(scene.meetings[i]);
        int between = 0;
        for (std::size_t j = i + 1; j < scene.meetings.size() && between <= 32; ++j) {
          if (plain.Who(scene.meetings[j]) != people) continue;
          ++between;
          Plain returned = other;
          returned.Exchange(scene.meetings[j]);
          best = std::max(best, scene.Evidence(returned) - before);
        }
      }
      return best;
    };
    for (const Exchange& exchange : result.exchanges) {
      double best = 0;
      for (const Meeting& meeting : scene.meetings) best = std::max(best, gain_at(meeting));
      if (exchange.back) {
        ++returns;
        EXPECT_LT(best, scene.margin + 1e-7);
        best = best_return();
      }
      plain.Exchange(exchange.meeting);
      if (exchange.back) plain.Exchange(*exchange.back);
      const double after = scene.Evidence(plain);
      EXPECT_NEAR(exchange.evidence, after - before, 1e-7);
      EXPECT_NEAR(exchange.evidence, best, 1e-7);
      EXPECT_GE(exchange.evidence, scene.margin);
      before = after;
    }
    EXPECT_EQ(plain.Paths(), result.paths);
    for (const Meeting& meeting : scene.meetings) {
      ASSERT_LT(gain_at(meeting), scene.margin + 1e-7) << "at frame " << meeting.frame;
    }
    EXPECT_LT(best_return(), scene.margin + 1e-7);
    exchanges += result.exchanges.size();
    for (const Exchange& one : result.exchanges) {
      together += static_cast<std::size_t>(
          std::ranges::count_if(result.exchanges, [&](const Exchange& other) {
            return one.meeting.frame == other.meeting.frame && one.meeting != other.meeting &&
                   (one.meeting.first == other.meeting.first ||
                    one.meeting.second == other.meeting.first ||
                    one.meeting.second == other.meeting.second);
          }));
    }
  }
  EXPECT_GT(exchanges, 400U);
  EXPECT_GT(returns, 20U);
  EXPECT_GT(together, 10U);
}

TEST(ExchangePaths, FindsWhoWasExchanged) {
  int planted = 0;
  for (unsigned seed = 0; seed < 300; ++seed) {
    SCOPED_TRACE(seed);
    Draws draws(seed);
    const PersonModel model = Model(seed % 7);
    const GroundGrid grid = WalkGrid(4);
    const auto people = RandomWalks(draws, grid, draws.Int(2, 4), 60);
    const auto meetings = FindMeetings(people, grid, 1.2, 5);
    // Who part for good long after the beginning and long before the end.
    const auto enough = [&](const Meeting& meeting) {
      return std::ranges::all_of(std::array{meeting.first, meeting.second}, [&](std::size_t i) {
        const std::int64_t step = meeting.frame - people[i].first_frame;
        return step >= 8 && step + 8 <= std::ssize(people[i].cells);
      });
    };
    std::vector<PathObservation> of_people;
    for (std::size_t i = 0; i < people.size(); ++i) {
      Eigen::VectorXd person = Eigen::VectorXd::Zero(model.axes());
      person[static_cast<Eigen::Index>(i) % person.size()] = i < 3 ? 4 : -4;
      for (std::size_t step = 0; step < people[i].cells.size(); ++step) {
        of_people.push_back({.path = i,
                             .frame = people[i].first_frame + static_cast<int>(step),
                             .projection = person + draws.Normals(model.axes())});
      }
    }
    const auto meeting = std::ranges::find_if(meetings, enough);
    if (meeting == meetings.end()) continue;
    ++planted;
    Plain plain(people);
    plain.Exchange(*meeting);
    std::vector<PathObservation> observations = of_people;
    for (PathObservation& seen : observations) {
      if (seen.frame < meeting->frame) continue;
      if (seen.path == meeting->first) {
        seen.path = meeting->second;
      } else if (seen.path == meeting->second) {
        seen.path = meeting->first;
      }
    }
    const std::vector<LinkedPath> linked = plain.Paths();
    const auto found =
        ExchangePaths(linked, FindMeetings(linked, grid, 1.2, 5), model, observations, 1, 5);
    ASSERT_TRUE(found);
    ASSERT_EQ(found->exchanges.size(), 1U);
    EXPECT_EQ(found->exchanges[0].meeting, *meeting);
    EXPECT_EQ(found->paths, people);
    // And who are right stay as they are.
    const auto right = ExchangePaths(people, meetings, model, of_people, 1, 5);
    EXPECT_THAT(right->exchanges, IsEmpty());
    EXPECT_EQ(right->paths, people);
  }
  EXPECT_GT(planted, 200);
}

TEST(ExchangePaths, WithoutMeetingsOrObservationsNothingChanges) {
  Scene scene = SceneOfExchanges();
  auto same = ExchangePaths(scene.paths, scene.meetings, scene.model, {}, 1, 0.01);
  EXPECT_EQ(same->paths, scene.paths);
  EXPECT_THAT(same->exchanges, IsEmpty());
  same = ExchangePaths(scene.paths, {}, scene.model, scene.observations, 1, 0.01);
  EXPECT_EQ(same->paths, scene.paths);
  EXPECT_THAT(same->exchanges, IsEmpty());
  EXPECT_THAT(ExchangePaths({}, {}, scene.model, {}, 1, 0.01)->paths, IsEmpty());
  scene.margin = 1e6;
  EXPECT_EQ(scene.Run().paths, scene.paths);
}

TEST(ExchangePaths, CanBeStopped) {
  const Scene scene = SceneOfExchanges();
  const std::atomic<bool> stop = true;
  const auto result = ExchangePaths(scene.paths, scene.meetings, scene.model, scene.observations,
                                    scene.weight, scene.margin, {.progress = {}, .stop = &stop});
  EXPECT_THAT(testing::MessageOf(result), ::testing::HasSubstr("interrupted"));
}

}  // namespace
}  // namespace vantage
