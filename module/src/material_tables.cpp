#include "material_tables.h"

#include <cstring>

#include "frame.h"
#include "transmittance.h"

namespace pellucid {

void makeTables(const PellucidMaterial& m, MaterialTables* tables) {
  tables->material = m;
  tables->halfThickness = static_cast<float>(halfThickness(m));
  tables->opaqueThickness = static_cast<float>(opaqueThickness(m));
  tables->gather = {};
  if (canBeGathered(m.transmittanceModel) && m.thinWalled == 0) tables->gather = gatherConstants(m);
  tables->kernel = kernelConstants(m);
}

}  // namespace pellucid

using namespace pellucid;

extern "C" PellucidResult pellucidMakeMaterialTables(const PellucidMaterial* material,
                                                     PellucidMaterialTables* tables) {
  if (!material || !tables) return PELLUCID_ERROR_INVALID_ARGUMENT;
  Inputs inputs;  // with nothing but the material
  inputs.frame.materials = material;
  inputs.frame.materialCount = 1;
  Findings silent;
  checkMaterials(inputs, silent);
  if (!silent.ok()) return silent.result();
  MaterialTables made;
  makeTables(inputs.material(0), &made);
  *tables = {};
  std::memcpy(tables->words, &made, sizeof made);
  return PELLUCID_OK;
}
