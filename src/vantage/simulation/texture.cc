// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/simulation/texture.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "vantage/simulation/hash.h"

namespace vantage::simulation::internal {
namespace {

using Eigen::Vector2f;
using Eigen::Vector3f;

/// Index of the unit cell that x lies in, safe for any finite x.
std::int64_t Cell(float x) {
  return static_cast<std::int64_t>(std::floor(std::clamp(x, -1e9F, 1e9F)));
}

float Fraction(float x) { return x - std::floor(x); }

float Lattice(std::int64_t i, std::int64_t j, std::uint32_t seed) {
  return UpperUnit(Hash(seed, i, j));
}

/// Smooth noise in [0, 1] with features of size 1 (value noise).
float Noise(float x, float y, std::uint32_t seed) {
  const std::int64_t i = Cell(x);
  const std::int64_t j = Cell(y);
  const float fx = Fraction(x);
  const float fy = Fraction(y);
  const float sx = fx * fx * (3 - 2 * fx);
  const float sy = fy * fy * (3 - 2 * fy);
  const float low = std::lerp(Lattice(i, j, seed), Lattice(i + 1, j, seed), sx);
  const float high = std::lerp(Lattice(i, j + 1, seed), Lattice(i + 1, j + 1, seed), sx);
  return std::lerp(low, high, sy);
}

Vector3f Blend(const Material& m, float share_of_second) {
  return m.color + share_of_second * (m.second - m.color);
}

Vector3f Speckle(const Material& m, float x, float y) {
  return Blend(m, 0.65F * Noise(x, y, m.seed) + 0.35F * Noise(3.1F * x, 3.1F * y, m.seed + 1));
}

Vector3f Plaid(const Material& m, float x, float y) {
  const auto band = [](float v) {
    const float f = Fraction(v);
    return f < 0.35F ? 0.5F : (f > 0.62F && f < 0.70F ? 0.3F : 0.0F);
  };
  return Blend(m, band(x) + band(y));
}

Vector3f Bricks(const Material& m, float x, float y) {
  constexpr float kCourse = 1.0F / 3;  // height of a brick with its mortar, of its length
  constexpr float kMortar = 0.045F;
  const std::int64_t row = Cell(y / kCourse);
  const float along = x + (row % 2 == 0 ? 0.0F : 0.5F);
  const std::int64_t column = Cell(along);
  if (Fraction(along) < kMortar || Fraction(y / kCourse) * kCourse < kMortar) {
    return m.second * (0.9F + 0.2F * Noise(9 * x, 9 * y, m.seed));
  }
  const float shade = 0.75F + 0.5F * Lattice(column, row, m.seed);
  return m.color * shade * (0.9F + 0.2F * Noise(7 * x, 7 * y, m.seed + 1));
}

Vector3f Planks(const Material& m, float x, float y) {
  constexpr float kLength = 14;  // of a board's width
  constexpr float kJoint = 0.035F;
  const std::int64_t row = Cell(y);
  const float along = x / kLength + 7.0F * Lattice(row, 0, m.seed);
  const std::int64_t column = Cell(along);
  if (Fraction(y) < kJoint || Fraction(along) * kLength < kJoint) return m.second;
  const float shade = 0.85F + 0.3F * Lattice(column, row, m.seed + 1);
  const float grain = Noise(0.7F * x, 9 * y, m.seed + 2);
  return m.color * shade * (0.92F + 0.16F * grain);
}

/// Rows of invented characters of 3 x 5 dots with words between blanks.
Vector3f Letters(const Material& m, float x, float y) {
  constexpr float kLine = 1.5F;     // of the height of a letter
  constexpr float kAdvance = 0.8F;  // 4 dots of 1/5
  const std::int64_t line = Cell(y / kLine);
  const float up = y - static_cast<float>(line) * kLine;
  const float column = x / kAdvance + 5.0F * Lattice(line, 3, m.seed);
  const std::int64_t letter = Cell(column);
  const std::int64_t dot_x = Cell(Fraction(column) * 4);
  const std::int64_t dot_y = Cell(up * 5);
  if (up >= 1 || dot_x >= 3 || Lattice(letter, line, m.seed) < 0.2F) return m.color;
  const std::uint64_t shape = Hash(m.seed, letter, line, 7);
  // Strokes rather than dots: the left column is always there, the rest by the letter's bits.
  const bool ink =
      dot_x == 0 || ((shape >> static_cast<unsigned>(dot_y * 2 + dot_x - 1)) & 1U) != 0;
  return ink ? m.second : m.color;
}

Vector3f Grass(const Material& m, float x, float y) {
  const float fine = Noise(4 * x, 4 * y, m.seed);
  const float coarse = Noise(0.31F * x, 0.31F * y, m.seed + 1);
  const float share = 0.5F + 1.3F * (fine - 0.5F) + 0.6F * (coarse - 0.5F);
  return Blend(m, std::clamp(share, 0.0F, 1.0F));
}

}  // namespace

Vector3f TextureColor(const Material& material, const Vector2f& place_m) {
  const float x = place_m.x() / material.scale_m;
  const float y = place_m.y() / material.scale_m;
  switch (material.pattern) {
    case Material::Pattern::kPlain:
      return material.color;
    case Material::Pattern::kSpeckle:
      return Speckle(material, x, y);
    case Material::Pattern::kStripes:
      return Cell(x) % 2 == 0 ? material.color : material.second;
    case Material::Pattern::kChecks:
      return (Cell(x) + Cell(y)) % 2 == 0 ? material.color : material.second;
    case Material::Pattern::kPlaid:
      return Plaid(material, x, y);
    case Material::Pattern::kBricks:
      return Bricks(material, x, y);
    case Material::Pattern::kPlanks:
      return Planks(material, x, y);
    case Material::Pattern::kLetters:
      return Letters(material, x, y);
    case Material::Pattern::kGrass:
      return Grass(material, x, y);
  }
  return material.color;
}

Vector2f PlaceOnPlane(const Vector3f& point_m, const Vector3f& normal) {
  if (std::abs(normal.z()) > 0.9F) return point_m.head<2>();
  const Vector2f level = Vector2f(-normal.y(), normal.x()).normalized();
  // Turned to the positive side, so that both faces of a wall carry the same pattern.
  const float sign = level.x() + 0.5F * level.y() < 0 ? -1.0F : 1.0F;
  return {sign * level.dot(point_m.head<2>()), point_m.z()};
}

Vector2f PlaceOnLimb(const Limb& limb, const Vector3f& point_m) {
  Vector3f axis = limb.b_m - limb.a_m;
  const float length = axis.norm();
  axis = length > 1e-6F ? Vector3f(axis / length) : Vector3f::UnitZ();
  const Vector3f reference = std::abs(axis.z()) > 0.5F ? Vector3f::UnitX() : Vector3f::UnitZ();
  const Vector3f side = axis.cross(reference).normalized();
  const Vector3f from_a = point_m - limb.a_m;
  const float angle = std::atan2(from_a.dot(axis.cross(side)), from_a.dot(side));
  const float girth = 0.5F * (limb.a_radius_m + limb.b_radius_m);
  return {from_a.dot(axis), angle * girth};
}

float MirroredShare(float gloss, float cosine) {
  if (gloss <= 0) return 0;
  const float miss = 1 - std::clamp(cosine, 0.0F, 1.0F);
  const float miss2 = miss * miss;
  return gloss + (1 - gloss) * miss2 * miss2 * miss;
}

}  // namespace vantage::simulation::internal
