#include "inputs.h"

namespace pellucid {

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
