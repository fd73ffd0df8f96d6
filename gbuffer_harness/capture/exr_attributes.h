// Attributes of OpenEXR's headers, and their use for a capture.
#pragma once

#include <ImfHeader.h>

#include <string>
#include <vector>

namespace pellucid::harness {

enum class AttributeUse {
  Used,      // by the reader, or by `pellucid init` for the camera; a manifest has its own camera
  NoEffect,  // on numbers of pixels: records, and advice for displays
  Named,     // a sentence says what it would change
  Refused    // pixels that no capture holds
};

struct ExrAttribute {
  const char* name;
  AttributeUse use;  // of Named ones, chromaticities are points, and the others are names of color spaces
};
// All attributes that readers use, name or refuse, and others that are known to have no effect. Attributes
// outside the list have no effect either.
const std::vector<ExrAttribute>& exrAttributes();

// A sentence for each Named attribute whose value says that colors are not linear Rec. 709's.
std::vector<std::string> unusedAttributes(const Imf::Header& header);

}  // namespace pellucid::harness
