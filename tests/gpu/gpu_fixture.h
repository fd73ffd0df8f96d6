// A validated Vulkan device shared by the GPU tests. No device fails the tests; one validation or
// synchronization message fails the test that caused it.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <memory>
#include <string>

#include "capture/material.h"
#include "common/device.h"
#include "refusal.h"
#include "replay/replay.h"

namespace pellucid::test {

using namespace pellucid::harness;

class GpuTest : public testing::Test {
protected:
  static Device& device() {
    static Device shared({"", true});
    return shared;
  }
  static Replayer& replayer() {
    static Replayer shared(device());
    return shared;
  }

  void SetUp() override { messagesBefore_ = device().validationMessages().size(); }
  void TearDown() override {
    const std::vector<std::string> messages = device().validationMessages();
    for (size_t i = messagesBefore_; i < messages.size(); ++i) ADD_FAILURE() << messages[i];
  }

  static Image replay(const Capture& capture, const PellucidMaterial& material,
                      const ReplaySettings& settings = {}) {
    return replayer().run(capture, {material}, settings).output;
  }
  // With the capture's own materials.
  static Image replay(const Capture& capture, const ReplaySettings& settings) {
    return replayer().run(capture, compileMaterials(capture), settings).output;
  }
  static Image record(const FrameRun& run) {
    device().run([&](VkCommandBuffer commands) { run.record(commands); });
    return run.output();
  }
  static std::string refusalOfRecording(const FrameRun& run) {
    std::string sentence;
    device().run([&](VkCommandBuffer commands) { sentence = refusalOf([&] { run.record(commands); }); });
    return sentence;
  }

