#include "stress/random_frame.h"

#include <algorithm>
#include <cmath>

#include "capture/material.h"
#include "capture/shadow_images.h"
#include "stress/random_parts.h"

namespace pellucid::harness::stress {

namespace {

CoefficientMaterial coefficients(double scattering, double absorption) {
  return {{scattering, scattering * 0.7, scattering * 1.5},
          {absorption, absorption * 2, absorption * 0.5},
          0,
          1.4};
}

BurleyMaterial burley(double distance) { return {{distance, distance / 1.4, distance / 2}, std::nullopt}; }

std::vector<float> minimumDots(Random& random, PellucidAngleModel model) {
  const int side = random.whole(3, 16);
  std::vector<float> table(static_cast<std::size_t>(model == kMinimumDotSphere ? side * side
                                                    : random.chance(0.5)     ? 36
                                                                             : random.whole(1, 360)));
  for (float& m : table) m = static_cast<float>(random.real(-1, 0));
  return table;
}

void randomAngles(Random& random, TranslucencySettings& t) {
  t.angleModel = random.of({PELLUCID_ANGLE_COSINE, PELLUCID_ANGLE_INVERSE_COSINE, PELLUCID_ANGLE_POLYNOMIAL,
                            PELLUCID_ANGLE_MINIMUM_DOT, kMinimumDotAzimuth, kMinimumDotSphere});
  for (float& c : t.anglePolynomial) c = static_cast<float>(random.real(-2, 2));
  t.minimumDot = random.chance(0.3) ? random.of({0.0f, -1.0f}) : static_cast<float>(random.real(-1, 0));
  t.prescaleAngle = random.chance(0.5);
  t.constantViewDirection = random.chance(0.3);
  if (t.hasMinimumDotTable()) t.minimumDotTable = minimumDots(random, t.angleModel);
}

void randomTranslucency(Random& random, bool wild, const StressFrame& frame, TranslucencySettings& t) {
  if (random.chance(0.2)) t.cameraThickness = frame.capture.backDepth.encoding != PELLUCID_DEPTH_THICKNESS;
  if (random.chance(0.25)) randomAngles(random, t);
  t.chordThickness = random.chance(0.2);
  if (random.chance(0.15)) t.maximumThickness = static_cast<float>(random.magnitude(0.1, wild ? 1e9 : 100));
  if (random.chance(0.2))
    t.transmittanceFilter = {static_cast<float>(random.real()), 1, random.of({0.0f, 0.5f})};
  t.gatherSamples = random.chance(0.7) ? random.of({0u, kDefaultGatherSamples, 16u})
                                       : static_cast<std::uint32_t>(4 * random.whole(0, 16));
  if (random.chance(0.4)) t.gatherSpacing = random.of({1u, 2u, 4u});
  std::uint32_t mark = 1;
  while (mark <= frame.capture.materials.size()) mark *= 2;
  if (random.chance(0.1)) t.materialMarkBit = mark << random.whole(0, 3);
}

void randomSettings(Random& random, StressFrame& frame) {
  ReplaySettings& s = frame.settings;
  const double kind = random.real();
  s.features = kind < 0.55   ? PELLUCID_FEATURE_TRANSLUCENCY | PELLUCID_FEATURE_DIFFUSION
               : kind < 0.78 ? PELLUCID_FEATURE_DIFFUSION
               : kind < 0.97 ? PELLUCID_FEATURE_TRANSLUCENCY
                             : 0;
  randomTranslucency(random, frame.wild, frame, s.translucency);
  s.outputFormat = random.of({VK_FORMAT_R16G16B16A16_SFLOAT, VK_FORMAT_R32G32B32A32_SFLOAT});
  s.aliasOutput = random.chance(0.3);
  s.indirectDispatches = random.chance(0.6);
  if (random.chance(0.1))
    s.reuse = random.of({PELLUCID_REUSE_ALTERNATE, PELLUCID_REUSE_COHERENCE, PELLUCID_REUSE_ACCUMULATE});
  // Views of lights need all in one dispatch.
  if (random.chance(0.08))
    s.debugView = shadowImages(frame.capture.lights).images.size() > 8
                      ? PELLUCID_DEBUG_IRRADIANCE
                      : random.of({PELLUCID_DEBUG_THICKNESS, PELLUCID_DEBUG_TRANSMITTANCE,
                                   PELLUCID_DEBUG_OCCLUSION, PELLUCID_DEBUG_IRRADIANCE});
  const auto width = frame.capture.width, height = frame.capture.height;
  if (random.chance(0.3)) {
    const int x = random.whole(0, width - 1), y = random.whole(0, height - 1);
    s.renderRect = {static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y),
                    static_cast<std::uint32_t>(random.whole(1, width - x)),
                    static_cast<std::uint32_t>(random.whole(1, height - y))};
  }
  if ((s.reuse == PELLUCID_REUSE_NONE || s.reuse == PELLUCID_REUSE_ACCUMULATE) && random.chance(0.3)) {
    const auto place = [&] { return static_cast<float>(random.real(-50, 50)); };
    s.anchor = {place(), place(), place(), 1};
  }
}

void markPixels(Random& random, StressFrame& frame) {
  const std::uint32_t bit = frame.settings.translucency.materialMarkBit;
  if (bit == 0) return;
  for (std::uint8_t& m : frame.capture.material)
    if (m != 0 && random.chance(0.3)) m = static_cast<std::uint8_t>(m | bit);
  frame.notInCapture +=
      (frame.notInCapture.empty() ? "" : " and ") + std::string("material values with the mark bit");
}

}  // namespace

