#include "scene.h"

#include <algorithm>
#include <bit>
#include <random>

#include "capture/material.h"

namespace pellucid::bench {

using namespace harness;

PellucidMaterial benchMaterial() { return compileMaterial(PresetMaterial{"skin1"}, "skin1"); }

Capture withMapsAlone(Capture capture) {
  for (Light& light : capture.lights)
    for (ShadowMap& map : light.shadowMaps) {
      map.exitDepth = {};
      map.casterMaterial.clear();
    }
  return capture;
}

namespace {

constexpr double kFar = 100;                  // mm, of the slab's camera
constexpr double kPixel = 0.1;                // mm
constexpr unsigned kMostShadowTexels = 1024;  // across the slab's map, which has about a texel a pixel

}  // namespace

Capture slab(int width, int height) {
  Capture c;
  c.name = "slab";
  c.width = width;
  c.height = height;
  c.metersPerUnit = 0.001;
  c.clipFromView[0] = 2 / (kPixel * width);
  c.clipFromView[5] = -2 / (kPixel * height);
  c.clipFromView[10] = -1 / kFar;
  c.frontDepth = {Image(width, height, 1, 0.50f), PELLUCID_DEPTH_DEVICE};
  c.backDepth = {Image(width, height, 1, 0.52f), PELLUCID_DEPTH_DEVICE};
  // Memory that compresses constants, which depths of G-buffers are not, would be read faster than real data.
  unsigned seed = 2;
  for (Image* depth : {&c.frontDepth.image, &c.backDepth.image}) {
    std::mt19937 random(seed++);
    std::uniform_real_distribution<double> grain(-0.005 * kPixel / kFar, 0.005 * kPixel / kFar);
    for (float& d : depth->data) d = static_cast<float>(static_cast<double>(d) + grain(random));
  }
  c.normal = Image(width, height, 3);
  c.irradiance = Image(width, height, 3);
  std::mt19937 random(1);  // zeros would run faster than real data
  for (size_t i = 0; i < c.irradiance.data.size(); ++i) {
    c.irradiance.data[i] = static_cast<float>(random() % 1024) / 512;
    c.normal.data[i] = i % 3 == 2 ? 1.0f : 0.0f;
  }
  c.material.assign(c.irradiance.pixels(), 1);
  c.materials.resize(1);
  Light light;
  light.direction = {0, 0, 1};
  light.shadowMaps.emplace_back();
  light.shadowMaps[0].clipFromWorld = {
      2 / (kPixel * width), 0, 0, 0, 0, 2 / (kPixel * height), 0, 0, 0, 0, 1 / kFar, 0, 0, 0, 1, 1};
  light.shadowMaps[0].depth.encoding = PELLUCID_DEPTH_DEVICE;
  const auto across = static_cast<int>(
      std::min(kMostShadowTexels, std::bit_ceil(static_cast<unsigned>(std::max(width, height)))));
  light.shadowMaps[0].depth.image = Image(across, across, 1, 0.48f);
  c.lights = {light};
  return c;
}

double slabThickness(const Capture& slab) {
  // To where the light enters, by the shadow map, which runs towards the camera.
  const double back = 1 - static_cast<double>(slab.lights.at(0).shadowMaps.at(0).depth.image.data[0]);
  return kFar * (back - static_cast<double>(slab.frontDepth.image.data[0]));
}

}  // namespace pellucid::bench
