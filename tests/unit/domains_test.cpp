// Each float and integer of the frame's structs in turn at NaN, infinity and other extremes: validation names
// the field, or the field's domain says why the value is allowed.
#include <gtest/gtest.h>

#include <cstring>
#include <fstream>
#include <functional>
#include <limits>
#include <regex>
#include <set>
#include <sstream>

#include "domains.h"
#include "frame_fixture.h"
#include "images.h"

namespace {

using namespace pellucid;
using pellucid::test::Frame;

// Lacks nothing.
struct Whole : pellucid::test::CompleteFrame {
  PellucidLightTable table{};

  Whole() {
    frame.options.lightTableCount = 1;
    frame.options.lightTables = &table;
  }
};

// Frames that together read every field.
const std::vector<std::function<void(Frame&)>> kFrames = {
    [](Frame&) {},
    [](Frame& f) {
      f.material.thinWalled = 1;
      std::fill_n(f.material.wallTransmittance, 3, 0.5f);
    },
    [](Frame& f) {
      f.material.gaussianCount = PELLUCID_MAX_GAUSSIANS;
      for (int c = 0; c < 3; ++c)
        for (int k = 0; k < PELLUCID_MAX_GAUSSIANS; ++k) {
          f.material.gaussianVariance[c][k] = 1;
          f.material.gaussianWeight[c][k] = 1.0f / static_cast<float>(PELLUCID_MAX_GAUSSIANS);
        }
    },
    [](Frame& f) {
      PellucidShadowMap& map = f.maps[0];
      map.encoding = PELLUCID_DEPTH_VIEW_Z;
      for (int i = 0; i < 4; ++i) map.options.viewFromWorld[5 * i] = i % 3 == 0 ? 1 : -1;  // along +z
      PellucidLight spot = Frame::light(0, 0);
      spot.type = PELLUCID_LIGHT_SPOT;
      spot.outerConeAngle = 0.5f;
      f.lights.insert(f.lights.begin(), spot);
      f.use();
    }};

const float kExtremes[] = {std::numeric_limits<float>::quiet_NaN(),
                           std::numeric_limits<float>::infinity(),
                           -std::numeric_limits<float>::infinity(),
                           -1,
                           0,
                           std::numeric_limits<float>::denorm_min(),
                           3e38f,
                           -3e38f};

// The struct of a frame that the tables of `Struct` are about, the struct's name, and what its fields are called by.
template <class Struct>
struct Of;
#define OF(Struct, object, prefix)                    \
  template <>                                         \
  struct Of<Struct> {                                 \
    static Struct& of(Frame& f) { return object; }    \
    static constexpr const char* kName = #Struct;     \
    static constexpr const char* kPrefix = prefix;    \
  };
OF(PellucidFrame, f.frame, "")
OF(PellucidThesisOptions, f.thesis, "thesis.")
OF(PellucidMaterial, f.material, "materials[0].")
OF(PellucidLight, f.lights[0], "lights[0].")
OF(PellucidShadowMap, f.maps[0], "shadowMaps[0].")
OF(PellucidLightTable, static_cast<Whole&>(f).table, "options.lightTables[0].")
#undef OF

template <class Value>
void set(void* object, size_t offset, uint32_t index, Value value) {
  std::memcpy(static_cast<char*>(object) + offset + index * sizeof value, &value, sizeof value);
}

template <class Struct>
class Domains : public testing::Test {};

using Structs = testing::Types<PellucidFrame, PellucidThesisOptions, PellucidMaterial, PellucidLight,
                               PellucidLightTable, PellucidShadowMap>;
TYPED_TEST_SUITE(Domains, Structs);

TYPED_TEST(Domains, FloatsOutsideAreNamed) {
  std::set<std::string> read;
  for (const auto& change : kFrames)
    for (const FloatDomain& d : domainsOf<TypeParam>().floats)
      for (uint32_t i = 0; i < d.count; ++i)
        for (const float value : kExtremes) {
          Whole f;
          change(f);
          ASSERT_EQ(f.problems(), "");
          auto& object = Of<TypeParam>::of(f);
          set(&object, d.offset, i, value);
          const std::string problems = f.problems();
          if (!isRead(d, &object, i)) {
            EXPECT_EQ(problems, "") << d.field << "[" << i << "] = " << value << " is not read";
            continue;
          }
          read.insert(d.field);
          if (contains(d, value)) continue;  // whether it fits the others is other tests' matter
          EXPECT_NE(problems.find(std::string(Of<TypeParam>::kPrefix) + d.field), std::string::npos)
              << d.field << "[" << i << "] = " << value << ": " << problems;
        }
  EXPECT_EQ(read.size(), domainsOf<TypeParam>().floats.size())
      << "some field is read by no frame of this test";
}

TYPED_TEST(Domains, IntegersOutsideAreNamed) {
  for (const IntegerDomain& d : domainsOf<TypeParam>().integers)
    for (uint32_t i = 0; i < d.count; ++i)
      for (const uint32_t value : {d.least - 1, d.most + 1, 0x80000000u, 0xFFFFFFFFu}) {
        if (value >= d.least && value <= d.most) continue;
        Whole f;
        set(&Of<TypeParam>::of(f), d.offset, i, value);
        const std::string problems = f.problems(), field = std::string(Of<TypeParam>::kPrefix) + d.field;
        EXPECT_EQ(problems.find(field), 0u) << problems;
        EXPECT_NE(problems.find("is " + std::to_string(value)), std::string::npos) << problems;
      }
}

// Names of the fields of a type that the headers declare in a struct and its options.
std::set<std::string> declared(const std::string& type, const std::string& name) {
  std::stringstream text;
  for (const char* header : {"pellucid.h", "pellucid_options.h", "pellucid_material.h", "pellucid_thesis.h"})
    text << std::ifstream(std::string(PELLUCID_SOURCE_DIR) + "/module/include/pellucid/" + header).rdbuf();
  const std::string declarations = std::regex_replace(text.str(), std::regex(R"(/\*[\s\S]*?\*/)"), "");
  const size_t first = declarations.find("struct " + name + " {"), last = declarations.find("}", first);
  std::set<std::string> fields;
  const std::string body = declarations.substr(first, last - first);
  const std::regex declaration("\\b" + type + " ([^*;]+);"), field(R"((\w+)(\[\w+\])*)");
  for (std::sregex_iterator d(body.begin(), body.end(), declaration), end; d != end; ++d) {
    std::stringstream list((*d)[1].str());
    for (std::string one; std::getline(list, one, ',');) {
      std::smatch match;
      if (std::regex_search(one, match, field)) fields.insert(match[1].str());
    }
  }
  if (body.find(name + "Options options;") != std::string::npos)
    for (const std::string& option : declared(type, name + "Options")) fields.insert("options." + option);
  return fields;
}

TYPED_TEST(Domains, TheTableHasEveryFloatOfTheHeader) {
  std::set<std::string> table;
  for (const FloatDomain& d : domainsOf<TypeParam>().floats) table.insert(d.field);
  EXPECT_EQ(table, declared("float", Of<TypeParam>::kName));
}

// Integers whose domain is no interval, or depends on other fields: values that each must refuse, and the
// field that the sentence names.
struct IntegerRule {
  const char* structName;
  const char* field;
  const char* named;
  std::function<void(Frame&, uint32_t)> set;
  std::vector<uint32_t> bad;
};

#define RULE(Struct, integer, named, ...)                                                       \
  {                                                                                             \
#Struct, #integer, named, [](Frame & f, uint32_t v) { Of<Struct>::of(f).integer = v; }, { \
      __VA_ARGS__                                                                               \
    }                                                                                           \
  }

