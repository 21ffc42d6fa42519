// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

#include "vantage/simulation/stage.h"

/// Internal to the simulation module: what colour a material has at a place of its surface.

namespace vantage::simulation::internal {

/// Linear reflectance at `place_m`, metres along the two axes of the surface.
Eigen::Vector3f TextureColor(const Material& material, const Eigen::Vector2f& place_m);

/// Place on a flat surface: for level ones (x, y), for others along the level line in the surface,
/// and up. `normal` has unit length; both are in the frame that the texture is fixed to.
Eigen::Vector2f PlaceOnPlane(const Eigen::Vector3f& point_m, const Eigen::Vector3f& normal);

/// Place on a limb: along its axis from a, and around it, as metres of its mean girth.
Eigen::Vector2f PlaceOnLimb(const Limb& limb, const Eigen::Vector3f& point_m);

/// Share of light mirrored by a material with this gloss whose normal makes an angle of this
/// cosine with the ray (Schlick, 1994); 0 where the gloss is 0.
float MirroredShare(float gloss, float cosine);

}  // namespace vantage::simulation::internal
