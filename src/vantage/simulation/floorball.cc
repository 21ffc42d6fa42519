// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <utility>

#include "vantage/simulation/floorball_cast.h"
#include "vantage/simulation/floorball_game.h"
#include "vantage/simulation/floorball_hall.h"
#include "vantage/simulation/floorball_walkers.h"
#include "vantage/simulation/presets.h"

namespace vantage::simulation {
namespace {

using Eigen::Vector3d;

constexpr FrameIndex kFrames = 1000;
constexpr ImageSize kPicture = {960, 768};

// Eight cameras high around the rink; any first three surround it.
struct View {
  Vector3d from_m;
  Vector3d to_m;
  double focal_px;
  double k1;
  double exposure;
  Eigen::Vector3f balance;
};

const std::array<View, 8>& Views() {
  static const std::array<View, 8> views = {{
      {{-22.0, -12.8, 7.2}, {-11.0, -5.6, 0}, 640, -0.090, 1.50, {1.00F, 1.00F, 1.02F}},
      {{22.2, -12.6, 7.0}, {11.0, -5.6, 0}, 645, -0.080, 1.62, {1.05F, 1.00F, 0.93F}},
      {{0.5, 13.3, 8.4}, {0.0, 2.5, 0}, 540, -0.070, 1.40, {0.95F, 1.00F, 1.06F}},
      {{22.0, 12.9, 7.4}, {10.6, 5.4, 0}, 635, -0.085, 1.55, {0.97F, 1.00F, 1.01F}},
      {{-22.3, 12.7, 6.8}, {-11.0, 5.4, 0}, 650, -0.095, 1.45, {1.03F, 1.00F, 0.97F}},
      {{-0.4, -13.4, 8.2}, {0.0, -2.5, 0}, 535, -0.075, 1.66, {1.00F, 1.00F, 0.95F}},
      {{-23.4, 0.3, 7.8}, {-11.5, 0, 0}, 660, -0.080, 1.48, {0.96F, 1.00F, 1.04F}},
      {{23.3, -0.4, 8.0}, {11.5, 0, 0}, 670, -0.100, 1.58, {1.04F, 1.00F, 1.00F}},
  }};
  return views;
}

Result<StageCamera> MakeCamera(int number, const View& view, double scale) {
  CameraPose pose;
  const Vector3d ahead = (view.to_m - view.from_m).normalized();
  const Vector3d right = ahead.cross(Vector3d::UnitZ()).normalized();
  pose.rotation.row(0) = right.transpose();
  pose.rotation.row(1) = ahead.cross(right).transpose();
  pose.rotation.row(2) = ahead.transpose();
  pose.translation_m = -pose.rotation * view.from_m;
  PinholeModel lens;
  lens.fx_px = lens.fy_px = view.focal_px;
  lens.cx_px = kPicture.width / 2.0 - 0.5 + 3.0 * std::sin(number);
  lens.cy_px = kPicture.height / 2.0 - 0.5 + 3.0 * std::cos(number);
  lens.distortion[0] = view.k1;
  VANTAGE_ASSIGN_OR_RETURN(const Camera full, Camera::Create(kPicture, lens, pose));
  const ImageSize size = {static_cast<int>(std::lround(kPicture.width * scale / 2)) * 2,
                          static_cast<int>(std::lround(kPicture.height * scale / 2)) * 2};
  VANTAGE_ASSIGN_OR_RETURN(Camera camera, full.Scaled(size));
  return StageCamera{.name = "camera" + std::to_string(number),
                     .camera = std::move(camera),
                     .exposure = view.exposure,
                     .balance = view.balance};
}

class FloorballScript : public Script {
 public:
  FloorballScript(std::uint64_t seed, FrameIndex frames, Stage& stage)
      : game_(seed, frames),
        frames_(frames),
        scenery_(stage),
        figures_(DressPeople(game_.people(), seed, stage)),
        ball_(AddMaterial(stage, {.color = {0.85F, 0.85F, 0.82F}})) {
    Dice dice(seed + 99);
    for (double& phase : phases_) phase = dice.Uniform(0, 2 * std::numbers::pi);
    door_secs_ = dice.Uniform(20, 35);
  }

