// From a manifest's description of a material to what the shaders evaluate.
#pragma once

#include <string>
#include <vector>

#include "capture/capture.h"

namespace pellucid::harness {

// Through the material compiler (pellucid_material.h); milliseconds. `where` stands before the field in
// errors ("capture.json: materials[0]"). Throws InputError for a description the compiler refuses.
PellucidMaterial compileMaterial(const MaterialSource& source, const std::string& where);

// The material with this index of refraction, [1, 3], in place of its own. Throws InputError where no
// scattering coefficients define it: a profile's boundary is part of the profile.
CoefficientMaterial withIor(const MaterialSource& source, double ior, const std::string& where);

// The scattering coefficients that a material is made of. Throws InputError likewise, and for layered skin.
CoefficientMaterial coefficientsOf(const MaterialSource& source, const std::string& where);

// Every material of a capture, in order.
std::vector<PellucidMaterial> compileMaterials(const Capture& capture);

}  // namespace pellucid::harness
