// BuildPlan and what goes with it, without a device.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <map>
#include <nlohmann/json.hpp>

#include "frame_fixture.h"
#include "context.h"
#include "shared/pellucid_shared.h"

static_assert(sizeof(PellucidPlan) <= 4096);  // as pellucid.h says

namespace {

using pellucid::test::bindingsOf;
using pellucid::test::Frame;
using pellucid::test::names;
using pellucid::test::skips;

TEST(Plan, WholeFrameIsFusedDispatchAndPyramid) {
  Frame f;
  const PellucidPlan plan = f.plan();
  EXPECT_EQ(names(plan), (std::vector<std::string>{"translucency", "base level", "downsample", "downsample",
                                                   "downsample", "upsample", "diffuse"}));
  EXPECT_EQ(plan.barrierCount, 6u);
  EXPECT_EQ(plan.skipCount, 2u);
  EXPECT_TRUE(skips(plan, "exit depth", "a shadow map has none: air behind an occluder counts as medium"));
  EXPECT_TRUE(skips(plan, "caster material",
                    "a shadow map has none: light enters through opaque bodies and other materials"));
  EXPECT_EQ(plan.dispatches[0].barrierBefore, 0u);
  EXPECT_EQ(plan.dispatches[0].groups[0], 13u) << "100 pixels in groups of 8";
  EXPECT_EQ(plan.dispatches[0].groups[1], 7u) << "50 pixels in groups of 8";
}

// Frames in which every light is in a dispatch of its own, and frames of one dispatch.
TEST(Plan, ConstantsSizeBoundsThatOfFrames) {
  for (const uint32_t lights : {0u, 1u, 3u, 9u, 16u, 150u})
    for (const uint32_t samples : {0u, 8u})
      for (const uint32_t mapsOfALight : {0u, 1u, 6u})
        for (const uint32_t indirect : {0u, 1u}) {
          Frame f(0);
          f.frame.options.gatherSamples = samples;
          f.frame.options.indirectDispatches = indirect;
          f.lights.clear();
          const Frame one(1);
          for (uint32_t i = 0; i < lights; ++i) {
            f.lights.push_back(Frame::light(static_cast<uint32_t>(f.maps.size()), mapsOfALight));
            for (uint32_t k = 0; k < mapsOfALight; ++k) {
              f.maps.push_back(one.maps[0]);
              // All maps of light 3 n share images, those of the others are their own.
              f.maps.back().image = i % 3 == 0 ? 0 : static_cast<uint32_t>(f.images.size());
              if (i % 3 != 0 || f.images.empty()) f.images.push_back(Frame::view());
            }
          }
          f.use();
          PellucidPlan plan;
          const PellucidResult result = pellucidBuildPlan(&f.frame, nullptr, &plan);
          if (result == PELLUCID_ERROR_CAPACITY) continue;
          ASSERT_EQ(result, PELLUCID_OK) << f.problems();
          const VkDeviceSize bound = pellucidGetConstantsSize(1, lights, lights * mapsOfALight);
          EXPECT_EQ(bound % 256, 0u);
          EXPECT_LE(plan.constantsSize, bound) << lights << " lights of " << mapsOfALight << " maps";
          // A gather takes 512 bytes a map besides, which frames without one lack.
          EXPECT_LT(bound, 4 * plan.constantsSize) << lights << " lights of " << mapsOfALight;
        }
}

TEST(Plan, EveryReadIsOfSomethingWritten) {
  for (uint32_t features : {0u, 1u, 2u, 3u})
    for (uint32_t images : {0u, 1u, 9u, 20u}) {
      Frame f(images);
      f.frame.options.features = features;
      const PellucidPlan plan = f.plan();
      // Nothing to do where the irradiance is the output already.
      const bool nothing = features == 0 && f.frame.output.view == f.frame.irradiance.view;
      if (nothing && f.frame.albedo.view == VK_NULL_HANDLE) {
        EXPECT_EQ(plan.dispatchCount, 0u);
        continue;
      }
      ASSERT_GT(plan.dispatchCount, 0u);
      std::set<uint32_t> written;
      for (uint32_t i = 0; i < plan.dispatchCount; ++i) {
        std::set<uint32_t> destinations;
        for (const PellucidBinding& binding : bindingsOf(plan, plan.dispatches[i])) {
          // The output stands in for a copy that the base level does not make.
          const bool standsIn = names(plan)[i] == "base level" && plan.dispatches[i].pushConstants[0] == 0 &&
                                binding.binding == PELLUCID_BINDING_DESTINATION;
          const bool write = binding.type == VK_DESCRIPTOR_TYPE_STORAGE_IMAGE && !standsIn;
          if (write) destinations.insert(binding.resource);
          const bool transient = binding.resource >= PELLUCID_RESOURCE_TRANSIENT0 &&
                                 binding.resource < PELLUCID_RESOURCE_SHADOW0;
          EXPECT_TRUE(!transient || write || written.count(binding.resource)) << "dispatch " << i;
          EXPECT_TRUE(binding.resource != PELLUCID_RESOURCE_IRRADIANCE || i == 0)
              << "irradiance is read by the first dispatch only";
        }
        const bool last = i + 1 == plan.dispatchCount;
        EXPECT_EQ(destinations.count(PELLUCID_RESOURCE_OUTPUT) == 1, last)
            << "output is written by the last dispatch only";
        written.insert(destinations.begin(), destinations.end());
      }
    }
}

TEST(Plan, NoLightNoTranslucency) {
  Frame f;
  f.frame.lightCount = 0;
  const PellucidPlan plan = f.plan();
  EXPECT_EQ(names(plan), (std::vector<std::string>{"base level", "downsample", "downsample", "downsample",
                                                   "upsample", "diffuse"}));
  EXPECT_EQ(plan.dispatches[0].pushConstants[0], 1u) << "copies";
  EXPECT_TRUE(skips(plan, "translucency", "no light can contribute"));
}

TEST(Plan, DiffusionAloneCopiesTheIrradianceUnlessTheOutputIsSeparate) {
  for (const uint32_t gatherSamples : {0u, 8u}) {
    Frame f;
    f.frame.options.gatherSamples = gatherSamples;
    f.frame.options.gatherSpacing = 4;
    if (gatherSamples == 0) f.frame.lightCount = 0;
    const auto lastReads = [](const PellucidPlan& plan, uint32_t resource) {
      const auto bindings = bindingsOf(plan, plan.dispatches[plan.dispatchCount - 1]);
      return std::any_of(bindings.begin(), bindings.end(),
                         [&](const PellucidBinding& b) { return b.resource == resource; });
    };
    const auto needs = [&] {
      uint32_t count = 0;
      EXPECT_EQ(pellucidGetImageNeeds(&f.frame, &count, nullptr), PELLUCID_OK);
      return count;
    };
    const PellucidPlan copying = f.plan();
    const uint32_t before = needs();
    EXPECT_EQ(copying.dispatches[0].pushConstants[0], 1u);
    EXPECT_FALSE(lastReads(copying, PELLUCID_RESOURCE_IRRADIANCE));
    f.frame.options.separateOutput = 1;
    const PellucidPlan separate = f.plan();
    EXPECT_EQ(separate.dispatches[0].pushConstants[0], 0u);
    EXPECT_TRUE(lastReads(separate, PELLUCID_RESOURCE_IRRADIANCE));
    EXPECT_EQ(names(separate), names(copying));
    EXPECT_EQ(needs(), before - 1);
  }
}

TEST(Plan, DropsLightsThatCannotContribute) {
  Frame f;
  f.lights.resize(5, f.lights[0]);
  f.lights[1].intensity = 0;
  f.lights[2].color[0] = f.lights[2].color[1] = f.lights[2].color[2] = 0;
  f.lights[3].shadowMapCount = 0;
  f.frame.backDepth = {};
  f.use();
  const PellucidPlan plan = f.plan();
  EXPECT_EQ(plan.activeLights, 2u);
  EXPECT_TRUE(skips(plan, "light", "no intensity", 2));
  EXPECT_TRUE(skips(plan, "light", "no back depth to take a thickness from", 1));
}

TEST(Plan, DiffusionNeedsAMaterialThatDiffuses) {
  Frame f;
  f.material.gaussianCount = 0;
  const PellucidPlan plan = f.plan();
  EXPECT_EQ(names(plan), std::vector<std::string>{"translucency"});
  EXPECT_TRUE(skips(plan, "diffusion", "no material diffuses"));
}

TEST(Plan, ManyShadowImagesBecomeSeveralDispatches) {
  Frame f(20);  // 8 a dispatch
  const PellucidPlan plan = f.plan();
  EXPECT_EQ(plan.activeLights, 20u);
  uint32_t lights = 0;
  for (int i = 0; i < 3; ++i) {
    EXPECT_STREQ(plan.dispatches[i].name, "translucency");
    EXPECT_LE(plan.dispatches[i].pushConstants[1], 8u);
    lights += plan.dispatches[i].pushConstants[1];
  }
  EXPECT_EQ(lights, 20u);
  EXPECT_STREQ(plan.dispatches[3].name, "base level");
}

// Exit depths and caster materials are shadow images, too.
TEST(Plan, ImagesBesideMapsCount) {
  Frame f(4);
  for (uint32_t i = 0; i < 4; ++i) {
    f.images.resize(f.images.size() + 2, Frame::view());
    f.maps[i].options.exitImage = 4 + 2 * i + 1;
    f.maps[i].options.casterMaterialImage = 4 + 2 * i + 2;
  }
  f.use();
  const PellucidPlan plan = f.plan();
  EXPECT_EQ(plan.skipCount, 0u);
  for (uint32_t i = 0; i < 2; ++i) {
    const PellucidDispatch& d = plan.dispatches[i];
    EXPECT_STREQ(d.name, "translucency");
    EXPECT_EQ(d.pushConstants[1], 2u) << "three images a light, 8 a dispatch";
    std::vector<uint32_t> images;
    for (const PellucidBinding& b : bindingsOf(plan, d))
      if (b.resource >= PELLUCID_RESOURCE_SHADOW0) images.push_back(b.resource - PELLUCID_RESOURCE_SHADOW0);
    const uint32_t light = 2 * i;
    EXPECT_EQ(images, (std::vector<uint32_t>{light, 4 + 2 * light, 5 + 2 * light, light + 1, 6 + 2 * light,
                                             7 + 2 * light, light, light}))
        << "the first one stands in for what is not read: views of one type";
  }
  EXPECT_STREQ(plan.dispatches[2].name, "base level");
}

// The dispatch of entry points has room for all images of four lights.
TEST(Plan, FourGatheredLightsWithAllImagesShareADispatch) {
  for (const uint32_t lights : {4u, 5u}) {
    SCOPED_TRACE(lights);
    Frame f(lights);
    f.images.resize(3 * lights, Frame::view());
    for (uint32_t i = 0; i < lights; ++i) {
      f.maps[i].options.exitImage = lights + 2 * i + 1;
      f.maps[i].options.casterMaterialImage = lights + 2 * i + 2;
    }
    f.use();
    f.frame.options.gatherSamples = 8;
    const PellucidPlan plan = f.plan();
    std::vector<uint32_t> bound;
    uint32_t dispatches = 0;
    for (uint32_t i = 0; i < plan.dispatchCount; ++i) {
      const PellucidDispatch& d = plan.dispatches[i];
      if (std::string(d.name) != "entry points") continue;
      ++dispatches;
      for (const PellucidBinding& b : bindingsOf(plan, d))
        if (b.resource >= PELLUCID_RESOURCE_SHADOW0) bound.push_back(b.binding);
    }
    EXPECT_EQ(dispatches, lights == 4 ? 1u : 2u);
    EXPECT_EQ(bound.size(), dispatches * PELLUCID_ENTRY_IMAGE_COUNT);
    bound.resize(PELLUCID_ENTRY_IMAGE_COUNT);
    std::sort(bound.begin(), bound.end());
    EXPECT_EQ(std::adjacent_find(bound.begin(), bound.end()), bound.end()) << "a binding holds one image";
  }
}

// Many lights leave out what lies beside their maps before a frame fails that has room for the maps.
TEST(Plan, ImagesBesideMapsAreLeftOutWhereTheyAreTooMany) {
  for (const uint32_t gather : {0u, 8u}) {
    SCOPED_TRACE(gather);
    Frame plain(64), beside(64);
    beside.images.resize(3 * 64, Frame::view());
    for (uint32_t i = 0; i < 64; ++i) {
      beside.maps[i].options.exitImage = 64 + i + 1;
      beside.maps[i].options.casterMaterialImage = 2 * 64 + i + 1;
    }
    for (Frame* f : {&plain, &beside}) {
      f->use();
      f->frame.options.gatherSamples = gather;
    }
    const PellucidPlan with = beside.plan();
    EXPECT_EQ(names(with), names(plain.plan()));
    EXPECT_TRUE(skips(with, "exit depth and caster material",
                      "more lights have them than the dispatches of a plan can bind"));
    std::vector<char> constants(static_cast<size_t>(with.constantsSize));
    EXPECT_EQ(pellucidWriteConstants(&with, &beside.frame, constants.data(), constants.size()), PELLUCID_OK);
  }
}

// Constants of a dispatch's lights are one window of a uniform buffer.
TEST(Plan, ManyLightsBecomeSeveralDispatches) {
  Frame f(0);
  f.lights.resize(300, f.lights[0]);
  f.use();
  f.frame.options.features = PELLUCID_FEATURE_TRANSLUCENCY;
  const PellucidPlan plan = f.plan();
  ASSERT_EQ(plan.dispatchCount, 3u);
  VkDeviceSize end = 0;
  for (int i = 0; i < 3; ++i) {
    const PellucidDispatch& d = plan.dispatches[i];
    EXPECT_EQ(d.pushConstants[1], i < 2 ? 128u : 44u);
    for (const PellucidBinding& b : bindingsOf(plan, d)) {
      if (b.type != VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER) continue;
      EXPECT_EQ(b.offset % 256, 0u);
      EXPECT_LE(b.size, 16384u);
      end = std::max(end, b.offset + b.size);
    }
  }
  EXPECT_LE(end, plan.constantsSize);
}

// Of a shader's workgroups, as its SPIR-V states it: columns, rows.
std::array<uint32_t, 2> workgroupOf(uint32_t pipeline) {
  PellucidShader shader{};
  EXPECT_EQ(pellucidGetShader(pipeline, VK_IMAGE_VIEW_TYPE_2D, &shader), PELLUCID_OK);
  constexpr size_t kHeaderWords = 5;
  constexpr uint32_t kOpExecutionMode = 16, kLocalSize = 17;
  for (size_t i = kHeaderWords; i < shader.wordCount; i += shader.words[i] >> 16)
    if ((shader.words[i] & 0xFFFF) == kOpExecutionMode && shader.words[i + 2] == kLocalSize)
      return {shader.words[i + 3], shader.words[i + 4]};
  return {};
}

// A light without a map, in the dispatch of the others or one of its own beside gathered ones.
TEST(Plan, AmbientLightIsALightOfItsOwn) {
  std::array<float, 27> sky{};
  Frame f;
  f.frame.options.ambient = sky.data();
  EXPECT_EQ(f.plan().activeLights, 1u) << "all coefficients are 0";
  sky[4] = -1;
  EXPECT_EQ(f.plan().activeLights, 2u);
  f.lights.clear();
  f.use();
  EXPECT_EQ(names(f.plan()).front(), "translucency");
  f.frame.backDepth = {};
  EXPECT_EQ(f.plan().activeLights, 0u);
  EXPECT_TRUE(skips(f.plan(), "ambient light", "no back depth to take a thickness from"));
  EXPECT_NE(f.problems(PELLUCID_SEVERITY_WARNING).find("ambient adds nothing: no back depth"),
            std::string::npos);

  Frame gathered;
  gathered.frame.options.gatherSamples = 8;
  EXPECT_EQ(names(gathered.plan()).back(), "diffuse");
  gathered.frame.options.ambient = sky.data();
  EXPECT_EQ(names(gathered.plan()).back(), "translucency");
}

// Tiles of one atlas, which a dispatch binds once.
TEST(Plan, AnAtlasHoldsTheMapsOfManyLights) {
  for (const uint32_t lights : {64u, 300u}) {
    Frame f;
    f.lights.clear();
    const PellucidShadowMap map = f.maps[0];
    f.maps.clear();
    for (uint32_t i = 0; i < lights; ++i) {
      f.maps.push_back(map);
      f.maps.back().options.offset[0] = i % 20 * map.extent[0];
      f.maps.back().options.offset[1] = i / 20 * map.extent[1];
      f.lights.push_back(Frame::light(i, 1));
    }
    f.use();
    const PellucidPlan plan = f.plan();
    EXPECT_EQ(plan.activeLights, lights);
    const auto all = names(plan);
    EXPECT_EQ(std::count(all.begin(), all.end(), "translucency"), lights == 64 ? 1 : 3) << "112 maps each";
  }
}

// Groups that overlap would do pixels twice, and no pixel would say so.
TEST(Plan, GroupsCoverTheFrameOnce) {
  Frame f;
  const PellucidPlan plan = f.plan();
  const PellucidDispatch& d = plan.dispatches[0];
  const auto [columns, rows] = workgroupOf(d.pipeline);
  ASSERT_GT(columns * rows, 0u);
  EXPECT_EQ(d.groups[0], (f.frame.imageExtent[0] + columns - 1) / columns);
  EXPECT_EQ(d.groups[1], (f.frame.imageExtent[1] + rows - 1) / rows);
}

// Uniform buffers of the gather hold what every device binds, however many maps there are.
TEST(Plan, EntryPointsOfManyMapsBindNoMoreThanDevicesDo) {
  for (const size_t lights : {size_t{1}, size_t{65}, size_t{128}}) {
    Frame f;
    f.frame.normal = Frame::view();
    f.frame.options.gatherSamples = 8;
    f.maps[0].extent[0] = f.maps[0].extent[1] = 16;
    f.lights.resize(lights, f.lights[0]);
    f.use();
    const PellucidPlan plan = f.plan();
    uint32_t found = 0;
    for (uint32_t i = 0; i < plan.dispatchCount; ++i) {
      if (names(plan)[i] != "entry points") continue;
      ++found;
      const PellucidDispatch& d = plan.dispatches[i];
      for (const PellucidBinding& binding : bindingsOf(plan, d)) {
        EXPECT_LE(binding.offset + binding.size, plan.constantsSize);
        EXPECT_TRUE(binding.type != VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER || binding.size <= 16384);
      }
    }
    EXPECT_EQ(found, lights > PELLUCID_DISPATCH_SHADOWS ? 2u : 1u);
  }
}

// A light whose map holds back faces is not gathered: its map is bound by a dispatch after the diffusion.
TEST(Plan, LightsOfBackFacesComeAfterTheDiffusion) {
  Frame f(2);
  f.maps[0].options.backFaces = 1;
  f.frame.options.gatherSamples = 8;
  const PellucidPlan plan = f.plan();
  EXPECT_EQ(plan.activeLights, 2u);
  EXPECT_TRUE(
      skips(plan, "gather", "a light's shadow map holds back faces, which do not say where light enters"));
  const std::vector<std::string> all = names(plan);
  EXPECT_EQ(all.end()[-2], "diffuse");
  EXPECT_EQ(all.back(), "translucency");
  const PellucidDispatch& d = plan.dispatches[all.size() - 1];
  EXPECT_EQ(d.pushConstants[1], 1u);
  bool bound = false;
  for (const PellucidBinding& b : bindingsOf(plan, d))
    bound = bound || b.resource == PELLUCID_RESOURCE_SHADOW0;
  EXPECT_TRUE(bound);
}

TEST(Plan, ImageNeedsCoverThePlan) {
  Frame f;
  for (uint32_t features : {1u, 2u, 3u}) {
    f.frame.options.features = features;
    PellucidImageNeed needs[PELLUCID_MAX_TRANSIENTS];
    uint32_t count = PELLUCID_MAX_TRANSIENTS;
    ASSERT_EQ(pellucidGetImageNeeds(&f.frame, &count, needs), PELLUCID_OK);
    EXPECT_EQ(count, features == 1 ? 0u : 5u) << "a color, the pyramid's three, and words of blocks";
    const PellucidPlan plan = f.plan();
    for (uint32_t d = 0; d < plan.dispatchCount; ++d)
      for (const PellucidBinding& b : bindingsOf(plan, plan.dispatches[d])) {
        const uint32_t resource = b.resource;
        if (resource < PELLUCID_RESOURCE_TRANSIENT0 || resource >= PELLUCID_RESOURCE_SHADOW0) continue;
        const uint32_t transient = resource - PELLUCID_RESOURCE_TRANSIENT0;
        ASSERT_LT(transient, count);
        EXPECT_GE(d, needs[transient].firstDispatch);
        EXPECT_LE(d, needs[transient].lastDispatch);
      }
    for (uint32_t i = 0; i < count; ++i) {
      const PellucidImageNeed& need = needs[i];
      const uint32_t texel = need.format == VK_FORMAT_R32_UINT            ? 4
                             : need.format == VK_FORMAT_R32G32B32A32_UINT ? 16
                                                                          : 8;
      EXPECT_EQ(need.bytes, need.extent[0] * need.extent[1] * texel);
      if (need.format == VK_FORMAT_R16G16B16A16_SFLOAT) {
        EXPECT_EQ(need.bytes, 100u * 50u * 8u);
      }
    }
  }
}

// Memory of an image may serve another from the next barrier on, not from the next dispatch.
TEST(Plan, ImagesAreInUseFromBarrierToBarrier) {
  for (const uint32_t indirect : {0, 1}) {
    Frame f;
    f.frame.options.indirectDispatches = indirect;
    f.frame.options.gatherSamples = 8;
    PellucidImageNeed needs[PELLUCID_MAX_TRANSIENTS];
    uint32_t count = PELLUCID_MAX_TRANSIENTS;
    ASSERT_EQ(pellucidGetImageNeeds(&f.frame, &count, needs), PELLUCID_OK);
    const PellucidPlan plan = f.plan();
    ASSERT_LT(plan.barrierCount + 1, plan.dispatchCount) << "some dispatches run beside others";
    for (uint32_t i = 0; i < count; ++i) {
      const uint32_t first = needs[i].firstDispatch, next = needs[i].lastDispatch + 1;
      EXPECT_TRUE(first == 0 || plan.dispatches[first].barrierBefore) << "transient " << i;
      EXPECT_TRUE(next == plan.dispatchCount || plan.dispatches[next].barrierBefore) << "transient " << i;
    }
  }
}

// D3D12, Metal and WebGPU forbid what Vulkan allows in GENERAL. A history is added to in place, pixel by
// pixel.
TEST(Plan, NoDispatchReadsAndWritesATransient) {
  for (const uint32_t features : {1u, 2u, 3u})
    for (const uint32_t samples : {0u, 8u})
      for (const uint32_t lights : {0u, 1u, 9u}) {
        Frame f(lights);
        f.frame.options.features = features;
        f.frame.options.gatherSamples = samples;
        const PellucidPlan plan = f.plan();
        for (uint32_t i = 0; i < plan.dispatchCount; ++i) {
          const PellucidDispatch& d = plan.dispatches[i];
          const std::vector<PellucidBinding> all = bindingsOf(plan, d);
          for (size_t a = 0; a < all.size(); ++a)
            for (size_t b = 0; b < all.size(); ++b) {
              const bool same = all[a].resource == all[b].resource;
              if (!same || all[a].type != VK_DESCRIPTOR_TYPE_STORAGE_IMAGE) continue;
              EXPECT_EQ(a, b) << d.name << " " << pellucidResourceName(all[a].resource);
            }
        }
      }
}

// Devices take 65535 groups along an axis, and no more need be promised.
TEST(Plan, LargeImagesKeepTheirLists) {
  for (const auto& [width, height] : {std::pair(4096u, 4096u), {7680u, 4320u}, {16384u, 4096u}})
    for (const uint32_t spacing : {0u, 1u}) {
      SCOPED_TRACE(std::to_string(width) + " x " + std::to_string(height));
      Frame f;
      f.frame.imageExtent[0] = width;
      f.frame.imageExtent[1] = height;
      f.frame.options.gatherSamples = 8;
      f.frame.options.gatherSpacing = spacing;
      f.frame.options.indirectDispatches = 1;
      const PellucidPlan plan = f.plan();
      uint32_t listed = 0;
      for (uint32_t i = 0; i < plan.dispatchCount; ++i) {
        for (const uint32_t groups : plan.dispatches[i].groups)
          EXPECT_LE(groups, 65535u) << plan.dispatches[i].name;
        listed += plan.dispatches[i].indirect;
      }
      EXPECT_EQ(listed + 2, plan.dispatchCount) << "all but those that find blocks and list them";
    }
}

// The default frame, as docs/how-it-works.md lists it.
TEST(Plan, GathersBesideTheDiffusion) {
  const std::vector<std::string> all = {"base level", "list blocks", "downsample", "entry points",
                                        "downsample", "probes",      "downsample", "filter probes",
                                        "upsample",   "diffuse"};
  for (const auto indirect : {1, 0}) {
    Frame f;
    f.frame.options.gatherSamples = 8;
    f.frame.options.indirectDispatches = indirect;
    const PellucidPlan plan = f.plan();
    std::vector<std::string> expected = all, found = names(plan);
    if (indirect == 0) expected.erase(expected.begin() + 1);
    EXPECT_EQ(std::multiset<std::string>(found.begin(), found.end()),
              std::multiset<std::string>(expected.begin(), expected.end()));
    EXPECT_EQ(plan.barrierCount, indirect == 0 ? 5u : 6u);
    // Steps between barriers: which passes run side by side.
    std::map<std::string, std::set<uint32_t>> steps;
    uint32_t step = 0;
    for (uint32_t i = 0; i < plan.dispatchCount; ++i)
      steps[found[i]].insert(step += plan.dispatches[i].barrierBefore);
    ASSERT_EQ(steps["downsample"].size(), 3u);
    for (const char* pass : {"entry points", "probes", "filter probes"})
      EXPECT_EQ(steps["downsample"].count(*steps[pass].begin()), 1u) << pass;
  }
}

std::vector<unsigned char> constantsOf(const Frame& f) {
  const PellucidPlan plan = f.plan();
  std::vector<unsigned char> constants(static_cast<size_t>(plan.constantsSize));
  EXPECT_EQ(pellucidWriteConstants(&plan, &f.frame, constants.data(), constants.size()), PELLUCID_OK);
  return constants;
}

// Tables save time and change no bit, whatever the frame takes of them.
TEST(Plan, TablesOfMaterialsHoldWhatFramesFindWithoutThem) {
  for (const uint32_t model : {PELLUCID_TRANSMITTANCE_EXP2, PELLUCID_TRANSMITTANCE_SINH_EXP,
                               PELLUCID_TRANSMITTANCE_GAUSSIANS, PELLUCID_TRANSMITTANCE_LINEAR})
    for (const uint32_t features : {1u, 2u, 3u})
      for (const uint32_t samples : {0u, 8u})
        for (const uint32_t thinWalled : {0u, 1u}) {
          Frame f;
          f.frame.options.features = features;
          f.frame.options.gatherSamples = samples;
          f.material.transmittanceModel = model;
          f.material.thinWalled = thinWalled;
          for (float(&t)[5] : f.material.transmittance) t[4] = 1;
          const std::vector<unsigned char> without = constantsOf(f);
          PellucidMaterialTables tables;
          ASSERT_EQ(pellucidMakeMaterialTables(&f.material, &tables), PELLUCID_OK);
          f.frame.options.materialTables = &tables;
          EXPECT_EQ(constantsOf(f), without) << model << " " << features << " " << samples;
        }
}

TEST(Plan, TablesOfAnotherMaterialAreRefused) {
  Frame f;
  for (PellucidImage& image : f.frame.transients) image = Frame::view();
  PellucidMaterialTables tables;
  ASSERT_EQ(pellucidMakeMaterialTables(&f.material, &tables), PELLUCID_OK);
  f.frame.options.materialTables = &tables;
  EXPECT_EQ(f.problems(), "");
  f.material.reflectance[1] = 0.25f;
  EXPECT_NE(f.problems().find("materialTables[0] is of another material"), std::string::npos) << f.problems();
  f.material.reflectance[1] = -1;
  EXPECT_EQ(pellucidMakeMaterialTables(&f.material, &tables), PELLUCID_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(pellucidMakeMaterialTables(nullptr, &tables), PELLUCID_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(pellucidMakeMaterialTables(&f.material, nullptr), PELLUCID_ERROR_INVALID_ARGUMENT);
}

// Between two dispatches of which one writes what the other uses there is a barrier, whatever the frame has.
TEST(Plan, BarriersPartAllThatShareAnImage) {
  for (const uint32_t lights : {0u, 1u, 9u, 20u})
    for (const uint32_t samples : {0u, 8u})
      for (const uint32_t indirect : {0u, 1u})
        for (const uint32_t reuse : {0u, 1u}) {
          Frame f(lights);
          f.frame.options.gatherSamples = samples;
          f.frame.options.indirectDispatches = indirect;
          f.frame.options.reuse = reuse;
          f.frame.normal = Frame::view();
          const PellucidPlan plan = f.plan();
          // Images of the wave so far.
          std::set<uint32_t> used, written;
          for (uint32_t i = 0; i < plan.dispatchCount; ++i) {
            const PellucidDispatch& d = plan.dispatches[i];
            SCOPED_TRACE(d.name);
            if (d.barrierBefore) used = written = {};
            std::set<uint32_t> uses, writes;
            for (const PellucidBinding& b : bindingsOf(plan, d)) {
              const bool standsIn = b.binding == PELLUCID_BINDING_DESTINATION &&
                                    std::string(d.name) == "base level" && d.pushConstants[0] == 0;
              // Words of the blocks are read by all passes but those two.
              const bool reads = b.binding == PELLUCID_BINDING_BLOCKS &&
                                 std::string(d.name) != "base level" && std::string(d.name) != "list blocks";
              if (b.resource == PELLUCID_RESOURCE_CONSTANTS || standsIn) continue;
              uses.insert(b.resource);
              if (b.type == VK_DESCRIPTOR_TYPE_STORAGE_IMAGE && !reads) writes.insert(b.resource);
            }
            for (const uint32_t resource : uses)
              EXPECT_EQ(written.count(resource), 0u) << pellucidResourceName(resource) << " was just written";
            for (const uint32_t resource : writes)
              EXPECT_EQ(used.count(resource), 0u) << pellucidResourceName(resource) << " is in use";
            used.insert(uses.begin(), uses.end());
            written.insert(writes.begin(), writes.end());
          }
        }
}

TEST(Plan, JsonParses) {
  Frame f;
  const PellucidPlan plan = f.plan();
  size_t size = 0;
  ASSERT_EQ(pellucidPlanToJson(&plan, nullptr, &size), PELLUCID_OK);
  std::string text(size, '?');
  ASSERT_EQ(pellucidPlanToJson(&plan, text.data(), &size), PELLUCID_OK);
  text.pop_back();
  const nlohmann::json json = nlohmann::json::parse(text);
  EXPECT_EQ(json.at("dispatchCount"), plan.dispatchCount);
  EXPECT_EQ(json.at("dispatches").at(0).at("groups"), nlohmann::json::array({13, 7, 1}));
  size = 10;
  char small[10];
  EXPECT_EQ(pellucidPlanToJson(&plan, small, &size), PELLUCID_ERROR_BUFFER_TOO_SMALL);
  EXPECT_EQ(size, text.size() + 1) << "says how much is needed";
  EXPECT_EQ(std::strlen(small), 9u) << "terminated within its room";
}

TEST(Plan, ShadersAreSpirv) {
  PellucidShader shader{};
  uint32_t arrays = 0;  // that read views of arrays
  for (const VkImageViewType views : {VK_IMAGE_VIEW_TYPE_2D, VK_IMAGE_VIEW_TYPE_2D_ARRAY})
    for (uint32_t p = 0; p < pellucidGetPipelineCount(); ++p) {
      ASSERT_EQ(pellucidGetShader(p, views, &shader), PELLUCID_OK);
      ASSERT_GT(shader.wordCount, 5u);
      EXPECT_EQ(shader.words[0], 0x07230203u);
      for (uint32_t i = 0; i < shader.constantCount; ++i)
        EXPECT_LE(shader.constants[i].value, 1u) << "switches";
      constexpr uint32_t kOpTypeImage = 25;
      bool array = false;
      for (size_t i = 5; i < shader.wordCount; i += shader.words[i] >> 16)
        array = array || ((shader.words[i] & 0xFFFF) == kOpTypeImage && shader.words[i + 5] == 1);
      arrays += array;
      EXPECT_TRUE(views == VK_IMAGE_VIEW_TYPE_2D_ARRAY || !array) << pellucidPipelineName(p);
    }
  EXPECT_EQ(arrays, 3u) << "translucency, debug view and entry points";
  EXPECT_EQ(pellucidGetShader(pellucidGetPipelineCount(), VK_IMAGE_VIEW_TYPE_2D, &shader),
            PELLUCID_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(pellucidGetShader(0, VK_IMAGE_VIEW_TYPE_CUBE, &shader), PELLUCID_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(pellucidGetShader(0, VK_IMAGE_VIEW_TYPE_2D, nullptr), PELLUCID_ERROR_INVALID_ARGUMENT);
}

// What the context does for devices without shaderStorageImageWriteWithoutFormat.
TEST(Plan, OutputFormatIsPatchedIntoShaders) {
  const auto counts = [](const std::vector<uint32_t>& words) {
    std::array<int, 2> result{};  // capabilities and images without a format
    for (size_t i = 5; i < words.size(); i += words[i] >> 16) {
      const uint32_t opcode = words[i] & 0xFFFF;
      if (opcode == 17 && words[i + 1] == 56) ++result[0];
      if (opcode == 25 && words[i + 7] == 2 && words[i + 8] == 0) ++result[1];
    }
    return result;
  };
  for (uint32_t p = 0; p < pellucidGetPipelineCount(); ++p) {
    PellucidShader shader{};
    ASSERT_EQ(pellucidGetShader(p, VK_IMAGE_VIEW_TYPE_2D, &shader), PELLUCID_OK);
    std::vector<uint32_t> words(shader.words, shader.words + shader.wordCount);
    const auto before = counts(words);
    EXPECT_LE(before[0], before[1]) << pellucidPipelineName(p);  // an image that is not written needs none
    pellucid::fixOutputFormat(words.data(), words.size(), true);
    EXPECT_EQ(counts(words), (std::array<int, 2>{})) << pellucidPipelineName(p);
  }
}

TEST(Plan, ConstantsStayInTheirSlice) {
  Frame f(9);
  const PellucidPlan plan = f.plan();
  std::vector<unsigned char> slice(static_cast<size_t>(plan.constantsSize) + 64, 0xAB);
  ASSERT_EQ(pellucidWriteConstants(&plan, &f.frame, slice.data(), static_cast<size_t>(plan.constantsSize)),
            PELLUCID_OK);
  for (size_t i = 0; i < 64; ++i) EXPECT_EQ(slice[static_cast<size_t>(plan.constantsSize) + i], 0xAB);
  EXPECT_EQ(
      pellucidWriteConstants(&plan, &f.frame, slice.data(), static_cast<size_t>(plan.constantsSize) - 1),
      PELLUCID_ERROR_BUFFER_TOO_SMALL);
}

}  // namespace