MaterialPool::MaterialPool() {
  const auto add = [&](MaterialSource source, bool tame) {
    Entry entry{std::move(source), tame, {}};
    const PellucidMaterial material = compileMaterial(entry.source, "stress");
    for (const TransmittanceChoice choice :
         {TransmittanceChoice::Material, TransmittanceChoice::Linear, TransmittanceChoice::Gaussians,
          TransmittanceChoice::GaussiansAsPrinted})
      entry.compiled[static_cast<std::size_t>(choice)] = withTransmittance({material}, choice).front();
    entries_.push_back(std::move(entry));
  };
  for (const char* preset : {"skin1", "marble", "ketchup", "whole_milk", "skin_three_layer"})
    add(PresetMaterial{preset}, true);
  add(coefficients(1, 0.05), true);
  add(burley(1), true);
  add(burley(5), true);
  add(GaussianMaterial{{0.05, 2}, {{0.3, 0.5, 0.9}, {0.7, 0.5, 0.1}}}, true);
  add(ThinWallMaterial{{0.2, 0.4, 0.1}, {0.3, 0.6, 0.1}, {}}, true);
  add(ThinWallMaterial{{0.5, 0.5, 0.5}, {0.5, 0.4, 0.3}, {{1, 2, 3}}}, true);
  // Mean free paths, mm; the compiler takes coefficients of 1e-6 to 1e6 per mm.
  for (const double length : {2e-6, 1e-3, 1e3, 5e5}) add(coefficients(1 / length, 0.01 / length), false);
  for (const double length : {2e-6, 1e-3, 1e3, 1e6}) add(burley(length), false);
  add(GaussianMaterial{{1e-12}, {{1, 1, 1}}}, false);
  add(GaussianMaterial{{1e12}, {{1, 1, 1}}}, false);
  add(coefficients(1e-6, 10), false);
  add(coefficients(10, 1e-6), false);
}

StressFrame randomFrame(std::uint64_t seed, std::uint64_t index, const MaterialPool& pool,
                        const FrameLimits& limits) {
  Random random(seed, index);
  StressFrame frame;
  frame.seed = seed;
  frame.index = index;
  frame.wild = index % 2 == 1;
  Capture& c = frame.capture;
  c.name = "stress-" + std::to_string(seed) + "-" + std::to_string(index);
  View view = randomView(random, frame.wild, limits, c);
  if (random.chance(0.2))
    frame.transmittance = random.of({TransmittanceChoice::Linear, TransmittanceChoice::Gaussians,
                                     TransmittanceChoice::GaussiansAsPrinted});
  const int count = random.of({1, 1, 2, 3});
  while (static_cast<int>(c.materials.size()) < count) {
    const auto& entry = pool.entries()[static_cast<std::size_t>(
        random.whole(0, static_cast<int>(pool.entries().size()) - 1))];
    if (!entry.tame && !frame.wild) continue;
    c.materials.push_back(entry.source);
    frame.materials.push_back(entry.compiled[static_cast<std::size_t>(frame.transmittance)]);
  }
  const bool gaussians = frame.materials[0].transmittanceModel == PELLUCID_TRANSMITTANCE_GAUSSIANS ||
                         frame.materials[0].transmittanceModel == PELLUCID_TRANSMITTANCE_GAUSSIANS_AS_PRINTED;
  if (random.chance(0.05) && !gaussians) {
    frame.materials[0].gaussianCount = 0;
    frame.notInCapture = "that material 1 does not diffuse";
  }
  addRandomImages(random, frame.wild, view, count, c);
  addRandomLights(random, frame.wild, view, c);
  randomSettings(random, frame);
  markPixels(random, frame);
  return frame;
}

std::vector<std::uint8_t> ownedPixels(const StressFrame& frame) {
  const Capture& c = frame.capture;
  std::array<std::uint32_t, 4> rect = frame.settings.renderRect;
  if (rect[2] == 0) rect = {0, 0, static_cast<std::uint32_t>(c.width), static_cast<std::uint32_t>(c.height)};
  const std::uint32_t mark = frame.settings.translucency.materialMarkBit;
  std::vector<std::uint8_t> owned(c.material.size(), 0);
  for (std::size_t y = rect[1]; y < rect[1] + rect[3]; ++y)
    for (std::size_t x = rect[0]; x < rect[0] + rect[2]; ++x) {
      const std::size_t i = y * static_cast<std::size_t>(c.width) + x;
      owned[i] = (c.material[i] & ~mark) != 0;
    }
  return owned;
}

}  // namespace pellucid::harness::stress
