#include "scene.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>
#include <random>

#include "capture/material.h"
#include "common/error.h"
#include "scene/scene.h"

namespace pellucid::bench {

using namespace harness;

PellucidMaterial benchMaterial() { return compileMaterial(PresetMaterial{"skin1"}, "skin1"); }

double pixelSizeFor(const PellucidMaterial& material, double radius) {
  return static_cast<double>(*std::max_element(material.radius, material.radius + 3)) / radius;
}

namespace {

constexpr double kFar = 100;                  // mm, of the slab's camera
constexpr unsigned kMostShadowTexels = 1024;  // across the slab's map, which has about a texel a pixel

// In device depths of which 1 is `far` mm away: random, up to half a hundredth of a pixel to either side.
// Memory that compresses what is constant, which depths of G-buffers are not, would be read faster than real
// data.
void addGrain(Capture& c, double pixel, double far) {
  unsigned seed = 2;
  for (Image* depth : {&c.frontDepth.image, &c.backDepth.image}) {
    std::mt19937 random(seed++);
    std::uniform_real_distribution<double> grain(-0.005 * pixel / far, 0.005 * pixel / far);
    for (float& d : depth->data) d = static_cast<float>(static_cast<double>(d) + grain(random));
  }
}

Capture slabWithoutGrain(int width, int height, double coverage, double pixel) {
  Capture c;
  c.name = "slab";
  c.width = width;
  c.height = height;
  c.metersPerUnit = 0.001;
  c.clipFromView[0] = 2 / (pixel * width);
  c.clipFromView[5] = -2 / (pixel * height);
  c.clipFromView[10] = -1 / kFar;
  c.frontDepth = {Image(width, height, 1, 0.50f), PELLUCID_DEPTH_DEVICE};
  c.backDepth = {Image(width, height, 1, 0.52f), PELLUCID_DEPTH_DEVICE};
  c.normal = Image(width, height, 3);
  c.irradiance = Image(width, height, 3);
  std::mt19937 random(1);  // zeros would run faster than real data
  for (size_t i = 0; i < c.irradiance.data.size(); ++i) {
    c.irradiance.data[i] = static_cast<float>(random() % 1024) / 512;
    c.normal.data[i] = i % 3 == 2 ? 1.0f : 0.0f;
  }
  c.material.assign(c.irradiance.pixels(), 0);
  std::fill_n(c.material.begin(),
              static_cast<std::ptrdiff_t>(coverage * static_cast<double>(c.material.size())),
              std::uint8_t{1});
  c.materials.resize(1);
  Light light;
  light.direction = {0, 0, 1};
  light.shadowMaps.emplace_back();
  light.shadowMaps[0].clipFromWorld = {
      2 / (pixel * width), 0, 0, 0, 0, 2 / (pixel * height), 0, 0, 0, 0, 1 / kFar, 0, 0, 0, 1, 1};
  light.shadowMaps[0].depth.encoding = PELLUCID_DEPTH_DEVICE;
  const auto across = static_cast<int>(
      std::min(kMostShadowTexels, std::bit_ceil(static_cast<unsigned>(std::max(width, height)))));
  light.shadowMaps[0].depth.image = Image(across, across, 1, 0.48f);
  c.lights = {light};
  return c;
}

}  // namespace

Capture withMapsAlone(Capture capture) {
  for (Light& light : capture.lights)
    for (ShadowMap& map : light.shadowMaps) {
      map.exitDepth = {};
      map.casterMaterial.clear();
    }
  return capture;
}

Capture slab(int width, int height, double coverage, double pixel) {
  Capture c = slabWithoutGrain(width, height, coverage, pixel);
  addGrain(c, pixel, kFar);
  return c;
}

double slabThickness(const Capture& slab) {
  // To where the light enters, by the shadow map, which runs towards the camera.
  const double back = 1 - static_cast<double>(slab.lights.at(0).shadowMaps.at(0).depth.image.data[0]);
  return kFar * (back - static_cast<double>(slab.frontDepth.image.data[0]));
}

Capture litFromTheFront(Capture slab) {
  Light& light = slab.lights.at(0);
  light.direction = {0, 0, -1};
  ShadowMap& map = light.shadowMaps.at(0);
  map.clipFromWorld[10] = -1 / kFar;
  map.clipFromWorld[14] = 0;
  std::fill(map.depth.image.data.begin(), map.depth.image.data.end(), 0.50f);
  return slab;
}

Capture inPerspective(Capture slab) {
  constexpr double kNear = 1;  // mm, of device depth 1; there is no far plane
  // As far away as the image is high. The map keeps its distance to the slab.
  const double behind = 2 / std::abs(slab.clipFromView[5]), front = kFar / 2 + behind;
  for (Image* depth : {&slab.frontDepth.image, &slab.backDepth.image})
    for (float& d : depth->data) d = static_cast<float>(kNear / (kFar * static_cast<double>(d) + behind));
  slab.clipFromView[0] *= front;
  slab.clipFromView[5] *= front;
  slab.clipFromView[10] = slab.clipFromView[15] = 0;
  slab.clipFromView[11] = -1;
  slab.clipFromView[14] = kNear;
  slab.lights.at(0).shadowMaps.at(0).clipFromWorld[14] += behind / kFar;
  return slab;
}

std::vector<ErrorScene> errorScenes() {
  const double plane = 40;
  const std::map<std::string, double> tilted = {{"tilt", 60}};
  return {
      {"checker of 1/8 of the width, at 17 degrees", "checker", {{"cell", plane / 8}, {"angle", 17}}, plane},
      {"step at 30 degrees", "step", {{"angle", 30}}, plane},
      {"tilted by 60 degrees, step", "tilted", tilted, plane},
      {"tilted by 60 degrees, step at 30 degrees", "tilted", {{"tilt", 60}, {"angle", 30}}, plane},
      {"tilted by 60 degrees, checker at 17 degrees",
       "checker",
       {{"cell", plane / 8}, {"angle", 17}, {"tilt", 60}},
       plane},
      {"sphere, lit from the side", "sphere", {{"lightAngle", 110}}, plane},
      {"sphere, checker at 17 degrees", "sphere", {}, plane, plane / 8},
      {"ear", "ear", {}, 92}};
}

namespace {

// Of each pixel with a material, from 4 x 4 points of it.
void paintChecker(Capture& capture, double side) {
  constexpr double kAngle = 17 * std::numbers::pi / 180;
  constexpr int kPoints = 4;
  const double c = std::cos(kAngle) / side, s = std::sin(kAngle) / side;
  for (int y = 0; y < capture.height; ++y)
    for (int x = 0; x < capture.width; ++x) {
      int lit = 0;
      for (int i = 0; i < kPoints * kPoints; ++i) {
        const double u = x + (i % kPoints + 0.5) / kPoints, v = y + (i / kPoints + 0.5) / kPoints;
        lit += static_cast<int>(std::floor(c * u + s * v) + std::floor(c * v - s * u)) % 2 == 0 ? 1 : 0;
      }
      const bool covered = capture.material[static_cast<size_t>(y) * static_cast<size_t>(capture.width) +
                                            static_cast<size_t>(x)] != 0;
      for (int k = 0; k < 3; ++k)
        capture.irradiance.at(x, y)[k] = covered ? static_cast<float>(lit) / (kPoints * kPoints) : 0;
    }
}

}  // namespace

Capture makeErrorCapture(const ErrorScene& scene, int size, double pixel) {
  SceneParameters p{.name = scene.scene, .width = size, .height = size, .options = scene.options};
  if (scene.scene == "checker" || scene.scene == "step" || scene.scene == "tilted") p.options["samples"] = 4;
  p.shadowSize = 0;
  Capture capture = makeScene(p);
  capture.metersPerUnit = 0.001 * pixel * size / scene.width;
  if (scene.checker > 0) paintChecker(capture, scene.checker * size / scene.width);
  capture.albedo = {};  // the error is the diffusion's
  return capture;
}

std::vector<std::uint8_t> spreadPixels(const Capture& capture, int count, int box) {
  const auto covered =
      std::count_if(capture.material.begin(), capture.material.end(), [](auto m) { return m != 0; });
  std::mt19937 random(5);
  std::vector<std::uint8_t> wanted(capture.material.size());
  for (int top = 0; top < capture.height; top += box)
    for (int left = 0; left < capture.width; left += box) {
      const bool chosen = random() % static_cast<std::uint64_t>(std::max<std::ptrdiff_t>(covered, 1)) <
                          static_cast<std::uint64_t>(count);
      for (int y = top; y < std::min(top + box, capture.height); ++y)
        for (int x = left; x < std::min(left + box, capture.width); ++x) {
          const auto i = static_cast<size_t>(y) * static_cast<size_t>(capture.width) + static_cast<size_t>(x);
          wanted[i] = chosen && capture.material[i] != 0;
        }
    }
  return wanted;
}

PellucidMaterial burleyMaterial(double radius) {
  PellucidMaterialDesc desc;
  pellucidInitMaterialDesc(&desc);
  desc.kind = PELLUCID_MATERIAL_BURLEY;
  // 3/4 e^{-r / 3d} = .001 - 1/4 e^{-r / d} holds at r = 19.86 d (Christensen & Burley 2015, the cdf).
  const double d = radius / 19.86;
  desc.burleyDistance[0] = d;
  desc.burleyDistance[1] = d / 1.4;
  desc.burleyDistance[2] = d / 2;
  PellucidMaterial material;
  if (pellucidCompileMaterial(&desc, &material, nullptr, nullptr, nullptr) != PELLUCID_OK)
    throw InputError("", "burleyDistance", "does not compile");
  return material;
}

}  // namespace pellucid::bench
