// The images of a frame, and the part of them that is rendered.
#pragma once

#include <array>
#include <cstddef>
#include <glm/glm.hpp>

#include "pellucid/pellucid.h"
#include "shared/pellucid_shared.h"

namespace pellucid {

// Images that have a field of their own. CONTRIBUTING.md says how one is added.
struct ImageField {
  uint32_t resource;  // PellucidResource
  const char* name;   // as in the API, plans and messages
  PellucidImage PellucidFrame::*field;
  bool required;
  uint32_t binding;
  uint32_t flag;  // tells shaders that an optional image is there; 0: none asks
};

constexpr std::array kImageFields = {
    ImageField{PELLUCID_RESOURCE_FRONT_DEPTH, "frontDepth", &PellucidFrame::frontDepth, true,
               PELLUCID_BINDING_FRONT_DEPTH, 0},
    ImageField{PELLUCID_RESOURCE_BACK_DEPTH, "backDepth", &PellucidFrame::backDepth, false,
               PELLUCID_BINDING_BACK_DEPTH, PELLUCID_FLAG_BACK_DEPTH},
    ImageField{PELLUCID_RESOURCE_HIDDEN_IRRADIANCE, "hiddenIrradiance", &PellucidFrame::hiddenIrradiance, false,
               PELLUCID_BINDING_HIDDEN_IRRADIANCE, PELLUCID_FLAG_HIDDEN_IRRADIANCE},
    ImageField{PELLUCID_RESOURCE_IRRADIANCE, "irradiance", &PellucidFrame::irradiance, true,
               PELLUCID_BINDING_SOURCE, 0},
    ImageField{PELLUCID_RESOURCE_ALBEDO, "albedo", &PellucidFrame::albedo, false, PELLUCID_BINDING_ALBEDO,
               PELLUCID_FLAG_ALBEDO},
    ImageField{PELLUCID_RESOURCE_MATERIAL, "material", &PellucidFrame::material, true,
               PELLUCID_BINDING_MATERIAL, 0},
    ImageField{PELLUCID_RESOURCE_MOTION, "motion", &PellucidFrame::motion, false, PELLUCID_BINDING_MOTION,
               0},
    ImageField{PELLUCID_RESOURCE_OUTPUT, "output", &PellucidFrame::output, true, PELLUCID_BINDING_DESTINATION,
               0},
};

inline bool given(const PellucidImage& image) { return image.view != VK_NULL_HANDLE; }

struct Extent {
  uint32_t width = 0, height = 0;
};

struct Rect {  // pixels
  uint32_t x, y, width, height;
  bool operator==(const Rect&) const = default;
  Rect movedBy(glm::ivec2 pixels) const {
    return {x + static_cast<uint32_t>(pixels.x), y + static_cast<uint32_t>(pixels.y), width, height};
  }
};

inline Rect renderRect(const PellucidFrame& frame) {
  const uint32_t* r = frame.options.renderRect;
  return r[2] == 0 ? Rect{0, 0, frame.imageExtent[0], frame.imageExtent[1]} : Rect{r[0], r[1], r[2], r[3]};
}

// Parts that cover a length, the last of them perhaps cut short.
constexpr uint32_t parts(uint32_t length, uint32_t part) { return (length + part - 1) / part; }

// As pellucidGetImage has it.
inline const PellucidImage* imageOf(const PellucidFrame& frame, uint32_t resource) {
  if (resource >= PELLUCID_RESOURCE_SHADOW0) {
    const uint32_t shadow = resource - PELLUCID_RESOURCE_SHADOW0;
    return frame.shadowImages && shadow < frame.shadowImageCount ? &frame.shadowImages[shadow] : nullptr;
  }
  if (resource == PELLUCID_RESOURCE_HISTORY) return &frame.options.history;
  for (const ImageField& image : kImageFields)
    if (image.resource == resource) return &(frame.*image.field);
  const uint32_t transient = resource - PELLUCID_RESOURCE_TRANSIENT0;
  return transient < PELLUCID_MAX_TRANSIENTS ? &frame.transients[transient] : nullptr;
}

}  // namespace pellucid
