// Captures from and to disk: what is read is what was written, and what is wrong is named.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>
#include <tuple>

#include "capture/json_field.h"
#include "capture/manifest_parts.h"
#include "capture/material.h"
#include "capture/read.h"
#include "capture/write.h"
#include "common/error.h"
#include "unit/capture_samples.h"

namespace pellucid::harness {
namespace {

using nlohmann::json;

// ---- Round trip

TEST(CaptureRoundTrip, IsBitExactWithFloat) {
  const TemporaryDirectory directory;
  const Capture written = sampleCapture();
  writeCapture(written, directory / "c.exr");
  const Capture read = readCapture(directory / "c.exr");

  EXPECT_EQ(read.name, (directory / "c.exr").string());
  const auto values = [](const Capture& c) {
    return std::tie(c.width, c.height, c.metersPerUnit, c.clipFromView, c.viewFromWorld, c.material,
                    c.environment, c.truth->samples, c.truth->seed, c.truth->scene);
  };
  EXPECT_TRUE(values(read) == values(written));
  EXPECT_TRUE(read.environment);
  expectSame(read.frontDepth, written.frontDepth);
  expectSame(read.backDepth, written.backDepth);
  for (const auto image :
       {&Capture::irradiance, &Capture::hiddenIrradiance, &Capture::motion, &Capture::albedo})
    EXPECT_TRUE(sameBits(read.*image, written.*image));
  EXPECT_TRUE(sameBits(read.truth->image, written.truth->image));
  EXPECT_TRUE(sameBits(read.truth->standardError, written.truth->standardError));

  ASSERT_EQ(read.lights.size(), written.lights.size());
  for (std::size_t i = 0; i < read.lights.size(); ++i) {
    SCOPED_TRACE(i);
    const auto ofLight = [](const Light& l) {
      return std::tie(l.type, l.position, l.direction, l.color, l.intensity, l.range, l.radius,
                      l.innerConeAngle, l.outerConeAngle, l.angleTable, l.distanceTable);
    };
    const auto ofMap = [](const ShadowMap& m) {
      return std::tie(m.casterMaterial, m.clipFromWorld, m.viewFromWorld, m.backFaces, m.depthBiasConstant,
                      m.depthBiasSlope, m.offsetLength, m.depthStep, m.sharedImage, m.offset, m.layer);
    };
    const Light &a = read.lights[i], &b = written.lights[i];
    EXPECT_TRUE(ofLight(a) == ofLight(b));
    ASSERT_EQ(a.shadowMaps.size(), b.shadowMaps.size());
    for (std::size_t k = 0; k < a.shadowMaps.size(); ++k) {
      EXPECT_TRUE(ofMap(a.shadowMaps[k]) == ofMap(b.shadowMaps[k])) << k;
      expectSame(a.shadowMaps[k].depth, b.shadowMaps[k].depth);
      EXPECT_TRUE(sameBits(a.shadowMaps[k].exitDepth, b.shadowMaps[k].exitDepth));
    }
  }

  ASSERT_EQ(read.materials.size(), 8u);
  const auto same = [&]<class M, class... T>(std::size_t i, T M::*... members) {
    const M &x = std::get<M>(read.materials[i]), &y = std::get<M>(written.materials[i]);
    return ((x.*members == y.*members) && ...);
  };
  EXPECT_TRUE(same(0, &PresetMaterial::preset));
  EXPECT_TRUE(same(1, &CoefficientMaterial::scattering, &CoefficientMaterial::absorption,
                   &CoefficientMaterial::g, &CoefficientMaterial::ior));
  EXPECT_TRUE(same(2, &BurleyMaterial::distance, &BurleyMaterial::transmittance));
  EXPECT_TRUE(same(3, &GaussianMaterial::variance, &GaussianMaterial::weight));
  for (const std::size_t i : {4u, 5u})
    EXPECT_TRUE(same(i, &ThinWallMaterial::reflectance, &ThinWallMaterial::transmittance,
                     &ThinWallMaterial::distance));
  EXPECT_EQ(std::get<OpenPbrMaterial>(read.materials[6]), std::get<OpenPbrMaterial>(written.materials[6]));
  EXPECT_EQ(std::get<SkinMaterial>(read.materials[7]), std::get<SkinMaterial>(written.materials[7]));
}

TEST(CaptureRoundTrip, MinimalCaptureHasNoOptionalParts) {
  const TemporaryDirectory directory;
  Capture written = sampleCapture();
  written.backDepth = {};
  written.hiddenIrradiance = written.motion = written.albedo = {};
  written.truth.reset();
  written.lights.clear();
  writeCapture(written, directory / "c.exr");
  const Capture read = readCapture(directory / "c.exr");
  EXPECT_TRUE(read.backDepth.image.empty());
  EXPECT_TRUE(read.hiddenIrradiance.empty());
  EXPECT_TRUE(read.motion.empty());
  EXPECT_TRUE(read.albedo.empty());
  EXPECT_FALSE(read.truth.has_value());
  EXPECT_TRUE(read.lights.empty());
  expectSame(read.frontDepth, written.frontDepth);
}

TEST(CaptureRoundTrip, EqualCapturesMakeEqualFiles) {
  const TemporaryDirectory directory;
  writeCapture(sampleCapture(), directory / "a.exr");
  writeCapture(sampleCapture(), directory / "b.exr");
  EXPECT_EQ(readText(directory / "a.exr"), readText(directory / "b.exr"));
}

TEST(CaptureRoundTrip, HalfRoundsColorsAndKeepsDepths) {
  const TemporaryDirectory directory;
  const Capture written = sampleCapture();
  writeCapture(written, directory / "c.exr", ColorFormat::Half);
  const Capture read = readCapture(directory / "c.exr");
  expectSame(read.frontDepth, written.frontDepth);
  expectSame(read.backDepth, written.backDepth);
  EXPECT_FALSE(sameBits(read.irradiance, written.irradiance));
  for (std::size_t i = 0; i < read.irradiance.data.size(); ++i)  // half has 11 bits: half a unit of 2^-10
    EXPECT_NEAR(read.irradiance.data[i], written.irradiance.data[i], written.irradiance.data[i] * 0x1p-11);
}

TEST(CaptureRoundTrip, HalfRefusesWhatItCannotHold) {
  const TemporaryDirectory directory;
  Capture capture = sampleCapture();
  capture.irradiance.data[4] = 70000;
  expectNames(refusalOf([&] { writeCapture(capture, directory / "c.exr", ColorFormat::Half); }),
              {"c.exr", "irradiance.G", "70000"});
}

// ---- Manifest beside EXR files

TEST_F(Manifests, EveryBufferArrives) {
  const Capture capture = read();
  EXPECT_EQ(capture.width, kSampleWidth);
  EXPECT_EQ(capture.height, kSampleHeight);
  expectSame(capture.frontDepth, sample.frontDepth);
  expectSame(capture.backDepth, sample.backDepth);
  EXPECT_TRUE(sameBits(capture.irradiance, sample.irradiance));
  EXPECT_EQ(capture.albedo.at(6, 4)[1], 0.38f);
  EXPECT_EQ(capture.material[0], 0);
  EXPECT_EQ(capture.material[1], 1);
  ASSERT_EQ(capture.lights.size(), 2u);
  EXPECT_EQ(capture.lights[0].type, PELLUCID_LIGHT_SPOT);
  EXPECT_EQ(capture.lights[0].shadowMaps[0].depth.encoding, PELLUCID_DEPTH_DISTANCE);
  EXPECT_TRUE(
      sameBits(capture.lights[0].shadowMaps[0].depth.image, sample.lights[0].shadowMaps[0].depth.image));
  EXPECT_EQ(capture.truth->image.at(2, 1)[0], 2 * sample.irradiance.at(2, 1)[0]);
  const auto& material = std::get<CoefficientMaterial>(capture.materials[0]);
  EXPECT_DOUBLE_EQ(material.scattering[0], 0.74) << "per millimeter";
  EXPECT_DOUBLE_EQ(material.absorption[2], 0.48);
}

TEST_F(Manifests, DefaultsAreThoseOfTheStructures) {
  manifest.erase("metersPerUnit");
  manifest["lights"] = {{{"type", "point"}, {"position", {1, 2, 3}}}};
  const Capture capture = read();
  EXPECT_EQ(capture.metersPerUnit, 1);
  const Light& light = capture.lights[0];
  EXPECT_EQ(light.color, (std::array<double, 3>{1, 1, 1}));
  EXPECT_EQ(light.intensity, 1);
  EXPECT_EQ(light.range, 0);
  EXPECT_TRUE(light.shadowMaps.empty());
}

// Programs write bounds as float32 or with seven digits, and both may lie outside.
TEST_F(Manifests, ValuesWithinARoundingOfABoundAreTheBound) {
  const double halfPi = std::numbers::pi / 2, asFloat = static_cast<double>(static_cast<float>(halfPi));
  ASSERT_GT(asFloat, halfPi);
  struct Cone {
    double inner, outer;
  };
  for (const auto& [inner, outer] : {Cone{0, asFloat},
                                     {-1e-9, 1.570797},
                                     {0.5, 0.5},
                                     {0.7000001, 0.7},
                                     {asFloat, asFloat},
                                     {std::nextafter(0.3, 0), 0.3}}) {
    SCOPED_TRACE(testing::Message() << inner << " " << outer);
    manifest["lights"][0]["innerConeAngle"] = inner;
    manifest["lights"][0]["outerConeAngle"] = outer;
    const Capture capture = read();
    const Light& light = capture.lights[0];
    EXPECT_NEAR(light.outerConeAngle, outer, 1e-6);
    EXPECT_NEAR(light.innerConeAngle, inner, 2e-6);  // of pi / 2 that is a rounding
    // As the module takes it.
    EXPECT_LE(static_cast<float>(light.outerConeAngle), 1.5707964f);
    EXPECT_GE(light.innerConeAngle, 0);
    EXPECT_LT(static_cast<float>(light.innerConeAngle), static_cast<float>(light.outerConeAngle));
    // What is written is read, to the bit.
    writeCapture(capture, directory / "again.exr");
    const Light again = readCapture(directory / "again.exr").lights[0];
    EXPECT_EQ(again.innerConeAngle, light.innerConeAngle);
    EXPECT_EQ(again.outerConeAngle, light.outerConeAngle);
  }
  manifest["lights"][0]["innerConeAngle"] = 0.1;
  manifest["lights"][0]["color"] = {1, -1e-8, 1};
  manifest["lights"][0]["intensity"] = -1e-7;
  manifest["lights"][0]["range"] = 3.4e38;  // as exporters write "unlimited"
  manifest["materials"][0] = {{"subsurface_color", {1.0000001, 0.5, -1e-9}}, {"specular_ior", 0.9999999}};
  const Capture capture = read();
  EXPECT_EQ(capture.lights[0].color[1], 0);
  EXPECT_EQ(capture.lights[0].intensity, 0);
  EXPECT_EQ(capture.lights[0].range, 1e15);
  const auto& medium = std::get<OpenPbrMaterial>(capture.materials[0]);
  EXPECT_EQ(medium.color, (std::array<double, 3>{1, 0.5, 0}));
  EXPECT_EQ(medium.ior, 1);
  manifest["materials"][0] = {
      {"thinWalled", {{"reflectance", {0.3, 0.5, 1}}, {"transmittance", {0.7000001, 0.4, 0}}}}};
  const auto wall = std::get<ThinWallMaterial>(read().materials[0]);
  EXPECT_EQ(wall.transmittance[0], 1 - 0.3);
}

TEST_F(Manifests, LightTablesOfAnyLengthBecomeThoseOfTheModule) {
  manifest["lights"] = {{{"type", "point"},
                         {"position", {1, 2, 3}},
                         {"direction", {0, 0, 1}},
                         {"range", 10},
                         {"angleTable", {1, 0}},
                         {"distanceTable", {0, 1, 0.5}}}};
  const Light light = read().lights[0];
  EXPECT_EQ(light.direction[2], 1);
  ASSERT_EQ(light.angleTable.size(), 64u);
  for (std::size_t i = 0; i < 64; ++i) {
    const double at = static_cast<double>(i) / 63;
    EXPECT_DOUBLE_EQ(light.angleTable[i], 1 - at);
    EXPECT_DOUBLE_EQ(light.distanceTable[i], at < 0.5 ? 2 * at : 1.5 - at);
  }
}

// A beam 1 degree wide between two of the 64 angles is lost whole, one of 12 degrees is not.
TEST_F(Manifests, LightTablesSayWhatTheyLose) {
  const auto beam = [](double at, double halfWidth) {
    std::vector<double> factors(361);
    for (std::size_t i = 0; i < factors.size(); ++i)
      factors[i] = std::max(0.0, 1 - std::abs(0.5 * static_cast<double>(i) - at) / halfWidth);
    return factors;
  };
  const double step = 180.0 / (PELLUCID_LIGHT_TABLE_ENTRIES - 1);
  manifest["lights"][0]["angleTable"] = beam(1.5, 1);
  Capture capture = read();
  EXPECT_EQ(capture.lights[0].angleTableError, 1)
      << "all angles of the table are outside of 0.5 .. 2.5 degrees";
  ASSERT_EQ(coarseTables(capture).size(), 1u);
  expectNames(coarseTables(capture)[0], {"lights[0].angleTable", "1/63", "1 of the most"});
  manifest["lights"][0]["angleTable"] = beam(10, 12);
  capture = read();
  // A tent loses at its top at most what half a step takes off.
  EXPECT_LE(capture.lights[0].angleTableError, step / 2 / 12 + 1e-9);
  manifest["lights"][0]["angleTable"] = beam(0, 180);
  EXPECT_LT(read().lights[0].angleTableError, 1e-9) << "a line";
  EXPECT_TRUE(coarseTables(read()).empty());
}

TEST_F(Manifests, WhatLiesBesideAShadowMapArrives) {
  const Capture capture = read();
  const ShadowMap& map = capture.lights[0].shadowMaps[0];
  EXPECT_TRUE(sameBits(map.exitDepth, sample.lights[0].shadowMaps[0].exitDepth));
  ASSERT_EQ(map.casterMaterial.size(), map.depth.image.pixels());
  EXPECT_EQ(map.casterMaterial[0], 1) << "7 by the map";
  EXPECT_EQ(map.casterMaterial[1], 0);
  const ShadowMap& constant = capture.lights[1].shadowMaps[0];
  ASSERT_EQ(constant.exitDepth.pixels(), constant.depth.image.pixels()) << "a constant has the map's size";
  EXPECT_EQ(constant.exitDepth.data.back(), 6.0f);
  EXPECT_EQ(constant.casterMaterial, std::vector<std::uint8_t>(constant.depth.image.pixels(), 1));
  for (const char* optional : {"exit", "casterMaterial"}) manifest["lights"][0]["shadowMap"].erase(optional);
  EXPECT_TRUE(read().lights[0].shadowMaps[0].exitDepth.empty());
  EXPECT_TRUE(read().lights[0].shadowMaps[0].casterMaterial.empty());
}

TEST_F(Manifests, TilesAreCutOutOfTheirImage) {
  json& map = manifest["lights"][0]["shadowMap"];
  map["offset"] = {1, 1};
  map["size"] = {2, 2};
  json& around = manifest["lights"][1]["shadowMaps"];
  around[1] = map;
  around[1]["offset"] = {0, 0};
  const Capture capture = read();
  const ShadowMap &tile = capture.lights[0].shadowMaps[0], &other = capture.lights[1].shadowMaps[1];
  const Image& whole = sample.lights[0].shadowMaps[0].depth.image;
  ASSERT_EQ(tile.depth.image.width, 2);
  ASSERT_EQ(tile.depth.image.height, 2);
  EXPECT_EQ(*tile.depth.image.at(1, 0), *whole.at(2, 1));
  EXPECT_EQ(*tile.exitDepth.at(0, 1), *sample.lights[0].shadowMaps[0].exitDepth.at(1, 2));
  EXPECT_EQ(tile.casterMaterial.size(), 4u);
  EXPECT_EQ(*other.depth.image.at(1, 1), *whole.at(1, 1));
  EXPECT_EQ(tile.sharedImage, 0);
  EXPECT_EQ(other.sharedImage, 0) << "tiles of one channel share an image";
  EXPECT_EQ(capture.lights[1].shadowMaps[0].sharedImage, -1) << "the whole image is one of its own";
}

TEST_F(Manifests, CountOfShadowMapsIsLimited) {
  json& maps = manifest["lights"][1]["shadowMaps"];
  const json one = maps[1];
  while (maps.size() < PELLUCID_MAX_LIGHT_SHADOW_MAPS) maps.push_back(one);
  EXPECT_EQ(read().lights[1].shadowMaps.size(), std::size_t{PELLUCID_MAX_LIGHT_SHADOW_MAPS});
  maps.push_back(one);
  expectNames(error(), {"lights[1].shadowMaps", "1 to 8", "has 9"});
}

TEST_F(Manifests, OneChannelMayServeTwice) {
  manifest["buffers"]["irradiance"]["channels"] = {"E.G", "E.G", "E.B"};
  const Capture capture = read();
  EXPECT_EQ(capture.irradiance.at(3, 2)[0], sample.irradiance.at(3, 2)[1]);
  EXPECT_EQ(capture.irradiance.at(3, 2)[1], sample.irradiance.at(3, 2)[1]);
  EXPECT_EQ(capture.irradiance.at(3, 2)[2], sample.irradiance.at(3, 2)[2]);
}

// Programs store E / pi, pre-exposed light, and centimeters.
TEST_F(Manifests, StoredValuesMayHaveAScale) {
  const Capture plain = read();
  manifest["buffers"]["frontDepth"]["scale"] = 0.01;
  manifest["buffers"]["irradiance"]["scale"] = 4;
  manifest["buffers"]["albedo"] = {{"constant", {0.25, 0.5, 0.125}}, {"scale", 2}};
  manifest["truth"]["scale"] = 8;
  manifest["truth"]["standardError"] = {{"constant", {0.25, 0.5, 0.125}}};
  const Capture scaled = read();
  for (std::size_t i = 0; i < plain.irradiance.data.size(); ++i)
    EXPECT_EQ(scaled.irradiance.data[i], 4 * plain.irradiance.data[i]);
  for (std::size_t i = 0; i < plain.frontDepth.image.data.size(); ++i) {
    const float stored = plain.frontDepth.image.data[i];
    if (stored < 1e9f)
      EXPECT_EQ(scaled.frontDepth.image.data[i], 0.01f * stored);
    else
      EXPECT_EQ(scaled.frontDepth.image.data[i], stored) << "nothing is there";
  }
  EXPECT_EQ(scaled.albedo.data[1], 1);
  EXPECT_EQ(scaled.truth->standardError.data[1], 4) << "noise has the unit of its truth";
}

// OpenGL's view z is below 0 before the camera. Read as it is, it would be an empty picture.
TEST_F(Manifests, NegativeViewZIsRefusedOrScaled) {
  for (const char* buffer : {"frontDepth", "backDepth"}) {
    const json before = manifest["buffers"][buffer];
    manifest["buffers"][buffer] = {{"constant", {-12.5}}, {"encoding", "viewZ"}};
    expectNames(error(), {std::string("buffers.") + buffer, "negative", "\"scale\": -1"});
    manifest["buffers"][buffer]["scale"] = -1;
    const Capture capture = read();
    const DepthImage& depth = std::string(buffer) == "frontDepth" ? capture.frontDepth : capture.backDepth;
    EXPECT_EQ(depth.image.at(3, 2)[0], 12.5f);
    manifest["buffers"][buffer]["scale"] = 0;
    expectNames(error(), {std::string("buffers.") + buffer, "must not be 0"});
    manifest["buffers"][buffer] = before;
  }
}

// A thickness map of 0..1 has its range as the scale. Depths of fronts are none, and neither are those of
// shadow maps.
TEST_F(Manifests, ThicknessesStandForBackDepths) {
  manifest["buffers"]["backDepth"] = {{"constant", {0.25}}, {"encoding", "thickness"}, {"scale", 20}};
  const Capture capture = read();
  EXPECT_EQ(capture.backDepth.encoding, PELLUCID_DEPTH_THICKNESS);
  EXPECT_EQ(capture.backDepth.image.at(3, 2)[0], 5.0f);
  manifest["buffers"]["backDepth"]["constant"] = {0};
  EXPECT_EQ(read().backDepth.image.at(3, 2)[0], 0.0f);
  manifest["buffers"]["backDepth"]["constant"] = {-1};
  expectNames(error(), {"buffers.backDepth", "no thickness from 0 on", "mm"});
  for (const char* pointer : {"/buffers/frontDepth/encoding", "/lights/0/shadowMap/encoding"}) {
    json wrong = manifest;
    wrong["buffers"]["backDepth"]["constant"] = {1};
    std::swap(manifest, wrong);
    manifest[json::json_pointer(pointer)] = "thickness";
    expectNames(error(), {"encoding", "thickness", "viewZ"});
    std::swap(manifest, wrong);
  }
}

// Ray tracers store how far along its ray a pixel's surface lies: of a plane that faces the camera, more to
// the side.
TEST_F(Manifests, DistancesAlongRaysBecomeViewZ) {
  manifest["buffers"]["frontDepth"] = {{"constant", {9.0}}, {"encoding", "distance"}};
  const Capture capture = read();
  EXPECT_EQ(capture.frontDepth.encoding, PELLUCID_DEPTH_VIEW_Z);
  for (const auto& [x, y] : {std::pair(0, 0), {3, 2}, {capture.width - 1, 1}}) {
    // The sample's clipFromView: x and y are times 2 and -2, over w = -z.
    const double tx = ((x + 0.5) / capture.width * 2 - 1) / 2, ty = ((y + 0.5) / capture.height * 2 - 1) / 2;
    EXPECT_NEAR(capture.frontDepth.image.at(x, y)[0], 9 / std::hypot(tx, ty, 1.0), 1e-6) << x << " " << y;
  }
}

// Engines have them, and the shared captures, too. Nothing of them is read: not even their file.
TEST_F(Manifests, NormalsMayBeThere) {
  for (const json& normal :
       {json{{"constant", {0, 0, 1}}, {"space", "view"}},
        json{{"file", "none.exr"}, {"channels", {"N.X", "N.Y", "N.Z"}}, {"encoding", "unorm"}}}) {
    manifest["buffers"]["normal"] = normal;
    EXPECT_TRUE(sameBits(read().irradiance, sample.irradiance));
    EXPECT_TRUE(readManifest(directory / "m.json").hasNormal);
  }
  manifest["buffers"].erase("normal");
  read();
  EXPECT_FALSE(readManifest(directory / "m.json").hasNormal);
}

// Renderers keep light and color apart, or multiplied: what is read is the irradiance, and the whole truth.
TEST_F(Manifests, LightMayBeAColorsMultipleOrPart) {
  const Capture plain = read();
  Image color(kSampleWidth, kSampleHeight, 3);
  for (std::size_t i = 0; i < color.data.size(); ++i) color.data[i] = i % 5 == 0 ? 0.5f : 0.25f;
  writeExr(directory / "color.exr", color, {"R", "G", "B"});
  const json times = {{"file", "color.exr"}, {"channels", {"R", "G", "B"}}};
  manifest["buffers"]["irradiance"]["times"] = times;
  manifest["truth"]["times"] = times;
  const Capture product = read();
  for (std::size_t i = 0; i < color.data.size(); ++i) {
    ASSERT_EQ(product.irradiance.data[i], plain.irradiance.data[i] * color.data[i]) << i;
    ASSERT_EQ(product.truth->image.data[i], plain.truth->image.data[i] * color.data[i]) << i;
  }
  manifest["buffers"]["irradiance"]["includesAlbedo"] = true;
  manifest["buffers"]["albedo"] = times;
  EXPECT_TRUE(sameBits(read().irradiance, plain.irradiance)) << "powers of two";
  manifest["buffers"]["irradiance"]["includesAlbedo"] = 1;
  expectNames(refusalOf([&] { read(); }), {"buffers.irradiance.includesAlbedo", "true or false"});
  manifest["buffers"]["irradiance"]["includesAlbedo"] = true;
  manifest["buffers"].erase("albedo");
  expectNames(refusalOf([&] { read(); }), {"buffers.irradiance.includesAlbedo", "albedo"});
}

// Bytes of an 8-bit target, which a converter turned into fractions.
TEST_F(Manifests, MaterialsMayBeFractionsOfBytes) {
  const Capture whole = read();
  Image fractions(kSampleWidth, kSampleHeight, 1);
  for (std::size_t i = 0; i < whole.material.size(); ++i) fractions.data[i] = static_cast<float>(whole.material[i]) / 255;
  writeExr(directory / "bytes.exr", fractions, {"R"});
  json& material = manifest["buffers"]["material"];
  material = {{"file", "bytes.exr"}, {"channel", "R"}};
  expectNames(refusalOf([&] { read(); }), {"bytes.exr", "buffers.material", "= 1/255", "\"scale\": 255"});
  material["scale"] = 255;
  EXPECT_EQ(read().material, whole.material);
}

// Each layer of the array is one image: the image of another file would take the place of the first one.
TEST_F(Manifests, LayersOfTwoFilesAreRefused) {
  json& map = manifest["lights"][0]["shadowMap"];
  map.erase("exit");
  map.erase("casterMaterial");
  map["layer"] = 0;
  json second = manifest["lights"][0];
  second["shadowMap"]["file"] = "other.exr";
  manifest["lights"].push_back(second);
  const std::size_t last = manifest["lights"].size() - 1;
  expectNames(refusalOf([&] { read(); }), {"lights[" + std::to_string(last) + "].shadowMap.layer", "is 0", "lights[0].shadowMap.layer"});
}

// Engines store motion in pixels, in parts of the image or of clip space, upwards or downwards.
TEST_F(Manifests, MotionIsInPartsOfTheImage) {
  EXPECT_TRUE(read().motion.empty());
  json& motion = manifest["buffers"]["motion"];
  motion = {{"file", "g.exr"}, {"channels", {"E.R", "E.G"}}, {"motionScale", {0.5, -0.25}}};
  const Capture capture = read();
  ASSERT_EQ(capture.motion.channels, 2);
  for (std::size_t i = 0; i < capture.motion.pixels(); ++i) {
    ASSERT_EQ(capture.motion.data[2 * i], 0.5f * capture.irradiance.data[3 * i]);
    ASSERT_EQ(capture.motion.data[2 * i + 1], -0.25f * capture.irradiance.data[3 * i + 1]);
  }
  motion["motionScale"] = {0.5};
  expectNames(refusalOf([&] { read(); }), {"buffers.motion.motionScale", "2"});
  motion.erase("motionScale");
  motion["scale"] = 2;
  expectNames(refusalOf([&] { read(); }), {"buffers.motion.scale"});
}

TEST_F(Manifests, FilesAreRelativeToTheManifest) {
  std::filesystem::create_directory(directory / "sub");
  for (const char* name : {"frontDepth", "backDepth", "irradiance", "material"})
    manifest["buffers"][name]["file"] = "../g.exr";
  manifest["truth"]["file"] = (directory / "g.exr").string();
  manifest["lights"] = json::array();
  writeText(directory / "sub/m.json", manifest.dump());
  EXPECT_TRUE(sameBits(readCapture(directory / "sub/m.json").irradiance, sample.irradiance));
}

TEST_F(Manifests, FloatMaterialIsRounded) {
  Image id(kSampleWidth, kSampleHeight, 1, 8.995f);
  id.data[0] = 0.005f;
  writeExr(directory / "id.exr", id, {"id"});
  manifest["buffers"]["material"] = {{"file", "id.exr"}, {"channel", "id"}, {"map", {{"9", 1}}}};
  const Capture capture = read();
  EXPECT_EQ(capture.material[0], 0);  // rounds to 0, which needs no entry in the map
  EXPECT_EQ(capture.material[1], 1);
}

// Between two materials, a filtered image names a third one.
TEST_F(Manifests, FilteredMaterialsAreNamed) {
  Image id(kSampleWidth, kSampleHeight, 1, 1);
  id.data[2] = 0.75f;
  writeExr(directory / "id.exr", id, {"id"});
  manifest["buffers"]["material"] = {{"file", "id.exr"}, {"channel", "id"}};
  expectNames(error(), {"id.exr", "buffers.material", "pixel (2, 0) holds 0.75", "no whole number"});
}

// What a reader takes for granted is said.
TEST_F(Manifests, WarningsNameHalvesUnitsAndLightsInBodies) {
  const auto warns = [&](const char* words) {
    const std::vector<std::string> all = read().warnings;
    return std::any_of(all.begin(), all.end(), [&](const std::string& s) { return s.find(words) != std::string::npos; });
  };
  EXPECT_FALSE(warns("metersPerUnit"));
  EXPECT_FALSE(warns("half floats"));
  EXPECT_FALSE(warns("lies inside the body"));
  manifest.erase("metersPerUnit");
  EXPECT_TRUE(warns("metersPerUnit: missing"));

  const Image front(kSampleWidth, kSampleHeight, 1, 300), back(kSampleWidth, kSampleHeight, 1, 310);
  ExrPart half;
  half.channels.push_back({"Z", ExrFormat::Half, &front, 0});
  writeExrParts(directory / "front.exr", {half});
  writeExr(directory / "back.exr", back, {"Z"});
  manifest["metersPerUnit"] = 0.001;
  manifest["camera"] = {{"clipFromView", {1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0}}, {"viewFromWorld", kIdentity}};
  manifest["buffers"]["frontDepth"] = {{"file", "front.exr"}, {"channel", "Z"}, {"encoding", "viewZ"}};
  manifest["buffers"]["backDepth"] = {{"file", "back.exr"}, {"channel", "Z"}, {"encoding", "viewZ"}};
  manifest["buffers"]["material"] = {{"constant", {1}}};
  manifest["lights"] = {{{"type", "point"}, {"position", {0, 0, -305}}}};
  EXPECT_TRUE(warns("buffers.frontDepth: half floats tell depths apart by 0.15 mm"));
  EXPECT_TRUE(warns("lights[0].position: lies inside the body"));
  manifest["lights"][0]["position"] = {0, 0, -311};
  EXPECT_FALSE(warns("lies inside the body"));
  EXPECT_FALSE(warns("has y up"));
  manifest["camera"]["clipFromView"][5] = 1;
  EXPECT_TRUE(warns("has y up"));
  EXPECT_FALSE(warns("no thickness is above 1 mm"));
  manifest["buffers"]["backDepth"] = {{"constant", {0.5}}, {"encoding", "thickness"}};
  EXPECT_TRUE(warns("no thickness is above 1 mm"));
}

// What writes a value to text would call itself for each level.
TEST_F(Manifests, DeepJsonIsRefused) {
  const std::string deep = std::string(200000, '[') + std::string(200000, ']');
  expectNames(refusalOf([&] { parseJson("m.json", "{\"pellucid\": " + deep + "}"); }), {"m.json", "nested deeper than 100 levels"});
}

TEST_F(Manifests, AlbedoNextToNothingIsNamed) {
  const auto warns = [&] {
    const std::vector<std::string> all = read().warnings;
    return std::any_of(all.begin(), all.end(), [](const std::string& s) { return s.find("includesAlbedo: 45 values are over 100 times") != std::string::npos; });
  };
  manifest["buffers"]["irradiance"] = {{"constant", {1, 1, 1}}, {"includesAlbedo", true}};
  EXPECT_FALSE(warns());
  manifest["buffers"]["albedo"]["constant"] = {1e-6, 1e-6, 1e-6};
  EXPECT_TRUE(warns()) << "15 pixels have a material";
}

TEST_F(Manifests, AStarNamesAllOtherMaterials) {
  Image id(kSampleWidth, kSampleHeight, 1, -1);
  id.data[0] = 9;
  id.data[1] = std::numeric_limits<float>::quiet_NaN();
  writeExr(directory / "id.exr", id, {"id"});
  manifest["buffers"]["material"] = {{"file", "id.exr"}, {"channel", "id"}, {"map", {{"9", 1}, {"-1", 0}}}};
  expectNames(error(), {"buffers.material", "pixel (1, 0)", "nan", "\"*\": 0"});
  manifest["buffers"]["material"]["map"] = {{"9", 1}, {"*", 0}};
  const Capture capture = read();
  EXPECT_EQ(capture.material[0], 1);
  EXPECT_EQ(capture.material[1], 0);
  EXPECT_EQ(capture.material[2], 0);
}

TEST_F(Manifests, MaterialMayBeConstant) {
  manifest["buffers"]["material"] = {{"constant", {1}}};
  EXPECT_EQ(read().material, std::vector<std::uint8_t>(kSampleWidth * kSampleHeight, 1));
}

TEST_F(Manifests, MaterialsThatAreNoNumbersAreNamed) {
  Image id(kSampleWidth, kSampleHeight, 1, std::numeric_limits<float>::quiet_NaN());
  writeExr(directory / "id.exr", id, {"id"});
  manifest["buffers"]["material"] = {{"file", "id.exr"}, {"channel", "id"}};
  expectNames(error(), {"id.exr", "buffers.material", "pixel (0, 0)", "nan"});
}

TEST_F(Manifests, AConstantCaptureHasNoSize) {
  for (auto& [name, buffer] : manifest["buffers"].items()) {
    const json encoding = buffer.value("encoding", json());
    buffer = {{"constant", std::vector<double>(name == "albedo" || name == "irradiance" ? 3 : 1, 1)}};
    if (!encoding.is_null()) buffer["encoding"] = encoding;
  }
  manifest.erase("truth");
  expectNames(error(), {"m.json", "buffers", "constant", "file"});
}

TEST_F(Manifests, OtherFilesAreNamed) {
  expectNames(refusalOf([&] { readCapture(directory / "none.json"); }), {"none.json", "no such file"});
  writeText(directory / "m.json", "{\"pellucid\": 1, ");
  expectNames(refusalOf([&] { readCapture(directory / "m.json"); }), {"m.json", "JSON"});
  writeText(directory / "m.json", "{\"pellucid\": 1, \"camera\": {}, \"camera\": {}}");
  expectNames(refusalOf([&] { readCapture(directory / "m.json"); }), {"m.json", "camera", "twice"});
  expectNames(refusalOf([&] { readCapture(directory / "g.exr"); }), {"g.exr", "pellucid.manifest"});
  std::filesystem::create_directory(directory / "d");
  expectNames(refusalOf([&] { readCapture(directory / "d"); }), {"not a regular file"});
  writeText(directory / "g.exr", "PNG, really");
  expectNames(error(), {"g.exr", "buffers.frontDepth.file", "not an OpenEXR file"});
}

// "/lights/0/type" is lights[0].type.
std::string fieldOf(json::json_pointer pointer) {
  std::string field;
  for (; !pointer.empty(); pointer.pop_back()) {
    const std::string key = pointer.back();
    const bool isIndex = key.find_first_not_of("0123456789") == std::string::npos;
    field = (isIndex ? "[" + key + "]" : "." + key) + field;
  }
  return field.substr(1);
}

constexpr const char* kRequired = R"(
/pellucid /camera /camera/clipFromView /camera/viewFromWorld /buffers /buffers/frontDepth
/buffers/irradiance /buffers/material /buffers/frontDepth/encoding /buffers/frontDepth/file
/buffers/frontDepth/channel /buffers/irradiance/channels /materials /materials/0/absorption /lights/0/type
/lights/0/position /lights/0/direction /lights/0/shadowMap/clipFromWorld /lights/0/shadowMap/viewFromWorld
/lights/1/shadowMaps/1/clipFromWorld
)";

constexpr const char* kUnknown = R"(
/exposure /camera/fov /buffers/albedo/layer /buffers/material/channels /lights/0/glow
/lights/0/shadowMap/bias /lights/0/shadowMap/exit/encoding /lights/0/shadowMap/casterMaterial/gain
/lights/1/shadowMaps/0/bias /materials/0/name /truth/exposure
)";

