// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/rendering/people.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace vantage {
namespace {

Track Walk(int id, FrameIndex first, FrameIndex last) {
  Track track{TrackId{id}, {}};
  for (FrameIndex frame = first; frame <= last; ++frame) {
    track.points.push_back({frame, 0.1 * static_cast<double>(frame), 2.0 * id, false});
  }
  return track;
}

TEST(PeopleAt, FindsThosePresent) {
  const Tracks tracks = {Walk(1, 0, 9), Walk(4, 5, 20), {TrackId{6}, {}}};
  EXPECT_TRUE(PeopleAt({}, 5, 3).empty());
  EXPECT_TRUE(PeopleAt(tracks, 21, 3).empty());
  ASSERT_EQ(PeopleAt(tracks, 9, 3).size(), 2u);
  const auto people = PeopleAt(tracks, 10, 3);
  ASSERT_EQ(people.size(), 1u);
  EXPECT_EQ(people[0].id, TrackId{4});
  EXPECT_EQ(people[0].position_m, Eigen::Vector2d(1.0, 8.0));
}

TEST(PeopleAt, TrailEndsAtTheLastFrames) {
  const Tracks tracks = {Walk(1, 0, 9)};
  const auto person = PeopleAt(tracks, 8, 4).at(0);
  ASSERT_EQ(person.trail.size(), 5u);  // frames 4 to 8
  EXPECT_EQ(person.trail.front().age, 1);
  EXPECT_EQ(person.trail.front().position_m.x(), 0.1 * 4.0);
  EXPECT_EQ(person.trail.back().age, 0);
  EXPECT_EQ(person.trail.back().position_m, person.position_m);
  EXPECT_EQ(PeopleAt(tracks, 1, 4).at(0).trail.size(), 2u);
  EXPECT_EQ(PeopleAt(tracks, 8, 0).at(0).trail.size(), 1u);
}

TEST(PeopleAt, GapsHaveNobody) {
  Track track = Walk(1, 0, 2);
  track.points.push_back({6, 0.6, 2, true});
  EXPECT_TRUE(PeopleAt({track}, 4, 10).empty());
  const auto person = PeopleAt({track}, 6, 10).at(0);
  EXPECT_TRUE(person.inferred);
  EXPECT_EQ(person.trail.size(), 4u);
}

TEST(PeopleAt, LeavesOutWhatIsNotANumber) {
  Track track = Walk(1, 0, 5);
  track.points[3].x_m = std::nan("");
  track.points[4].y_m = std::numeric_limits<double>::infinity();
  EXPECT_TRUE(PeopleAt({track}, 3, 5).empty());
  EXPECT_EQ(PeopleAt({track}, 5, 5).at(0).trail.size(), 4u);
}

}  // namespace
}  // namespace vantage
