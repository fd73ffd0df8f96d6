#include "inputs.h"

#include <algorithm>

#include "defaults.h"

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
  if (!canReadStruct(frame, kLeastFrame)) {
    out.fail(PELLUCID_ERROR_VERSION, "structSize", "is ", frame->structSize, "; this library reads ",
             kLeastFrame, " to ", sizeof(PellucidFrame),
             " bytes, and more if they are 0 (call pellucidInitFrame)");
    return false;
  }
  inputs->frame = readStruct(frame, defaultFrame());
  const PellucidThesisOptions* thesis = inputs->frame.options.thesis;
  if (thesis && !canReadStruct(thesis, kLeastThesisOptions)) {
    out.fail(PELLUCID_ERROR_VERSION, "thesis.structSize", "is ", thesis->structSize, "; this library reads ",
             kLeastThesisOptions, " to ", sizeof(PellucidThesisOptions),
             " bytes, and more if they are 0 (call pellucidInitThesisOptions)");
    return false;
  }
  inputs->thesis = thesis ? readStruct(thesis, defaultThesisOptions()) : defaultThesisOptions();
  for (const ImageField& image : kImageFields)
    if (given(inputs->frame.*image.field)) inputs->images |= 1u << image.resource;
  inputs->inPlace = given(inputs->frame.output) && inputs->frame.output.view == inputs->frame.irradiance.view;
  return true;
}

}  // namespace pellucid
