// What the attributes of OpenEXR's headers mean for a capture: the one list of those that this program knows.
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
  AttributeUse use;
};
// An attribute outside the list belongs to the program that wrote it, and has no effect.
const std::vector<ExrAttribute>& exrAttributes();

// A sentence for each Named attribute whose value says that colors are not linear Rec. 709's.
std::vector<std::string> unusedAttributes(const Imf::Header& header);

}  // namespace pellucid::harness
