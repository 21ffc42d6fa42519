// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <random>
#include <span>
#include <vector>

#include "vantage/linking/linker.h"

/// For tests and benchmarks only: probability maps of simulated people, with the truth.

namespace vantage::testing {

/// What is simulated. Lengths are in cells, times in frames; probabilities and shares are in
/// [0, 1].
struct SceneOptions {
  int columns = 28;
  int rows = 28;
  std::int64_t frames = 100;
  std::uint32_t seed = 1;
  /// Where people come and go: all cells of the border, or the one in the middle of each wall.
  enum class Access { kBorder, kFourDoors } access = Access::kBorder;

  /// At every frame, so many people are there, 0 <= min <= max.
  int min_people = 1;
  int max_people = 1;
  /// How long somebody stays before heading for the nearest way out, mean, at least 1.
  double mean_stay_frames = 500;
  /// Nobody moves more than this per frame, above 0. With a speed of at most the linker's depth,
  /// every true way is a legal path.
  double top_speed = 0.5;
  /// Change of velocity per frame at most, above 0.
  double acceleration = 0.05;

  /// Share of frames in which somebody leaves no mark in the map.
  double misses = 0;
  /// Mean length of a run of such frames; in a crowd they come together. At least 1.
  double mean_miss_frames = 1;
  /// Marks per frame where nobody is, mean, at least 0. One in five stays for 2 to 6 frames, the
  /// others for one.
  double false_alarms = 0;
  /// A mark is up to this far from the person along each axis, anew in every frame.
  double position_error = 0;
  /// A mark is strongest in the cell under it. The up to three other cells that a cell's size
  /// around its position overlaps hold up to this share of that, in proportion to the overlap: real
  /// maps do so where people stand between cells.
  double blur = 0;
  /// Probability of cells without a mark.
  float background = 0.002F;
  /// Share of the cells that in each frame, in place of the background, hold a value up to `noise`
  /// (most far below it).
  double noisy_share = 0;
  double noise = 0.2;
};

/// Where somebody truly is. The cell is (floor(column), floor(row)).
struct ScenePerson {
  std::int32_t id = 0;  ///< from 0, in the order of coming
  double column = 0;
  double row = 0;
};

struct SceneFrame {
  std::vector<float> map;  ///< columns * rows, cell = column + row * columns
  std::vector<ScenePerson> people;
};

/// Simulates a scene frame by frame; equal options give equal bits on every machine.
///
/// People start anywhere, walk or run towards one random place after the other with bounded
/// acceleration, each at a pace of its own, give way a little to others near them (they do cross
/// and may share a cell), and in the end leave by the nearest access cell. Others come in by random
/// access cells. Maps are what a detector with independent errors would give: marks of random
/// surety (mostly near 1) at the people's positions, with the errors of SceneOptions. Not
/// simulated: errors that depend on where people stand or on each other (occlusion, reflections),
/// people who stand still for long, and crowding at the doors.
class Scene {
 public:
  explicit Scene(const SceneOptions& options);

  /// The next frame; valid until the next call.
  const SceneFrame& Next();

  /// Per cell, non-zero where people come and go.
  const std::vector<std::uint8_t>& access() const { return access_; }

 private:
  struct Vector {
    double x = 0, y = 0;
  };
  struct Walker {
    std::int32_t id;
    Vector position, velocity, goal;
    double pace;
    bool leaving = false;
    bool missed = false;
  };
  struct FalseAlarm {
    Vector position;
    std::uint64_t frames_left;
  };

  double Uniform();
  bool Chance(double probability) { return Uniform() < probability; }
  std::uint64_t Below(std::uint64_t count) { return engine_() % count; }
  double Surety();
  Vector AnyPlace();
  Vector AnyDoor();
  Vector NearestDoor(const Vector& from) const;
  std::size_t CellAt(const Vector& position) const;
  void Enter(const Vector& position);
  void ComeAndGo();
  void Walk(std::size_t index);
  void Mark(const Vector& position);
  void Draw();

  const SceneOptions options_;
  std::mt19937_64 engine_;
  std::vector<std::uint8_t> access_;
  std::vector<Vector> doors_;  // centres of the access cells
  std::vector<Walker> walkers_;
  std::vector<FalseAlarm> false_alarms_;
  std::int32_t next_id_ = 0;
  SceneFrame frame_;
};

/// All frames of a scene at once.
struct RecordedScene {
  explicit RecordedScene(const SceneOptions& options);
  LinkingProblem problem() const;

  SceneOptions options;
  std::vector<std::uint8_t> access;
  std::vector<float> probability;
  std::vector<std::vector<ScenePerson>> people;  ///< by frame
};

/// A room with four doors, a few people: 28 x 28 cells, 1,500 frames. For depth 1.
SceneOptions RoomCase();
/// A hall for a team sport, 12 to 14 people with substitutions, noisy maps: 80 x 40 cells, 1,000
/// frames. For depth 1.
SceneOptions ArenaCase();
/// A square full of passers-by, 40 people: 60 x 180 cells, 100 frames. For depth 3.
SceneOptions CrowdCase();
/// The hall for an hour at 20 frames per second: 80 x 40 cells, 72,000 frames, 14 people. Depth 1.
SceneOptions HourCase();

}  // namespace vantage::testing
