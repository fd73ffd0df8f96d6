#include "scene.h"

#include <algorithm>
#include <random>

#include "common/error.h"
#include "pellucid/pellucid_material.h"
#include "scene/scene.h"

namespace pellucid::bench {

using namespace harness;

PellucidMaterial benchMaterial() {
  PellucidMaterialDesc desc;
  pellucidInitMaterialDesc(&desc);
  desc.kind = PELLUCID_MATERIAL_PRESET;
  desc.preset = "skin1";
  PellucidMaterial material;
  if (pellucidCompileMaterial(&desc, &material, nullptr, nullptr, nullptr) != PELLUCID_OK)
    throw InputError("", "skin1", "does not compile");
  return material;
}

double pixelSizeFor(const PellucidMaterial& material, double radius) {
  return static_cast<double>(*std::max_element(material.radius, material.radius + 3)) / radius;
}

Capture slab(int width, int height, double coverage, double pixel) {
  Capture c;
  c.name = "slab";
  c.width = width;
  c.height = height;
  c.metersPerUnit = 0.001;
  c.clipFromView[0] = 2 / (pixel * width);
  c.clipFromView[5] = -2 / (pixel * height);
  c.clipFromView[10] = -1.0 / 100;
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
      2 / (pixel * width), 0, 0, 0, 0, 2 / (pixel * height), 0, 0, 0, 0, 0.01, 0, 0, 0, 1, 1};
  light.shadowMaps[0].depth.encoding = PELLUCID_DEPTH_DEVICE;
  light.shadowMaps[0].depth.image = Image(1024, 1024, 1, 0.48f);
  c.lights = {light};
  return c;
}

std::vector<Capture> patterns(int size, double pixel) {
  const auto make = [&](const char* name, std::map<std::string, double> options) {
    SceneParameters p;
    p.name = name;
    p.width = p.height = size;
    p.options = std::move(options);
    p.options["extent"] = size * pixel;
    p.options["samples"] = 4;
    p.shadowSize = 0;
    return makeScene(p);
  };
  return {make("checker", {{"cell", size * pixel / 7}}), make("step", {{"angle", 30}}), make("tilted", {})};
}

}  // namespace pellucid::bench
