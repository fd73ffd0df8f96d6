#include "inputs.h"

#include <algorithm>

#include "struct_size.h"

namespace pellucid {

PellucidMaterial Inputs::material(uint32_t index) const {
  // The caller's structs lie as far apart as each is long.
  const auto* bytes = reinterpret_cast<const unsigned char*>(frame.materials);
  const size_t offset = static_cast<size_t>(index) * frame.materials->structSize;
  PellucidMaterial m =
      readStruct(reinterpret_cast<const PellucidMaterial*>(bytes + offset), PellucidMaterial{});
  if (m.thinWalled == 0) return m;
  m.transmittanceModel = PELLUCID_TRANSMITTANCE_EXP2;
  for (int c = 0; c < 3; ++c) {
    std::fill_n(m.transmittance[c], 5, 0.0f);
    m.transmittance[c][0] = m.wallTransmittance[c];
  }
  return m;
}

PellucidMaterial Inputs::diffused(uint32_t index) const {
  PellucidMaterial m = material(index);
  m.gaussianCount = diffusedCount(m);
  return m;
}

bool readInputs(const PellucidFrame* frame, Findings& out, Inputs* inputs) {
  if (!frame) {
    out.error("frame", "is NULL");
    return false;
  }
  if (!checkStructSize(frame, kLeastFrame, "structSize", "pellucidInitFrame", out)) return false;
  inputs->frame = readStruct(frame, defaultFrame());
  inputs->thesis = defaultThesisOptions();
  if (const PellucidThesisOptions* thesis = inputs->frame.options.thesis) {
    if (!checkStructSize(thesis, kLeastThesisOptions, "thesis.structSize", "pellucidInitThesisOptions", out))
      return false;
    inputs->thesis = readStruct(thesis, inputs->thesis);
  }
  for (const ImageField& image : kImageFields)
    if (given(inputs->frame.*image.field)) inputs->images |= 1u << image.resource;
  return true;
}

}  // namespace pellucid
