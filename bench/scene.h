// What the benchmarks run on.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "capture/capture.h"
#include "pellucid/pellucid.h"

namespace pellucid::bench {

// skin1 of Jensen et al. 2001.
PellucidMaterial benchMaterial();

// Pixel size (mm) at which the material's 99.9 % radius, of its widest channel, is `radius` pixels.
double pixelSizeFor(const PellucidMaterial& material, double radius);

// The capture without exit depths and caster materials: few engines have them, and the other methods here
// bind no images for them.
harness::Capture withMapsAlone(harness::Capture capture);

// A 2 mm slab, noise in the irradiance and of a hundredth of a pixel in the depths, one directional light
// from behind with a shadow map of about a texel a pixel, at most 1024^2; the upper `coverage` of the image
// has the material. A pixel is `pixel` mm wide.
harness::Capture slab(int width, int height, double coverage, double pixel);

// Of the slab's first pixel, mm.
double slabThickness(const harness::Capture& slab);

// The same, with the light in front of it, so that its map shows what the camera sees.
harness::Capture litFromTheFront(harness::Capture slab);

// The same through a pinhole, reversed and without a far plane, as engines have it: radii are not known to
// the plan.
harness::Capture inPerspective(harness::Capture slab);

// A scene that diffusions' errors are stated for.
struct ErrorScene {
  std::string title, scene;
  std::map<std::string, double> options;
  double width;  // visible, scene units
  // If > 0, the irradiance is a checker of that side in the image, scene units, at 17 degrees.
  double checker = 0;
};

std::vector<ErrorScene> errorScenes();

// `size` pixels a side; all lengths scaled so that a pixel is `pixel` mm wide where the scene has its width.
harness::Capture makeErrorCapture(const ErrorScene& scene, int size, double pixel);

// One value per pixel: 1 in blocks of box x box pixels that hold about `count` of the pixels with a material,
// spread at random with a fixed seed; in all blocks where there are no more.
std::vector<std::uint8_t> spreadPixels(const harness::Capture& capture, int count, int box = 1);

// Burley's profile (Christensen & Burley 2015) with 99.9 % of the energy within `radius` mm in red, and
// distances 1/1.4 and 1/2 of that in green and blue.
PellucidMaterial burleyMaterial(double radius);

}  // namespace pellucid::bench
