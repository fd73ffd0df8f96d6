// All that recordings take from a material alone. Pure.
#pragma once

#include "pellucid/pellucid.h"
#include "shared/pellucid_shared.h"

namespace pellucid {

// As PellucidMaterialTables holds it.
struct MaterialTables {
  PellucidMaterial material;  // that it was made from, as Inputs::material has it
  float halfThickness, opaqueThickness;
  shared::GatherConstants gather;  // zeros for models without a gather
  shared::KernelConstants kernel;
};
static_assert(sizeof(MaterialTables) <= sizeof(PellucidMaterialTables));

// Constants of the gather for one material, whose transmittance model must be one of canBeGathered (docs/how-it-works.md).
shared::GatherConstants gatherConstants(const PellucidMaterial& material);

// How far from a surface its probes look for entry points, mm.
float gatherReach(const shared::GatherConstants& gather, uint32_t samples);

// The diffusion profile as the pyramid's passes read it. All zeros (the pixel keeps everything) for a material
// without Gaussians.
shared::KernelConstants kernelConstants(const PellucidMaterial& material);

// The material has passed checkMaterials.
void makeTables(const PellucidMaterial& material, MaterialTables* tables);

}  // namespace pellucid
