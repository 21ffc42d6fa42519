// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/metrics/clear_mot.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "vantage/base/test_support.h"
#include "vantage/metrics/test_tracks.h"
#include "vantage/tracks/track_file.h"

namespace vantage {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

using testing::kGone;
using testing::Walk;

TrackMeasures Measure(const Tracks& truth, const Tracks& results,
                      const EvaluationOptions& options = {}, const Polygon* area = nullptr) {
  const Result<TrackMeasures> measures = EvaluateTracks(truth, results, options, area);
  EXPECT_TRUE(measures) << testing::MessageOf(measures);
  return measures ? *measures : TrackMeasures{};
}

TEST(ClearMot, TruthAgainstItselfIsPerfect) {
  std::mt19937 engine(3);
  Tracks truth;
  for (int id = 1; id <= 6; ++id) {
    Track& track = truth.emplace_back(Track{.id = TrackId{id}, .points = {}});
    for (FrameIndex frame = id; frame < 40; ++frame) {
      if (engine() % 5 == 0) continue;
      track.points.push_back({frame, engine() % 1000 / 100.0, engine() % 1000 / 100.0, false});
    }
  }
  const TrackMeasures m = Measure(truth, truth);
  EXPECT_EQ(m.misses + m.false_positives + m.switches + m.fragmentations, 0);
  EXPECT_EQ(m.matches, m.truth_positions);
  EXPECT_EQ(m.mostly_tracked, 6);
  for (const double one :
       {m.mota, m.motp_similarity, m.precision, m.recall, m.idf1, m.idp, m.idr, m.moda, m.modp}) {
    EXPECT_EQ(one, 1);
  }
  for (const double one : {m.hota, m.deta, m.assa, m.loca}) EXPECT_DOUBLE_EQ(one, 1);
  EXPECT_EQ(m.motp, 0);
}

TEST(ClearMot, CountsMissesFalsePositivesAndDistances) {
  const Tracks truth = {Walk(1, {0, 0, 0, 0}), Walk(2, {10, 10, 10, 10})};
  const Tracks results = {Walk(1, {0.5, 0.25, 3, 0.25}), Walk(5, {kGone, 20})};
  const TrackMeasures m = Measure(truth, results);
  EXPECT_EQ(m.frames, 4);
  EXPECT_EQ(m.truth_tracks, 2);
  EXPECT_EQ(m.result_tracks, 2);
  EXPECT_EQ(m.truth_positions, 8);
  EXPECT_EQ(m.result_positions, 5);
  EXPECT_EQ(m.matches, 3);
  EXPECT_EQ(m.misses, 5);
  EXPECT_EQ(m.false_positives, 2);
  EXPECT_EQ(m.switches, 0);
  EXPECT_EQ(m.fragmentations, 1);
  EXPECT_EQ(m.partially_tracked, 1);
  EXPECT_EQ(m.mostly_lost, 1);
  EXPECT_DOUBLE_EQ(m.mota, 1 - 7.0 / 8);
  EXPECT_DOUBLE_EQ(m.motp, 1.0 / 3);
  EXPECT_DOUBLE_EQ(m.precision, 3.0 / 5);
  EXPECT_DOUBLE_EQ(m.recall, 3.0 / 8);
  EXPECT_DOUBLE_EQ(m.moda, 1 - 7.0 / 8);
  EXPECT_DOUBLE_EQ(m.modp, (0.5 + 0.75 + 0.75) / 3);
}

TEST(ClearMot, MatchesAreCarriedOverWhileTheyHold) {
  // From frame 1 on result 2 is nearer, but result 1 still holds.
  const Tracks truth = {Walk(1, {0, 0, 0})};
  const Tracks results = {Walk(1, {0, 0.9, 0.9}), Walk(2, {5, 0.1, 0.1})};
  const TrackMeasures m = Measure(truth, results);
  EXPECT_EQ(m.switches, 0);
  EXPECT_DOUBLE_EQ(m.motp, (0 + 0.9 + 0.9) / 3);
  // At the threshold itself it no longer does.
  const TrackMeasures broken = Measure(truth, {Walk(1, {0, 1.0, 1.0}), Walk(2, {5, 0.1, 0.1})});
  EXPECT_EQ(broken.switches, 1);
  EXPECT_DOUBLE_EQ(broken.motp, (0 + 0.1 + 0.1) / 3);
}

TEST(ClearMot, LooseThresholdsDoNotLoseCarriedMatches) {
  // Programs that carry a match over by a bonus on its score lose it where the threshold is larger
  // than the bonus. Result 2 is on the spot, result 1, matched before, 9 km away.
  const Tracks truth = {Walk(1, {0, 0, 0})};
  const Tracks results = {Walk(1, {0, 9000, 9000}), Walk(2, {kGone, 0, 0})};
  const TrackMeasures m = Measure(truth, results, {.threshold_m = 10'000});
  EXPECT_EQ(m.switches, 0);
  EXPECT_DOUBLE_EQ(m.motp, 6000);

  const auto box = [](std::int64_t id, double left_first, double left_then) {
    return BoxTrack{TrackId{id}, {{0, left_first, 0, 10, 10}, {1, left_then, 0, 10, 10}}};
  };
  const Result<TrackMeasures> boxes =
      EvaluateBoxes({box(1, 0, 0)}, {box(1, 0, 9.9), box(2, 500, 0)}, {.min_iou = 1e-6});
  ASSERT_TRUE(boxes);
  EXPECT_EQ(boxes->switches, 0);
}

TEST(ClearMot, FramesWithoutAnyResultCount) {
  // Two people in 10 frames, both found in the first 4, nobody in the others. 12 of 20 are missed:
  // MODA = MOTA = 1 - 12 / 20, and not 1 as over the frames with results. IDF1 = 2 * 8 / (20 + 8).
  const Tracks truth = {Walk(1, {0, 0, 0, 0, 0, 0, 0, 0, 0, 0}),
                        Walk(2, {9, 9, 9, 9, 9, 9, 9, 9, 9, 9})};
  const Tracks results = {Walk(1, {0, 0, 0, 0}), Walk(2, {9, 9, 9, 9})};
  const TrackMeasures m = Measure(truth, results);
  EXPECT_EQ(m.frames, 10);
  EXPECT_EQ(m.misses, 12);
  EXPECT_DOUBLE_EQ(m.moda, 0.4);
  EXPECT_DOUBLE_EQ(m.mota, 0.4);
  EXPECT_DOUBLE_EQ(m.idf1, 16.0 / 28);
  EXPECT_DOUBLE_EQ(m.modp, 1);
}

TEST(ClearMot, BothDefinitionsOfMotp) {
  // 0.5 m and 1 m away, at a threshold of 2 m: 0.75 m, or a similarity of (0.75 + 0.5) / 2.
  const TrackMeasures m = Measure({Walk(1, {0, 0})}, {Walk(1, {0.5, 1})}, {.threshold_m = 2});
  EXPECT_DOUBLE_EQ(m.motp, 0.75);
  EXPECT_DOUBLE_EQ(m.motp_similarity, 0.625);
}

TEST(ClearMot, MatchesAreRememberedAcrossGaps) {
  const Tracks truth = {Walk(1, {0, kGone, 0, 0})};
  const Tracks same = {Walk(1, {0.5, 0.5, 0.5, 0.5}), Walk(2, {kGone, kGone, 0, 0})};
  EXPECT_EQ(Measure(truth, same).switches, 0);
  const Tracks other = {Walk(1, {0.5}), Walk(2, {kGone, kGone, 0, 0})};
  EXPECT_EQ(Measure(truth, other).switches, 1);
}

TEST(ClearMot, TheLaterMatchHasTheResult) {
  // Result 1 is on truth 1, then on truth 2, then both are near it.
  const Tracks truth = {Walk(1, {0, kGone, 0.2}), Walk(2, {kGone, 0, 0.3})};
  const Tracks results = {Walk(1, {0, 0, 0})};
  const TrackMeasures m = Measure(truth, results);
  EXPECT_EQ(m.misses, 1);
  EXPECT_EQ(m.switches, 0);
  EXPECT_DOUBLE_EQ(m.motp, 0.1);
}

TEST(ClearMot, MoreMatchesGoBeforeNearerOnes) {
  const Tracks truth = {Walk(1, {0}), Walk(2, {0.9})};
  const Tracks results = {Walk(1, {0.8}), Walk(2, {1.7})};
  const TrackMeasures m = Measure(truth, results);
  EXPECT_EQ(m.matches, 2);  // 0-0.8 and 0.9-1.7, though 0.9-0.8 is nearest
  EXPECT_DOUBLE_EQ(m.motp, 0.8);
}

TEST(ClearMot, SwappedIdentitiesByHand) {
  // Two people, exchanged by the tracker after 4 of 10 frames.
  const Tracks truth = {Walk(1, {0, 0, 0, 0, 0, 0, 0, 0, 0, 0}),
                        Walk(2, {9, 9, 9, 9, 9, 9, 9, 9, 9, 9})};
  const Tracks results = {Walk(1, {0, 0, 0, 0, 9, 9, 9, 9, 9, 9}),
                          Walk(2, {9, 9, 9, 9, 0, 0, 0, 0, 0, 0})};
  const TrackMeasures m = Measure(truth, results);
  EXPECT_EQ(m.switches, 2);
  EXPECT_DOUBLE_EQ(m.mota, 0.9);
  EXPECT_EQ(m.id_true_positives, 12);  // the six frames after the exchange
  EXPECT_DOUBLE_EQ(m.idf1, 0.6);
  EXPECT_DOUBLE_EQ(m.moda, 1);
}

TEST(ClearMot, IdentityPrecisionAndRecallByHand) {
  // One person in 8 frames; result 1 covers 5 of them, result 2 the last 3 and one more elsewhere.
  const Tracks truth = {Walk(1, {0, 0, 0, 0, 0, 0, 0, 0})};
  const Tracks results = {Walk(1, {0, 0, 0, 0, 0}),
                          Walk(2, {kGone, kGone, kGone, kGone, 7, 0, 0, 0})};
  const TrackMeasures m = Measure(truth, results);
  EXPECT_EQ(m.id_true_positives, 5);
  EXPECT_DOUBLE_EQ(m.idp, 5.0 / 9);
  EXPECT_DOUBLE_EQ(m.idr, 5.0 / 8);
  EXPECT_DOUBLE_EQ(m.idf1, 10.0 / 17);
}

TEST(ClearMot, DetectionMeasuresDoNotCarryMatchesOver) {
  // Keeping the old match costs a person here; MODA assigns every frame anew.
  const Tracks truth = {Walk(1, {0, 0}), Walk(2, {kGone, 1.5})};
  const Tracks results = {Walk(1, {0, 0.8}), Walk(2, {kGone, -0.8})};
  const TrackMeasures m = Measure(truth, results);
  EXPECT_EQ(m.misses, 1);
  EXPECT_EQ(m.false_positives, 1);
  EXPECT_DOUBLE_EQ(m.mota, 1 - 2.0 / 3);
  EXPECT_DOUBLE_EQ(m.moda, 1);
  EXPECT_NEAR(m.modp, (1 + 0.2 + 0.3) / 3, 1e-12);
}

TEST(ClearMot, TruthInSomeFramesOnly) {
  // Truth in every 40th frame, results in all: the frames between do not count.
  const Tracks truth = {Walk(1, {0, 0, kGone, 0}, 10, 40)};
  Track everywhere{.id = TrackId{1}, .points = {}};
  for (FrameIndex frame = 0; frame < 200; ++frame)
    everywhere.points.push_back({frame, 0, 0, false});
  const TrackMeasures m = Measure(truth, {everywhere});
  EXPECT_EQ(m.frames, 4);
  EXPECT_EQ(m.matches, 3);
  EXPECT_EQ(m.false_positives, 1);  // frame 90: looked at, nobody there
  const TrackMeasures only = Measure(truth, {everywhere}, {.truth_frames_only = true});
  EXPECT_EQ(only.frames, 3);
  EXPECT_EQ(only.false_positives, 0);
  EXPECT_EQ(Measure({Walk(1, {0}, 7)}, {everywhere}).frames, 1);
}

TEST(ClearMot, OnlyTheAreaCounts) {
  const Result<Polygon> area = Polygon::Rectangle({-1, -1}, {5, 1});
  ASSERT_TRUE(area);
  const Tracks truth = {Walk(1, {0, 4.9, 9}), Walk(2, {8, 8, 8})};
  const Tracks results = {Walk(1, {0, 5.1, 9}), Walk(2, {8, 30, 8})};
  const TrackMeasures m = Measure(truth, results, {}, &*area);
  EXPECT_EQ(m.frames, 3);
  EXPECT_EQ(m.truth_tracks, 1);
  EXPECT_EQ(m.truth_positions, 2);
  EXPECT_EQ(m.result_positions, 1);
  EXPECT_EQ(m.misses, 1);  // 5.1 is outside, though near
}

TEST(ClearMot, RatiosOfNothingAreNaN) {
  const TrackMeasures m = Measure({Walk(1, {0, 0})}, {});
  EXPECT_EQ(m.mota, 0);
  EXPECT_EQ(m.idf1, 0);
  EXPECT_TRUE(std::isnan(m.motp));
  EXPECT_TRUE(std::isnan(m.precision));
  EXPECT_TRUE(std::isnan(m.modp));
  EXPECT_EQ(m.hota, 0);
  EXPECT_TRUE(std::isnan(m.loca));
}

TEST(ClearMot, ObjectsAndFramesByHand) {
  // Person 1 goes from result 1 over a miss to result 2, is away in frame 4, and comes back; person
  // 2 is never found. Result 3 finds nobody.
  const Tracks truth = {Walk(1, {0, 0, 0, 0, kGone, 0}), Walk(2, {50, 50, 50, 50, 50, 50})};
  const Tracks results = {Walk(1, {0.5, 0.25}), Walk(2, {kGone, kGone, kGone, 0, kGone, 0}),
                          Walk(3, {kGone, 9})};
  const Result<TrackAnalysis> analysis = AnalyzeTracks(truth, results, {});
  ASSERT_TRUE(analysis) << testing::MessageOf(analysis);
  ASSERT_EQ(analysis->truth.size(), 2u);
  const ObjectMeasures& first = analysis->truth[0];
  EXPECT_EQ(first.id, TrackId{1});
  EXPECT_EQ(first.first_frame, 0);
  EXPECT_EQ(first.last_frame, 5);
  EXPECT_EQ(first.positions, 5);
  EXPECT_EQ(first.matches, 4);
  EXPECT_EQ(first.partners, 2);
  EXPECT_EQ(first.switches, 1);
  EXPECT_EQ(first.fragmentations, 1);
  EXPECT_DOUBLE_EQ(first.distance_sum, 0.75);
  EXPECT_EQ(first.id_true_positives, 2);
  EXPECT_THAT(first.spans, ElementsAre(MatchSpan{0, 1, TrackId{1}}, MatchSpan{2, 2, std::nullopt},
                                       MatchSpan{3, 3, TrackId{2}}, MatchSpan{5, 5, TrackId{2}}));
  const ObjectMeasures& second = analysis->truth[1];
  EXPECT_EQ(second.matches, 0);
  EXPECT_FALSE(second.identity);
  EXPECT_THAT(second.spans, ElementsAre(MatchSpan{0, 5, std::nullopt}));

  ASSERT_EQ(analysis->results.size(), 3u);
  EXPECT_EQ(analysis->results[0].matches, 2);
  EXPECT_EQ(analysis->results[0].partners, 1);
  EXPECT_EQ(analysis->results[2].matches, 0);
  EXPECT_EQ(analysis->results[2].first_frame, 1);

  ASSERT_EQ(analysis->frames.size(), 6u);
  const FrameMeasures& frame = analysis->frames[1];
  EXPECT_EQ(frame.truth, 2);
  EXPECT_EQ(frame.results, 2);
  EXPECT_EQ(frame.matches, 1);
  EXPECT_DOUBLE_EQ(frame.distance_sum, 0.25);
  EXPECT_EQ(analysis->frames[3].switches, 1);
}

TEST(ClearMot, RefusesWhatCannotBeMeasured) {
  EXPECT_THAT(testing::MessageOf(EvaluateTracks({}, {}, {})), HasSubstr("truth is empty"));
  EXPECT_THAT(testing::MessageOf(EvaluateTracks({Walk(1, {0})}, {}, {.threshold_m = 0})),
              HasSubstr("evaluation.threshold is 0"));
  const Result<Polygon> area = Polygon::Rectangle({50, 50}, {60, 60});
  EXPECT_THAT(testing::MessageOf(EvaluateTracks({Walk(1, {0})}, {}, {}, &*area)),
              HasSubstr("no position inside the area"));
  Tracks crowd;
  for (int id = 0; id < 2001; ++id) crowd.push_back(Walk(id, {3.0 * id}));
  EXPECT_THAT(testing::MessageOf(EvaluateTracks({Walk(1, {0})}, crowd, {})),
              HasSubstr("frame 0 has 1 of truth and 2001 of results; at most 2000"));
  Tracks many;
  for (int id = 0; id < 4500; ++id) many.push_back(Walk(id, {0}, id));
  EXPECT_THAT(testing::MessageOf(EvaluateTracks(many, many, {})), HasSubstr("too many to compare"));
}

TEST(ClearMot, BoxesByHand) {
  const auto box = [](std::int64_t id, double left) {
    return BoxTrack{TrackId{id}, {{0, left, 0, 10, 10}}};
  };
  // Shifted by 2 of 10 pixels: 80 shared of 120.
  const Result<TrackMeasures> m = EvaluateBoxes({box(1, 0), box(2, 100)}, {box(1, 2)}, {});
  ASSERT_TRUE(m);
  EXPECT_EQ(m->matches, 1);
  EXPECT_DOUBLE_EQ(m->motp, 1 - 80.0 / 120);
  EXPECT_DOUBLE_EQ(m->motp_similarity, 80.0 / 120);
  EXPECT_DOUBLE_EQ(m->modp, 80.0 / 120);
  const Result<TrackMeasures> strict = EvaluateBoxes({box(1, 0)}, {box(1, 2)}, {.min_iou = 0.7});
  EXPECT_EQ(strict->matches, 0);
}

TEST(ClearMot, KnownAnswerOfTudCampus) {
  const std::filesystem::path data = testing::DataFolder();
  if (data.empty()) GTEST_SKIP() << "no research data";
  const std::filesystem::path folder = data / "motmetrics" / "TUD-Campus";
  const Result<BoxTracks> truth = ReadBoxTracks(folder / "gt.txt");
  const Result<BoxTracks> results = ReadBoxTracks(folder / "test.txt");
  ASSERT_TRUE(truth && results);
  const Result<TrackMeasures> m = EvaluateBoxes(*truth, *results, {.min_iou = 0.5});
  ASSERT_TRUE(m) << testing::MessageOf(m);
  EXPECT_NEAR(m->mota, 0.526462, 1e-6);
  EXPECT_NEAR(m->motp, 0.277201, 1e-6);
  EXPECT_EQ(m->false_positives, 13);
  EXPECT_EQ(m->misses, 150);
  EXPECT_EQ(m->switches, 7);
  EXPECT_EQ(m->fragmentations, 7);
  EXPECT_NEAR(m->idf1, 0.557659, 1e-6);
  EXPECT_NEAR(m->motp_similarity, 1 - 0.277201, 1e-6);
  EXPECT_NEAR(m->hota, 0.391397438, 1e-9);
  EXPECT_NEAR(m->deta, 0.418047030, 1e-9);
  EXPECT_NEAR(m->assa, 0.369120681, 1e-9);
}

TEST(ClearMot, PositionsOfPetsInTheUsualArea) {
  const std::filesystem::path data = testing::DataFolder();
  if (data.empty()) GTEST_SKIP() << "no research data";
  const Result<Tracks> truth = ReadTracks(data / "pets2009" / "gt-mot15-3d.txt");
  ASSERT_TRUE(truth);
  const Result<Polygon> area = Polygon::Rectangle({-14.0696, -14.274}, {4.9813, 1.7335});
  ASSERT_TRUE(area);
  const TrackMeasures m = Measure(*truth, *truth, {}, &*area);
  EXPECT_EQ(m.frames, 795);
  EXPECT_EQ(m.truth_positions, 3941);
  EXPECT_EQ(m.mota, 1);
}

}  // namespace
}  // namespace vantage
