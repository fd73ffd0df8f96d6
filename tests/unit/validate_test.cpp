// Each convention violated once: the field is named, the value is in the sentence, and no plan is made.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>

#include "frame_fixture.h"

namespace {

using pellucid::test::CompleteFrame;
using pellucid::test::Frame;

struct Violation {
  const char *name, *field, *sentence;
  void (*commit)(Frame&);
};

// Ones, but for one entry.
void addTable(Frame& f, float entry) {
  static PellucidLightTable table;
  std::fill_n(table.factor, PELLUCID_LIGHT_TABLE_ENTRIES, 1.0f);
  table.factor[5] = entry;
  f.frame.options.lightTableCount = 1;
  f.frame.options.lightTables = &table;
}

PellucidLight& makePoint(Frame& f) {
  f.lights[0].type = PELLUCID_LIGHT_POINT;
  f.lights[0].shadowMapCount = 0;
  return f.lights[0];
}

// domains_test has a value outside of every number's domain.
const Violation kViolations[] = {
    {"RectOverflow", "options.renderRect", "outside",
     [](Frame& f) {
       f.frame.options.renderRect[0] = 0xFFFFFFFF;
       f.frame.options.renderRect[2] = 2;
       f.frame.options.renderRect[3] = 2;
     }},
    {"AnchorsWeight", "options.anchor", "has w 0.5", [](Frame& f) { f.frame.options.anchor[3] = 0.5f; }},
    {"AnchorOfKeptLight", "options.anchor", "has w 1 with reuse 1",
     [](Frame& f) {
       f.frame.options.anchor[3] = 1;
       f.frame.options.reuse = PELLUCID_REUSE_ALTERNATE;
     }},
    {"ObliqueNearPlane", "clipFromView", "pass view z (DEPTH_VIEW_Z) and the matrix without",
     [](Frame& f) { f.frame.clipFromView[2] = 0.1f; }},
    {"BackDepthOfDistance", "options.backDepthEncoding", "is 2; use DEVICE, VIEW_Z or THICKNESS",
     [](Frame& f) { f.frame.options.backDepthEncoding = PELLUCID_DEPTH_DISTANCE; }},
    {"FrontDepthOfThickness", "options.frontDepthEncoding", "is 3",
     [](Frame& f) { f.frame.options.frontDepthEncoding = PELLUCID_DEPTH_THICKNESS; }},
    {"MapOfThickness", "shadowMaps[0].encoding", "is 3", [](Frame& f) { f.maps[0].encoding = PELLUCID_DEPTH_THICKNESS; }},
    {"ThicknessBehindShadows", "options.cameraThickness", "do not say what a shadow map hides; use 0",
     [](Frame& f) {
       f.frame.options.backDepthEncoding = PELLUCID_DEPTH_THICKNESS;
       f.frame.options.cameraThickness = 1;
     }},
    {"DirectionalWithPerspectiveMap", "lights[0].firstShadowMap", "draw a directional light's map again",
     [](Frame& f) { f.maps[0].clipFromWorld[7] = 0.1f; }},
    {"MaterialMaskBelowShift", "options.materialMask", "whose last bits materialShift 4 drops",
     [](Frame& f) {
       f.frame.options.materialShift = 4;
       f.frame.options.materialMask = 0xFF;
     }},
    {"MaterialMaskWithoutIndices", "options.materialMask", "leave 14; the indices of 1 materials take 1",
     [](Frame& f) {
       f.frame.options.materialShift = 4;
       f.frame.options.materialMask = 0xE0;
     }},
    {"MarkBitOutsideTheMask", "thesis.materialMarkBit", "which materialMask 112 and materialShift 4",
     [](Frame& f) {
       f.frame.options.materialShift = 4;
       f.frame.options.materialMask = 0x70;
       f.thesis.materialMarkBit = 8;
     }},
    {"Ambient", "options.ambient", "[26] is nan",
     [](Frame& f) {
       static const auto sky = [] {
         std::array<float, 27> s{};
         s[26] = NAN;
         return s;
       }();
       f.frame.options.ambient = sky.data();
     }},
    {"ViewScale", "viewFromWorld", "rotation", [](Frame& f) { f.frame.viewFromWorld[0] = 2; }},
    {"OutputFormat", "options.outputFormat", "VkFormat 37",
     [](Frame& f) { f.frame.options.outputFormat = VK_FORMAT_R8G8B8A8_UNORM; }},
    {"SinhPole", "materials[0].transmittance", "z > 0",
     [](Frame& f) {
       f.material.transmittanceModel = PELLUCID_TRANSMITTANCE_SINH_EXP;
       f.material.transmittance[0][2] = 0;
     }},
    {"Weights", "materials[0].gaussianWeight", "sums to",
     [](Frame& f) { f.material.gaussianWeight[0][0] = 0.9f; }},
    {"WallBrighterThanItsLight", "materials[0].wallTransmittance", "of channel 2 is 0.6",
     [](Frame& f) {
       f.material.thinWalled = 1;
       std::fill_n(f.material.reflectance, 3, 0.5f);
       f.material.wallTransmittance[2] = 0.6f;
     }},
    {"ShadowSingular", "shadowMaps[0].clipFromWorld", "inverted",
     [](Frame& f) { f.maps[0].clipFromWorld[0] = 0; }},
    {"ShadowTile", "shadowMaps[0].options.offset", "[1] is 65500 with an extent of 64",
     [](Frame& f) { f.maps[0].options.offset[1] = 65500; }},
    {"FacesOfOneLight", "shadowMaps[1].options.backFaces",
     "is 1, but that of the first map of lights[0] is 0",
     [](Frame& f) {
       f.maps.push_back(f.maps[0]);
       f.maps[1].options.backFaces = 1;
       f.lights[0].shadowMapCount = 2;
       f.use();
     }},
    {"ShadowView", "shadowMaps[0].options.viewFromWorld", "encoding",
     [](Frame& f) { f.maps[0].encoding = PELLUCID_DEPTH_VIEW_Z; }},
    {"ViewOffItsMap", "shadowMaps[0].options.viewFromWorld", "looks 90 degrees off clipFromWorld",
     [](Frame& f) {
       f.maps[0].encoding = PELLUCID_DEPTH_VIEW_Z;
       const float view[16] = {0, 0, -1, 0, 0, 1, 0, 0, 1, 0, 0, 0, 0, 0, 0, 1};
       std::copy(view, view + 16, f.maps[0].options.viewFromWorld);
     }},
    {"BiasThatIsAFactor", "shadowMaps[0].options.depthBiasConstant", "is 1.25, over half of the range",
     [](Frame& f) { f.maps[0].options.depthBiasConstant = 1.25f; }},
    {"StepThatIsACount", "shadowMaps[0].options.depthStep", "is 65535; needs the smallest difference",
     [](Frame& f) { f.maps[0].options.depthStep = 65535; }},
    {"DirectionOffItsMap", "lights[0].direction", "is 45 degrees off the rays of shadowMaps[0]",
     [](Frame& f) { f.lights[0].direction[0] = f.lights[0].direction[2] = 1; }},
    {"DirectionAgainstItsMap", "lights[0].direction", "is 180 degrees off the rays of shadowMaps[0]",
     [](Frame& f) {
       f.maps[0].encoding = PELLUCID_DEPTH_VIEW_Z;
       for (int i = 0; i < 4; ++i) f.maps[0].options.viewFromWorld[5 * i] = 1;  // along -z
     }},
    {"SpotAwayFromItsMap", "lights[0].direction", "points away from what the light's shadow maps show",
     [](Frame& f) {
       const float clip[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 1, 0, 0, 0.1f, 0};  // w grows along z
       std::copy(clip, clip + 16, f.maps[0].clipFromWorld);
       f.lights[0].type = PELLUCID_LIGHT_SPOT;
       f.lights[0].outerConeAngle = 0.5f;
       f.lights[0].direction[2] = -1;
     }},
    {"CasterIsTheExit", "shadowMaps[0].options.casterMaterialImage", "the exitImage",
     [](Frame& f) {
       f.images.push_back(Frame::view());
       f.maps[0].options.exitImage = f.maps[0].options.casterMaterialImage = 2;
       f.use();
     }},
    {"LightImages", "lights[0].shadowMapCount", "more than the 8 images",
     [](Frame& f) {
       f.images.assign(9, Frame::view());
       f.maps.assign(3, f.maps[0]);
       for (uint32_t i = 0; i < 3; ++i) {
         f.maps[i].image = 3 * i;
         f.maps[i].options.exitImage = 3 * i + 2;
         f.maps[i].options.casterMaterialImage = 3 * i + 3;
       }
       f.lights[0].shadowMapCount = 3;
       f.use();
     }},
    {"LightDirection", "lights[0].direction", "length 0", [](Frame& f) { f.lights[0].direction[2] = 0; }},
    {"SpotCone", "lights[0].outerConeAngle", "inner",
     [](Frame& f) { f.lights[0].type = PELLUCID_LIGHT_SPOT; }},
    {"LightTablesMissing", "options.lightTables", "is NULL, but lightTableCount is 1",
     [](Frame& f) { f.frame.options.lightTableCount = 1; }},
    {"LightTableFactor", "options.lightTables[0].factor", "[5] is 1.5", [](Frame& f) { addTable(f, 1.5f); }},
    {"LightTableIndex", "lights[0].angleTable", "is 2 (an index plus 1), but there are 1 lightTables",
     [](Frame& f) {
       addTable(f, 1);
       makePoint(f).angleTable = 2;
     }},
    {"DistanceTableWithoutRange", "lights[0].range", "is 0, but distanceTable is 1",
     [](Frame& f) {
       addTable(f, 1);
       makePoint(f).distanceTable = 1;
     }},
    {"AngleTableWithoutDirection", "lights[0].direction", "has length 0",
     [](Frame& f) {
       addTable(f, 1);
       PellucidLight& point = makePoint(f);
       point.angleTable = 1;
       point.direction[2] = 0;
     }},
    {"PointWithOrthographicMap", "lights[0].firstShadowMap", "orthographic",
     [](Frame& f) { f.lights[0].type = PELLUCID_LIGHT_POINT; }},
};

TEST(Validate, NamesFieldAndValue) {
  for (const Violation& violation : kViolations) {
    SCOPED_TRACE(violation.name);
    CompleteFrame f;
    ASSERT_EQ(f.problems(), "");
    violation.commit(f);
    const std::string problems = f.problems();
    EXPECT_EQ(problems.find(violation.field), 0u) << problems;
    EXPECT_NE(problems.find(violation.sentence), std::string::npos) << problems;
    PellucidPlan plan;
    EXPECT_NE(pellucidBuildPlan(&f.frame, nullptr, &plan), PELLUCID_OK);
    EXPECT_EQ(plan.dispatchCount, 0u);
  }
}

// What validation accepts a plan can be made of, at every number of lights with maps of their own.
TEST(Validate, CapacityIsThePlans) {
  for (const uint32_t samples : {0u, 8u}) {
    bool refused = false;
    for (uint32_t lights = 8; lights <= 320 && !refused; lights += 8) {
      Frame f(lights);
      f.frame.options.gatherSamples = samples;
      const std::string problems = f.problems();
      PellucidPlan plan;
      const PellucidResult result = pellucidBuildPlan(&f.frame, nullptr, &plan);
      // The fixture has no transients, which validation asks for, but not the plan.
      refused = result == PELLUCID_ERROR_CAPACITY;
      EXPECT_EQ(problems.find("shadowImages of all " + std::to_string(lights)) == 0, refused) << problems;
      if (!refused) continue;
      const size_t first = problems.find("first ") + 6;
      Frame fits(static_cast<uint32_t>(std::stoul(problems.substr(first))));
      fits.frame.options.gatherSamples = samples;
      EXPECT_EQ(pellucidBuildPlan(&fits.frame, nullptr, &plan), PELLUCID_OK);
    }
    EXPECT_TRUE(refused) << samples << " samples: no number of lights was too many";
  }
}

TEST(Validate, MissingViewsAreNamed) {
  Frame f;
  f.frame.irradiance = {};
  const std::string problems = f.problems();
  EXPECT_NE(problems.find("irradiance has no view"), std::string::npos);
  EXPECT_NE(problems.find("transients[1] has no view"), std::string::npos);
}

struct Warned {
  const char* name;
  const char* sentence;
  void (*change)(Frame&);
};

// The fixture's texels are .3 mm long and its material's diffusion length is 2 mm.
const Warned kWarned[] = {
    {"Dark", "lights[0] adds nothing", [](Frame& f) { f.lights[0].intensity = 0; }},
    // 65504 is the largest half, which exposed light must not exceed.
    {"CutByHalves", "lights[0].intensity brings an irradiance of 65536",
     [](Frame& f) { f.lights[0].intensity = 65536; }},
    {"Coarse", "shadowMaps[0].extent makes a texel 20 mm long", [](Frame& f) { f.maps[0].extent[0] = 1; }},
    {"Overlap", "shadowMaps[1].options.offset is 32, 63",
     [](Frame& f) {
       f.maps.push_back(f.maps[0]);
       f.maps[1].options.offset[0] = 32;
       f.maps[1].options.offset[1] = 63;
       f.use();
     }},
    {"BackFaces", "shadowMaps[0].options.backFaces is 1", [](Frame& f) { f.maps[0].options.backFaces = 1; }},
    {"BackFacesAlone", "lights[0] adds nothing",
     [](Frame& f) {
       f.maps[0].options.backFaces = 1;
       f.frame.backDepth = {};
     }},
    {"SlopeWithoutNeighbors", "shadowMaps[0].options.depthBiasSlope is 1.75",
     [](Frame& f) {
       f.maps[0].options.depthBiasSlope = 1.75f;
       f.maps[0].extent[1] = 1;
     }},
};

TEST(Validate, WarnsByFieldAndValue) {
  for (const Warned& w : kWarned) {
    CompleteFrame f;
    EXPECT_EQ(f.problems(PELLUCID_SEVERITY_WARNING), "");
    w.change(f);
    EXPECT_EQ(f.problems(), "") << w.name;
    const std::string warnings = f.problems(PELLUCID_SEVERITY_WARNING);
    EXPECT_NE(warnings.find(w.sentence), std::string::npos) << w.name << ": " << warnings;
  }
}

TEST(Validate, WhatHalvesHoldIsNotWarnedOf) {
  CompleteFrame f;
  f.lights[0].color[0] = f.lights[0].color[1] = f.lights[0].color[2] = 0.5f;
  f.lights[0].intensity = 2 * 65504;
  EXPECT_EQ(f.problems(PELLUCID_SEVERITY_WARNING), "");
  f.lights[0].intensity *= 2;
  f.frame.preExposure = 0.5f;
  EXPECT_EQ(f.problems(PELLUCID_SEVERITY_WARNING), "");
}

// Tiles that meet, other layers and one map of two lights are no overlap.
TEST(Validate, TilesMayMeet) {
  const std::vector<std::function<void(PellucidShadowMap&)>> changes = {
      [](PellucidShadowMap& m) { m.options.offset[0] = 64; },
      [](PellucidShadowMap& m) { m.options.offset[1] = 64; },
      [](PellucidShadowMap& m) {
        m.options.layer = 1;
        m.options.offset[0] = 3;
      },
      [](PellucidShadowMap&) {}};
  for (const auto& change : changes) {
    CompleteFrame f;
    f.maps.push_back(f.maps[0]);
    change(f.maps[1]);
    f.use();
    EXPECT_EQ(f.problems(PELLUCID_SEVERITY_WARNING), "");
  }
}

TEST(Validate, OneTileIsNotDrawnByTwoMatrices) {
  CompleteFrame f;
  f.maps.push_back(f.maps[0]);
  f.maps[1].clipFromWorld[12] = 0.5f;
  f.use();
  EXPECT_NE(f.problems(PELLUCID_SEVERITY_WARNING).find("in the same image and layer"), std::string::npos);
}

TEST(Validate, LightIsNotAddedToTheIrradiance) {
  CompleteFrame f;
  f.frame.options.addToOutput = 1;
  f.frame.output.view = f.frame.irradiance.view;
  EXPECT_NE(f.problems().find("options.addToOutput is 1"), std::string::npos) << f.problems();
  f.frame.output.view = reinterpret_cast<VkImageView>(uintptr_t{2});
  EXPECT_EQ(f.problems(), "");
}

TEST(Validate, MoreBlocksThanADispatchHasGroupsAreRefused) {
  Frame f;
  for (PellucidImage& image : f.frame.transients) image = Frame::view();
  f.frame.imageExtent[0] = f.frame.imageExtent[1] = 16384;  // 258 blocks a side, with the border
  EXPECT_EQ(f.problems().find("options.renderRect touches 66564 blocks"), 0u) << f.problems();
  f.frame.options.renderRect[2] = 16384, f.frame.options.renderRect[3] = 8192;
  EXPECT_EQ(f.problems(), "");
}

TEST(Validate, NullIsAnError) {
  EXPECT_EQ(pellucidValidateFrame(nullptr, nullptr, nullptr), PELLUCID_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(pellucidBuildPlan(nullptr, nullptr, nullptr), PELLUCID_ERROR_INVALID_ARGUMENT);
  PellucidContext* context = nullptr;
  EXPECT_EQ(pellucidCreateContext(nullptr, &context), PELLUCID_ERROR_INVALID_ARGUMENT);
  pellucidDestroyContext(nullptr);
}

}  // namespace
