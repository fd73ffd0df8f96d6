// A small capture on disk, for tests to read, change and damage.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "capture/capture.h"
#include "capture/exr.h"
#include "capture/read.h"
#include "common/error.h"
#include "refusal.h"
#include "temporary_directory.h"

namespace pellucid::harness {

inline constexpr int kSampleWidth = 7, kSampleHeight = 5;  // not equal, not even: transposed reads show
inline constexpr int kSampleShadowSize = 3;

// Values that differ in every pixel and component and need all bits of a float.
inline Image sampleImage(int width, int height, int channels, float first) {
  Image image(width, height, channels);
  for (std::size_t i = 0; i < image.data.size(); ++i)
    image.data[i] = first + std::sqrt(static_cast<float>(i)) / 3.0f;
  return image;
}

// Every buffer, a light of each type, a material of each form, a truth.
inline Capture sampleCapture() {
  Capture capture;
  capture.environment.emplace();
  for (std::size_t i = 0; i < 9; ++i) (*capture.environment)[i] = {1.0 / double(i + 3), -0.5, double(i)};
  capture.width = kSampleWidth;
  capture.height = kSampleHeight;
  capture.metersPerUnit = 0.001;
  capture.clipFromView = {2, 0, 0, 0, 0, -2, 0, 0, 0, 0, -1.01, -1, 0, 0, -0.1, 0};
  capture.viewFromWorld = {1, 0, 0, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0.1, 0.2, -3, 1};
  const auto screen = [](int channels, float first) {
    return sampleImage(kSampleWidth, kSampleHeight, channels, first);
  };
  capture.frontDepth = {screen(1, 2.0f), PELLUCID_DEPTH_VIEW_Z};
  capture.frontDepth.image.data[0] = kNoDepth;
  capture.frontDepth.image.data[1] = std::numeric_limits<float>::infinity();
  capture.backDepth = {screen(1, 0.125f), PELLUCID_DEPTH_DEVICE};
  capture.irradiance = screen(3, 0.1f);
  capture.hiddenIrradiance = screen(3, 0.2f);
  capture.motion = screen(2, -0.4f);
  capture.albedo = screen(3, 0.3f);
  capture.truth = Truth{screen(3, 0.9f), screen(3, 0.01f), 1u << 20, 7, "0123456789abcdef"};
  for (int i = 0; i < kSampleWidth * kSampleHeight; ++i)
    capture.material.push_back(static_cast<std::uint8_t>(i % 5));

  Light sun;
  sun.direction = {0.1, -0.7, 1.0 / 3.0};
  sun.color = {1, 0.5, 0.25};
  sun.intensity = 12.566370614359172;
  sun.shadowMaps = {
      ShadowMap{{sampleImage(kSampleShadowSize, kSampleShadowSize, 1, 0.2f), PELLUCID_DEPTH_DEVICE},
                {0.1, 0, 0, 0, 0, 0.1, 0, 0, 0, 0, -0.01, 0, 0, 0, 0.5, 1},
                std::nullopt}};
  sun.shadowMaps[0].exitDepth = sampleImage(kSampleShadowSize, kSampleShadowSize, 1, 0.3f);
  for (int i = 0; i < kSampleShadowSize * kSampleShadowSize; ++i)
    sun.shadowMaps[0].casterMaterial.push_back(static_cast<std::uint8_t>(i % 5));
  sun.shadowMaps[0].depthBiasConstant = -1.25 / 65535;
  sun.shadowMaps[0].depthBiasSlope = -1.75;
  sun.shadowMaps[0].offsetLength = 0.125;
  sun.shadowMaps[0].depthStep = 1.0 / 65535;
  Light lamp;
  lamp.type = PELLUCID_LIGHT_POINT;
  lamp.position = {1.5, 2.5, -3.5};
  lamp.range = 40;
  lamp.radius = 0.25;
  for (int i = 0; i < PELLUCID_LIGHT_TABLE_ENTRIES; ++i) {
    lamp.angleTable.push_back(1.0 / (1 + i));
    lamp.distanceTable.push_back(i / 64.0);
  }
  Light spot;
  spot.type = PELLUCID_LIGHT_SPOT;
  spot.position = {0, 0, -9};
  spot.innerConeAngle = 0.25;
  spot.outerConeAngle = 0.5;
  spot.shadowMaps = {ShadowMap{{sampleImage(11, 13, 1, 4.0f), PELLUCID_DEPTH_DISTANCE},
                               {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, -1, 0, 0, -0.1, 0},
                               kIdentity}};
  spot.shadowMaps[0].exitDepth = sampleImage(11, 13, 1, 5.0f);
  spot.shadowMaps[0].exitDepth.data[2] = std::numeric_limits<float>::quiet_NaN();
  Light around = lamp;  // two maps of different sizes
  around.shadowMaps = {spot.shadowMaps[0],
                       {{sampleImage(3, 2, 1, 7.0f), PELLUCID_DEPTH_VIEW_Z},
                        {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 1, 0, 0, -0.1, 0},
                        kIdentity}};
  for (ShadowMap& map : around.shadowMaps) map.backFaces = true;
  Light tiled =
      lamp;  // two tiles of an atlas, of which one alone has an exit depth, and two layers of an array
  tiled.shadowMaps = around.shadowMaps;
  tiled.shadowMaps[0].sharedImage = tiled.shadowMaps[1].sharedImage = 0;
  tiled.shadowMaps[1].offset = {11, 5};
  Light layered = tiled;
  layered.shadowMaps[0].sharedImage = layered.shadowMaps[1].sharedImage = 1;
  layered.shadowMaps[1].layer = 1;
  capture.lights = {sun, lamp, spot, around, tiled, layered};
  capture.materials = {PresetMaterial{"skin1"},
                       CoefficientMaterial{{0.74, 0.88, 1.01}, {0.032, 0.17, 0.48}, 0.1, 1.3},
                       BurleyMaterial{{1, 2, 3},
                                      std::array<std::array<double, 4>, 3>{
                                          {{0.5, 1, 0.25, 2}, {0.5, 3, 0.25, 4}, {0.5, 5, 0.25, 6}}}},
                       GaussianMaterial{{0.5, 2}, {{0.25, 0.5, 0.75}, {0.75, 0.5, 0.25}}},
                       ThinWallMaterial{{0.25, 0.5, 0.125}, {0.5, 0.25, 0.75}, {}},
                       ThinWallMaterial{{0, 0.5, 1}, {1, 0.25, 0}, {{1, 2, 3}}},
                       OpenPbrMaterial{{0.8, 0.5, 0.3}, 2.5, {0.5, 0.25, 0.125}, 0.6, 1.3},
                       SkinMaterial{0.1, 0.7, 0.02, 1.45}};
  return capture;
}

inline void writeText(const std::filesystem::path& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

inline std::string readText(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

// Writes g.exr and s.exr of the sample's values into `directory` and returns the manifest that names them.
inline nlohmann::json writeSampleFiles(const std::filesystem::path& directory) {
  const Capture capture = sampleCapture();
  Image all(kSampleWidth, kSampleHeight, 6);
  for (int y = 0; y < kSampleHeight; ++y)
    for (int x = 0; x < kSampleWidth; ++x) {
      float* pixel = all.at(x, y);
      pixel[0] = *capture.frontDepth.image.at(x, y);
      std::copy_n(capture.irradiance.at(x, y), 3, pixel + 1);
      pixel[4] = static_cast<float>(x % 2);
      pixel[5] = *capture.backDepth.image.at(x, y);
    }
  writeExr(directory / "g.exr", all, {"Z", "E.R", "E.G", "E.B", "id", "ZBack"});
  const ShadowMap& map = capture.lights[0].shadowMaps[0];
  Image shadow(kSampleShadowSize, kSampleShadowSize, 3);
  for (std::size_t i = 0; i < shadow.pixels(); ++i) {
    shadow.data[3 * i] = map.depth.image.data[i];
    shadow.data[3 * i + 1] = map.exitDepth.data[i];
    shadow.data[3 * i + 2] = i % 2 == 0 ? 7.0f : 0.0f;
  }
  writeExr(directory / "s.exr", shadow, {"ViewLayer.Depth.Z", "ViewLayer.Exit.Z", "id"});
  return nlohmann::json::parse(R"({
    "pellucid": 1, "metersPerUnit": 0.001,
    "camera": {"clipFromView": [2,0,0,0, 0,-2,0,0, 0,0,-1.01,-1, 0,0,-0.1,0],
               "viewFromWorld": [1,0,0,0, 0,1,0,0, 0,0,1,0, 0.1,0.2,-3,1]},
    "buffers": {
      "frontDepth": {"file": "g.exr", "part": 0, "channel": "Z", "encoding": "viewZ"},
      "backDepth": {"file": "g.exr", "channel": "ZBack", "encoding": "device"},
      "irradiance": {"file": "g.exr", "channels": ["E.R", "E.G", "E.B"]},
      "albedo": {"constant": [0.62, 0.38, 0.24]},
      "material": {"file": "g.exr", "channel": "id", "map": {"1": 1}}},
    "lights": [{"type": "spot", "position": [0, 0, -9], "direction": [0, 0, -1], "color": [1, 1, 1], "intensity": 3,
                "range": 0, "innerConeAngle": 0.1, "outerConeAngle": 0.7,
                "shadowMap": {"file": "s.exr", "channel": "ViewLayer.Depth.Z", "encoding": "distance",
                              "exit": {"file": "s.exr", "part": 0, "channel": "ViewLayer.Exit.Z"},
                              "casterMaterial": {"file": "s.exr", "channel": "id", "map": {"7": 1}},
                              "clipFromWorld": [1,0,0,0, 0,1,0,0, 0,0,-1,-1, 0,0,-0.1,0],
                              "viewFromWorld": [1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1]}},
               {"type": "point", "position": [0, 0, 0], "shadowMaps": [
                 {"file": "s.exr", "channel": "ViewLayer.Depth.Z", "encoding": "distance",
                  "exit": {"constant": [6]}, "casterMaterial": {"constant": [1]},
                  "clipFromWorld": [1,0,0,0, 0,1,0,0, 0,0,-1,-1, 0,0,-0.1,0],
                  "viewFromWorld": [1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1]},
                 {"constant": [5], "encoding": "device",
                  "exit": {"constant": [1]}, "casterMaterial": {"constant": [0]},
                  "clipFromWorld": [1,0,0,0, 0,-1,0,0, 0,0,1,1, 0,0,-0.1,0]}]}],
    "materials": [{"scattering": [7.4, 8.8, 10.1], "absorption": [0.32, 1.7, 4.8], "g": 0, "ior": 1.4,
                   "unit": "1/cm"}],
    "truth": {"file": "g.exr", "channels": ["E.R", "E.G", "E.B"], "scale": 2}
  })");
}

// Bits, so that NaN, infinity and -0 count.
inline bool sameBits(const Image& a, const Image& b) {
  return a.width == b.width && a.height == b.height && a.channels == b.channels &&
         a.data.size() == b.data.size() &&
         (a.data.empty() || std::memcmp(a.data.data(), b.data.data(), a.data.size() * sizeof(float)) == 0);
}

inline void expectSame(const DepthImage& a, const DepthImage& b) {
  EXPECT_TRUE(sameBits(a.image, b.image));
  EXPECT_EQ(a.encoding, b.encoding);
}

using pellucid::test::refusalOf;

inline void expectNames(const std::string& sentence, const std::vector<std::string>& parts) {
  for (const std::string& part : parts)
    EXPECT_NE(sentence.find(part), std::string::npos) << '"' << part << "\" is not in: " << sentence;
}

// Rows of a text, with " | " between their cells.
inline std::vector<std::vector<std::string>> tableOf(const std::string& text) {
  std::vector<std::vector<std::string>> table;
  std::istringstream rows(text);
  for (std::string row; std::getline(rows, row);) {
    if (row.empty()) continue;
    std::vector<std::string>& cells = table.emplace_back();
    for (std::size_t at = 0; at != std::string::npos;) {
      const std::size_t end = row.find(" | ", at);
      cells.push_back(row.substr(at, end == std::string::npos ? end : end - at));
      at = end == std::string::npos ? end : end + 3;
    }
  }
  return table;
}

// The sample files with a manifest to change.
class Manifests : public testing::Test {
protected:
  Capture read() {
    writeText(directory / "m.json", manifest.dump());
    return readCapture(directory / "m.json");
  }
  std::string error() {
    return refusalOf([&] { read(); });
  }

  TemporaryDirectory directory;
  nlohmann::json manifest = writeSampleFiles(directory);
  Capture sample = sampleCapture();
};

}  // namespace pellucid::harness
