// Each float and integer of the frame's structs in turn at NaN, infinity and other extremes: validation names
// the field, or the field's domain says why the value is allowed.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <fstream>
#include <functional>
#include <limits>
#include <regex>
#include <set>
#include <sstream>

#include "domains.h"
#include "frame_fixture.h"

namespace {

using namespace pellucid;
using pellucid::test::Frame;

// Lacks nothing.
struct Whole : Frame {
  Whole() {
    for (PellucidImage& image : frame.transients) image = view();
  }
};

// Frames that together read every field.
const std::vector<std::function<void(Frame&)>> kFrames = {
    [](Frame&) {},
    [](Frame& f) {
      static const float table[9] = {};
      f.thesis.angleModel = PELLUCID_ANGLE_MINIMUM_DOT_SPHERE;
      f.thesis.minimumDotTableSize = 3;
      f.thesis.minimumDotTable = table;
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
      for (int i = 0; i < 4; ++i) map.viewFromWorld[5 * i] = 1;
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

// The struct of a frame that the tables of `Struct` are about, and what its fields are called by.
template <class Struct>
Struct& objectOf(Frame& f);
template <>
PellucidFrame& objectOf(Frame& f) {
  return f.frame;
}
template <>
PellucidThesisOptions& objectOf(Frame& f) {
  return f.thesis;
}
template <>
PellucidMaterial& objectOf(Frame& f) {
  return f.material;
}
template <>
PellucidLight& objectOf(Frame& f) {
  return f.lights[0];
}
template <>
PellucidShadowMap& objectOf(Frame& f) {
  return f.maps[0];
}

template <class Struct>
const char* prefix() {
  if constexpr (std::is_same_v<Struct, PellucidThesisOptions>) return "thesis.";
  if constexpr (std::is_same_v<Struct, PellucidMaterial>) return "materials[0].";
  if constexpr (std::is_same_v<Struct, PellucidLight>) return "lights[0].";
  if constexpr (std::is_same_v<Struct, PellucidShadowMap>) return "shadowMaps[0].";
  return "";
}

template <class Value>
void set(void* object, size_t offset, uint32_t index, Value value) {
  std::memcpy(static_cast<char*>(object) + offset + index * sizeof value, &value, sizeof value);
}

template <class Struct>
class Domains : public testing::Test {};

using Structs =
    testing::Types<PellucidFrame, PellucidThesisOptions, PellucidMaterial, PellucidLight, PellucidShadowMap>;
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
          auto& object = objectOf<TypeParam>(f);
          set(&object, d.offset, i, value);
          const std::string problems = f.problems();
          if (!isRead(d, &object, i)) {
            EXPECT_EQ(problems, "") << d.field << "[" << i << "] = " << value << " is not read";
            continue;
          }
          read.insert(d.field);
          if (contains(d, value)) continue;  // whether it fits the others is other tests' matter
          EXPECT_NE(problems.find(std::string(prefix<TypeParam>()) + d.field), std::string::npos)
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
        set(&objectOf<TypeParam>(f), d.offset, i, value);
        const std::string problems = f.problems(), field = std::string(prefix<TypeParam>()) + d.field;
        EXPECT_EQ(problems.find(field), 0u) << problems;
        EXPECT_NE(problems.find("is " + std::to_string(value)), std::string::npos) << problems;
      }
}

// Names of the float fields that the header declares in a struct.
std::set<std::string> declaredFloats(const std::string& name) {
  const char* const header = name == "PellucidThesisOptions" ? "pellucid_thesis.h" : "pellucid.h";
  std::ifstream file(std::string(PELLUCID_SOURCE_DIR) + "/module/include/pellucid/" + header);
  std::stringstream text;
  text << file.rdbuf();
  const std::string declarations = std::regex_replace(text.str(), std::regex(R"(/\*[\s\S]*?\*/)"), "");
  const size_t first = declarations.find("struct " + name + " {"), last = declarations.find("}", first);
  std::set<std::string> fields;
  const std::string body = declarations.substr(first, last - first);
  const std::regex declaration(R"(\bfloat ([^*;]+);)"), field(R"((\w+)(\[\w+\])*)");
  for (std::sregex_iterator d(body.begin(), body.end(), declaration), end; d != end; ++d) {
    std::stringstream list((*d)[1].str());
    for (std::string one; std::getline(list, one, ',');) {
      std::smatch match;
      if (std::regex_search(one, match, field)) fields.insert(match[1].str());
    }
  }
  return fields;
}

TYPED_TEST(Domains, TheTableHasEveryFloatOfTheHeader) {
  const char* name = std::is_same_v<TypeParam, PellucidFrame>           ? "PellucidFrame"
                     : std::is_same_v<TypeParam, PellucidThesisOptions> ? "PellucidThesisOptions"
                     : std::is_same_v<TypeParam, PellucidMaterial>      ? "PellucidMaterial"
                     : std::is_same_v<TypeParam, PellucidLight>         ? "PellucidLight"
                                                                        : "PellucidShadowMap";
  std::set<std::string> table;
  for (const FloatDomain& d : domainsOf<TypeParam>().floats) table.insert(d.field);
  EXPECT_EQ(table, declaredFloats(name));
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

TEST(Domains, ClipMatricesWithoutPixelSizeAreRefused) {
  for (const float scale : {1e30f, 1e-30f, 1e14f, 1e-13f}) {
    Whole f;
    f.frame.clipFromView[0] = scale;
    f.frame.clipFromView[5] = -scale;
    EXPECT_NE(f.problems().find("clipFromView"), std::string::npos) << scale;
  }
}

}  // namespace
