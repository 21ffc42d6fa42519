// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/linking/test_scenes.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

// Only operations that IEEE 754 rounds exactly (the square root among them), and no distributions
// of the standard library, whose results it leaves open.

namespace vantage::testing {
namespace {

/// Of the 20 % of false alarms that stay for 2 to 6 frames, and of the others.
constexpr double kMeanFalseAlarmFrames = 0.8 * 1 + 0.2 * 4;
/// People keep this far apart if they can.
constexpr double kPersonalDistance = 1.5;

}  // namespace

Scene::Scene(const SceneOptions& options) : options_(options), engine_(options.seed) {
  const int columns = options.columns, rows = options.rows;
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      const bool side = column == 0 || column == columns - 1;
      const bool end = row == 0 || row == rows - 1;
      const bool open = options.access == SceneOptions::Access::kBorder
                            ? side || end
                            : (side && row == rows / 2) || (end && column == columns / 2);
      access_.push_back(open ? 1 : 0);
      if (open) doors_.push_back({column + 0.5, row + 0.5});
    }
  }
  for (int i = 0; i < options.max_people; ++i) Enter(AnyPlace());
}

const SceneFrame& Scene::Next() {
  Draw();
  frame_.people.clear();
  for (const Walker& walker : walkers_) {
    frame_.people.push_back({walker.id, walker.position.x, walker.position.y});
  }
  for (std::size_t i = 0; i < walkers_.size(); ++i) Walk(i);
  ComeAndGo();
  return frame_;
}

double Scene::Uniform() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }

/// 1 - p is spread over orders of magnitude, as in real maps.
double Scene::Surety() {
  const double u = Uniform();
  return 1 - 0.3 * (u * u) * (u * u);
}

Scene::Vector Scene::AnyPlace() {
  const double x = Uniform(), y = Uniform();
  return {x * options_.columns, y * options_.rows};
}

Scene::Vector Scene::AnyDoor() { return doors_[Below(doors_.size())]; }

Scene::Vector Scene::NearestDoor(const Vector& from) const {
  const auto squared = [&from](const Vector& door) {
    return (door.x - from.x) * (door.x - from.x) + (door.y - from.y) * (door.y - from.y);
  };
  return *std::min_element(
      doors_.begin(), doors_.end(),
      [&squared](const Vector& a, const Vector& b) { return squared(a) < squared(b); });
}

std::size_t Scene::CellAt(const Vector& position) const {
  return static_cast<std::size_t>(position.x) +
         static_cast<std::size_t>(position.y) * static_cast<std::size_t>(options_.columns);
}

void Scene::Enter(const Vector& position) {
  walkers_.push_back({.id = next_id_++,
                      .position = position,
                      .velocity = {},
                      .goal = AnyPlace(),
                      .pace = options_.top_speed * (0.3 + 0.7 * Uniform())});
}

/// People who reach their way out are gone; others come, at once where too few are left.
void Scene::ComeAndGo() {
  std::erase_if(walkers_, [this](const Walker& walker) {
    return walker.leaving && access_[CellAt(walker.position)] != 0;
  });
  while (std::ssize(walkers_) < options_.max_people) {
    if (std::ssize(walkers_) >= options_.min_people && !Chance(0.05)) break;
    Enter(AnyDoor());
  }
  for (Walker& walker : walkers_) {
    if (!walker.leaving && Chance(1 / options_.mean_stay_frames)) {
      walker.leaving = true;
      walker.goal = NearestDoor(walker.position);
    }
  }
}

void Scene::Walk(std::size_t index) {
  Walker& walker = walkers_[index];
  Vector& position = walker.position;
  const auto towards = [&position](const Vector& place) {
    return Vector{place.x - position.x, place.y - position.y};
  };
  const auto length = [](const Vector& v) { return std::sqrt(v.x * v.x + v.y * v.y); };

  Vector way = towards(walker.goal);
  if (length(way) < 2 && !walker.leaving) {
    walker.goal = AnyPlace();
    walker.pace = options_.top_speed * (0.3 + 0.7 * Uniform());
    way = towards(walker.goal);
  }
  // Slower near the goal, so that nobody circles around a door.
  const double distance = length(way) + 1e-9;
  const double speed = std::min(walker.pace, 0.2 * distance + 0.1 * options_.top_speed);
  Vector change{way.x / distance * speed - walker.velocity.x,
                way.y / distance * speed - walker.velocity.y};
  const double needed = length(change) + 1e-9;
  const double scale = std::min(1.0, options_.acceleration / needed);
  change = {change.x * scale, change.y * scale};
  for (std::size_t other = 0; other < walkers_.size(); ++other) {
    if (other == index) continue;
    const Vector apart = towards(walkers_[other].position);
    const double gap = length(apart) + 1e-9;
    if (gap >= kPersonalDistance) continue;
    const double push = 0.5 * options_.acceleration * (1 - gap / kPersonalDistance) / gap;
    change = {change.x - apart.x * push, change.y - apart.y * push};
  }
  Vector velocity{walker.velocity.x + change.x, walker.velocity.y + change.y};
  const double cap = std::min(1.0, options_.top_speed / (length(velocity) + 1e-9));
  walker.velocity = velocity = {velocity.x * cap, velocity.y * cap};
  position.x = std::clamp(position.x + velocity.x, 0.0, options_.columns - 1e-6);
  position.y = std::clamp(position.y + velocity.y, 0.0, options_.rows - 1e-6);
}

