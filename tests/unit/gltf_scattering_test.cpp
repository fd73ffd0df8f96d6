// glTF: what the extensions of scattering and transmission become.
#include <cmath>

#include "capture/material.h"
#include "common/png.h"
#include "gltf/material.h"
#include "gltf_fixture.h"
#include "pellucid/pellucid_material.h"

namespace {

using namespace pellucid::test;
using Rgb = std::array<double, 3>;

class Scattering : public Gltf {
protected:
  GltfScene read(const Json& extensions, const Json& baseColor = {1, 1, 1, 1}) {
    GltfBuilder b = square();
    b.json["materials"][0]["extensions"] = extensions;
    b.json["materials"][0]["pbrMetallicRoughness"]["baseColorFactor"] = baseColor;
    return loadGltf(write("t.glb", b.glb()));
  }
  void expectRgb(const Rgb& value, const Rgb& expected, double tolerance = 1e-12) const {
    for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(value[i], expected[i], tolerance) << i;
  }
  // The square with one texture of 2 x 1 texels, used by "index" 0.
  GltfScene readTextured(const Json& extensions, const std::vector<std::uint8_t>& rgb) {
    GltfBuilder b = square();
    b.json["materials"][0]["extensions"] = extensions;
    b.json["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] =
        b.accessor(std::vector<float>{0, 0, 1, 0, 1, 1, 0, 1}, 5126, "VEC2", 2);
    writePng(folder_ / "c.png", 2, 1, rgb);
    b.json["images"] = {{{"uri", "c.png"}}};
    b.json["textures"] = {{{"source", 0}}};
    return loadGltf(write("t.glb", b.glb()));
  }
};

const Json kVolume = {
    {"thicknessFactor", 1}, {"attenuationDistance", 0.002}, {"attenuationColor", {0.5, 0.25, 0.125}}};
const Json kAllEnters = {{"transmissionFactor", 1}};

// Kulla & Conty's fit is good to .01.
TEST_F(Scattering, TheAlbedoIsThatOfTheColor) {
  CoefficientMaterial medium{};
  for (std::size_t i = 0; i < 3; ++i) {
    medium.scattering[i] = singleScatteringAlbedo(0.2 + 0.3 * static_cast<double>(i));
    medium.absorption[i] = 1 - medium.scattering[i];
  }
  medium.ior = 1;
  const PellucidMaterial compiled = compileMaterial(medium, "test");
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(compiled.reflectance[i], 0.2 + 0.3 * i, 0.015);
}

// ---- KHR_materials_volume_scatter

// Light that does not enter is reflected with the base color, and has no part in what comes through.
TEST_F(Scattering, LightThatDoesNotEnterHasItsOwnAlbedo) {
  const Model m = read({{"KHR_materials_volume", kVolume},
                        {"KHR_materials_volume_scatter", {{"multiscatterColorFactor", {0.8, 0.5, 0.2}}}},
                        {"KHR_materials_diffuse_transmission", {{"diffuseTransmissionFactor", 0.25}}}},
                       {0.4, 0.4, 0.4, 1})
                      .model;
  const Surface& s = m.surfaces[0];
  EXPECT_EQ(s.lobes, SurfaceLobes::Apart);
  expectRgb(s.baseColor, {0.3, 0.3, 0.3});
  expectRgb(s.addedColor, {0.2, 0.125, 0.05});
  EXPECT_EQ(s.backscatter, 1) << "the medium reflects, too";
}

// ---- Textures

TEST_F(Scattering, TexturesOfScatteringAreRead) {
  // Linear 1 and 0 in red; the medium has the mean.
  const GltfScene scene =
      readTextured({{"KHR_materials_volume", kVolume},
                    {"KHR_materials_transmission", kAllEnters},
                    {"KHR_materials_volume_scatter",
                     {{"multiscatterColorFactor", {1, 1, 1}}, {"multiscatterColorTexture", {{"index", 0}}}}}},
                   {255, 255, 255, 0, 255, 255});
  const Model& m = scene.model;
  const Surface& s = m.surfaces[0];
  ASSERT_GE(s.lobeMap, 0);
  EXPECT_EQ(m.textures[static_cast<std::size_t>(s.lobeMap)].rgba,
            (std::vector<std::uint8_t>{255, 255, 255, 255, 0, 255, 255, 255}));
  EXPECT_EQ(m.vertices[2].lobeUv, (std::array<float, 2>{1, 1}));
  const auto& medium = std::get<CoefficientMaterial>(m.materials.at(0));
  EXPECT_NEAR(medium.scattering[0], singleScatteringAlbedo(0.5) * std::log(2) / 2, 1e-9);
  EXPECT_NEAR(medium.scattering[1], std::log(4) / 2, 1e-4) << "white";
  EXPECT_FALSE(says(scene.warnings, "ignored"));
}

}  // namespace