// Of each row: what is changed, to which JSON, and what the error names besides; "@" before a field that is
// not the changed one.
constexpr const char* kMistakes = R"(
/buffers/irradiance/scale | 0 | above 0
/buffers/material/scale | 0 | above 0
/buffers/backDepth | {"constant": [0.5], "encoding": "device", "scale": 2} | buffers.backDepth.scale | no unit
/environment | [[1, 1, 1]] | needs 9 coefficients | has 1
/environment | [[1, 1], 1, 1, 1, 1, 1, 1, 1, 1] | environment[0] | 3
/buffers/depth | {} | unknown key | frontDepth
/lights/0/cookie | {} | unknown key | angleTable
/lights/0/radius | 1 | only a point light
/lights/0/shadowMap/faces | "both" | both
/lights/0/shadowMap/layer | -1 | -1
/lights/0/shadowMap/depthStep | -1 | -1
/lights/0/shadowMap/offsetLength | -1 | -1
/lights/0/shadowMap/depthBiasSlope | 2e6 | 2000000
/lights/0/shadowMap/depthBiasConstant | "x" | number
/lights/0/shadowMap/offset | [1, 2] | size
/lights/0/shadowMap/size | [1] | 2 whole numbers
/lights/0/shadowMap/size | [1, 0] | 0
/lights/1/shadowMaps/1/size | [1, 1] | constant
/lights/0/shadowMap/size | [100, 2] | @lights[0].shadowMap | s.exr | 100x2 texels at (0, 0) | outside the image
/truth/samples | "-1" | whole number in quotes | -1
/lights/1/shadowMap | {} | lights[1].shadowMaps | not both
/lights/1/shadowMaps | [] | has 0
/lights/1/shadowMaps | {} | array
/pellucid | 2 | version 2
/metersPerUnit | 0 | at least | 0
/metersPerUnit | "1" | number | "1"
/metersPerUnit | 1e300 | 1e+300
/camera/clipFromView | [1,2,3] | 16 | 3
/camera/clipFromView | [1,0,0,0,0,1,0,0,0,0,0,0,0,0,0,1] | singular
/camera/clipFromView/5 | null | null
/camera/viewFromWorld | [2,0,0,0,0,2,0,0,0,0,2,0,0,0,0,1] | rigid
/camera/viewFromWorld | [1,0,0,5,0,1,0,6,0,0,1,7,0,0,0,1] | column-major
/buffers/frontDepth/encoding | "planar" | viewZ | planar
/buffers/frontDepth/part | 4 | g.exr | 4
/buffers/frontDepth/part | -1 | -1
/buffers/frontDepth/part | 0.5 | 0.5
/buffers/frontDepth/channel | "W" | @buffers.frontDepth | g.exr | "W" | ZBack
/buffers/frontDepth/file | "h.exr" | h.exr | no such file
/buffers/frontDepth/constant | [1] | @buffers.frontDepth.file | constant
/buffers/albedo/constant | [1] | 3 | 1
/buffers/irradiance/channels | ["E.R"] | 3 | 1
/buffers/irradiance/channels/1 | "" | empty
/buffers/material/map | {"1": 2} | buffers.material.map.1 | 2 | 1 materials
/buffers/material/map | {"one": 1} | buffers.material.map.one | whole number
/buffers/material/map | {"1": 1, "01": 0} | twice
/lights/0/type | "area" | area | spot
/lights/0/direction | [0,0,0] | length
/lights/0/color | [1,-1,1] | negative | -1
/lights/0/intensity | -2 | -2
/lights/0/range | -1 | -1
/lights/0/angleTable | [1] | two factors | 1
/lights/0/angleTable | [1, 2] | lights[0].angleTable[1] | 2
/lights/0/outerConeAngle | 1.6 | 1.6
/lights/0/innerConeAngle | 0.8 | 0.8
/materials | [] | 0
/materials/0/scattering | [-1, 1, 1] | -1
/materials/0/unit | "1/inch" | 1/inch | 1/cm
/materials/0/g | 1 | 1
/materials/0/ior | 0.9 | 0.9
/materials/0 | {} | preset | subsurface_color
/materials/0 | {"subsurface_color": [0.5, 1.5, 0]} | materials[0].subsurface_color[1] | at most 1 | 1.5
/materials/0 | {"subsurface_radius": 0} | materials[0].subsurface_radius | above 0 | 0
/materials/0 | {"subsurface_radius_scale": [1, 0, 1]} | materials[0].subsurface_radius_scale | above 0
/materials/0 | {"subsurface_scatter_anisotropy": 1} | materials[0].subsurface_scatter_anisotropy | 1
/materials/0 | {"subsurface_radius": 1, "specular_ior": 4} | materials[0].specular_ior | 4
/materials/0 | {"subsurface_radius": 1, "unit": "inch"} | materials[0].unit | inch | mm
/materials/0 | {"subsurface_color": [1, 1, 1], "subsurface_weight": 1} | materials[0].subsurface_weight | unknown key
/materials/0 | {"melanin": 2} | materials[0].melanin | 2
/materials/0 | {"melanin": 0, "haemoglobin": 0} | materials[0].haemoglobin | unknown
/materials/0 | {"profile": "burley", "distance": [1, 0, 1]} | materials[0].distance | positive
/materials/0 | {"profile": "sss", "distance": [1, 1, 1]} | materials[0].profile | sss
/materials/0 | {"gaussians": {"variance": [1], "weight": [[1, 1, 0.5]]}} | materials[0].gaussians.weight | sum
/materials/0 | {"thinWalled": {"reflectance": [0.5, 0.5, 0.5], "transmittance": [0.5, 0.6, 0]}} | materials[0].thinWalled.transmittance | 1.1
/materials/0 | {"thinWalled": {"reflectance": [0.5, -1, 0.5], "transmittance": [0, 0, 0]}} | materials[0].thinWalled.reflectance[1] | at least 0
/truth/scale | "pi" | pi
/buffers/albedo | {"file": "s.exr", "channels": ["id", "id", "id"]} | s.exr | 3x3 | 7x5 | buffers.frontDepth
/buffers/material/map | {"7": 1} | @buffers.material | g.exr | pixel (1, 0) | holds 1
/buffers/material | {"constant": [300]} | 300 | 1 materials
/buffers/material | {"constant": [-1]} | -1
/lights/0/shadowMap/exit | {"file": "g.exr", "channel": "Z"} | g.exr
/lights/0/shadowMap/casterMaterial | {"file": "g.exr", "channel": "id"} | g.exr
/lights/0/shadowMap/casterMaterial/map | {"3": 1} | @lights[0].shadowMap.casterMaterial | s.exr | holds 7
/lights/0/shadowMap/casterMaterial | {"file": "s.exr", "channel": "id"} | holds 7 | 1 materials
/lights/1/outerConeAngle | 0.5 | of spot lights
/camera/viewFromWorld | [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1] | mirrored
/camera/clipFromView | [1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 0, -0.1, 0, 0, -1, 0] | transposed
/lights/1/angleTable | [1, 0] | @lights[1].direction
/lights/1/distanceTable | [1, 0] | range
/lights/1 | {"type": "directional", "direction": [0, 0, 1], "angleTable": [1, 0]} | @lights[1].angleTable
)";