void Scene::Mark(const Vector& position) {
  const double surety = Surety();
  const auto add = [&](double column, double row, double share) {
    if (column < 0 || row < 0 || column >= options_.columns || row >= options_.rows) return;
    float& q = frame_.map[CellAt({column, row})];
    q = static_cast<float>(1 - (1 - static_cast<double>(q)) * (1 - surety * share));
  };
  // Overlaps of a cell's size around the position with the up to four cells there.
  const double left = std::floor(position.x - 0.5), low = std::floor(position.y - 0.5);
  const double right_share = position.x - 0.5 - left, high_share = position.y - 0.5 - low;
  const double most = std::max(right_share, 1 - right_share) * std::max(high_share, 1 - high_share);
  for (const double column : {left, left + 1}) {
    for (const double row : {low, low + 1}) {
      const double overlap = (column > left ? right_share : 1 - right_share) *
                             (row > low ? high_share : 1 - high_share);
      const bool under = column == std::floor(position.x) && row == std::floor(position.y);
      add(column, row, under ? 1 : options_.blur * overlap / most);
    }
  }
}

void Scene::Draw() {
  frame_.map.assign(access_.size(), options_.background);
  if (options_.noisy_share > 0) {
    for (float& q : frame_.map) {
      if (!Chance(options_.noisy_share)) continue;
      const double u = Uniform();
      q = static_cast<float>(options_.noise * (u * u) * (u * u));
    }
  }

  const double run = options_.mean_miss_frames;
  const double begin_miss = options_.misses / (run * (1 - options_.misses));
  for (Walker& walker : walkers_) {
    walker.missed = walker.missed ? !Chance(1 / run) : Chance(begin_miss);
    if (walker.missed) continue;
    const double error_x = options_.position_error * (2 * Uniform() - 1);
    const double error_y = options_.position_error * (2 * Uniform() - 1);
    Mark({std::clamp(walker.position.x + error_x, 0.0, options_.columns - 1e-6),
          std::clamp(walker.position.y + error_y, 0.0, options_.rows - 1e-6)});
  }

  const double expected = options_.false_alarms / kMeanFalseAlarmFrames;
  for (int i = 0; i < expected && Chance(expected - i); ++i) {
    const Vector place = AnyPlace();
    false_alarms_.push_back({place, Chance(0.2) ? 2 + Below(5) : 1});
  }
  for (FalseAlarm& alarm : false_alarms_) {
    Mark(alarm.position);
    --alarm.frames_left;
  }
  std::erase_if(false_alarms_, [](const FalseAlarm& alarm) { return alarm.frames_left == 0; });
}

RecordedScene::RecordedScene(const SceneOptions& scene_options) : options(scene_options) {
  Scene scene(options);
  access = scene.access();
  probability.reserve(access.size() * static_cast<std::size_t>(options.frames));
  for (std::int64_t frame = 0; frame < options.frames; ++frame) {
    const SceneFrame& next = scene.Next();
    probability.insert(probability.end(), next.map.begin(), next.map.end());
    people.push_back(next.people);
  }
}

LinkingProblem RecordedScene::problem() const {
  return {.columns = options.columns,
          .rows = options.rows,
          .frames = options.frames,
          .probability = probability,
          .access = access,
          .obstacle = {}};
}

SceneOptions RoomCase() {
  SceneOptions options;
  options.frames = 1500;
  options.access = SceneOptions::Access::kFourDoors;
  options.min_people = 2;
  options.max_people = 5;
  options.mean_stay_frames = 300;
  options.misses = 0.1;
  options.mean_miss_frames = 2;
  options.false_alarms = 0.3;
  options.blur = 0.3;
  return options;
}

SceneOptions ArenaCase() {
  SceneOptions options;
  options.columns = 80;
  options.rows = 40;
  options.frames = 1000;
  options.min_people = 12;
  options.max_people = 14;
  options.mean_stay_frames = 800;
  options.misses = 0.1;
  options.mean_miss_frames = 3;
  options.false_alarms = 1;
  options.position_error = 0.5;
  options.blur = 0.4;
  options.noisy_share = 0.05;
  return options;
}

SceneOptions CrowdCase() {
  SceneOptions options;
  options.columns = 60;
  options.rows = 180;
  options.frames = 100;
  options.min_people = 40;
  options.max_people = 40;
  options.mean_stay_frames = 150;
  options.top_speed = 1.5;
  options.acceleration = 0.3;
  options.misses = 0.1;
  options.mean_miss_frames = 2;
  options.false_alarms = 2;
  options.position_error = 0.5;
  options.blur = 0.4;
  options.noisy_share = 0.02;
  return options;
}

SceneOptions HourCase() {
  SceneOptions options = ArenaCase();
  options.frames = 72'000;
  options.min_people = 14;
  return options;
}

}  // namespace vantage::testing