// Sets the number of what is not there.
template <uint32_t PellucidFrame::*count, auto PellucidFrame::*first>
void countOf(Frame& f, uint32_t value) {
  f.frame.*count = value;
  f.frame.*first = nullptr;
}

const std::vector<IntegerRule> kIntegerRules = {
    RULE(PellucidFrame, options.features, "options.features", 4, 7, 0x80000000, 0xFFFFFFFF),
    RULE(PellucidFrame, imageExtent[1], "imageExtent", 0, 65537, 0x80000000, 0xFFFFFFFF),
    RULE(PellucidFrame, options.renderRect[0], "options.renderRect", 1, 65537, 0x80000000, 0xFFFFFFFF),
    RULE(PellucidFrame, options.renderRect[2], "options.renderRect", 1, 0x80000000,
         0xFFFFFFFF),  // of height 0
    {"PellucidFrame",
     "options.renderRect",
     "options.renderRect",
     [](Frame& f, uint32_t v) {
       f.frame.options.renderRect[1] = f.frame.options.renderRect[2] = 1;
       f.frame.options.renderRect[3] = v;
     },
     {0, 50, 0x80000000, 0xFFFFFFFF}},
    RULE(PellucidFrame, materialCount, "materials", 0, 256, 0x80000000, 0xFFFFFFFF),
    {"PellucidFrame",
     "lightCount",
     "lights",
     countOf<&PellucidFrame::lightCount, &PellucidFrame::lights>,
     {1, 0xFFFFFFFF}},
    {"PellucidFrame",
     "shadowMapCount",
     "shadowMaps",
     countOf<&PellucidFrame::shadowMapCount, &PellucidFrame::shadowMaps>,
     {1, 0xFFFFFFFF}},
    {"PellucidFrame",
     "shadowImageCount",
     "shadowImages",
     countOf<&PellucidFrame::shadowImageCount, &PellucidFrame::shadowImages>,
     {1, 0xFFFFFFFF}},
    RULE(PellucidFrame, options.gatherSamples, "options.gatherSamples", 1, 3, 66, 68, 0x80000000, 0xFFFFFFFF),
    RULE(PellucidFrame, options.gatherSpacing, "options.gatherSpacing", 3, 5, 8, 0x80000000, 0xFFFFFFFF),
    RULE(PellucidFrame, options.materialMask, "options.materialMask", 2, 0x80000000, 0xFFFFFFFE),
    RULE(PellucidFrame, options.reuse, "options.reuse", 3, 5, 0x80000000, 0xFFFFFFFF),
    RULE(PellucidThesisOptions, materialMarkBit, "thesis.materialMarkBit", 1, 3, 192, 0xFFFFFFFF),
    RULE(PellucidLight, firstShadowMap, "lights[0].shadowMapCount", 1, 0x80000000, 0xFFFFFFFF),
    RULE(PellucidLight, shadowMapCount, "lights[0].shadowMapCount", 2, PELLUCID_MAX_LIGHT_SHADOW_MAPS + 1,
         0x80000000, 0xFFFFFFFF),
    // The light is directional.
    RULE(PellucidLight, angleTable, "lights[0].angleTable", 1, 2, 0xFFFFFFFF),
    RULE(PellucidLight, distanceTable, "lights[0].distanceTable", 1, 2, 0xFFFFFFFF),
    RULE(PellucidShadowMap, image, "shadowMaps[0].image", 1, 0x80000000, 0xFFFFFFFF),
    RULE(PellucidShadowMap, options.exitImage, "shadowMaps[0].options.exitImage", 1, 2, 0x80000000,
         0xFFFFFFFF),
    RULE(PellucidShadowMap, options.casterMaterialImage, "shadowMaps[0].options.casterMaterialImage", 1, 2,
         0x80000000, 0xFFFFFFFF)};

