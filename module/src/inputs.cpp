#include "inputs.h"

#include <algorithm>

namespace pellucid {

PellucidMaterial Inputs::material(uint32_t index) const {
  PellucidMaterial m = frame.materials[index];
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
  inputs->frame = *frame;
  if (frame->options.thesis)
    inputs->thesis = *frame->options.thesis;
  else
    pellucidInitThesisOptions(&inputs->thesis);
  for (const ImageField& image : kImageFields)
    if (given(inputs->frame.*image.field)) inputs->images |= 1u << image.resource;
  return true;
}

}  // namespace pellucid
