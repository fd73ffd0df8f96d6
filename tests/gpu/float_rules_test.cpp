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
size_t changedComparisons, changedLogarithms;

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

// Adds 2^-21 to each scalar log2, as its error may be where the result is near 0 (Vulkan, "Precision and Operation of SPIR-V
// Instructions").
VkResult VKAPI_CALL createInexact(VkDevice device, const VkShaderModuleCreateInfo* info, const VkAllocationCallbacks* allocator,
                                  VkShaderModule* module) {
  constexpr uint32_t kHeader = 5, kExtInst = 12, kTypeFloat = 22, kConstant = 43, kFunction = 54, kFAdd = 129, kLog2 = 30;
  constexpr float kError = 0x1p-21f;
  const std::vector<uint32_t> words(info->pCode, info->pCode + info->codeSize / 4);
  std::vector<uint32_t> changed(words.begin(), words.begin() + kHeader);
  uint32_t scalar = 0, error = 0;
  for (size_t i = kHeader; i < words.size(); i += words[i] >> 16) {
    const uint32_t op = words[i] & 0xFFFF;
    if (op == kTypeFloat && words[i + 2] == 32) scalar = words[i + 1];
    if (op == kFunction && error == 0) {
      error = changed[3]++;
      uint32_t bits;
      std::memcpy(&bits, &kError, sizeof bits);
      changed.insert(changed.end(), {4 << 16 | kConstant, scalar, error, bits});
    }
    const size_t at = changed.size();
    changed.insert(changed.end(), words.begin() + static_cast<std::ptrdiff_t>(i),
                   words.begin() + static_cast<std::ptrdiff_t>(i + (words[i] >> 16)));
    if (op != kExtInst || words[i + 1] != scalar || words[i + 4] != kLog2) continue;
    const uint32_t exact = changed[3]++, result = words[i + 2];
    changed[at + 2] = exact;
    changed.insert(changed.end(), {5 << 16 | kFAdd, scalar, result, exact, error});
    ++changedLogarithms;
  }
  VkShaderModuleCreateInfo other = *info;
  other.pCode = changed.data();
  other.codeSize = changed.size() * sizeof(uint32_t);
  return createShaderModule(device, &other, allocator, module);
}

PFN_vkCreateShaderModule createsInstead;  // of vkCreateShaderModule

PFN_vkVoidFunction VKAPI_CALL deviceFunction(VkDevice device, const char* name) {
  const PFN_vkVoidFunction function = getDeviceProcAddr(device, name);
  if (std::string(name) != "vkCreateShaderModule") return function;
  createShaderModule = reinterpret_cast<PFN_vkCreateShaderModule>(function);
  return reinterpret_cast<PFN_vkVoidFunction>(createsInstead);
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
  createsInstead = &createUnordered;
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

// The stored surface is the receiver: all light comes through, however the mean of four thicknesses of 0 is rounded.
TEST_F(GpuTest, ThicknessZeroIsNoLessWhereLogarithmsAreInexact) {
  changedLogarithms = 0;
  createsInstead = &createInexact;
  const Context inexact(device(), [](PellucidContextDesc& d) { d.getInstanceProcAddr = &instanceFunction; });
  Capture c = flatCapture(32, 24);
  c.lights = {backLight()};
  c.lights[0].shadowMaps = {flatShadowMap(-10, PELLUCID_DEPTH_VIEW_Z)};
  ReplaySettings s = inFloats(PELLUCID_FEATURE_TRANSLUCENCY);
  s.translucency.gatherSamples = 0;
  const Image out = record(FrameRun(device(), inexact, c, {testMaterial()}, s));
  EXPECT_GT(changedLogarithms, 0u);
  // E + T(0) E_back / rho; 1e-5: arithmetic of floats.
  for (int x = 0; x < c.width; ++x) EXPECT_NEAR(out.at(x, 11)[0], 7, 7e-5) << x;
}

}  // namespace
