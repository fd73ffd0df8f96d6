// Compilers may take floats for finite (VkPhysicalDeviceFloatControlsProperties), so that "a < b" may be
// compiled as "not a >= b". No guard against NaN relies on the comparison: pictures are the same to the bit
// with shaders in which every comparison of floats is true for NaN.
#include <limits>

#include "gpu_fixture.h"

namespace {

using namespace pellucid::test;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

PFN_vkCreateShaderModule createShaderModule;
PFN_vkGetDeviceProcAddr getDeviceProcAddr;
size_t changedComparisons;

// OpFOrdEqual to OpFOrdGreaterThanEqual have even numbers, each before its unordered form.
VkResult VKAPI_CALL createUnordered(VkDevice device, const VkShaderModuleCreateInfo* info,
                                    const VkAllocationCallbacks* allocator, VkShaderModule* module) {
  constexpr uint32_t kFirst = 180, kLast = 190;
  std::vector<uint32_t> words(info->pCode, info->pCode + info->codeSize / 4);
  for (size_t i = 5; i < words.size(); i += words[i] >> 16) {
    const uint32_t op = words[i] & 0xFFFF;
    if (op < kFirst || op > kLast || op % 2 != 0) continue;
    ++words[i];
    ++changedComparisons;
  }
  VkShaderModuleCreateInfo changed = *info;
  changed.pCode = words.data();
  return createShaderModule(device, &changed, allocator, module);
}

PFN_vkVoidFunction VKAPI_CALL deviceFunction(VkDevice device, const char* name) {
  const PFN_vkVoidFunction function = getDeviceProcAddr(device, name);
  if (std::string(name) != "vkCreateShaderModule") return function;
  createShaderModule = reinterpret_cast<PFN_vkCreateShaderModule>(function);
  return reinterpret_cast<PFN_vkVoidFunction>(&createUnordered);
}

PFN_vkVoidFunction VKAPI_CALL instanceFunction(VkInstance instance, const char* name) {
  const PFN_vkVoidFunction function = vkGetInstanceProcAddr(instance, name);
  if (std::string(name) != "vkGetDeviceProcAddr") return function;
  getDeviceProcAddr = reinterpret_cast<PFN_vkGetDeviceProcAddr>(function);
  return reinterpret_cast<PFN_vkVoidFunction>(&deviceFunction);
}

// Puts NaN and infinities at some texels, other ones for each `seed`.
void spoil(Image& image, size_t seed) {
  const float bad[] = {kNan, -kNan, kInfinity, -kInfinity};
  for (size_t i = seed; i < image.data.size(); i += 61 + seed) image.data[i] = bad[i / (61 + seed) % 4];
}

// A slab with waves, lit from behind through a map that has all images beside it, with bad texels in each
// image.
Capture spoiled(PellucidDepthEncoding encoding) {
  constexpr int kSize = 96, kMap = 64;
  Capture c = perspectiveCapture(kSize);
  c.albedo = Image(kSize, kSize, 3, 0.5f);
  for (size_t i = 0; i < c.frontDepth.image.data.size(); ++i) {
    c.frontDepth.image.data[i] += 0.3f * std::sin(0.2f * static_cast<float>(i % kSize));
    if (i / kSize < 20) c.material[i] = 0;
  }
  c.lights = {backLight()};
  c.lights[0].shadowMaps = {flatShadowMap(-12, encoding, kMap)};
  ShadowMap& map = c.lights[0].shadowMaps[0];
  map.clipFromWorld[0] = map.clipFromWorld[5] = 0.04;
  map.exitDepth = flatShadowMap(-9, encoding, kMap).depth.image;
  map.casterMaterial.assign(size_t{kMap} * kMap, 1);
  map.depthBiasConstant = 1e-3;
  map.depthBiasSlope = encoding == PELLUCID_DEPTH_DEVICE ? 2 : 0;
  size_t seed = 1;
  for (Image* image :
       {&c.frontDepth.image, &c.backDepth.image, &c.irradiance, &c.albedo, &map.depth.image, &map.exitDepth})
    spoil(*image, seed++);
  return c;
}

TEST_F(GpuTest, NoGuardReliesOnComparisonsThatAreFalseForNan) {
  const Context& plain = replayer().contextFor({});
  changedComparisons = 0;
  const Context unordered(device(),
                          [](PellucidContextDesc& d) { d.getInstanceProcAddr = &instanceFunction; });
  for (const auto encoding : {PELLUCID_DEPTH_DEVICE, PELLUCID_DEPTH_DISTANCE})
    for (const uint32_t samples : {0u, 8u}) {
      const Capture c = spoiled(encoding);
      ReplaySettings s;
      s.translucency.gatherSamples = samples;
      const Image expected = record(FrameRun(device(), plain, c, {testMaterial()}, s));
      for (size_t i = 0; i < c.material.size(); ++i)
        for (size_t channel = 0; c.material[i] != 0 && channel < 3; ++channel)
          ASSERT_TRUE(std::isfinite(expected.data[4 * i + channel])) << i;
      EXPECT_TRUE(sameBits(record(FrameRun(device(), unordered, c, {testMaterial()}, s)), expected))
          << "encoding " << encoding << ", samples " << samples;
    }
  EXPECT_GT(changedComparisons, 100u);
}

}  // namespace
