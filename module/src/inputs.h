// The caller's structs. The first of a frame's facts.
#pragma once

#include "findings.h"
#include "images.h"
#include "pellucid/pellucid_thesis.h"

namespace pellucid {

struct Inputs {
  PellucidFrame frame{};
  PellucidThesisOptions thesis{};
  uint32_t images = 0;  // bit (1 << PellucidResource) of each image field that has a view

  bool has(PellucidResource image) const { return (images & 1u << image) != 0; }
  bool debug() const { return frame.options.debugView != PELLUCID_DEBUG_NONE; }
  bool translucency() const { return (frame.options.features & PELLUCID_FEATURE_TRANSLUCENCY) != 0; }
  // The output is the irradiance's view.
  bool inPlace() const { return given(frame.output) && frame.output.view == frame.irradiance.view; }
  // The output shares no memory with the irradiance.
  bool separate() const {
    return frame.options.addToOutput == 1 || (given(frame.output) && given(frame.irradiance) && !inPlace());
  }
  // That the angle model reads; 0: it reads none.
  double minimumDot(const PellucidLight& light) const {
    const uint32_t model = thesis.angleModel;
    const bool prescaled = thesis.prescaleAngle && model >= PELLUCID_ANGLE_COSINE && model <= PELLUCID_ANGLE_POLYNOMIAL;
    return prescaled || model == PELLUCID_ANGLE_MINIMUM_DOT ? light.minimumDot : 0;
  }
  // Bits of a material value that may hold the index.
  uint32_t materialBits() const {
    return (frame.options.materialMask == 0 ? UINT32_MAX : frame.options.materialMask) >> frame.options.materialShift;
  }

  // Gaussians as the diffusion takes them: none where the diffusion is not among the features. Its passes add gathered light there,
  // too.
  uint32_t diffusedCount(const PellucidMaterial& material) const {
    return (frame.options.features & PELLUCID_FEATURE_DIFFUSION) != 0 ? material.gaussianCount : 0;
  }

  // All maps of a light hold the same faces.
  bool holdsBackFaces(const PellucidLight& light) const {
    return light.shadowMapCount > 0 && frame.shadowMaps[light.firstShadowMap].options.backFaces == 1;
  }
  // True where the light's thickness is the camera's.
  bool takesChord(const PellucidLight& light) const {
    return light.shadowMapCount == 0 || frame.options.cameraThickness == 1 ||
           holdsBackFaces(light);
  }
  // True where solids have no thickness for the light.
  bool lacksChord(const PellucidLight& light) const {
    return takesChord(light) && !has(PELLUCID_RESOURCE_BACK_DEPTH);
  }
};

// False: an error.
bool readInputs(const PellucidFrame* frame, Findings& out, Inputs* inputs);

}  // namespace pellucid
