// Values of fields that callers leave alone.
#include "pellucid/pellucid_thesis.h"

extern "C" void pellucidInitFrame(PellucidFrame* frame) {
  if (!frame) return;
  *frame = {};
  frame->options.features = PELLUCID_FEATURE_TRANSLUCENCY | PELLUCID_FEATURE_DIFFUSION;
  frame->metersPerUnit = 1;
  frame->options.motionScale[0] = frame->options.motionScale[1] = 1;
  for (int i = 0; i < 4; ++i) frame->viewFromWorld[i * 5] = 1;
  frame->options.outputFormat = VK_FORMAT_R16G16B16A16_SFLOAT;
  frame->options.coherenceThreshold = 0.005f;
  frame->options.gatherSamples = 8;
  frame->options.indirectDispatches = 1;
  frame->preExposure = 1;
}

extern "C" void pellucidInitThesisOptions(PellucidThesisOptions* options) {
  if (!options) return;
  *options = {};
  for (float& factor : options->transmittanceFilter) factor = 1;
}

extern "C" void pellucidInitContextDesc(PellucidContextDesc* desc) {
  if (!desc) return;
  *desc = {};
  desc->headerVersion = PELLUCID_HEADER_VERSION;
  desc->apiVersion = VK_API_VERSION_1_1;
  desc->options.outputFormat = VK_FORMAT_R16G16B16A16_SFLOAT;
  desc->options.shadowViewType = VK_IMAGE_VIEW_TYPE_2D;
}
