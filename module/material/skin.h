// Layered human skin.
#pragma once

#include "pellucid/pellucid_material.h"
#include "source.h"

namespace pellucid::material {

// Donner & Jensen 2005, "Light Diffusion in Multi-Layered Translucent Materials": epidermis, upper dermis,
// bloody dermis.
Description threeLayerSkin(double ior);

// Donner & Jensen 2006, "A Spectral BSSRDF for Shading Human Skin": epidermis on dermis. Fractions in
// [0, 1]: melanin C_m, share of eumelanin beta_m, hemoglobin C_h.
struct Physiology {
  double melanin, melaninType, hemoglobin;
};
Description physiologicalSkin(const Physiology& physiology, PellucidIlluminant illuminant, double ior);

}  // namespace pellucid::material
