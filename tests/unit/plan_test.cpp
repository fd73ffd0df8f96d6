// BuildPlan and the constants of plans, without a device.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>

#include "entry_points.h"
#include "frame_fixture.h"
#include "shared/pellucid_shared.h"

static_assert(sizeof(PellucidPlan) <= 4096);  // as pellucid.h says

namespace {

using pellucid::test::bindingsOf;
using pellucid::test::Frame;
using pellucid::test::names;
using pellucid::test::plainMaterial;
using pellucid::test::skipped;

using Names = std::vector<std::string>;

const PellucidDispatch* find(const PellucidPlan& plan, const std::string& name) {
  for (uint32_t i = 0; i < plan.dispatchCount; ++i)
    if (plan.dispatches[i].name == name) return &plan.dispatches[i];
  return nullptr;
}

std::ptrdiff_t countOf(const PellucidPlan& plan, const std::string& name) {
  const Names all = names(plan);
  return std::count(all.begin(), all.end(), name);
}

PellucidMaterial paper() {
  PellucidMaterial m{};
  m.thinWalled = 1;
  for (int c = 0; c < 3; ++c) {
    m.reflectance[c] = 0.5f;
    m.wallTransmittance[c] = 0.25f;
  }
  return m;
}

// As engines have it: gathered.
struct Gathered : Frame {
  explicit Gathered(uint32_t shadowImages = 1) : Frame(shadowImages) { frame.options.gatherSamples = 8; }
};

// Gives each map an exit depth and caster materials: two images more.
void addImagesBeside(Frame& f) {
  const auto maps = static_cast<uint32_t>(f.maps.size());
  f.images.resize(3 * maps, Frame::view());
  for (uint32_t i = 0; i < maps; ++i) {
    f.maps[i].options.exitImage = maps + 2 * i + 1;
    f.maps[i].options.casterMaterialImage = maps + 2 * i + 2;
  }
  f.use();
}

// ---- Which passes a frame has, and what it skips

TEST(Plan, PassesAndSkipsFollowTheFrame) {
  const Names pyramid = {"base level", "downsample", "coarse levels", "upsample", "diffuse"};
  Names whole = pyramid;
  whole.insert(whole.begin(), "translucency");
  struct Row {
    const char* name;
    void (*change)(Frame&);
    Names passes;
    const char* skip;
    uint32_t count;
  };
  const Row rows[] = {
      {"no exit depth", [](Frame&) {}, whole, "exit depth", 1},
      {"no caster material", [](Frame&) {}, whole, "caster material", 1},
      {"no light", [](Frame& f) { f.frame.lightCount = 0; }, pyramid, "translucency", 1},
      {"nothing diffuses", [](Frame& f) { f.material.gaussianCount = 0; }, {"translucency"}, "diffusion", 1},
      {"dark lights",
       [](Frame& f) {
         f.lights.resize(3, f.lights[0]);
         f.lights[1].intensity = 0;
         std::fill_n(f.lights[2].color, 3, 0.0f);
         f.use();
       },
       whole, "light", 2},
      {"light without a thickness",
       [](Frame& f) {
         f.lights.push_back(Frame::light(0, 0));
         f.frame.backDepth = {};
         f.use();
       },
       whole, "light", 1},
      {"thin walls alone",
       [](Frame& f) {
         f.frame.options.gatherSamples = 8;
         f.material = paper();
       },
       {"translucency"},
       "gather",
       1},
      // Light that is not gathered is diffused. Probes find what curved surfaces return.
      {"back faces",
       [](Frame& f) {
         f.frame.options.gatherSamples = 8;
         f.maps[0].options.backFaces = 1;
       },
       {"translucency", "base level", "downsample", "probes", "coarse levels", "filter probes", "upsample", "diffuse"},
       "gather",
       1}};
  for (const Row& row : rows) {
    SCOPED_TRACE(row.name);
    Frame f;
    row.change(f);
    const PellucidPlan plan = f.plan();
    EXPECT_EQ(names(plan), row.passes);
    EXPECT_EQ(skipped(plan, row.skip), row.count);
  }
}

// The output is irradiance times albedo, where no light comes through and nothing diffuses.
TEST(Plan, IrradianceThatIsTheOutputIsLeftAlone) {
  Frame f;
  f.frame.options.features = PELLUCID_FEATURE_TRANSLUCENCY;
  f.frame.lightCount = 0;
  ASSERT_EQ(f.frame.output.view, f.frame.irradiance.view);
  EXPECT_EQ(names(f.plan()), Names{});
  f.frame.albedo = Frame::view();
  EXPECT_EQ(names(f.plan()), Names{"translucency"});
  f.frame.albedo = {};
  f.frame.output.view = reinterpret_cast<VkImageView>(uintptr_t{2});
  EXPECT_EQ(names(f.plan()), Names{"translucency"});
}

// The default frame, as docs/how-it-works.md lists it.
// A debug view is written whether or not anything else is.
TEST(Plan, DebugViewsInPlaceAreWritten) {
  for (const uint32_t features : {0u, uint32_t{PELLUCID_FEATURE_TRANSLUCENCY}, Frame().frame.options.features}) {
    Frame f(0);
    f.frame.lightCount = 0;
    f.frame.options.features = features;
    f.frame.output = f.frame.irradiance;
    f.frame.options.debugView = PELLUCID_DEBUG_THICKNESS;
    EXPECT_EQ(names(f.plan()), Names{"debug view"}) << features;
  }
}

// Clip coordinates are homogeneous.
TEST(Plan, TexelsHaveTheirSideWhateverTheFactorOfTheMatrix) {
  Frame f;
  f.maps[0].clipFromWorld[0] = 0.2f;
  const PellucidShadowMap orthographic = f.maps[0];
  PellucidShadowMap perspective = orthographic;
  perspective.clipFromWorld[11] = -1, perspective.clipFromWorld[15] = 0;
  for (PellucidShadowMap map : {orthographic, perspective}) {
    const double side = pellucid::texelSide(map);
    EXPECT_GT(side, 0);
    for (float& v : map.clipFromWorld) v *= 8;
    EXPECT_EQ(pellucid::texelSide(map), side);
  }
}

TEST(Plan, GathersBesideTheDiffusion) {
  const Names all = {"base level", "downsample", "entry points",  "coarse levels",
                     "probes",     "upsample",   "filter probes", "diffuse"};
  for (const auto indirect : {1, 0}) {
    Gathered f;
    f.frame.options.indirectDispatches = indirect;
    const PellucidPlan plan = f.plan();
    const Names found = names(plan);
    EXPECT_EQ(std::multiset<std::string>(found.begin(), found.end()), std::multiset<std::string>(all.begin(), all.end()));
    EXPECT_EQ(plan.barrierCount, 4u);
    // Steps between barriers: which passes run side by side.
    std::map<std::string, std::set<uint32_t>> steps;
    uint32_t step = 0;
    for (uint32_t i = 0; i < plan.dispatchCount; ++i)
      steps[found[i]].insert(step += plan.dispatches[i].barrierBefore);
    for (const auto& [pass, beside] : {std::pair("entry points", "downsample"),
                                       {"probes", "coarse levels"},
                                       {"filter probes", "upsample"}})
      EXPECT_EQ(steps[pass], steps[beside]) << pass;
  }
}

TEST(Plan, DiffusionAloneCopiesTheIrradianceUnlessTheOutputIsSeparate) {
  for (const uint32_t gatherSamples : {0u, 8u}) {
    Frame f;
    f.frame.options.gatherSamples = gatherSamples;
    f.frame.options.gatherSpacing = 4;
    if (gatherSamples == 0) f.frame.lightCount = 0;
    Names passes[2];
    uint32_t needs[2] = {};
    for (const uint32_t separate : {0u, 1u}) {
      f.frame.output.view = reinterpret_cast<VkImageView>(uintptr_t{1 + separate});
      const PellucidPlan plan = f.plan();
      passes[separate] = names(plan);
      EXPECT_EQ(pellucidGetImageNeeds(&f.frame, &needs[separate], nullptr), PELLUCID_OK);
      EXPECT_EQ(plan.dispatches[0].pushConstants[0], 1 - separate) << "copies";
      const auto last = bindingsOf(plan, plan.dispatches[plan.dispatchCount - 1]);
      EXPECT_EQ(
          std::any_of(last.begin(), last.end(),
                      [](const PellucidBinding& b) { return b.resource == PELLUCID_RESOURCE_IRRADIANCE; }),
          separate == 1);
    }
    EXPECT_EQ(passes[0], passes[1]);
    EXPECT_EQ(needs[1], needs[0] - 1);
  }
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
  EXPECT_EQ(skipped(f.plan(), "ambient light"), 1u);
  EXPECT_NE(f.problems(PELLUCID_SEVERITY_WARNING).find("ambient "), std::string::npos);

  Gathered gathered;
  EXPECT_EQ(names(gathered.plan()).front(), "base level");
  gathered.frame.options.ambient = sky.data();
  EXPECT_EQ(names(gathered.plan()).front(), "translucency");
}

TEST(Plan, GathersTheFramesSamples) {
  PellucidFrame fresh;
  pellucidInitFrame(&fresh);
  EXPECT_EQ(fresh.options.gatherSamples, 8u);
  for (const uint32_t samples : {0u, 4u, 8u, 16u, 64u}) {
    Frame f;
    f.frame.options.gatherSamples = samples;
    const PellucidPlan plan = f.plan();
    EXPECT_EQ(plan.gatherSamples, samples);
    EXPECT_EQ(find(plan, "probes") != nullptr, samples > 0);
    EXPECT_EQ(skipped(plan, "gather"), 0u) << "nobody asked for more";
  }
}

// As large images' probes would cost the most, they lie farther apart, however many samples they take.
TEST(Plan, ProbesLieApartByTheImagesSize) {
  struct Row {
    uint32_t width, height, spacing;
  };
  for (const Row& row : {Row{1024, 512, 1}, {1024, 513, 2}, {1024, 1024, 2}, {1024, 1025, 4}})
    for (const uint32_t samples : {4u, 16u}) {
      Frame f;
      f.frame.options.gatherSamples = samples;
      f.frame.imageExtent[0] = row.width;
      f.frame.imageExtent[1] = row.height;
      EXPECT_EQ(find(f.plan(), "probes")->pushConstants[0], row.spacing) << row.height << " rows";
      f.frame.options.gatherSpacing = 1;
      EXPECT_EQ(find(f.plan(), "probes")->pushConstants[0], 1u);
    }
}

// The plan leaves out a gather that a frame cannot have, and says so.
TEST(Plan, FramesThatCannotBeGatheredTakeOneThickness) {
  const std::pair<const char*, void (*)(Frame&)> cases[] = {
      {"thickness", [](Frame& f) { f.frame.options.cameraThickness = 1; }},
      {"mark bit", [](Frame& f) { f.thesis.materialMarkBit = 128; }},
      {"angle", [](Frame& f) { f.thesis.angleModel = PELLUCID_ANGLE_COSINE; }},
      {"view", [](Frame& f) { f.thesis.constantViewDirection = 1; }},
      {"thickest", [](Frame& f) { f.thesis.maximumThickness = 10; }},
      {"model", [](Frame& f) {
         f.material.transmittanceModel = PELLUCID_TRANSMITTANCE_LINEAR;
         for (auto& channel : f.material.transmittance) channel[0] = 4;
       }}};
  for (const auto& [name, change] : cases) {
    SCOPED_TRACE(name);
    Gathered f;
    ASSERT_NE(find(f.plan(), "probes"), nullptr);
    change(f);
    const PellucidPlan plan = f.plan();
    EXPECT_EQ(find(plan, "probes"), nullptr);
    EXPECT_EQ(find(plan, "entry points"), nullptr);
    EXPECT_EQ(plan.gatherSamples, 0u);
    EXPECT_EQ(names(plan)[0], "translucency");
    EXPECT_EQ(skipped(plan, "gather"), 1u);
    f.frame.options.gatherSamples = 0;
    EXPECT_EQ(skipped(f.plan(), "gather"), 0u) << "nobody asked for one";
  }
}

// ---- Rules of every plan

// Dispatches share images across barriers alone, read what was written, and stay within what every device
// has.
void expectRules(const Frame& f) {
  const PellucidPlan plan = f.plan();
  PellucidImageNeed needs[PELLUCID_MAX_TRANSIENTS + 1];
  uint32_t needCount = PELLUCID_MAX_TRANSIENTS + 1;
  ASSERT_EQ(pellucidGetImageNeeds(&f.frame, &needCount, needs), PELLUCID_OK);
  // Memory of an image may serve another from the next barrier on, not from the next dispatch. Needs of
  // frames that reuse light are those of two plans.
  for (uint32_t i = 0; i < needCount && f.frame.options.reuse == PELLUCID_REUSE_NONE; ++i) {
    const uint32_t first = needs[i].firstDispatch, next = needs[i].lastDispatch + 1;
    EXPECT_TRUE(first == 0 || plan.dispatches[first].barrierBefore) << "transient " << i;
    EXPECT_TRUE(next == plan.dispatchCount || plan.dispatches[next].barrierBefore) << "transient " << i;
  }
  std::set<uint32_t> everWritten, used, written;  // in the plan, and in the wave so far
  uint32_t inPlace = 0;
  for (uint32_t i = 0; i < plan.dispatchCount; ++i) {
    const PellucidDispatch& d = plan.dispatches[i];
    SCOPED_TRACE(d.name);
    const std::string name = d.name;
    for (const uint32_t groups : d.groups) EXPECT_LE(groups, 65535u);
    if (d.barrierBefore) used = written = {};
    std::multiset<uint32_t> uses;
    std::set<uint32_t> writes, numbers, sampled, stored;
    const std::vector<PellucidBinding> bound = bindingsOf(plan, d), all = bindingsOf(d.pipeline);
    ASSERT_EQ(bound.size(), all.size());
    if (d.indirect) {
      EXPECT_GE(d.indirectOffset, plan.listsOffset);
      EXPECT_LE(d.indirectOffset + 5 * sizeof(uint32_t), plan.constantsSize);
    }
    for (const PellucidBinding& b : bound) {
      EXPECT_TRUE(numbers.insert(b.binding).second) << "a binding holds one image";
      const bool oneImage = b.resource == PELLUCID_RESOURCE_OUTPUT && f.frame.output.view == f.frame.irradiance.view;
      const uint32_t image = oneImage ? static_cast<uint32_t>(PELLUCID_RESOURCE_IRRADIANCE) : b.resource;
      if (b.type == VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE) sampled.insert(image);
      if (b.type == VK_DESCRIPTOR_TYPE_STORAGE_IMAGE) stored.insert(image);
      const PellucidBinding& ofPipeline = all[static_cast<size_t>(&b - bound.data())];
      EXPECT_EQ(b.binding, ofPipeline.binding);
      EXPECT_EQ(b.type, ofPipeline.type);
      EXPECT_EQ(b.writes, ofPipeline.writes);
      if (b.resource == PELLUCID_RESOURCE_CONSTANTS) {
        EXPECT_LE(b.offset + b.size, b.writes ? plan.constantsSize : plan.listsOffset) << pellucidBindingName(b.binding);
        EXPECT_EQ(b.offset % 256, 0u);
        EXPECT_EQ(b.writes, b.offset >= plan.listsOffset) << "dispatches write the lists alone";
        EXPECT_TRUE(b.type != VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER || (b.size <= 16384 && b.size % 256 == 0));
        continue;
      }
      // The output stands in for a copy that the base level does not make.
      if (b.binding == PELLUCID_BINDING_DESTINATION && name == "base level" && d.pushConstants[0] == 0)
        continue;
      uses.insert(b.resource);
      // Words of the blocks are read by all passes but one.
      const bool reads =
          b.binding == PELLUCID_BINDING_BLOCKS && name != "base level";
      const bool write = b.type == VK_DESCRIPTOR_TYPE_STORAGE_IMAGE && !reads;
      EXPECT_EQ(b.writes, write) << pellucidBindingName(b.binding);
      if (write) writes.insert(b.resource);
      if (b.resource < PELLUCID_RESOURCE_TRANSIENT0 || b.resource >= PELLUCID_RESOURCE_HISTORY) continue;
      const uint32_t transient = b.resource - PELLUCID_RESOURCE_TRANSIENT0;
      ASSERT_LT(transient, needCount);
      EXPECT_GE(i, needs[transient].firstDispatch);
      EXPECT_LE(i, needs[transient].lastDispatch);
      // Probes of frames without maps have no entry point to read.
      const bool noEntries = b.binding == PELLUCID_BINDING_ENTRY_POINTS && f.frame.shadowMapCount == 0;
      EXPECT_TRUE(write || noEntries || everWritten.count(b.resource)) << "transient " << transient;
    }
    inPlace += std::any_of(stored.begin(), stored.end(), [&](uint32_t image) { return sampled.count(image) > 0; });
    for (const uint32_t resource : uses)
      EXPECT_EQ(written.count(resource), 0u) << pellucidResourceName(resource) << " was just written";
    for (const uint32_t resource : writes) {
      EXPECT_EQ(used.count(resource), 0u) << pellucidResourceName(resource) << " is in use";
      // D3D12, Metal and WebGPU forbid what Vulkan allows in GENERAL. A history is added to in place.
      if (resource != PELLUCID_RESOURCE_HISTORY) {
        EXPECT_EQ(uses.count(resource), 1u) << pellucidResourceName(resource) << " is read and written";
      }
    }
    EXPECT_EQ(writes.count(PELLUCID_RESOURCE_OUTPUT) == 1, i + 1 == plan.dispatchCount)
        << "output is written by the last dispatch only";
    used.insert(uses.begin(), uses.end());
    written.insert(writes.begin(), writes.end());
    everWritten.insert(writes.begin(), writes.end());
  }
  EXPECT_EQ(plan.inPlaceDispatches, inPlace);
}

TEST(Plan, EveryPlanKeepsTheRules) {
  for (const uint32_t lights : {0u, 1u, 9u, 20u})
    for (const uint32_t features : {0u, 1u, 2u, 3u})
      for (const uint32_t samples : {0u, 8u})
        for (const uint32_t indirect : {0u, 1u})
          for (const uint32_t reuse : {PELLUCID_REUSE_NONE, PELLUCID_REUSE_ALTERNATE}) {
            SCOPED_TRACE(testing::Message() << lights << " lights, features " << features << ", samples "
                                            << samples << ", lists " << indirect << ", reuse " << reuse);
            Frame f(lights);
            f.frame.options.features = features;
            f.frame.options.gatherSamples = samples;
            f.frame.options.indirectDispatches = indirect;
            f.frame.options.reuse = reuse;
            expectRules(f);
          }
  for (const size_t lights : {65, 128}) {
    Gathered manyOfOneMap;
    manyOfOneMap.lights.resize(lights, manyOfOneMap.lights[0]);
    manyOfOneMap.use();
    expectRules(manyOfOneMap);
  }
  for (const uint32_t samples : {0u, 8u}) {
    Frame beside(5);
    addImagesBeside(beside);
    beside.frame.options.gatherSamples = samples;
    expectRules(beside);
  }
}

// APIs with one state an image ask before they record.
TEST(Plan, DispatchesInPlaceAreCounted) {
  struct Row {
    const char* name;
    void (*change)(Frame&);
    uint32_t twoImages, oneImage;  // output and irradiance
  };
  constexpr uint32_t kThrough = PELLUCID_FEATURE_TRANSLUCENCY;
  const Row rows[] = {
      {"gathered", [](Frame& f) { f.frame.options.gatherSamples = 8; }, 0, 0},
      {"one thickness a pixel", [](Frame&) {}, 0, 0},
      {"added to the output", [](Frame& f) { f.frame.options.addToOutput = 1; }, 1, 0},
      {"not diffused", [](Frame& f) { f.frame.options.features = kThrough; }, 0, 1},
      {"diffusion alone", [](Frame& f) { f.frame.options.features = PELLUCID_FEATURE_DIFFUSION; }, 0, 0},
      {"a debug view", [](Frame& f) { f.frame.options.debugView = PELLUCID_DEBUG_THICKNESS; }, 0, 1},
      {"kept light", [](Frame& f) { f.frame.options.reuse = PELLUCID_REUSE_ALTERNATE; }, 0, 0},
      {"kept light, not diffused",
       [](Frame& f) {
         f.frame.options.reuse = PELLUCID_REUSE_ALTERNATE;
         f.frame.options.features = kThrough;
       },
       0, 1},
      {"kept probes",
       [](Frame& f) {
         f.frame.options.reuse = PELLUCID_REUSE_ALTERNATE;
         f.frame.options.gatherSamples = 8;
       },
       0, 0}};
  for (const Row& row : rows) {
    SCOPED_TRACE(row.name);
    Frame f(4);
    row.change(f);
    f.frame.output.view = reinterpret_cast<VkImageView>(uintptr_t{2});
    EXPECT_EQ(f.plan().inPlaceDispatches, row.twoImages);
    f.frame.output = f.frame.irradiance;
    if (f.frame.options.addToOutput == 0) {
      EXPECT_EQ(f.plan().inPlaceDispatches, row.oneImage) << "the output is the irradiance";
    }
  }
  Frame many(20);  // three dispatches
  many.frame.options.reuse = PELLUCID_REUSE_ALTERNATE;
  EXPECT_EQ(many.plan().inPlaceDispatches, 2u);
}

TEST(Plan, LargeImagesKeepTheirLists) {
  for (const auto& [width, height] : {std::pair(4096u, 4096u), {7680u, 4320u}, {16384u, 4096u}})
    for (const uint32_t spacing : {0u, 1u}) {
      SCOPED_TRACE(testing::Message() << width << " x " << height);
      Gathered f;
      f.frame.imageExtent[0] = width;
      f.frame.imageExtent[1] = height;
      f.frame.options.gatherSpacing = spacing;
      f.frame.options.indirectDispatches = 1;
      expectRules(f);
      const PellucidPlan plan = f.plan();
      uint32_t listed = 0;
      for (uint32_t i = 0; i < plan.dispatchCount; ++i) listed += plan.dispatches[i].indirect;
      EXPECT_EQ(listed + 1, plan.dispatchCount) << "all but the one that lists blocks";
    }
}

// Dispatches bind 8 shadow images, or 16 of entry points, and the constants of 128 lights or 112 maps.
TEST(Plan, ManyLightsBecomeSeveralDispatches) {
  struct Row {
    const char* name;
    uint32_t lights, maps, samples;  // maps: 0, 1, or 2 for tiles of one atlas
    bool beside;
    const char* pass;
    std::ptrdiff_t dispatches;
  };
  for (const Row& row : {Row{"maps of their own", 20, 1, 0, false, "translucency", 3},
                         {"three images a light", 4, 1, 0, true, "translucency", 2},
                         {"no maps", 300, 0, 0, false, "translucency", 3},
                         {"an atlas", 64, 2, 0, false, "translucency", 1},
                         {"a large atlas", 300, 2, 0, false, "translucency", 3},
                         {"gathered, three images a light", 4, 1, 8, true, "entry points", 1},
                         {"one more", 5, 1, 8, true, "entry points", 2}}) {
    SCOPED_TRACE(row.name);
    Frame f(row.maps == 1 ? row.lights : row.maps / 2);
    if (row.maps == 0) f.lights.resize(row.lights, f.lights[0]);
    for (uint32_t i = 1; row.maps == 2 && i < row.lights; ++i) {
      f.maps.push_back(f.maps[0]);
      f.maps[i].options.offset[0] = i % 20 * f.maps[0].extent[0];
      f.maps[i].options.offset[1] = i / 20 * f.maps[0].extent[1];
      f.lights.push_back(Frame::light(i, 1));
    }
    f.use();
    if (row.beside) addImagesBeside(f);
    f.frame.options.gatherSamples = row.samples;
    const PellucidPlan plan = f.plan();
    EXPECT_EQ(plan.activeLights, row.lights);
    EXPECT_EQ(countOf(plan, row.pass), row.dispatches);
    if (row.samples > 0) continue;
    uint32_t lights = 0;
    for (uint32_t i = 0; i < plan.dispatchCount; ++i)
      if (std::string(plan.dispatches[i].name) == row.pass) lights += plan.dispatches[i].pushConstants[1];
    EXPECT_EQ(lights, row.lights) << "each light once";
  }
}

// Many lights leave out what lies beside their maps before a frame fails that has room for the maps.
TEST(Plan, ImagesBesideMapsAreLeftOutWhereTheyAreTooMany) {
  for (const uint32_t gather : {0u, 8u}) {
    SCOPED_TRACE(gather);
    Frame plain(64), beside(64);
    addImagesBeside(beside);
    for (Frame* f : {&plain, &beside}) f->frame.options.gatherSamples = gather;
    const PellucidPlan with = beside.plan();
    EXPECT_EQ(names(with), names(plain.plan()));
    EXPECT_EQ(skipped(with, "exit depth and caster material"), 1u);
    std::vector<char> constants(static_cast<size_t>(with.constantsSize));
    EXPECT_EQ(pellucidWriteConstants(&with, &beside.frame, constants.data(), constants.size()), PELLUCID_OK);
  }
}

// docs/integration.md, "Limits".
TEST(Plan, ImagesBesideFiftyTwoMapsFit) {
  for (const uint32_t lights : {52u, 53u}) {
    Frame f(lights);
    addImagesBeside(f);
    f.frame.options.gatherSamples = 8;
    EXPECT_EQ(skipped(f.plan(), "exit depth and caster material"), lights > 52 ? 1u : 0u) << lights;
  }
}

// Of a shader's workgroups, as its SPIR-V states it: columns, rows.
std::array<uint32_t, 2> workgroupOf(uint32_t pipeline) {
  PellucidShader shader{};
  EXPECT_EQ(pellucidGetShader(pipeline, VK_IMAGE_VIEW_TYPE_2D, VK_FORMAT_UNDEFINED, nullptr, &shader), PELLUCID_OK);
  constexpr size_t kHeaderWords = 5;
  constexpr uint32_t kOpExecutionMode = 16, kLocalSize = 17;
  for (size_t i = kHeaderWords; i < shader.wordCount; i += shader.words[i] >> 16)
    if ((shader.words[i] & 0xFFFF) == kOpExecutionMode && shader.words[i + 2] == kLocalSize)
      return {shader.words[i + 3], shader.words[i + 4]};
  return {};
}

// Bytes of a shader's Workgroup variables.
uint32_t sharedBytesOf(uint32_t pipeline) {
  PellucidShader shader{};
  EXPECT_EQ(pellucidGetShader(pipeline, VK_IMAGE_VIEW_TYPE_2D, VK_FORMAT_UNDEFINED, nullptr, &shader), PELLUCID_OK);
  std::map<uint32_t, uint32_t> bytes, constants, pointees;  // by id
  uint32_t total = 0;
  for (size_t i = 5; i < shader.wordCount; i += shader.words[i] >> 16) {
    const uint32_t* w = shader.words + i;
    const uint32_t count = w[0] >> 16, op = w[0] & 0xFFFF;
    if (op == 43) constants[w[2]] = w[3];                           // OpConstant
    if (op == 20) bytes[w[1]] = 4;                                  // OpTypeBool
    if (op == 21 || op == 22) bytes[w[1]] = w[2] / 8;               // OpTypeInt, OpTypeFloat
    if (op == 23 || op == 24) bytes[w[1]] = bytes[w[2]] * w[3];     // OpTypeVector, OpTypeMatrix
    if (op == 28) bytes[w[1]] = bytes[w[2]] * constants[w[3]];      // OpTypeArray
    for (uint32_t member = 2; op == 30 && member < count; ++member)  // OpTypeStruct
      bytes[w[1]] += bytes[w[member]];
    if (op == 32) pointees[w[1]] = w[3];                      // OpTypePointer
    if (op == 59 && w[3] == 4) total += bytes[pointees[w[1]]];  // OpVariable, Workgroup
  }
  return total;
}

// The context asks the device for 16 KiB (kSharedBytes of context.cpp).
TEST(Plan, ShadersShareNoMoreMemoryThanTheContextAsksFor) {
  uint32_t most = 0;
  for (uint32_t pipeline = 0; pipeline < pellucidGetPipelineCount(); ++pipeline) {
    EXPECT_LE(sharedBytesOf(pipeline), 16384u) << pellucidPipelineName(pipeline);
    most = std::max(most, sharedBytesOf(pipeline));
  }
  EXPECT_GT(most, 8192u) << "shared memory was not counted";
}

// Groups that overlap would do pixels twice, and no pixel would say so.
TEST(Plan, GroupsCoverTheFrameOnce) {
  Frame f;
  const PellucidPlan plan = f.plan();
  const auto [columns, rows] = workgroupOf(plan.dispatches[0].pipeline);
  ASSERT_GT(columns * rows, 0u);
  EXPECT_EQ(plan.dispatches[0].groups[0], (f.frame.imageExtent[0] + columns - 1) / columns);
  EXPECT_EQ(plan.dispatches[0].groups[1], (f.frame.imageExtent[1] + rows - 1) / rows);
}

// ---- The diffusion's levels

// 100 x 50 pixels over 20 units.
struct Orthographic : Frame {
  Orthographic() {
    const float projection[16] = {0.1f, 0, 0, 0, 0, -0.1f, 0, 0, 0, 0, -0.01f, 0, 0, 0, 0, 1};
    std::copy(projection, projection + 16, frame.clipFromView);
  }
};

// The widest Gaussian of the fixture's material has a deviation of 1.41 mm.
TEST(Plan, SmallRadiiDropLevelsAndNoImages) {
  const auto coarsest = [](const Frame& f) { return find(f.plan(), "upsample")->pushConstants[0]; };
  EXPECT_EQ(coarsest(Frame()), 7u) << "a perspective camera has no scale";
  Orthographic f;
  struct Row {
    float metersPerUnit;
    uint32_t coarsest;
  };
  // 23.6, 21.4, 5.9, 5.4, .007 pixels
  for (const Row& row : {Row{3e-4f, 7}, {3.3e-4f, 5}, {1.2e-3f, 5}, {1.3e-3f, 3}, {1, 3}}) {
    f.frame.metersPerUnit = row.metersPerUnit;
    const PellucidPlan plan = f.plan();
    const PellucidDispatch* coarse = find(plan, "coarse levels");
    EXPECT_EQ(coarse ? coarse->pushConstants[1] : 3, row.coarsest) << row.metersPerUnit;
    EXPECT_EQ(coarsest(f), row.coarsest) << row.metersPerUnit;
  }
  f.frame.metersPerUnit = 1.3e-3f;
  f.material.gaussianVariance[1][0] = 4;  // 7.7 pixels
  EXPECT_EQ(coarsest(f), 5u) << "any Gaussian of any channel";
  f.material.gaussianWeight[1][0] = 0;
  f.material.gaussianWeight[1][1] = 1;
  EXPECT_EQ(coarsest(f), 3u) << "that has a weight";

  // The images that the caller creates do not follow a scale that a zoom changes.
  PellucidImageNeed needs[2][PELLUCID_MAX_TRANSIENTS];
  uint32_t counts[2] = {PELLUCID_MAX_TRANSIENTS, PELLUCID_MAX_TRANSIENTS};
  for (const size_t wide : {0u, 1u}) {
    f.frame.metersPerUnit = wide ? 1 : 3e-4f;
    ASSERT_EQ(pellucidGetImageNeeds(&f.frame, &counts[wide], needs[wide]), PELLUCID_OK);
  }
  ASSERT_EQ(counts[0], counts[1]);
  for (uint32_t i = 0; i < counts[0]; ++i)
    for (const int axis : {0, 1}) EXPECT_EQ(needs[0][i].extent[axis], needs[1][i].extent[axis]);
}

TEST(Plan, RadiiBeyondThePyramidAreReported) {
  Orthographic f;
  PellucidMaterial materials[3] = {f.material, f.material, f.material};
  materials[1].gaussianVariance[0][1] = 16;  // 4 mm
  materials[2].gaussianCount = 0;
  f.frame.materials = materials;
  f.frame.materialCount = 3;
  // 50 pixels a mm with .1 mm a unit; level 7 is 97.8 pixels.
  for (const auto& [metersPerUnit, count] : {std::pair(1e-4f, 1u), {7e-5f, 2u}, {3e-4f, 0u}}) {
    f.frame.metersPerUnit = metersPerUnit;
    EXPECT_EQ(skipped(f.plan(), "diffusion radius"), count) << metersPerUnit;
  }
}

// ---- Thin walls

// A solid and a sheet, gathered.
struct Mixed : Gathered {
  PellucidMaterial materials[2] = {plainMaterial(), paper()};
  explicit Mixed(uint32_t count = 1) : Gathered(count) {
    frame.materialCount = 2;
    frame.materials = materials;
    for (PellucidImage& image : frame.transients) image = view();
  }
};

TEST(ThinWall, GatheredFramesHaveADispatchMoreBeforeTheDiffusion) {
  Mixed f;
  const PellucidPlan plan = f.plan();
  EXPECT_EQ(plan.gatherSamples, 8u);
  EXPECT_EQ(names(plan)[0], "thin walls");
  EXPECT_EQ(names(plan)[1], "base level");
  EXPECT_EQ(plan.dispatches[0].pushConstants[0], PELLUCID_LIGHT_WALLS);
  EXPECT_EQ(plan.dispatches[0].pushConstants[1], 1u);
  const auto bound = bindingsOf(plan, plan.dispatches[0]);
  EXPECT_TRUE(std::any_of(bound.begin(), bound.end(),
                          [](const PellucidBinding& b) { return b.resource >= PELLUCID_RESOURCE_SHADOW0; }));
  f.frame.options.gatherSamples = 0;
  const PellucidPlan alike = f.plan();
  EXPECT_EQ(alike.dispatches[0].pushConstants[0], PELLUCID_LIGHT_ALL);
  f.frame.materialCount = 1;
  EXPECT_EQ(names(alike), names(f.plan())) << "without a gather sheets need no other dispatches";
  f.frame.options.gatherSamples = 8;
  EXPECT_EQ(f.plan().dispatchCount + 1, plan.dispatchCount);
  EXPECT_EQ(countOf(f.plan(), "thin walls"), 0);
}

TEST(ThinWall, LightsThatAreNotGatheredAddToEachMaterialOnce) {
  Mixed f;
  f.lights.push_back(Frame::light(0, 0));
  PellucidShadowMap back = f.maps[0];
  back.options.backFaces = 1;
  f.maps.push_back(back);
  f.lights.push_back(Frame::light(1, 1));
  f.use();
  f.frame.materialCount = 2;
  f.frame.materials = f.materials;
  const PellucidPlan plan = f.plan();
  uint32_t walls = 0;
  for (uint32_t i = 0; i < plan.dispatchCount; ++i) {
    const PellucidDispatch& d = plan.dispatches[i];
    if (std::string(d.name) == "thin walls") walls += d.pushConstants[1];
    EXPECT_TRUE(std::string(d.name) != "translucency" || d.pushConstants[0] == PELLUCID_LIGHT_SOLIDS);
  }
  EXPECT_EQ(walls, 3u);
}

// A sheet's light needs no thickness.
TEST(ThinWall, LightsNeedNoBackDepth) {
  Mixed f(0);
  f.frame.backDepth = {};
  EXPECT_EQ(f.plan().activeLights, 1u);
  EXPECT_EQ(skipped(f.plan(), "light in solids"), 1u);
  f.frame.materialCount = 1;
  EXPECT_EQ(f.plan().activeLights, 0u);
  f.frame.materials = &f.materials[1];
  EXPECT_EQ(f.plan().activeLights, 1u);
  EXPECT_EQ(skipped(f.plan(), "light in solids"), 0u);
}

// T(d) does not count, unlike with solids.
TEST(ThinWall, TransmittanceIsNotRead) {
  Mixed f;
  f.materials[1].transmittanceModel = PELLUCID_TRANSMITTANCE_LINEAR;
  EXPECT_EQ(f.plan().gatherSamples, 8u);
  f.materials[1] = plainMaterial();
  f.materials[1].transmittanceModel = PELLUCID_TRANSMITTANCE_LINEAR;
  EXPECT_EQ(f.plan().gatherSamples, 0u);
  EXPECT_EQ(skipped(f.plan(), "gather"), 1u);
}

// ---- Constants and shaders

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
          // A gather takes 512 bytes a map besides, which frames without one lack; large images have counters of 32,768 blocks.
          EXPECT_LT(bound, 4 * plan.constantsSize + 65536) << lights << " lights of " << mapsOfALight;
        }
}