TEST_F(Manifests, WhatIsMissingOrUnknownIsNamed) {
  const json good = manifest;
  for (const bool unknown : {false, true}) {
    std::istringstream pointers(unknown ? kUnknown : kRequired);
    for (std::string text; pointers >> text;) {
      SCOPED_TRACE(text);
      const json::json_pointer pointer(text);
      manifest = good;
      if (unknown)
        manifest[pointer] = 1;
      else
        manifest[pointer.parent_pointer()].erase(pointer.back());
      expectNames(error(), {"m.json", fieldOf(pointer), unknown ? "unknown key" : "missing"});
    }
  }
}

TEST_F(Manifests, WrongValuesAreNamed) {
  const json good = manifest;
  for (const std::vector<std::string>& cells : tableOf(kMistakes)) {
    SCOPED_TRACE(testing::PrintToString(cells));
    const json::json_pointer pointer(cells[0]);
    manifest = good;
    manifest[pointer] = json::parse(cells[1]);
    std::vector<std::string> named(cells.begin() + 2, cells.end());
    if (!named.empty() && named[0][0] == '@')
      named[0].erase(0, 1);
    else
      named.push_back(fieldOf(pointer));
    named.push_back((directory / "").string());
    expectNames(error(), named);
  }
}

// Names and values of files may be as long as the files, and hold what a terminal obeys.
TEST_F(Manifests, MessagesAreShortAndOfOneLine) {
  const json good = manifest;
  const std::string tangled = "\x1b[31m\n\u00e9" + std::string(30000, 'x') + "\u00e9";
  for (const char* where : {"/buffers/irradiance/channels/0", "/buffers/frontDepth/file", "/lights/0/type"}) {
    manifest = good;
    manifest[json::json_pointer(where)] = tangled;
    expectNames(error(), {(directory / "").string()});
    EXPECT_LT(error().size(), 9000u) << where;
  }
  manifest = good;
  manifest[tangled] = 1;
  for (const std::string& sentence : {error(), refusalOf([] { parseJson("m.json", "[\"\x01" + std::string(30000, '\x01')); })}) {
    EXPECT_LT(sentence.size(), 9000u);
    EXPECT_TRUE(std::none_of(sentence.begin(), sentence.end(), [](unsigned char c) { return c < 0x20; })) << sentence;
    EXPECT_NO_THROW(json(sentence).dump()) << "no character of UTF-8 is cut";
  }
}