  // Frames of one size, each of which goes on with the history of the one before.
  struct Sequence {
    std::unique_ptr<FrameRun> last;
    Image run(const Capture& capture, const PellucidMaterial& material, const ReplaySettings& settings) {
      last = std::make_unique<FrameRun>(device(), replayer().contextFor(capture), capture,
                                        std::vector{material}, settings, last.get());
      return record(*last);
    }
  };

private:
  size_t messagesBefore_ = 0;
};

// Outputs of 32 bits a channel: halves round by 5e-4.
inline ReplaySettings inFloats(uint32_t features = ReplaySettings{}.features) {
  ReplaySettings settings;
  settings.features = features;
  settings.outputFormat = VK_FORMAT_R32G32B32A32_SFLOAT;
  return settings;
}

inline ReplaySettings gathering(uint32_t samples,
                                uint32_t spacing = ReplaySettings{}.translucency.gatherSpacing) {
  ReplaySettings settings = inFloats();
  settings.translucency.gatherSamples = samples;
  settings.translucency.gatherSpacing = spacing;
  return settings;
}

inline const PellucidMaterial& skin() {
  static const PellucidMaterial compiled = compileMaterial(PresetMaterial{"skin1"}, "skin1");
  return compiled;
}

// RMS of a - b over the RMS of b, in RGB where there is a material; everywhere without `material`.
inline double relativeRmse(const Image& a, const Image& b, const std::vector<std::uint8_t>& material = {}) {
  double square = 0, power = 0;
  for (size_t i = 0; i < a.pixels(); ++i)
    for (size_t k = 0; k < 3 && (material.empty() || material[i] != 0); ++k) {
      const auto va = static_cast<double>(a.data[i * static_cast<size_t>(a.channels) + k]);
      const auto vb = static_cast<double>(b.data[i * static_cast<size_t>(b.channels) + k]);
      square += (va - vb) * (va - vb);
      power += vb * vb;
    }
  return std::sqrt(square / power);
}

// T = e^{-d / 2 mm} in red, e^{-d} in green, 0.7 e^{-2 d} + 0.3 e^{-d / 4 mm} in blue.
inline PellucidMaterial testMaterial() {
  PellucidMaterial m{};
  m.transmittanceModel = PELLUCID_TRANSMITTANCE_EXP2;
  const float t[3][5] = {{1, 0.5f, 0, 0, 0}, {1, 1, 0, 0, 0}, {0.7f, 2, 0.3f, 0.25f, 0}};
  std::memcpy(m.transmittance, t, sizeof t);
  m.gaussianCount = 2;
  for (int c = 0; c < 3; ++c) {
    m.reflectance[c] = 0.5f;
    m.gaussianVariance[c][0] = 0.2f * static_cast<float>(c + 1);
    m.gaussianVariance[c][1] = 1.5f * static_cast<float>(c + 1);
    m.gaussianWeight[c][0] = 0.4f;
    m.gaussianWeight[c][1] = 0.6f;
    m.radius[c] = 3.1f * std::sqrt(m.gaussianVariance[c][1]);
  }
  return m;
}

// A slab facing an orthographic right-handed camera: front at 10 mm, back `thickness` mm behind it,
// pixels of 0.25 mm, material 1 everywhere, irradiance (1, 0.5, 0.25).
inline Capture flatCapture(int width, int height, double thickness = 1) {
  Capture c;
  c.name = "flat";
  c.width = width;
  c.height = height;
  c.metersPerUnit = 0.001;
  c.clipFromView = kIdentity;
  c.clipFromView[0] = 8.0 / width;
  c.clipFromView[5] = -8.0 / height;
  c.clipFromView[10] = -1.0 / 100;
  c.frontDepth.image = Image(width, height, 1, 10);
  c.backDepth.image = Image(width, height, 1, static_cast<float>(10 + thickness));
  c.irradiance = Image(width, height, 3);
  for (size_t i = 0; i < c.irradiance.pixels(); ++i) {
    c.irradiance.data[3 * i] = 1;
    c.irradiance.data[3 * i + 1] = 0.5f;
    c.irradiance.data[3 * i + 2] = 0.25f;
  }
  c.material.assign(c.irradiance.pixels(), 1);
  c.materials.resize(1);
  return c;
}

// The same with a perspective camera, whose pixels are 0.5 mm at the slab.
inline Capture perspectiveCapture(int size) {
  Capture c = flatCapture(size, size);
  c.clipFromView = {};
  c.clipFromView[0] = 2 * 10 / (0.5 * size);
  c.clipFromView[5] = -c.clipFromView[0];
  c.clipFromView[11] = -1;
  c.clipFromView[14] = 0.1;
  return c;
}

// Of the pyramid's levels, the one that upsampling begins at.
inline uint32_t coarsestUpsampled(const PellucidPlan& plan) {
  for (uint32_t i = 0; i < plan.dispatchCount; ++i)
    if (plan.dispatches[i].name == std::string("upsample")) return plan.dispatches[i].pushConstants[0];
  return 0;
}

// Straight from behind, E = 3.
inline Light backLight() {
  Light light;
  light.direction = {0, 0, 1};
  light.intensity = 3;
  return light;
}

// Orthographic map of a light travelling along +z from z = -50, covering +-100 mm, whose surface lies at
// view depth `z` (negative) everywhere.
inline ShadowMap flatShadowMap(double z, PellucidDepthEncoding encoding, int size = 32) {
  ShadowMap map;
  map.clipFromWorld = kIdentity;
  map.clipFromWorld[0] = map.clipFromWorld[5] = 0.01;
  map.clipFromWorld[10] = 1.0 / 100;
  map.clipFromWorld[14] = 0.5;
  // The light's view looks along +z: turned half round about y.
  map.viewFromWorld = Matrix{-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, 0, 0, 0, -50, 1};
  const double distance = z + 50;
  map.depth.encoding = encoding;
  map.depth.image =
      Image(size, size, 1, static_cast<float>(encoding == PELLUCID_DEPTH_DEVICE ? distance / 100 : distance));
  return map;
}

inline bool sameBits(const Image& a, const Image& b) {
  return a.data.size() == b.data.size() &&
         std::memcmp(a.data.data(), b.data.data(), a.data.size() * sizeof(float)) == 0;
}

}  // namespace pellucid::test
