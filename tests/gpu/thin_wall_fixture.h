// A sheet of paper without thickness, what may stand beside it, and their replays.
#pragma once

#include "capture/material.h"
#include "gpu/model_builder.h"
#include "gpu_fixture.h"
#include "raster/raster.h"

namespace pellucid::test {

inline constexpr double kE = 2;
inline constexpr std::array<double, 3> kReflectance = {0.5, 0.25, 0.125}, kTransmittance = {0.5, 0.6, 0.1};
inline const MaterialSource kPaper = ThinWallMaterial{kReflectance, kTransmittance, {}};

// A square of 10 mm that faces the camera, of paper on both sides.
inline Model sheet() {
  Model model = emptyModel();
  addSquare(model, 0, 0, 0, 5);
  endPart(model, 0);
  model.surfaces[0].doubleSided = true;
  model.surfaces[0].baseColor = kReflectance;
  model.materials[0] = kPaper;
  return model;
}

// An opaque square between the sheet and a light behind.
inline void addOccluder(Model& model, double half, double z) {
  Surface opaque;
  opaque.doubleSided = true;
  model.surfaces.push_back(opaque);
  addSquare(model, 0, 0, z, half);
  endPart(model, 1, static_cast<std::uint32_t>(model.surfaces.size() - 1));
}

// A sphere of skin beside the sheet, so that a frame may gather.
inline void addSkin(Model& model, const Vector3& center, double radius) {
  Surface skin;
  skin.baseColor = {0.5, 0.5, 0.5};
  skin.material = 2;
  model.surfaces.push_back(skin);
  model.materials.emplace_back(PresetMaterial{"skin1"});
  addSphere(model, center, radius, 24);
  endPart(model, 2, static_cast<std::uint32_t>(model.surfaces.size() - 1));
}

class ThinWall : public GpuTest {
protected:
  static Capture draw(const Model& model, int shadowSize = 256, PointMaps maps = PointMaps::Auto) {
    const RasterOptions options{.width = 65, .height = 65, .shadowSize = shadowSize, .pointMaps = maps};
    return rasterize(device(), model, frontCamera(true), options).capture;
  }
  static ReplaySettings gathering(std::uint32_t samples) {
    ReplaySettings settings = inFloats();
    settings.translucency.gatherSamples = samples;
    return settings;
  }
  static Image run(const Capture& c, const ReplaySettings& settings) {
    return replayer().run(c, compileMaterials(c), settings).output;
  }
};

}  // namespace pellucid::test
