// All that shaders read of a material alone, as PellucidMaterial::tables holds it. Pure.
#pragma once

#include <cstring>

#include "pellucid/pellucid.h"
#include "shared/pellucid_shared.h"

namespace pellucid {

struct MaterialTables {
  uint64_t fingerprint;  // of the fields that the tables were made from
  shared::MaterialConstants constants;
  shared::KernelConstants kernel;
};
static_assert(sizeof(MaterialTables) <= sizeof(PellucidMaterial::tables));

inline MaterialTables tablesOf(const PellucidMaterial& material) {
  MaterialTables tables;
  std::memcpy(&tables, material.tables, sizeof tables);
  return tables;
}

// The tables are of the material's fields.
bool hasTables(const PellucidMaterial& material);

// Constants of the gather for one material, whose transmittance model must be one of canBeGathered (docs/how-it-works.md).
shared::GatherConstants gatherConstants(const PellucidMaterial& material);

// How far from a surface its probes look for entry points, mm.
float gatherReach(const shared::GatherConstants& gather, uint32_t samples);

// The diffusion profile as the pyramid's passes read it. All zeros (the pixel keeps everything) for a material
// without Gaussians.
shared::KernelConstants kernelConstants(const PellucidMaterial& material);

}  // namespace pellucid
