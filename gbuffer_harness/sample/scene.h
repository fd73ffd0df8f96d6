// The meshes that are drawn, and the lights on them.
#pragma once

#include <vector>

#include "capture/capture.h"
#include "raster/framing.h"
#include "raster/view_camera.h"
#include "sample/frame.h"

namespace pellucid::sample {

using namespace pellucid::harness;

struct SceneLight {
  Light light;
  std::vector<LightView> views;  // of its shadow maps; none of the sun, whose cascades follow the camera
};

struct Scene {
  Model model;
  ViewCamera camera;
  Bounds bounds;                   // of what casts shadows
  std::vector<SceneLight> lights;  // a sun, three spots and a point light
  Harmonics ambient;               // of a sky
  std::vector<PellucidMaterial> materials;
};

// The head of the procedural scene "head" on a floor. cell: mm between the mesh's vertices, 1..20.
Scene headScene(double cell, int mapTexels);

}  // namespace pellucid::sample
