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

// ---- KHR_materials_scatter

// The single-scattering albedo of the extension, by its own print.
double printedAlbedo(double color, double g) {
  const double s = 4.09712 + 4.20863 * color - std::sqrt(9.59217 + 41.6808 * color + 17.7126 * color * color);
  return (1 - s * s) / (1 - g * s * s);
}

TEST_F(Scattering, ScatterFillsAVolume) {
  const GltfScene scene = read({{"KHR_materials_volume", kVolume},
                                {"KHR_materials_transmission", kAllEnters},
                                {"KHR_materials_ior", {{"ior", 1.3}}},
                                {"KHR_materials_scatter",
                                 {{"scatterStrengthFactor", 0.5},
                                  {"multiscatterColorFactor", {0.8, 0.6, 0.4}},
                                  {"scatterAnisotropy", 0.6}}}},
                               {0.9, 0.8, 0.7, 1});
  const Model& m = scene.model;
  ASSERT_EQ(m.materials.size(), 1u);
  const auto& medium = std::get<CoefficientMaterial>(m.materials[0]);
  const Rgb attenuation = {0.5, 0.25, 0.125}, color = {0.8, 0.6, 0.4};
  for (std::size_t i = 0; i < 3; ++i) {
    const double sigma = -std::log(attenuation[i]) / 2, albedo = printedAlbedo(0.5 * color[i], 0.6);
    EXPECT_NEAR(medium.scattering[i], albedo * sigma, 1e-12);
    EXPECT_NEAR(medium.absorption[i], (1 - albedo) * sigma, 1e-12);
  }
  EXPECT_EQ(medium.g, 0.6);
  EXPECT_EQ(medium.ior, 1.3);
  const Surface& s = m.surfaces[0];
  EXPECT_EQ(s.lobes, SurfaceLobes::Together);
  expectRgb(s.baseColor, {0, 0, 0});
  expectRgb(s.addedColor, {0.81 * 0.4, 0.64 * 0.3, 0.49 * 0.2});
  EXPECT_TRUE(scene.warnings.empty() || !says(scene.warnings, "scatter"));
}

// Similarity: the half-space reflects the color that was asked for, whatever the anisotropy. Kulla & Conty's
// fit is good to .01.
TEST_F(Scattering, TheAlbedoIsThatOfTheColorForEveryAnisotropy) {
  for (const double g : {-0.5, 0.0, 0.8}) {
    CoefficientMaterial medium{};
    for (std::size_t i = 0; i < 3; ++i) {
      const double albedo = singleScatteringAlbedo(0.2 + 0.3 * static_cast<double>(i), g);
      medium.scattering[i] = albedo;
      medium.absorption[i] = 1 - albedo;
    }
    medium.g = g;
    medium.ior = 1;
    const PellucidMaterial compiled = compileMaterial(medium, "test");
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(compiled.reflectance[i], 0.2 + 0.3 * i, 0.015) << g;
  }
}

TEST_F(Scattering, ScatterSplitsTheLightOfAThinWall) {
  for (const bool withVolume : {false, true}) {
    Json extensions = {{"KHR_materials_transmission", {{"transmissionFactor", 0.75}}},
                       {"KHR_materials_scatter",
                        {{"scatterStrengthFactor", 0.5},
                         {"multiscatterColorFactor", {0.8, 0.6, 0.4}},
                         {"scatterAnisotropy", 0.2}}}};
    if (withVolume)
      extensions["KHR_materials_volume"] = {{"thicknessFactor", 0}, {"attenuationDistance", 0.002}};
    const Model m = read(extensions, {0.5, 0.25, 0.125, 1}).model;
    const Surface& s = m.surfaces[0];
    EXPECT_EQ(s.lobes, SurfaceLobes::Apart);
    expectRgb(s.baseColor, {0.125, 0.0625, 0.03125});
    expectRgb(s.addedColor, {0.75 * 0.5 * 0.6 * 0.8, 0.75 * 0.5 * 0.6 * 0.6, 0.75 * 0.5 * 0.6 * 0.4});
    EXPECT_NEAR(s.backscatter, 0.4 / 0.6, 1e-12);
    const PellucidMaterial compiled = compileMaterial(m.materials.at(0), "test");
    EXPECT_EQ(compiled.thinWalled, 1u);
    for (std::size_t i = 0; i < 3; ++i)
      EXPECT_EQ(compiled.wallTransmittance[i], compiled.reflectance[i])
          << "the albedo is the transmitted color";
  }
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
                    {"KHR_materials_scatter",
                     {{"scatterStrengthFactor", 1}, {"multiscatterColorTexture", {{"index", 0}}}}}},
                   {255, 255, 255, 0, 255, 255});
  const Model& m = scene.model;
  const Surface& s = m.surfaces[0];
  ASSERT_GE(s.lobeMap, 0);
  EXPECT_EQ(m.textures[static_cast<std::size_t>(s.lobeMap)].rgba,
            (std::vector<std::uint8_t>{255, 255, 255, 255, 0, 255, 255, 255}));
  EXPECT_EQ(m.vertices[2].lobeUv, (std::array<float, 2>{1, 1}));
  const auto& medium = std::get<CoefficientMaterial>(m.materials.at(0));
  EXPECT_NEAR(medium.scattering[0], printedAlbedo(0.5, 0) * std::log(2) / 2, 1e-9);
  EXPECT_NEAR(medium.scattering[1], std::log(4) / 2, 1e-4) << "white";
  EXPECT_FALSE(says(scene.warnings, "ignored"));
}

}  // namespace
