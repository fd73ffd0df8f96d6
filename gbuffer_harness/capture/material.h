// From a manifest's description of a material to what the shaders evaluate.
#pragma once

#include <string>
#include <vector>

#include "capture/capture.h"
#include "common/error.h"
#include "pellucid/pellucid_material.h"

namespace pellucid::harness {

// Calls the material compiler with a message function and its user pointer. Throws InputError with what it
// complains of.
template <class Call>
void requireMaterial(const std::string& where, Call&& call) {
  struct Complaint {
    std::string field, sentence;
  } complaint;
  const PellucidMessageFn note = [](void* user, PellucidSeverity severity, const char* field,
                                    const char* message) {
    if (severity == PELLUCID_SEVERITY_ERROR) *static_cast<Complaint*>(user) = {field, message};
  };
  const PellucidResult result = call(note, static_cast<void*>(&complaint));
  if (result == PELLUCID_OK) return;
  if (complaint.sentence.empty()) complaint.sentence = pellucidResultName(result);
  throw InputError(where, complaint.field, complaint.sentence);
}

// Through the material compiler (pellucid_material.h); milliseconds. `where` stands before the field in
// errors ("capture.json: materials[0]"). Throws InputError for a description the compiler refuses.
PellucidMaterial compileMaterial(const MaterialSource& source, const std::string& where);

// The description that the compiler takes, and `pellucid material` prints; its pointers are into `source`.
// Throws InputError as compileMaterial() does.
PellucidMaterialDesc describeMaterial(const MaterialSource& source, const std::string& where);

// The material with this index of refraction, [1, 3], in place of its own. Throws InputError where no
// scattering coefficients define it: a profile's boundary is part of the profile. An OpenPBR medium keeps its
// color, and skin by physiology its layers.
MaterialSource withIor(const MaterialSource& source, double ior, const std::string& where);

// The scattering coefficients that a material is made of. Throws InputError likewise, and for skin of layers.
CoefficientMaterial coefficientsOf(const MaterialSource& source, const std::string& where);

// Every material of a capture, in order.
std::vector<PellucidMaterial> compileMaterials(const Capture& capture);

}  // namespace pellucid::harness
