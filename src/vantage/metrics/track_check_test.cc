// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/metrics/track_check.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "vantage/base/test_support.h"
#include "vantage/metrics/test_tracks.h"
#include "vantage/tracks/track_file.h"

namespace vantage {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::kGone;
using ::testing::SizeIs;
using testing::Walk;

std::vector<TrackRemark> Check(const Tracks& truth, const Tracks& results,
                               const EvaluationOptions& options = {}) {
  const Result<TrackMeasures> measures = EvaluateTracks(truth, results, options);
  EXPECT_TRUE(measures) << testing::MessageOf(measures);
  return CheckTracks(truth, results, options, measures.value_or(TrackMeasures{}));
}

/// Walks 0.2 m a frame around a square, as two people do out of step.
Tracks TwoPeople(FrameIndex later = 0, double scale = 1) {
  Tracks tracks;
  for (int id = 1; id <= 2; ++id) {
    Track& track = tracks.emplace_back(Track{.id = TrackId{id}, .points = {}});
    for (FrameIndex frame = 0; frame < 80; ++frame) {
      const double angle = 0.04 * static_cast<double>(frame) + 3 * id;
      track.points.push_back(
          {frame + later, scale * 5 * std::cos(angle), scale * 5 * std::sin(angle), false});
    }
  }
  return tracks;
}

TEST(TrackCheck, NothingToSayOfTruthAgainstItself) {
  EXPECT_THAT(Check(TwoPeople(), TwoPeople()), IsEmpty());
}

TEST(TrackCheck, Scale) {
  EXPECT_DOUBLE_EQ(ScaleOfResults({Walk(1, {2, 3, 4})}, {Walk(1, {200, 300, 400})}), 100);
  EXPECT_TRUE(std::isnan(ScaleOfResults(TwoPeople(), {})));

  const std::vector<TrackRemark> centimetres = Check(TwoPeople(), TwoPeople(0, 100));
  ASSERT_THAT(centimetres, SizeIs(1));
  EXPECT_TRUE(centimetres[0].warning);
  EXPECT_EQ(centimetres[0].text,
            "coordinates are 100 times those of the truth, as if they were in centimetres; both "
            "must be in metres");
  EXPECT_THAT(Check(TwoPeople(0, 1000), TwoPeople()).front().text,
              HasSubstr("0.001 times those of the truth, as if the truth's were in millimetres"));
  EXPECT_THAT(Check(TwoPeople(), TwoPeople(0, 3.281)).front().text, HasSubstr("in feet"));
  // A match by chance hides nothing: here id 3 is right.
  Tracks mixed = TwoPeople(0, 100);
  mixed.push_back(Walk(3, {5}));
  Tracks truth = TwoPeople();
  truth.push_back(Walk(3, {5}));
  EXPECT_THAT(Check(truth, mixed).front().text, HasSubstr("centimetres"));
  // Results in one part of the area are no mistake.
  EXPECT_THAT(Check({Walk(1, {2, 2}), Walk(2, {9, 9}), Walk(3, {9, 9})}, {Walk(1, {2, 2})}),
              IsEmpty());
}

TEST(TrackCheck, TimeOffset) {
  const std::vector<TrackRemark> later = Check(TwoPeople(), TwoPeople(3));
  ASSERT_FALSE(later.empty());
  EXPECT_TRUE(later[0].warning);
  EXPECT_THAT(later[0].text, HasSubstr("frame numbers lowered by 3 would fit the truth better "
                                       "(mean similarity 1.000 in place of"));
  EXPECT_THAT(Check(TwoPeople(1000), TwoPeople()).front().text, HasSubstr("raised by 1000"));
  // Truth in every 40th frame, results one frame off: none falls on a frame that counts.
  Tracks sparse = {Walk(1, {0, 1, 2, 3}, 0, 40)};
  EXPECT_THAT(Check(sparse, {Walk(1, {0, 1, 2, 3}, 1, 40)}).front().text,
              HasSubstr("lowered by 1 would"));
}

TEST(TrackCheck, ASmallTimeOffsetIsANote) {
  // 0.05 m a frame: one frame off costs 0.025 of similarity.
  Tracks truth = {Walk(1, {})};
  Tracks results = {Walk(1, {})};
  for (FrameIndex frame = 0; frame < 100; ++frame) {
    truth[0].points.push_back({frame, 0.05 * static_cast<double>(frame), 0, false});
    results[0].points.push_back({frame, 0.05 * static_cast<double>(frame - 1), 0, false});
  }
  const std::vector<TrackRemark> remarks = Check(truth, results);
  ASSERT_THAT(remarks, SizeIs(1));
  EXPECT_FALSE(remarks[0].warning);
  EXPECT_THAT(remarks[0].text, HasSubstr("lowered by 1 would"));
}

TEST(TrackCheck, FramesWithoutTruthOrResults) {
  // Marked at irregular times: frames 0, 10 and 11 of 12.
  const Tracks truth = {
      Walk(1, {0, kGone, kGone, kGone, kGone, kGone, kGone, kGone, kGone, kGone, 0, 0})};
  const Tracks results = {Walk(1, {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0})};
  std::vector<TrackRemark> remarks = Check(truth, results);
  ASSERT_THAT(remarks, SizeIs(2));
  EXPECT_TRUE(remarks[0].warning);
  EXPECT_EQ(remarks[0].about, TrackRemark::About::kTruth);
  EXPECT_THAT(remarks[0].text, HasSubstr("9 of the 12 frames that count hold nobody"));
  EXPECT_FALSE(remarks[1].warning);
  EXPECT_THAT(remarks[1].text, HasSubstr("1 positions do not count"));
  remarks = Check(truth, results, {.truth_frames_only = true});
  EXPECT_THAT(remarks, SizeIs(1));

  remarks = Check(results, {Walk(1, {0, 0, 0})});
  ASSERT_THAT(remarks, SizeIs(1));
  EXPECT_TRUE(remarks[0].warning);
  EXPECT_THAT(remarks[0].text, HasSubstr("nothing in 10 of the 13 frames with truth"));
}

TEST(TrackCheck, GapsInTracks) {
  const Tracks tracks = {Walk(1, {0, kGone, kGone, 0, 0}), Walk(2, {9, 9, 9, kGone, 9}),
                         Walk(3, {5, 5, 5})};
  const std::vector<TrackRemark> remarks = Check(tracks, tracks);
  ASSERT_THAT(remarks, SizeIs(2));
  EXPECT_EQ(remarks[0].about, TrackRemark::About::kTruth);
  EXPECT_EQ(remarks[1].about, TrackRemark::About::kResults);
  EXPECT_FALSE(remarks[0].warning);
  EXPECT_EQ(remarks[0].text,
            "2 of 3 tracks have gaps; the longest, 2 frames, ends where id 1 comes back in frame "
            "3");
  EXPECT_EQ(remarks[0].at, std::pair(TrackId{1}, FrameIndex{3}));
  // Truth in every 40th frame has none.
  EXPECT_THAT(Check({Walk(1, {0, 0, 0}, 0, 40)}, {Walk(1, {0, 0, 0}, 0, 40)}), IsEmpty());
}

TEST(TrackCheck, FarPositions) {
  Tracks results = TwoPeople();
  results[1].points[7].x_m = 4e6;
  const std::vector<TrackRemark> remarks = Check(TwoPeople(), results);
  ASSERT_THAT(remarks, SizeIs(1));
  EXPECT_TRUE(remarks[0].warning);
  EXPECT_EQ(remarks[0].at, std::pair(TrackId{2}, FrameIndex{7}));
  EXPECT_THAT(remarks[0].text,
              HasSubstr("1 positions lie more than 1000 m from the middle of the truth; the "
                        "farthest, id 2 in frame 7, 4e+06 m"));
}

TEST(TrackCheck, NothingMatches) {
  EXPECT_THAT(Check(TwoPeople(), {Walk(1, {8, 8})}).front().text,
              HasSubstr("nothing matches the truth"));
  EXPECT_THAT(Check(TwoPeople(), {}).front().text, HasSubstr("holds no position"));
}

TEST(TrackCheck, Boxes) {
  const auto boxes = [](double scale) {
    return BoxTracks{{TrackId{1}, {{0, 100 * scale, 80 * scale, 10 * scale, 20 * scale}}}};
  };
  const auto check = [](const BoxTracks& truth, const BoxTracks& results) {
    const Result<TrackMeasures> measures = EvaluateBoxes(truth, results, {});
    return CheckBoxes(truth, results, {}, measures.value_or(TrackMeasures{}));
  };
  EXPECT_THAT(check(boxes(1), boxes(1)), IsEmpty());
  EXPECT_THAT(check(boxes(1), boxes(1.0 / 768)).front().text,
              HasSubstr("0.0013 times those of the truth; both must be in pixels"));
}

TEST(TrackCheck, RealTruthIsSound) {
  const std::filesystem::path data = testing::DataFolder();
  if (data.empty()) GTEST_SKIP() << "no research data";
  const Result<Tracks> truth = ReadTracks(data / "pets2009" / "gt-mot15-3d.txt");
  ASSERT_TRUE(truth);
  for (const TrackRemark& remark : Check(*truth, *truth)) {
    EXPECT_FALSE(remark.warning) << remark.text;
  }
  // One frame off is 0.2 m at a walk; it shows.
  Tracks shifted = *truth;
  for (Track& track : shifted) {
    for (TrackPoint& point : track.points) ++point.frame;
  }
  EXPECT_THAT(Check(*truth, shifted).front().text, HasSubstr("lowered by 1 would"));
}

}  // namespace
}  // namespace vantage
