// Facts of a frame, computed once: planning, image needs, constants, validation and recording read it here.
#pragma once

#include <glm/glm.hpp>

#include "ambient.h"
#include "blocks.h"
#include "camera.h"
#include "constants_layout.h"
#include "cull.h"
#include "findings.h"
#include "images.h"
#include "light_groups.h"
#include "pellucid/pellucid_thesis.h"
#include "pyramid.h"
#include "quality.h"
#include "rect.h"
#include "stages.h"

namespace pellucid {

struct FrameFacts {
  // The caller's, with the defaults of fields that its structs lack.
  PellucidFrame frame{};
  PellucidThesisOptions thesis{};

  // ---- Of the view
  Rect rect{};
  bool wide = false;                           // colors of 32 bits a channel
  VkFormat colorFormat = VK_FORMAT_UNDEFINED;  // of transients and histories that hold colors
  uint32_t images = 0;   // bit (1 << PellucidResource) of each image field that has a view
  bool inPlace = false;  // the output is the irradiance's view
  glm::dmat4 clipFromView{1}, viewFromWorld{1};
  DepthRange depthRange{};
  ViewBounds view;
  Pyramid pyramid;

  // ---- Of the materials
  bool diffuses = false;                   // a material does
  bool thinWalls = false, solids = false;  // a material is thin-walled; one is not
  DiffusionReach reach{};

  // ---- Of the gather
  const char* whyNotGathered = nullptr;  // NULL: lights with a map can be
  uint32_t gatherSamples = 0;            // of each probe, by frame.targetError if that chooses
  uint32_t gatherSpacing = 0;            // pixels a side of what one probe stands for
  bool gathers = false;                  // lights with a map are gathered from
  bool shapes = false;                   // curved surfaces return more or less light than planes, as probes find
  float longestEntrySide = 0;            // see entry_points.h

  // ---- Of the lights
  PellucidLight ambient{};  // see ambient.h
  bool needsChord = false;  // thickness along view rays is asked for
  LightGroups lights;

  // ---- Of what runs
  Stages stages;
  bool missesTarget = false;   // no number of samples has frame.targetError
  uint32_t coarsestLevel = 0;  // of the pyramid that the diffusion needs
  Blocks blocks;
  ConstantsLayout constants;

  bool has(PellucidResource image) const { return (images & 1u << image) != 0; }
  bool debug() const { return frame.debugView != PELLUCID_DEBUG_NONE; }
  // The output shares no memory with the irradiance.
  bool separate() const { return frame.separateOutput != 0 || frame.outputMode == PELLUCID_OUTPUT_ADD; }
  // All maps of a light hold the same faces.
  bool holdsBackFaces(const PellucidLight& light) const {
    return light.shadowMapCount > 0 && frame.shadowMaps[light.firstShadowMap].faces == PELLUCID_FACES_BACK;
  }
  bool isGathered(const PellucidLight& light) const {
    return light.shadowMapCount > 0 && gathers && !holdsBackFaces(light);
  }
  // True where the light's thickness is the camera's.
  bool takesChord(const PellucidLight& light) const {
    return light.shadowMapCount == 0 || frame.thicknessSource == PELLUCID_THICKNESS_CAMERA ||
           holdsBackFaces(light);
  }

  // True where solids have no thickness for the light.
  bool lacksChord(const PellucidLight& light) const {
    return takesChord(light) && !has(PELLUCID_RESOURCE_BACK_DEPTH);
  }

  // frame.materials[index] with the defaults of fields that the caller's lacks. A thin wall's T(d) is
  // constant.
  PellucidMaterial material(uint32_t index) const;

  // As the diffusion takes it: without a profile where the diffusion is not among the features. Its passes add
  // gathered light there, too.
  PellucidMaterial diffused(uint32_t index) const;

  // Why a light adds nothing to the frame, or nullptr. Static string.
  const char* whySkipped(const PellucidLight& light) const { return view.whySkipped(*this, light); }

  // Calls light(const LightGroup&, const PellucidLight&) for each light that is not skipped, as it is placed:
  // the group counts the light, its maps and its images already.
  template <class OnLight>
  void forEachLight(OnLight&& light) const {
    placeLights(lights.beside, light, [](const LightGroup&) {});
  }

  // Places lights with what lies beside maps or without, and group(const LightGroup&) for each group in
  // order.
  template <class OnLight, class OnGroup>
  void placeLights(bool beside, OnLight&& light, OnGroup&& group) const {
    LightGroup current;
    current.beside = beside;
    current.shapes = shapes;
    const auto place = [&](const PellucidLight& l) {
      if (whySkipped(l)) return;
      if (!current.addLight(*this, l)) {
        group(static_cast<const LightGroup&>(current));
        current = current.next();
        current.addLight(*this, l);
      }
      light(static_cast<const LightGroup&>(current), l);
    };
    for (const bool gathered : {true, false})
      for (uint32_t i = 0; i < frame.lightCount; ++i)
        if (isGathered(frame.lights[i]) == gathered) place(frame.lights[i]);
    place(ambient);
    if (current.lightCount > 0 || current.shapes) group(static_cast<const LightGroup&>(current));
  }
};

// Bits of a material value that may hold the index.
inline uint32_t materialBits(const PellucidFrame& frame) {
  return (frame.materialMask == 0 ? UINT32_MAX : frame.materialMask) >> frame.materialShift;
}

// Checks everything that a plan relies on, image views not among it, and fills `facts`, in the order in which
// one needs the other. PELLUCID_OK: all of `facts` holds.
PellucidResult readFrame(const PellucidFrame* frame, Findings& out, FrameFacts* facts);

}  // namespace pellucid
