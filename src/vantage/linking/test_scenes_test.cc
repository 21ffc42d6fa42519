// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/linking/test_scenes.h"

#include <gmock/gmock.h>

#include <cmath>
#include <cstddef>
#include <map>

namespace vantage::testing {
namespace {

SceneOptions Shortened(SceneOptions options, std::int64_t frames) {
  options.frames = frames;
  return options;
}

TEST(Scene, EqualOptionsGiveEqualMapsAndAnotherSeedOthers) {
  SceneOptions options = Shortened(ArenaCase(), 50);
  const RecordedScene first(options), again(options);
  EXPECT_EQ(first.probability, again.probability);
  options.seed = 2;
  EXPECT_NE(first.probability, RecordedScene(options).probability);
}

TEST(Scene, ArithmeticIsTheSameEverywhere) {
  // Computed on x86-64. Where it differs, benchmarks and tests would have other inputs.
  const RecordedScene scene(Shortened(RoomCase(), 200));
  double sum = 0;
  for (const float q : scene.probability) sum += static_cast<double>(q);
  EXPECT_DOUBLE_EQ(sum, 1369.6066671751905);
}

TEST(Scene, KeepsToTheNumberOfPeopleTheirSpeedAndTheGrid) {
  for (const SceneOptions& options :
       {RoomCase(), ArenaCase(), CrowdCase(), Shortened(HourCase(), 2000)}) {
    Scene scene(options);
    std::map<std::int32_t, ScenePerson> before;
    bool all_probabilities = true;
    for (std::int64_t frame = 0; frame < options.frames; ++frame) {
      const SceneFrame& next = scene.Next();
      ASSERT_EQ(next.map.size(), static_cast<std::size_t>(options.columns * options.rows));
      for (const float q : next.map) all_probabilities &= q >= 0 && q <= 1;
      ASSERT_GE(std::ssize(next.people), options.min_people);
      ASSERT_LE(std::ssize(next.people), options.max_people);
      std::map<std::int32_t, ScenePerson> now;
      for (const ScenePerson& person : next.people) {
        ASSERT_TRUE(now.emplace(person.id, person).second);
        ASSERT_TRUE(person.column >= 0 && person.column < options.columns);
        ASSERT_TRUE(person.row >= 0 && person.row < options.rows);
        const auto last = before.find(person.id);
        const auto cell =
            static_cast<std::size_t>(person.column) +
            static_cast<std::size_t>(person.row) * static_cast<std::size_t>(options.columns);
        if (last == before.end()) {
          ASSERT_TRUE(frame == 0 || scene.access()[cell] != 0) << "came from nowhere";
        } else {
          ASSERT_LE(std::hypot(person.column - last->second.column, person.row - last->second.row),
                    options.top_speed + 1e-6);
        }
      }
      before = now;
    }
    EXPECT_TRUE(all_probabilities);
  }
}

TEST(Scene, PeopleComeAndGo) {
  const RecordedScene scene(ArenaCase());
  EXPECT_GT(scene.people.back().back().id, 15);  // of at most 14 at a time
  EXPECT_LT(scene.people.back().back().id, 60);
}

TEST(Scene, MissesAndFalseAlarmsAreAsOftenAsAsked) {
  SceneOptions options;
  options.frames = 4000;
  options.min_people = options.max_people = 2;
  options.misses = 0.2;
  options.mean_miss_frames = 4;
  options.false_alarms = 1;
  const RecordedScene scene(options);
  std::int64_t marks = 0, hits = 0, people = 0;
  for (std::size_t frame = 0; frame < scene.people.size(); ++frame) {
    const auto cells = static_cast<std::size_t>(options.columns * options.rows);
    const std::span map = std::span(scene.probability).subspan(frame * cells, cells);
    marks += std::count_if(map.begin(), map.end(), [](float q) { return q > 0.5F; });
    for (const ScenePerson& person : scene.people[frame]) {
      const auto cell =
          static_cast<std::size_t>(person.column) +
          static_cast<std::size_t>(person.row) * static_cast<std::size_t>(options.columns);
      hits += map[cell] > 0.5F ? 1 : 0;
      ++people;
    }
  }
  EXPECT_NEAR(static_cast<double>(hits) / static_cast<double>(people), 0.8, 0.03);
  EXPECT_NEAR(static_cast<double>(marks - hits) / static_cast<double>(options.frames), 1, 0.1);
}

}  // namespace
}  // namespace vantage::testing
