// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/simulation/body.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

namespace vantage::simulation {
namespace {

constexpr MaterialIndex kShoes = 7, kHair = 8, kStick = 9, kSkin = 6;

Figure Someone(double height_m = 1.75) {
  Figure figure;
  figure.height_m = height_m;
  figure.shoes = kShoes;
  figure.hair = kHair;
  figure.skin = kSkin;
  figure.stick_material = kStick;
  return figure;
}

std::vector<Limb> Made(const std::vector<Limb>& limbs, MaterialIndex material) {
  std::vector<Limb> those;
  for (const Limb& limb : limbs) {
    if (limb.material == material) those.push_back(limb);
  }
  return those;
}

float Lowest(const Limb& limb) {
  return std::min(limb.a_m.z() - limb.a_radius_m, limb.b_m.z() - limb.b_radius_m);
}

float Top(const std::vector<Limb>& limbs) {
  float top = 0;
  for (const Limb& limb : limbs) {
    top = std::max({top, limb.a_m.z() + limb.a_radius_m, limb.b_m.z() + limb.b_radius_m});
  }
  return top;
}

double Reach(const std::vector<Limb>& limbs, const Eigen::Vector2d& ground_m) {
  double reach = 0;
  for (const Limb& limb : limbs) {
    if (limb.material == kStick) continue;
    const Eigen::Vector2d a = limb.a_m.head<2>().cast<double>() - ground_m;
    const Eigen::Vector2d b = limb.b_m.head<2>().cast<double>() - ground_m;
    reach = std::max({reach, a.norm() + limb.a_radius_m, b.norm() + limb.b_radius_m});
  }
  return reach;
}

double Part() { return *rc::gen::inRange(0, 101) / 100.0; }

Posture AnyPosture() {
  Posture posture;
  posture.ground_m = {20 * Part() - 10, 20 * Part() - 10};
  posture.heading_rad = 7 * Part();
  posture.speed_m_s = *rc::gen::element(0.0, 0.05, 1.0, 8.0) * Part();
  posture.gait = 50 * Part();
  posture.crouch = *rc::gen::element(0.0, 1.0) * Part();
  posture.bend = *rc::gen::element(0.0, 1.0) * Part();
  posture.sit = *rc::gen::element(0.0, 1.0) * Part();
  posture.arm_reach = Part();
  return posture;
}

RC_GTEST_PROP(Body, IsFiniteAndAboveTheGroundInEveryPosture, ()) {
  Figure figure = Someone(1.5 + 0.5 * Part());
  figure.build = 0.8 + 0.5 * Part();
  figure.legs = *rc::gen::inRange(0, 2);
  figure.stick = *rc::gen::arbitrary<bool>();
  const Posture posture = AnyPosture();
  const std::vector<Limb> limbs = BodyLimbs(figure, posture);
  RC_ASSERT(limbs.size() == (figure.stick ? 22U : 20U) + (figure.legs == figure.shorts ? 0U : 2U));
  for (const Limb& limb : limbs) {
    RC_ASSERT(limb.a_m.allFinite() && limb.b_m.allFinite());
    RC_ASSERT(limb.a_radius_m > 0 && limb.b_radius_m > 0);
    RC_ASSERT(Lowest(limb) >= -1e-3F);
  }
  RC_ASSERT(Top(limbs) < figure.height_m + 0.04);
}

RC_GTEST_PROP(Body, StandsAsTallAsItsFigureAndWalksNearlySo, ()) {
  const double height = 1.5 + 0.5 * Part();
  Posture posture;
  posture.gait = Part();
  RC_ASSERT(std::abs(Top(BodyLimbs(Someone(height), posture)) - height) < 0.01);
  posture.speed_m_s = 1.6 * Part();
  RC_ASSERT(std::abs(Top(BodyLimbs(Someone(height), posture)) - height) < 0.09);
}

RC_GTEST_PROP(Body, StaysNearItsPlaceOnTheGround, ()) {
  Posture posture = AnyPosture();
  posture.crouch = posture.bend = posture.sit = posture.arm_reach = 0;
  const double limit = posture.speed_m_s == 0 ? 0.35 : posture.speed_m_s < 2 ? 0.65 : 0.85;
  RC_ASSERT(Reach(BodyLimbs(Someone(), posture), posture.ground_m) < limit);
}

TEST(Body, TurnsWithItsHeading) {
  Posture posture;
  posture.ground_m = {3, -2};
  posture.heading_rad = std::numbers::pi / 2;
  posture.arm_reach = 1;
  for (const Limb& limb : BodyLimbs(Someone(), posture)) {
    if (limb.material == kSkin && limb.a_m.z() < 1.3F) {
      EXPECT_GT(limb.b_m.y(), -1.8F);  // hands are ahead: +y
    }
    EXPECT_NEAR(limb.a_m.x(), 3, 0.35);
  }
}

TEST(Body, SitsBendsAndCrouchesLower) {
  Posture posture;
  posture.sit = 1;
  EXPECT_NEAR(Top(BodyLimbs(Someone(), posture)), 1.35, 0.1);
  posture = {};
  posture.crouch = 1;
  EXPECT_LT(Top(BodyLimbs(Someone(), posture)), 1.4);
  posture = {};
  posture.bend = 1;
  const std::vector<Limb> bent = BodyLimbs(Someone(), posture);
  EXPECT_LT(Top(bent), 1.2);
  EXPECT_LT(std::min(Lowest(bent.back()), Lowest(bent[16])), 0.4);  // the hands come down
}

// The point of the sole that carries: the toe once the heel rises.
class BodyInMotion : public testing::TestWithParam<double> {};

TEST_P(BodyInMotion, StandingFootStaysWhereItIs) {
  const double speed = GetParam();
  const double dt = 0.005;
  Posture posture;
  posture.speed_m_s = speed;
  std::array<std::optional<Eigen::Vector2f>, 2> down;
  int steps = 0;
  int grounded = 0;
  const int count = 1000;
  for (int i = 0; i < count; ++i) {
    const std::vector<Limb> feet = Made(BodyLimbs(Someone(), posture), kShoes);
    ASSERT_EQ(feet.size(), 2U);
    bool any = false;
    for (std::size_t foot = 0; foot < 2; ++foot) {
      const float toe_up = feet[foot].b_m.z() - feet[foot].b_radius_m;
      const float heel_up = feet[foot].a_m.z() - feet[foot].a_radius_m;
      if (std::min(toe_up, heel_up) > 0.001F) {
        down[foot].reset();
        continue;
      }
      any = true;
      if (toe_up > 0.001F) continue;  // still rolls over the heel
      const Eigen::Vector2f toe = feet[foot].b_m.head<2>();
      if (!down[foot]) {
        down[foot] = toe;
        ++steps;
      }
      EXPECT_LT((*down[foot] - toe).norm(), 0.02) << "speed " << speed << " at " << i * dt << " s";
    }
    grounded += any ? 1 : 0;
    posture.ground_m.x() += speed * dt;
    posture.gait = AdvanceGait(posture.gait, speed, 1.75, dt);
  }
  if (speed < 1.5) {
    EXPECT_EQ(grounded, count);  // walkers never fly
  }
  if (speed > 3) {
    EXPECT_LT(grounded, 0.85 * count);  // runners do
  }
  EXPECT_NEAR(steps, 2 * posture.gait, 2.5);
}

TEST_P(BodyInMotion, LooksMirroredHalfAStrideLater) {
  Posture now;
  now.speed_m_s = GetParam();
  Posture later = now;
  for (double gait = 0; gait < 1; gait += 0.07) {
    now.gait = gait;
    later.gait = gait + 0.5;
    std::vector<Limb> mirrored = BodyLimbs(Someone(), later);
    for (Limb& limb : mirrored) {
      limb.a_m.y() *= -1;
      limb.b_m.y() *= -1;
    }
    for (const Limb& limb : BodyLimbs(Someone(), now)) {
      EXPECT_TRUE(std::any_of(mirrored.begin(), mirrored.end(), [&](const Limb& other) {
        return limb.material == other.material &&
               (((limb.a_m - other.a_m).norm() < 1e-4F && (limb.b_m - other.b_m).norm() < 1e-4F) ||
                ((limb.a_m - other.b_m).norm() < 1e-4F && (limb.b_m - other.a_m).norm() < 1e-4F));
      }));
    }
  }
}

TEST_P(BodyInMotion, MovesSmoothly) {
  const double speed = GetParam();
  const double dt = 0.005;
  Posture posture;
  posture.speed_m_s = speed;
  Figure figure = Someone();
  figure.stick = true;
  std::vector<Limb> before = BodyLimbs(figure, posture);
  for (int i = 0; i < 400; ++i) {
    posture.gait = AdvanceGait(posture.gait, speed, 1.75, dt);
    std::vector<Limb> after = BodyLimbs(figure, posture);
    for (std::size_t k = 0; k < after.size(); ++k) {
      EXPECT_LT((after[k].a_m - before[k].a_m).norm() / dt, 2 + 2.2 * speed) << k << " at " << i;
      EXPECT_LT((after[k].b_m - before[k].b_m).norm() / dt, 2 + 2.2 * speed) << k << " at " << i;
    }
    before = std::move(after);
  }
}

INSTANTIATE_TEST_SUITE_P(Speeds, BodyInMotion, testing::Values(0.4, 0.9, 1.4, 2.0, 2.6, 4.0, 6.5));

TEST(AdvanceGait, StandsStillAtNoSpeedAndTakesLongerStridesWhenFaster) {
  EXPECT_EQ(AdvanceGait(0.3, 0, 1.75, 1), 0.3);
  double stride = 0;
  for (const double speed : {0.5, 1.4, 3.0, 6.0}) {
    const double longer = speed / AdvanceGait(0, speed, 1.75, 1);
    EXPECT_GT(longer, stride);
    stride = longer;
  }
  EXPECT_NEAR(1.4 / AdvanceGait(0, 1.4, 1.75, 1), 1.5, 0.1);
}

}  // namespace
}  // namespace vantage::simulation