TEST(Domains, IntegersAgainstTheirRulesAreNamed) {
  for (const IntegerRule& rule : kIntegerRules)
    for (const uint32_t value : rule.bad) {
      Whole f;
      rule.set(f, value);
      const std::string problems = f.problems();
      EXPECT_EQ(problems.find(rule.named), 0u) << rule.field << " = " << value << ": " << problems;
      PellucidPlan plan;
      EXPECT_NE(pellucidBuildPlan(&f.frame, nullptr, &plan), PELLUCID_OK) << rule.field << " = " << value;
    }
}

TYPED_TEST(Domains, EveryIntegerOfTheHeaderHasADomainOrARule) {
  std::set<std::string> known;
  for (const IntegerDomain& d : domainsOf<TypeParam>().integers) known.insert(d.field);
  for (const IntegerRule& rule : kIntegerRules)
    if (std::string(rule.structName) == Of<TypeParam>::kName)
      known.insert(std::string(rule.field).substr(0, std::string(rule.field).find('[')));
  std::set<std::string> fields = declared("uint32_t", Of<TypeParam>::kName);
  fields.erase("tables");  // no number, but all that shaders read
  EXPECT_EQ(known, fields);
}

// Each image in each layout that shaders cannot read, and the written ones in all but GENERAL.
TEST(Domains, LayoutsThatDoNotFitAreNamed) {
  std::vector<std::pair<std::string, std::function<PellucidImage&(Frame&)>>> images = {
      {"shadowImages[0]", [](Frame& f) -> PellucidImage& { return f.images[0]; }},
      {"transients[0]", [](Frame& f) -> PellucidImage& { return f.frame.transients[0]; }},
      {"options.history", [](Frame& f) -> PellucidImage& { return f.frame.options.history; }}};
  for (const ImageField& i : kImageFields)
    images.emplace_back(i.name, [&i](Frame& f) -> PellucidImage& { return f.frame.*i.field; });
  const VkImageLayout readable[] = {
      VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL,
      VK_IMAGE_LAYOUT_DEPTH_READ_ONLY_STENCIL_ATTACHMENT_OPTIMAL, VK_IMAGE_LAYOUT_DEPTH_READ_ONLY_OPTIMAL,
      VK_IMAGE_LAYOUT_READ_ONLY_OPTIMAL};
  const VkImageLayout others[] = {VK_IMAGE_LAYOUT_UNDEFINED,
                                  VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                                  VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL,
                                  VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                                  VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                                  VK_IMAGE_LAYOUT_PREINITIALIZED,
                                  VK_IMAGE_LAYOUT_PRESENT_SRC_KHR,
                                  VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL,
                                  VK_IMAGE_LAYOUT_ATTACHMENT_OPTIMAL,
                                  static_cast<VkImageLayout>(9),
                                  VK_IMAGE_LAYOUT_MAX_ENUM};
  const auto problemsWith = [](const auto& image, VkImageLayout layout) {
    Whole f;
    f.frame.albedo = f.frame.hiddenIrradiance = f.frame.motion = f.frame.options.history = Frame::view();
    f.frame.options.reuse = PELLUCID_REUSE_ACCUMULATE;
    f.frame.options.gatherSamples = 8;
    image(f).layout = layout;
    return f.problems();
  };
  for (const auto& [name, image] : images) {
    // The irradiance is the output, too.
    const bool written = name == "output" || name == "irradiance" || name == "transients[0]" || name == "options.history";
    EXPECT_EQ(problemsWith(image, VK_IMAGE_LAYOUT_GENERAL), "") << name;
    for (const VkImageLayout layout : readable)
      EXPECT_EQ(problemsWith(image, layout).find(name + " is in VkImageLayout"),
                written ? 0u : std::string::npos)
          << name << " " << layout;
    for (const VkImageLayout layout : others)
      EXPECT_EQ(problemsWith(image, layout).find(name + " is in VkImageLayout"), 0u) << name << " " << layout;
  }
}