TEST_F(Manifests, UnknownPresetIsNamedWhenCompiled) {
  manifest["materials"][0] = {{"preset", "plutonium"}};
  const Capture capture = read();
  expectNames(refusalOf([&] { compileMaterials(capture); }),
              {"m.json", "materials[0]", "preset", "plutonium"});
}

TEST_F(Manifests, OpenPbrMediaHaveDefaultsAndAUnit) {
  manifest["materials"][0] = {{"subsurface_radius", 0.2}, {"unit", "cm"}};
  OpenPbrMaterial expected;
  expected.radius = 2;
  EXPECT_EQ(std::get<OpenPbrMaterial>(read().materials[0]), expected);
  manifest["materials"][0] = {{"subsurface_color", {0.5, 0.4, 0.3}}};
  expected = {{0.5, 0.4, 0.3}};
  EXPECT_EQ(std::get<OpenPbrMaterial>(read().materials[0]), expected);
  manifest["materials"][0] = {{"hemoglobin", 0.1}};
  EXPECT_EQ(std::get<SkinMaterial>(read().materials[0]), (SkinMaterial{0.005, 0.5, 0.1, 1.4}));
}

// An index given for all media changes the boundary: an OpenPBR medium keeps its color, and gets the albedo
// that has this color behind it.
TEST(Materials, OpenPbrMediaKeepTheirColorAtAnotherIndex) {
  const OpenPbrMaterial material{{0.8, 0.5, 0.3}, 2, {1, 1, 1}, 0, 1.5};
  const MaterialSource matched = withIor(material, 1, "test");
  const CoefficientMaterial here = coefficientsOf(material, "test"), there = coefficientsOf(matched, "test");
  EXPECT_EQ(there.ior, 1);
  for (std::size_t c = 0; c < 3; ++c) {
    EXPECT_NEAR(here.scattering[c] + here.absorption[c], 0.5, 1e-12);
    EXPECT_NEAR(there.scattering[c] + there.absorption[c], 0.5, 1e-12);
    EXPECT_LT(there.scattering[c], here.scattering[c]);
  }
  EXPECT_EQ(std::get<SkinMaterial>(withIor(SkinMaterial{}, 1.3, "test")).ior, 1.3);
  expectNames(refusalOf([] { coefficientsOf(SkinMaterial{}, "test"); }), {"test", "layers"});
}

TEST(Materials, EveryFormCompiles) {
  const auto materials = compileMaterials(sampleCapture());
  ASSERT_EQ(materials.size(), 8u);
  EXPECT_FLOAT_EQ(materials[2].transmittance[1][1], 3.0f);  // k1 of green, as given
  EXPECT_EQ(materials[3].gaussianCount, 2u);
  EXPECT_FLOAT_EQ(materials[3].gaussianWeight[2][1], 0.25f);
  EXPECT_EQ(materials[4].thinWalled, 1u);
  EXPECT_FLOAT_EQ(materials[4].wallTransmittance[2], 0.75f);
  EXPECT_FLOAT_EQ(materials[5].burleyDistance[1], 2.0f);
  EXPECT_GT(materials[6].reflectance[0], materials[6].reflectance[1]) << "the color's order";
  EXPECT_GT(materials[6].radius[0], materials[6].radius[2]) << "the scale's order";
  EXPECT_GT(materials[7].reflectance[0], materials[7].reflectance[2]) << "skin is red";
}

}  // namespace
}  // namespace pellucid::harness
