// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
// HOTA in cases worked by hand. On the ground the similarity is 1 - distance / 2 m at the default
// threshold of 1 m; thresholds on it are 0.05, 0.10 ... 0.95, 19 of them.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "vantage/base/test_support.h"
#include "vantage/metrics/clear_mot.h"
#include "vantage/metrics/test_tracks.h"

namespace vantage {
namespace {

using testing::kGone;
using testing::Walk;

TrackAnalysis Analyze(const Tracks& truth, const Tracks& results,
                      const EvaluationOptions& options = {}) {
  const Result<TrackAnalysis> analysis = AnalyzeTracks(truth, results, options);
  EXPECT_TRUE(analysis) << testing::MessageOf(analysis);
  return analysis.value_or(TrackAnalysis{});
}

TEST(Hota, BrokenInTwoByHand) {
  // One person found in all 10 frames, as result 1 in 5 and result 2 in 5. DetA = 10 / 10. Each TP
  // is in a pair with TPA 5, FNA 5, FPA 0: AssA = 5 / 10. HOTA = sqrt(1 * 1/2).
  const Tracks truth = {Walk(1, {0, 0, 0, 0, 0, 0, 0, 0, 0, 0})};
  const Tracks results = {Walk(1, {0, 0, 0, 0, 0}), Walk(2, {0, 0, 0, 0, 0}, 5)};
  const TrackMeasures m = Analyze(truth, results).measures;
  EXPECT_DOUBLE_EQ(m.deta, 1);
  EXPECT_DOUBLE_EQ(m.assa, 0.5);
  EXPECT_DOUBLE_EQ(m.hota, std::sqrt(0.5));
  EXPECT_DOUBLE_EQ(m.loca, 1);
}

TEST(Hota, SwappedByHand) {
  // Two people, exchanged after 4 of 10 frames. 8 TP are in pairs with TPA 4 of 10 + 10 - 4 = 16,
  // 12 in pairs with TPA 6 of 14: AssA = (8 * 4/16 + 12 * 6/14) / 20 = 5/14.
  const Tracks truth = {Walk(1, {0, 0, 0, 0, 0, 0, 0, 0, 0, 0}),
                        Walk(2, {9, 9, 9, 9, 9, 9, 9, 9, 9, 9})};
  const Tracks results = {Walk(1, {0, 0, 0, 0, 9, 9, 9, 9, 9, 9}),
                          Walk(2, {9, 9, 9, 9, 0, 0, 0, 0, 0, 0})};
  const TrackMeasures m = Analyze(truth, results).measures;
  EXPECT_DOUBLE_EQ(m.deta, 1);
  EXPECT_DOUBLE_EQ(m.assa, 5.0 / 14);
  EXPECT_DOUBLE_EQ(m.hota, std::sqrt(5.0 / 14));
}

TEST(Hota, ThresholdsByHand) {
  // One person in 4 frames; the result is 0.5 m away in two (similarity 0.75), absent in one, and
  // 1.9 m away in one (0.05).
  const TrackAnalysis analysis =
      Analyze({Walk(1, {0, 0, 0, 0})}, {Walk(1, {0.5, 0.5, kGone, 1.9})});
  ASSERT_EQ(analysis.hota.size(), 19u);
  // At 0.05: TP 3, FN 1, FP 0: DetA = 3/4; TPA 3 of 4 + 3 - 3: AssA = 3/4.
  EXPECT_DOUBLE_EQ(analysis.hota[0].deta, 0.75);
  EXPECT_DOUBLE_EQ(analysis.hota[0].assa, 0.75);
  EXPECT_DOUBLE_EQ(analysis.hota[0].hota, 0.75);
  EXPECT_DOUBLE_EQ(analysis.hota[0].loca, (0.75 + 0.75 + 0.05) / 3);
  // At 0.10 to 0.75, 14 thresholds: TP 2, FN 2, FP 1: DetA = 2/5; TPA 2 of 4 + 3 - 2: AssA = 2/5.
  for (const std::size_t i : {1u, 14u}) {
    EXPECT_DOUBLE_EQ(analysis.hota[i].hota, 0.4) << i;
    EXPECT_DOUBLE_EQ(analysis.hota[i].loca, 0.75) << i;
  }
  EXPECT_DOUBLE_EQ(analysis.hota[14].alpha, 0.75);
  // At 0.80 to 0.95 nothing matches.
  EXPECT_EQ(analysis.hota[15].hota, 0);
  EXPECT_TRUE(std::isnan(analysis.hota[15].loca));
  EXPECT_NEAR(analysis.measures.hota, (0.75 + 14 * 0.4) / 19, 1e-12);
  EXPECT_NEAR(analysis.measures.deta, (0.75 + 14 * 0.4) / 19, 1e-12);
  EXPECT_NEAR(analysis.measures.loca, (1.55 / 3 + 14 * 0.75) / 15, 1e-12);
}

TEST(Hota, WhoFitsAsAWholeGoesBeforeWhoIsNearer) {
  // Result 1 is 0.4 m away (0.8) in all 3 frames, result 2 0.1 m (0.95) in the middle one only.
  // Shares there: 0.8 / 1.75 and 0.95 / 1.75. How well they fit as a whole: (2 + 0.8/1.75) / (6 -
  // 2 - 0.8/1.75) = 0.69 and (0.95/1.75) / (4 - 0.95/1.75) = 0.16, so that 0.69 * 0.8 wins over
  // 0.16 * 0.95. Up to 0.80, 16 thresholds: TP 3, FP 1, DetA = 3/4, AssA = 3/3; above that nothing.
  const TrackMeasures m =
      Analyze({Walk(1, {0, 0, 0})}, {Walk(1, {0.4, 0.4, 0.4}), Walk(2, {0.1}, 1)}).measures;
  EXPECT_NEAR(m.deta, 16 * 0.75 / 19, 1e-12);
  EXPECT_NEAR(m.assa, 16.0 / 19, 1e-12);
  EXPECT_NEAR(m.hota, 16 * std::sqrt(0.75) / 19, 1e-12);
  EXPECT_NEAR(m.loca, 0.8, 1e-12);
}

TEST(Hota, BoxesByHand) {
  // Shifted by 2 of 10 pixels: IoU 80 / 120, matched up to 0.65, 13 thresholds; the other person is
  // missed: DetA = 1/2, AssA = 1.
  const auto box = [](std::int64_t id, double left) {
    return BoxTrack{TrackId{id}, {{0, left, 0, 10, 10}}};
  };
  const Result<TrackMeasures> m = EvaluateBoxes({box(1, 0), box(2, 100)}, {box(1, 2)}, {});
  ASSERT_TRUE(m);
  EXPECT_NEAR(m->deta, 13 * 0.5 / 19, 1e-12);
  EXPECT_NEAR(m->assa, 13.0 / 19, 1e-12);
  EXPECT_NEAR(m->loca, 2.0 / 3, 1e-12);
}

TEST(Hota, DoesNotChangeWhenTruthAndResultsDo) {
  std::mt19937 engine(5);
  std::uniform_real_distribution<double> place(0, 3);
  const auto random_tracks = [&] {
    Tracks tracks;
    for (int id = 1; id <= 4; ++id) {
      Track& track = tracks.emplace_back(Track{.id = TrackId{id}, .points = {}});
      for (FrameIndex frame = 0; frame < 20; ++frame) {
        if (frame % 19 != 0 && engine() % 3 == 0) continue;  // all in the first and last frame
        track.points.push_back({frame, place(engine), place(engine), false});
      }
    }
    return tracks;
  };
  for (int round = 0; round < 20; ++round) {
    const Tracks a = random_tracks();
    const Tracks b = random_tracks();
    const TrackMeasures forth = Analyze(a, b).measures;
    const TrackMeasures back = Analyze(b, a).measures;
    EXPECT_NEAR(forth.hota, back.hota, 1e-12);
    EXPECT_NEAR(forth.deta, back.deta, 1e-12);
    EXPECT_NEAR(forth.assa, back.assa, 1e-12);
    EXPECT_NEAR(forth.loca, back.loca, 1e-12);
    EXPECT_GT(forth.hota, 0);
    EXPECT_LT(forth.hota, 1);
  }
}

}  // namespace
}  // namespace vantage