  std::vector<Thing> At(FrameIndex frame) const override {
    frame = std::clamp<FrameIndex>(frame, 0, frames_ - 1);
    const double secs = Secs(frame);
    std::vector<Thing> things;
    int id = 0;
    for (std::size_t i = 0; i < figures_.size(); ++i) {
      const Posture posture = game_.PostureAt(i, frame);
      Thing person;
      person.id = ++id;
      person.ground_m = posture.ground_m;
      person.limbs = BodyLimbs(figures_[i], posture);
      things.push_back(std::move(person));
    }
    Thing ball;
    ball.id = ++id;
    ball.kind = Thing::Kind::kObject;
    const Eigen::Vector3f place = game_.BallAt(frame).cast<float>();
    ball.ground_m = place.head<2>().cast<double>();
    ball.limbs.push_back({place, place, 0.036F, 0.036F, ball_});
    things.push_back(std::move(ball));
    things.push_back(scenery_.Board(++id, secs));
    things.push_back(scenery_.Curtain(++id, secs));
    return things;
  }

  // The mains and the sky behind the windows drift; once a minute a door stands open for a while.
  std::vector<float> Gains(FrameIndex frame) const override {
    const double secs = Secs(frame);
    const double since = std::fmod(secs + 60 - door_secs_, 60.0);
    const double open = secs < door_secs_ - 1 ? 0
                                              : std::clamp(since / 0.3, 0.0, 1.0) *
                                                    std::clamp((6 - since) / 0.3, 0.0, 1.0);
    std::vector<float> gains;
    for (std::size_t i = 0; i < phases_.size(); ++i) {
      const double period = i == 0 ? 71 : 41 + 7.0 * static_cast<double>(i);
      const double drift = 0.03 * std::sin(2 * std::numbers::pi * secs / period + phases_[i]);
      gains.push_back(static_cast<float>(1 + drift + (i == 0 ? 0.06 * open : 0)));
    }
    return gains;
  }

 private:
  static double Secs(FrameIndex frame) {
    return static_cast<double>(frame) / FloorballGame::kFramesPerSecond;
  }

  FloorballGame game_;
  FrameIndex frames_;
  HallScenery scenery_;
  std::vector<Figure> figures_;
  MaterialIndex ball_;
  std::array<double, 5> phases_ = {};
  double door_secs_ = 0;
};

}  // namespace

Result<Stage> MakeFloorball(const PresetOptions& options) {
  if (!options.people.empty()) {
    return Fail("people: floorball invents its players; leave this option out");
  }
  const int most = static_cast<int>(Views().size());
  const int cameras = options.cameras.value_or(most);
  if (cameras < 1 || cameras > most) {
    return Fail("cameras is {}; floorball has 1 to {}", cameras, most);
  }
  Stage stage;
  stage.name = "floorball";
  stage.frames_per_second = FloorballGame::kFramesPerSecond;
  stage.frames = options.frames.value_or(kFrames);
  VANTAGE_ASSIGN_OR_RETURN(stage.area, Polygon::Rectangle({-kRinkHalfLength_m, -kRinkHalfWidth_m},
                                                          {kRinkHalfLength_m, kRinkHalfWidth_m}));
  for (int i = 0; i < cameras; ++i) {
    VANTAGE_ASSIGN_OR_RETURN(
        StageCamera camera, MakeCamera(i + 1, Views()[static_cast<std::size_t>(i)], options.scale));
    stage.cameras.push_back(std::move(camera));
  }
  BuildHall(stage);
  stage.script = std::make_unique<FloorballScript>(options.seed, stage.frames, stage);
  return stage;
}

}  // namespace vantage::simulation
