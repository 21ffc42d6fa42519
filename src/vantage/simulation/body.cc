// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/simulation/body.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

// The body is built in a frame of its own: x forward, y left, z up, origin on the ground below the
// hips. Lengths are those of a person 1.75 m tall (D. Winter, Biomechanics of Human Movement, table
// of segment lengths), scaled.

namespace vantage::simulation {
namespace {

using Eigen::Vector3d;
using std::numbers::pi;

constexpr double kTall = 1.75;
constexpr double kThigh = 0.425, kShin = 0.42, kLeg = kThigh + kShin;
constexpr double kUpperArm = 0.30, kForearm = 0.25;
constexpr double kStraight = 0.985;  // of a leg that carries
constexpr double kHipSide = 0.085, kShoulderSide = 0.165, kShoulderUp = 0.50;
// The foot is one round cone from heel to toe with the ankle above the heel.
constexpr double kFoot = 0.185, kHeelRadius = 0.042, kToeRadius = 0.034;
constexpr double kAnkleAhead = 0.02, kAnkleUp = 0.088;
constexpr double kHeadTop = 1.75;

double Smooth(double from, double to, double x) {
  const double t = std::clamp((x - from) / (to - from), 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

double Cadence(double speed_m_s, double height_m) {  // strides per second
  return 0.85 * std::pow(speed_m_s, 0.33) * std::sqrt(kTall / height_m);
}

// Share of a stride that a foot is on the ground: above one half when walking, below when running.
double Duty(double speed_m_s) {
  const double walk = 0.62 - 0.04 * std::min(speed_m_s, 2.0);
  const double run = 0.36 - 0.036 * std::clamp(speed_m_s - 2.4, 0.0, 4.2);
  return std::lerp(walk, run, Smooth(1.5, 2.6, speed_m_s));
}

// One gait at one speed, in lengths of a person kTall tall.
struct Gait {
  double speed = 0;   // of that person
  double stride = 0;  // covered in one stride
  double duty = 0;
  double run = 0;     // 0 walks, 1 runs
  double moving = 0;  // 0 stands
  double sweep = 0;   // covered while a foot stands
  double ahead = 0;   // of the ankle when its foot is put down
  double pelvis = 0;  // how far a hip goes ahead with its leg
};

Gait GaitOf(double speed_m_s, double height_m) {
  Gait gait;
  const double scale = height_m / kTall;
  gait.speed = speed_m_s;
  gait.stride = speed_m_s > 0 ? speed_m_s / Cadence(speed_m_s, height_m) / scale : 0;
  gait.duty = Duty(speed_m_s);
  gait.run = Smooth(1.8, 2.8, speed_m_s);
  gait.moving = Smooth(0, 1.2, speed_m_s);
  gait.sweep = gait.stride * gait.duty;
  gait.ahead = std::lerp(0.44, 0.36, gait.run) * gait.sweep;
  gait.pelvis = 0.04 * gait.moving;
  return gait;
}

// Where a foot is: the place of its ankle were it flat, how high it is lifted, and its pitch (heel
// up is positive).
struct Step {
  double ankle_x = 0;
  double lift = 0;
  double pitch_rad = 0;
};

Step StepAt(const Gait& gait, double phase) {
  Step step;
  phase -= std::floor(phase);
  const double push_rad = gait.moving * 0.75;
  const double strike_rad = -0.3 * gait.moving * (1 - gait.run);
  if (phase < gait.duty) {  // on the ground: goes back as fast as the body advances
    const double t = phase / gait.duty;
    step.ankle_x = gait.ahead - gait.stride * phase;
    step.pitch_rad = strike_rad * (1 - Smooth(0, 0.25, t)) + push_rad * Smooth(0.5, 1.0, t);
    return step;
  }
  const double t = (phase - gait.duty) / (1 - gait.duty);
  const double from = gait.ahead - gait.sweep;
  // A cubic that lands with the ground's speed, so that the foot does not skid.
  const double slope = -gait.stride * (1 - gait.duty);
  step.ankle_x =
      from + gait.sweep * t * t * (3 - 2 * t) + slope * t * (1 - t) * (0.6 * (1 - t) - t);
  const double early = std::pow(std::sin(pi * std::pow(t, 0.75)), 2);
  step.lift = Smooth(0, 0.5, gait.speed) * early *
              (0.06 + gait.run * (0.12 + 0.05 * std::clamp(gait.speed - 2, 0.0, 5.0)));
  step.pitch_rad = std::lerp(push_rad, strike_rad, Smooth(0.1, 1, t)) + 0.7 * gait.run * early;
  return step;
}

// The joint between two links that reach from `from` towards `to`, bent towards `hint`; `to` is
// drawn in when it is out of reach.
Vector3d Bend(const Vector3d& from, Vector3d& to, double first, double second,
              const Vector3d& hint) {
  Vector3d along = to - from;
  const double wanted = std::max(along.norm(), 1e-6);
  along /= wanted;
  const double length = first + second;
  double reach = std::max(wanted, std::abs(first - second) + 0.02);
  if (const double soft = 0.975 * length, left = 0.024 * length; reach > soft) {
    reach = soft + left * std::tanh((reach - soft) / left);  // the joint straightens gently
  }
  to = from + reach * along;
  const double share = (first * first - second * second + reach * reach) / (2 * reach);
  const double out = std::sqrt(std::max(0.0, first * first - share * share));
  Vector3d side = hint - hint.dot(along) * along;
  if (side.squaredNorm() < 1e-12) side = along.unitOrthogonal();
  return from + share * along + out * side.normalized();
}

class Builder {
 public:
  Builder(const Figure& figure, const Posture& posture)
      : figure_(figure),
        posture_(posture),
        gait_(GaitOf(std::clamp(posture.speed_m_s, 0.0, 12.0), figure.height_m)),
        phase_(posture.gait - std::floor(posture.gait)),
        scale_(figure.height_m / kTall) {
    limbs_.reserve(24);
    PlaceTrunk();
  }

  std::vector<Limb> Build() {
    Trunk();
    for (const double side : {1.0, -1.0}) Leg(side);
    std::array<Vector3d, 2> hands = {Hand(1), Hand(-1)};
    if (figure_.stick) Stick(hands);
    for (const double side : {1.0, -1.0}) Arm(side, hands[side > 0 ? 0 : 1]);
    return std::move(limbs_);
  }

 private:
  void PlaceTrunk() {
    const double crouch = posture_.crouch;
    const double sit = posture_.sit;
    const double bend = posture_.bend;
    // The hips are as high as the leg that is just put down allows; walkers rise over the standing
    // foot, runners sink there and fly between the steps.
    const double reach = kStraight * kLeg;
    const double ahead = std::max(0.0, gait_.ahead - gait_.pelvis);
    const double low = std::sqrt(reach * reach - std::min(ahead * ahead, 0.5)) + kAnkleUp;
    const double rise = 0.3 * (reach + kAnkleUp - low);
    const double bob = std::lerp(rise, -0.035, gait_.run);
    const double base = low + std::lerp(rise, -0.025, gait_.run);
    const double mid_stance = 2 * pi * (phase_ - gait_.duty / 2);
    double z = base + bob * std::cos(2 * mid_stance);
    z -= 0.30 * crouch + 0.24 * bend;
    z = std::lerp(z, 0.45 / scale_ + 0.10, sit);
    const double sway = 0.015 * gait_.moving * (1 - gait_.run) * std::cos(mid_stance);
    hips_ = {-0.08 * crouch - 0.16 * bend, sway, z};
    lean_rad_ = (0.03 + 0.12 * gait_.run * std::min(gait_.speed / 4, 1.6)) * gait_.moving +
                0.55 * crouch + 1.2 * bend + 0.12 * sit;
    lean_rad_ = std::min(lean_rad_, 1.4);
    up_ = {std::sin(lean_rad_), 0, std::cos(lean_rad_)};
    front_ = {std::cos(lean_rad_), 0, -std::sin(lean_rad_)};
    // The shoulders turn against the hips: the left foot is put down at phase 0.
    twist_rad_ = -0.16 * gait_.moving * (1 - 0.4 * sit) * std::cos(2 * pi * phase_);
  }

  // A point of the upper body, given relative to the hips.
  Vector3d OnTrunk(double ahead, double left, double up, bool twisted = true) const {
    const double twist = twisted ? twist_rad_ * std::clamp(up / kShoulderUp, 0.0, 1.0) : 0;
    const double x = ahead * std::cos(twist) - left * std::sin(twist);
    const double y = ahead * std::sin(twist) + left * std::cos(twist);
    return hips_ + x * front_ + Vector3d(0, y, 0) + up * up_;
  }

  void Add(const Vector3d& a, const Vector3d& b, double a_radius, double b_radius,
           MaterialIndex material) {
    Limb limb;
    limb.a_m = World(a);
    limb.b_m = World(b);
    limb.a_radius_m = static_cast<float>(a_radius * scale_);
    limb.b_radius_m = static_cast<float>(b_radius * scale_);
    limb.material = material;
    limbs_.push_back(limb);
  }

  Eigen::Vector3f World(const Vector3d& own) const {
    const double c = std::cos(posture_.heading_rad), s = std::sin(posture_.heading_rad);
    const Vector3d world(posture_.ground_m.x() + scale_ * (c * own.x() - s * own.y()),
                         posture_.ground_m.y() + scale_ * (s * own.x() + c * own.y()),
                         scale_ * own.z());
    return world.cast<float>();
  }

  void Trunk() {
    const double girth = figure_.build;
    Add(OnTrunk(0, 0.07, -0.01), OnTrunk(0, -0.07, -0.01), 0.108 * girth, 0.108 * girth,
        figure_.shorts);
    // Three cones side by side: wider than deep.
    Add(OnTrunk(0.005, 0, 0.06), OnTrunk(0.0, 0, 0.42), 0.118 * girth, 0.112 * girth,
        figure_.shirt);
    for (const double side : {1.0, -1.0}) {
      Add(OnTrunk(0, 0.062 * side, 0.06), OnTrunk(0, 0.092 * side, 0.40), 0.104 * girth,
          0.095 * girth, figure_.shirt);
    }
    Add(OnTrunk(0, kShoulderSide - 0.03, kShoulderUp - 0.01),
        OnTrunk(0, 0.03 - kShoulderSide, kShoulderUp - 0.01), 0.062 * girth, 0.062 * girth,
        figure_.shirt);
    // The head stays upright longer than the back; standing, its hair ends at the height.
    const Vector3d neck = OnTrunk(0.0, 0, kShoulderUp + 0.03);
    const double nod = 0.35 * lean_rad_;
    const Vector3d up(std::sin(nod), 0, std::cos(nod));
    const Vector3d front(std::cos(nod), 0, -std::sin(nod));
    const double standing_neck = kStraight * kLeg + kAnkleUp + kShoulderUp + 0.03;
    const Vector3d skull = neck + (kHeadTop - 0.10 - standing_neck) * up + 0.01 * front;
    Add(neck, neck + 0.07 * up, 0.058 * girth, 0.052, figure_.skin);
    Add(skull - 0.055 * up + 0.03 * front, skull + 0.012 * front, 0.066, 0.086, figure_.skin);
    Add(skull + 0.006 * up - 0.012 * front, skull - 0.03 * up - 0.025 * front, 0.094, 0.085,
        figure_.hair);
  }

  void Leg(double side) {
    const Step step = StepAt(gait_, phase_ + (side > 0 ? 0 : 0.5));
    const double pelvis = gait_.pelvis * side * std::cos(2 * pi * phase_);
    const Vector3d hip = hips_ + Vector3d(pelvis, kHipSide * side, 0);
    const double apart =
        std::lerp(0.10, 0.065, gait_.moving) + 0.16 * posture_.crouch + 0.03 * posture_.sit;
    const double flat_x = step.ankle_x + 0.40 * posture_.sit;
    // Heel up turns the foot about its toe, toe up about its heel.
    const double flat_rad = std::asin((kHeelRadius - kToeRadius) / kFoot);
    const double pitch_rad = step.pitch_rad + flat_rad;
    const Vector3d along(std::cos(pitch_rad), 0, -std::sin(pitch_rad));
    const Vector3d above(std::sin(pitch_rad), 0, std::cos(pitch_rad));
    Vector3d heel(flat_x - kAnkleAhead, apart * side, kHeelRadius + step.lift);
    if (step.pitch_rad > 0) {
      heel += kFoot * (Vector3d(std::cos(flat_rad), 0, -std::sin(flat_rad)) - along);
    }
    Vector3d ankle = heel + kAnkleAhead * along + (kAnkleUp - kHeelRadius) * above;
    const Vector3d wanted = ankle;
    const Vector3d knee_to(1, 0.12 * side + 0.35 * side * posture_.crouch, 0.1);
    const Vector3d knee = Bend(hip, ankle, kThigh, kShin, knee_to);
    heel += ankle - wanted;
    Vector3d toe = heel + kFoot * along;
    heel.z() = std::max(heel.z(), kHeelRadius);
    toe.z() = std::max(toe.z(), kToeRadius);
    const double girth = figure_.build;
    if (figure_.legs == figure_.shorts) {  // trousers
      Add(hip, knee, 0.088 * girth, 0.058 * girth, figure_.shorts);
    } else {  // bare knees below shorts
      Add(hip, hip + 0.62 * (knee - hip), 0.092 * girth, 0.080 * girth, figure_.shorts);
      Add(hip, knee, 0.078 * girth, 0.055 * girth, figure_.skin);
    }
    Add(knee, ankle, 0.056 * girth, 0.038, figure_.legs);
    Add(heel, toe, kHeelRadius, kToeRadius, figure_.shoes);
  }

  Vector3d Shoulder(double side) const {
    return OnTrunk(0, kShoulderSide * side, kShoulderUp - 0.02);
  }

  // A hand that swings against the leg of its side, or reaches forward.
  Vector3d Hand(double side) const {
    const double swing = gait_.moving * std::min(0.35 + 0.09 * gait_.speed, 0.85);
    const double angle = 0.2 * lean_rad_ - side * swing * std::cos(2 * pi * phase_);
    const double elbow = 0.25 + 1.2 * gait_.run + 0.1 * gait_.moving + 0.8 * posture_.sit;
    const double aside = 0.10 + 0.06 * gait_.run;
    const Vector3d upper(std::sin(angle), side * aside, -std::cos(angle));
    const Vector3d lower(std::sin(angle + elbow), side * (aside - 0.25 * std::sin(elbow)),
                         -std::cos(angle + elbow));
    const Vector3d swinging =
        Shoulder(side) + kUpperArm * upper.normalized() + kForearm * lower.normalized();
    const Vector3d forward =
        0.5 * (Shoulder(1) + Shoulder(-1)) + Vector3d(0.38, 0.16 * side, -0.28);
    return swinging + posture_.arm_reach * (forward - swinging);
  }

  // A stick held in both hands, its blade on the floor in front and to the right.
  void Stick(std::array<Vector3d, 2>& hands) {
    const Vector3d middle = 0.5 * (Shoulder(1) + Shoulder(-1));
    const double swing = 0.05 * gait_.moving * std::cos(2 * pi * phase_);
    Vector3d top = middle + Vector3d(0.20, 0.06 + swing, -0.44);
    top.z() = std::clamp(top.z(), 0.30, 1.0);
    const double blade_z = 0.025 + 0.06 * gait_.run;
    const double length = 1.08;
    const double ground = std::sqrt(length * length - std::pow(top.z() - blade_z, 2));
    const double aside = 0.45 - swing;
    const Vector3d blade =
        Vector3d(top.x() + ground * std::cos(aside), top.y() - ground * std::sin(aside), blade_z);
    Add(top, blade, 0.017, 0.013, figure_.stick_material);
    Add(blade, blade + Vector3d(0.2, 0.06, 0), 0.025, 0.02, figure_.stick_material);
    hands[0] = top + 0.05 * (blade - top);
    hands[1] = top + 0.32 * (blade - top);
  }

  void Arm(double side, Vector3d hand) {
    const Vector3d shoulder = Shoulder(side);
    const Vector3d elbow =
        Bend(shoulder, hand, kUpperArm, kForearm, Vector3d(-0.8, 0.5 * side, -0.5));
    hand.z() = std::max(hand.z(), 0.06);
    const double girth = figure_.build;
    Add(shoulder, elbow, 0.056 * girth, 0.044 * girth, figure_.sleeves);
    Add(elbow, hand, 0.041 * girth, 0.032, figure_.long_sleeves ? figure_.sleeves : figure_.skin);
    const Vector3d fingers = hand + 0.06 * (hand - elbow).normalized();
    Add(hand, {fingers.x(), fingers.y(), std::max(fingers.z(), 0.05)}, 0.038, 0.034, figure_.skin);
  }

  const Figure& figure_;
  const Posture& posture_;
  Gait gait_;
  double phase_;
  double scale_;
  Vector3d hips_;
  Vector3d up_;
  Vector3d front_;
  double lean_rad_ = 0;
  double twist_rad_ = 0;
  std::vector<Limb> limbs_;
};

}  // namespace

double AdvanceGait(double gait, double speed_m_s, double height_m, double seconds) {
  if (!(speed_m_s > 0)) return gait;
  return gait + Cadence(std::min(speed_m_s, 12.0), height_m) * seconds;
}

std::vector<Limb> BodyLimbs(const Figure& figure, const Posture& posture) {
  return Builder(figure, posture).Build();
}

}  // namespace vantage::simulation
