// Values of fields that callers leave alone.
#include "struct_size.h"

namespace pellucid {

// A field that is appended must not land in bytes that older headers left undefined.
#define ENDS_WITH(Struct, field) \
  (offsetof(Struct, field) + sizeof(static_cast<Struct*>(nullptr)->field) == sizeof(Struct))
static_assert(ENDS_WITH(PellucidFrame, options.motionScale));
static_assert(ENDS_WITH(PellucidMaterial, wallTransmittance));
static_assert(ENDS_WITH(PellucidThesisOptions, objectCenter));
static_assert(ENDS_WITH(PellucidContextDesc, options.allocator));
#undef ENDS_WITH

PellucidFrame defaultFrame() {
  PellucidFrame frame{};
  frame.structSize = sizeof frame;
  frame.options.features = PELLUCID_FEATURE_TRANSLUCENCY | PELLUCID_FEATURE_DIFFUSION;
  frame.metersPerUnit = 1;
  frame.options.motionScale[0] = frame.options.motionScale[1] = 1;
  for (int i = 0; i < 4; ++i) frame.viewFromWorld[i * 5] = 1;
  frame.options.outputFormat = VK_FORMAT_R16G16B16A16_SFLOAT;
  frame.options.coherenceThreshold = 0.005f;
  frame.options.gatherSamples = 8;
  frame.options.indirectDispatches = 1;
  frame.preExposure = 1;
  return frame;
}

PellucidThesisOptions defaultThesisOptions() {
  PellucidThesisOptions options{};
  options.structSize = sizeof options;
  for (float& factor : options.transmittanceFilter) factor = 1;
  return options;
}

PellucidContextDesc defaultContextDesc() {
  PellucidContextDesc desc{};
  desc.structSize = sizeof desc;
  desc.headerVersion = PELLUCID_HEADER_VERSION;
  desc.apiVersion = VK_API_VERSION_1_1;
  desc.options.outputFormat = VK_FORMAT_R16G16B16A16_SFLOAT;
  desc.options.shadowViewType = VK_IMAGE_VIEW_TYPE_2D;
  return desc;
}

}  // namespace pellucid

using namespace pellucid;

extern "C" void pellucidInitFrameSized(PellucidFrame* frame, size_t structSize) {
  writeStruct(frame, structSize, defaultFrame());
}

extern "C" void pellucidInitThesisOptionsSized(PellucidThesisOptions* options, size_t structSize) {
  writeStruct(options, structSize, defaultThesisOptions());
}

extern "C" void pellucidInitContextDescSized(PellucidContextDesc* desc, size_t structSize) {
  writeStruct(desc, structSize, defaultContextDesc());
}