// Transmittance that thicker parts have more of is refused, even where its rates are positive.
TEST(Domains, TransmittanceThatRisesIsRefused) {
  struct Row {
    float t[4];
    bool allowed;
  };
  for (const Row& row : {Row{{1, 0.5f, 0, 0}, true},
                         {{0.7f, 2, 0.3f, 0.25f}, true},
                         {{1.5f, 1, -0.5f, 2}, true},   // a shoulder: 1.5 e^-d - .5 e^-2d falls from 1
                         {{1, 1, -0.5f, 0.5f}, false},  // below 0 where it is thick
                         {{-1, 2, 1.5f, 1}, false},     // rises from .5
                         {{-1, 1, 0, 0}, false}}) {
    Whole f;
    std::copy(row.t, row.t + 4, f.material.transmittance[1]);
    const std::string problems = f.problems();
    if (row.allowed)
      EXPECT_EQ(problems, "");
    else
      EXPECT_NE(problems.find("materials[0].transmittance of channel 1 grows"), std::string::npos)
          << problems;
  }
}

// One thickness a pixel ends T at 1, and the gather goes as far as kappa says: elsewhere the two would differ.
TEST(Domains, TransmittanceBeyondWhatTheGatherTakesIsRefused) {
  struct Row {
    uint32_t model;
    float t[5];
    const char* refused;  // empty: allowed
  };
  constexpr uint32_t kExp2 = PELLUCID_TRANSMITTANCE_EXP2, kSinhExp = PELLUCID_TRANSMITTANCE_SINH_EXP;
  for (const Row& row : {Row{kSinhExp, {0.0578f, 9.73f, 0.389f, 0.774f, 9.73f}, ""},
                         {kSinhExp, {0.0578f, 9.73f, 0.389f, 0.774f, 0.573f}, "has c 0.573 below kappa 9.73"},
                         {kSinhExp, {0.0578f, 9.73f, 0.389f, 0, 0}, ""},
                         {kSinhExp, {1.206f, 5.97f, 0.194f, 0.0238f, 6.8f}, "without thickness 6.2"},
                         {kExp2, {0.6f, 1, 0.4005f, 2, 0}, ""},
                         {kExp2, {0.6f, 1, 0.5f, 2, 0}, "without thickness 1.1"}}) {
    Whole f;
    f.material.transmittanceModel = row.model;
    for (float(&channel)[5] : f.material.transmittance) std::copy(row.t, row.t + 5, channel);
    const std::string problems = f.problems();
    if (*row.refused == '\0')
      EXPECT_EQ(problems, "");
    else
      EXPECT_NE(problems.find("materials[0].transmittance of channel 0 "), std::string::npos) << problems;
    EXPECT_NE(problems.find(row.refused), std::string::npos) << problems;
  }
}

TEST(Domains, ClipMatricesWithoutPixelSizeAreRefused) {
  for (const float scale : {1e30f, 1e-30f, 1e14f, 1e-13f}) {
    Whole f;
    f.frame.clipFromView[0] = scale;
    f.frame.clipFromView[5] = -scale;
    EXPECT_NE(f.problems().find("clipFromView"), std::string::npos) << scale;
  }
}

}  // namespace
