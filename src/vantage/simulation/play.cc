// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/simulation/play.h"

#include <algorithm>
#include <cmath>
#include <memory>

namespace vantage::simulation {
namespace {

/// First frame in which the thing is elsewhere than in frame 0; beyond all where it never moves.
std::size_t FirstMove(const std::vector<Placement>& placements) {
  std::size_t frame = 0;
  while (frame < placements.size() && placements[frame].ground_m == placements[0].ground_m &&
         placements[frame].yaw_rad == placements[0].yaw_rad) {
    ++frame;
  }
  return frame;
}

float GainAt(const LightCurve& curve, double seconds) {
  if (curve.empty()) return 1;
  if (seconds <= curve.front().first) return static_cast<float>(curve.front().second);
  for (std::size_t i = 1; i < curve.size(); ++i) {
    if (seconds >= curve[i].first) continue;
    const auto& [from, low] = curve[i - 1];
    const auto& [to, high] = curve[i];
    const double t = (seconds - from) / (to - from);
    return static_cast<float>(low + (high - low) * t * t * (3 - 2 * t));
  }
  return static_cast<float>(curve.back().second);
}

class Play : public Script {
 public:
  explicit Play(Rehearsal rehearsal) : rehearsal_(std::move(rehearsal)) {
    for (const Prop& prop : rehearsal_.props) first_moves_.push_back(FirstMove(prop.placements));
  }

  std::vector<Thing> At(FrameIndex frame) const override {
    const double seconds = static_cast<double>(frame) / rehearsal_.frames_per_second;
    std::vector<Thing> things;
    for (const Actor& actor : rehearsal_.actors) {
      const FrameIndex index = frame - actor.first;
      if (index < 0 || index >= static_cast<FrameIndex>(actor.postures.size())) continue;
      const Posture& posture = actor.postures[static_cast<std::size_t>(index)];
      things.push_back({.id = actor.id,
                        .kind = Thing::Kind::kPerson,
                        .ground_m = posture.ground_m,
                        .limbs = BodyLimbs(actor.figure, posture),
                        .blocks = {}});
    }
    for (std::size_t i = 0; i < rehearsal_.props.size(); ++i) {
      const Prop& prop = rehearsal_.props[i];
      const std::size_t index =
          std::min(static_cast<std::size_t>(frame), prop.placements.size() - 1);
      const Placement& placement = prop.placements[index];
      Shape shape = Placed(prop.shape, placement.ground_m, placement.yaw_rad);
      things.push_back({.id = prop.id,
                        .kind = Thing::Kind::kObject,
                        .foreground = index >= first_moves_[i],
                        .ground_m = placement.ground_m.head<2>().cast<double>(),
                        .limbs = std::move(shape.limbs),
                        .blocks = std::move(shape.blocks)});
    }
    for (const Swaying& swaying : rehearsal_.scenery) {
      things.push_back({.id = swaying.id,
                        .kind = Thing::Kind::kScenery,
                        .foreground = false,
                        .ground_m = swaying.foliage.ground_m.cast<double>(),
                        .limbs = LeavesAt(swaying.foliage, seconds),
                        .blocks = {}});
    }
    for (const Board& board : rehearsal_.boards) {
      const auto turn = static_cast<std::size_t>(seconds / board.secs);
      Thing thing{.id = board.id,
                  .kind = Thing::Kind::kScenery,
                  .foreground = false,
                  .ground_m = board.block.center_m.head<2>().cast<double>(),
                  .limbs = {},
                  .blocks = {board.block}};
      thing.blocks[0].material = board.pictures[turn % board.pictures.size()];
      things.push_back(std::move(thing));
    }
    std::sort(things.begin(), things.end(),
              [](const Thing& a, const Thing& b) { return a.id < b.id; });
    return things;
  }

  std::vector<float> Gains(FrameIndex frame) const override {
    std::vector<float> gains;
    for (const LightCurve& curve : rehearsal_.lights) {
      gains.push_back(GainAt(curve, static_cast<double>(frame) / rehearsal_.frames_per_second));
    }
    return gains;
  }

 private:
  Rehearsal rehearsal_;
  std::vector<std::size_t> first_moves_;
};

}  // namespace

LightCurve Clouds(double seconds, Dice& dice) {
  LightCurve curve = {{0, 1}};
  double at = dice.Uniform(8, 14);
  curve.emplace_back(at, 1);
  while (at < seconds) {
    at += dice.Uniform(20, 30);
    const double shade = dice.Uniform(0.3, 0.5);
    curve.emplace_back(at, shade);
    at += dice.Uniform(4, 8);
    curve.emplace_back(at, shade);
    at += 3;
    curve.emplace_back(at, dice.Uniform(0.85, 1));
    at += dice.Uniform(8, 14);
    curve.emplace_back(at, 1);
  }
  return curve;
}

std::unique_ptr<Script> MakePlay(Rehearsal rehearsal) {
  return std::make_unique<Play>(std::move(rehearsal));
}

}  // namespace vantage::simulation
