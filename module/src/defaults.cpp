#include "defaults.h"

namespace pellucid {
namespace {

// A field that is appended must not land in bytes that older headers left undefined.
#define ENDS_WITH(Struct, field) (offsetof(Struct, field) + sizeof(Struct::field) == sizeof(Struct))
static_assert(ENDS_WITH(PellucidFrame, materialTables));
static_assert(ENDS_WITH(PellucidMaterial, wallTransmittance));
static_assert(ENDS_WITH(PellucidThesisOptions, minimumDotTable));
static_assert(ENDS_WITH(PellucidContextDesc, reserved));
#undef ENDS_WITH

}  // namespace

PellucidFrame defaultFrame() {
  PellucidFrame frame{};
  frame.structSize = sizeof frame;
  frame.features = PELLUCID_FEATURE_TRANSLUCENCY | PELLUCID_FEATURE_DIFFUSION;
  frame.metersPerUnit = 1;
  for (int i = 0; i < 4; ++i) frame.viewFromWorld[i * 5] = 1;
  frame.outputFormat = VK_FORMAT_R16G16B16A16_SFLOAT;
  frame.coherenceThreshold = 0.005f;
  frame.gatherSamples = 8;
  frame.indirectDispatches = PELLUCID_INDIRECT_MATERIAL;
  frame.preExposure = 1;
  return frame;
}

PellucidThesisOptions defaultThesisOptions() {
  PellucidThesisOptions options{};
  options.structSize = sizeof options;
  for (float& factor : options.transmittanceFilter) factor = 1;
  options.faceVector[2] = 1;
  options.upAxis[1] = 1;
  return options;
}

PellucidContextDesc defaultContextDesc() {
  PellucidContextDesc desc{};
  desc.structSize = sizeof desc;
  desc.headerVersion = PELLUCID_HEADER_VERSION;
  desc.apiVersion = VK_API_VERSION_1_1;
  desc.outputFormat = VK_FORMAT_R16G16B16A16_SFLOAT;
  desc.shadowViewType = VK_IMAGE_VIEW_TYPE_2D;
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
