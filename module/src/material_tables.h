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

// The material has passed checkMaterials.
void makeTables(const PellucidMaterial& material, MaterialTables* tables);

}  // namespace pellucid