TEST(Plan, TablesOfOtherFieldsAreRefused) {
  pellucid::test::CompleteFrame f;
  ASSERT_EQ(f.problems(), "");
  PellucidPlan plan;
  f.material.reflectance[1] = 0.25f;
  EXPECT_EQ(pellucidBuildPlan(&f.frame, nullptr, &plan), PELLUCID_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(pellucidMakeMaterialTables(&f.material, nullptr, nullptr), PELLUCID_OK);
  EXPECT_EQ(pellucidBuildPlan(&f.frame, nullptr, &plan), PELLUCID_OK);
  f.material.tables[0] ^= 1;  // as a file of another version has it
  EXPECT_EQ(pellucidBuildPlan(&f.frame, nullptr, &plan), PELLUCID_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(pellucidMakeMaterialTables(nullptr, nullptr, nullptr), PELLUCID_ERROR_INVALID_ARGUMENT);
}

TEST(Plan, ShadersThatAreNotThereAreRefused) {
  PellucidShader shader{};
  const auto get = [](uint32_t pipeline, VkImageViewType type, VkFormat format, PellucidShader* to) {
    return pellucidGetShader(pipeline, type, format, nullptr, to);
  };
  constexpr PellucidResult kInvalid = PELLUCID_ERROR_INVALID_ARGUMENT;
  EXPECT_EQ(get(pellucidGetPipelineCount(), VK_IMAGE_VIEW_TYPE_2D, VK_FORMAT_UNDEFINED, &shader), kInvalid);
  EXPECT_EQ(get(0, VK_IMAGE_VIEW_TYPE_CUBE, VK_FORMAT_UNDEFINED, &shader), kInvalid);
  EXPECT_EQ(get(0, VK_IMAGE_VIEW_TYPE_2D, VK_FORMAT_R8G8B8A8_UNORM, &shader), kInvalid);
  EXPECT_EQ(get(0, VK_IMAGE_VIEW_TYPE_2D, VK_FORMAT_UNDEFINED, nullptr), kInvalid);
}

// Engines without a context have handles of their own. Validation and recording alone refuse images without a view.
TEST(Plan, ViewsMayBeNull) {
  for (const uint32_t samples : {0u, 8u}) {
    Frame f(2);
    f.frame.options.gatherSamples = samples;
    const PellucidPlan with = f.plan();
    f.images.assign(f.images.size(), {});
    f.use();
    f.frame.frontDepth = f.frame.irradiance = f.frame.material = f.frame.output = {};
    const PellucidPlan plan = f.plan();
    EXPECT_EQ(names(plan), names(with));
    uint32_t count = 0;
    EXPECT_EQ(pellucidGetImageNeeds(&f.frame, &count, nullptr), PELLUCID_OK);
    std::vector<char> constants(static_cast<size_t>(plan.constantsSize));
    EXPECT_EQ(pellucidWriteConstants(&plan, &f.frame, constants.data(), constants.size()), PELLUCID_OK);
    EXPECT_NE(f.problems(), "");
  }
}

// Engines without a context make pipelines of these.
TEST(Plan, PipelinesAreKnownWithoutAPlan) {
  std::set<uint32_t> numbers, uses;
  for (uint32_t p = 0; p < pellucidGetPipelineCount(); ++p) {
    SCOPED_TRACE(pellucidPipelineName(p));
    for (const PellucidBinding& b : bindingsOf(p)) {
      numbers.insert(b.binding);
      EXPECT_EQ(b.resource + b.offset + b.size, 0u);
      EXPECT_TRUE(b.writes == 0 || b.type == VK_DESCRIPTOR_TYPE_STORAGE_IMAGE || b.type == VK_DESCRIPTOR_TYPE_STORAGE_BUFFER);
    }
    PellucidShader shader{};
    ASSERT_EQ(pellucidGetShader(p, VK_IMAGE_VIEW_TYPE_2D, VK_FORMAT_UNDEFINED, nullptr, &shader), PELLUCID_OK);
    EXPECT_NE(shader.uses, 0u);
    uses.insert(shader.uses);
  }
  EXPECT_EQ(*numbers.rbegin(), static_cast<uint32_t>(PELLUCID_MAX_BINDING_NUMBER));
  EXPECT_EQ(uses, (std::set<uint32_t>{PELLUCID_USE_TRANSLUCENCY, PELLUCID_USE_GATHER, PELLUCID_USE_DIFFUSION, PELLUCID_USE_REUSE,
                                      PELLUCID_USE_DEBUG_VIEWS}));
  PellucidBinding none[PELLUCID_MAX_BINDINGS];
  EXPECT_EQ(pellucidGetPipelineBindings(pellucidGetPipelineCount(), none), 0u);
  EXPECT_EQ(pellucidGetPipelineBindings(0, nullptr), 0u);
}

// Engines without a context may leave these constants out.
TEST(Plan, ConstantsOfTheContextHaveTheirDefaults) {
  constexpr uint32_t kDecorate = 71, kSpecId = 1, kTrue = 48, kFalse = 49, kConstant = 50;
  std::map<uint32_t, std::set<uint32_t>> defaults;
  for (uint32_t p = 0; p < pellucidGetPipelineCount(); ++p) {
    PellucidShader shader{};
    ASSERT_EQ(pellucidGetShader(p, VK_IMAGE_VIEW_TYPE_2D, VK_FORMAT_UNDEFINED, nullptr, &shader), PELLUCID_OK);
    std::map<uint32_t, uint32_t> ids;  // of constants, by result
    for (size_t i = 5; i < shader.wordCount; i += shader.words[i] >> 16) {
      const uint32_t opcode = shader.words[i] & 0xFFFF, *operands = shader.words + i + 1;
      if (opcode == kDecorate && operands[1] == kSpecId) ids[operands[0]] = operands[2];
      if (opcode == kTrue || opcode == kFalse) defaults[ids[operands[1]]].insert(opcode == kTrue);
      if (opcode == kConstant) defaults[ids[operands[1]]].insert(operands[2]);
    }
  }
  EXPECT_EQ(defaults[PELLUCID_SPECIALIZATION_LIGHT_TABLES], std::set<uint32_t>{0});
  EXPECT_EQ(defaults[PELLUCID_SPECIALIZATION_USES], std::set<uint32_t>{UINT32_MAX});
}

// For devices without shaderStorageImageWriteWithoutFormat.
TEST(Plan, OutputFormatIsPatchedIntoShaders) {
  const auto counts = [](const PellucidShader& shader) {
    std::array<int, 2> result{};  // capabilities and images without a format
    const uint32_t* words = shader.words;
    for (size_t i = 5; i < shader.wordCount; i += words[i] >> 16) {
      const uint32_t opcode = words[i] & 0xFFFF;
      if (opcode == 17 && words[i + 1] == 56) ++result[0];
      if (opcode == 25 && words[i + 7] == 2 && words[i + 8] == 0) ++result[1];
    }
    return result;
  };
  for (uint32_t p = 0; p < pellucidGetPipelineCount(); ++p) {
    SCOPED_TRACE(pellucidPipelineName(p));
    PellucidShader shader{};
    ASSERT_EQ(pellucidGetShader(p, VK_IMAGE_VIEW_TYPE_2D, VK_FORMAT_UNDEFINED, nullptr, &shader), PELLUCID_OK);
    const auto before = counts(shader);
    EXPECT_LE(before[0], before[1]);  // an image that is not written needs none
    for (const VkFormat format : {VK_FORMAT_R16G16B16A16_SFLOAT, VK_FORMAT_R32G32B32A32_SFLOAT}) {
      PellucidShader fixed{};
      ASSERT_EQ(pellucidGetShader(p, VK_IMAGE_VIEW_TYPE_2D, format, nullptr, &fixed), PELLUCID_OK);
      EXPECT_EQ(fixed.words, nullptr);
      ASSERT_EQ(fixed.wordCount, shader.wordCount);
      std::vector<uint32_t> words(fixed.wordCount);
      ASSERT_EQ(pellucidGetShader(p, VK_IMAGE_VIEW_TYPE_2D, format, words.data(), &fixed), PELLUCID_OK);
      EXPECT_EQ(fixed.words, words.data());
      EXPECT_EQ(counts(fixed), (std::array<int, 2>{}));
    }
  }
}

}  // namespace
