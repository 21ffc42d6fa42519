// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "vantage/simulation/body.h"
#include "vantage/simulation/dice.h"

namespace vantage::simulation {

/// Adds a material and says which it is.
MaterialIndex AddMaterial(std::vector<Material>& materials, const Material& material);

/// Somebody in everyday clothes: build, skin, hair, shirt (plain, striped, plaid, speckled), coat
/// or pullover, trousers or shorts. A good part wears dark clothes, as people do, which hide well
/// on dark ground. Their materials are added.
Figure DressUp(std::vector<Material>& materials, Dice& dice);

}  // namespace vantage::simulation
