// Every key of `--set`: what a good value does to a picture, and how a bad one is refused.
#include "cli/settings.h"

#include <map>
#include <ostream>
#include <sstream>
#include <vector>

#include "capture/material.h"
#include "common/compare.h"
#include "common/error.h"
#include "gpu/gpu_fixture.h"
#include "scene/environment.h"
#include "scene/scene.h"

namespace {

using namespace pellucid::test;

enum class Effect {
  Changes,
  Keeps  // up to the rounding of half floats in three passes, relative to the mean of a dark picture
};

// A value that the key's own type refuses or, where a field is named, what the module knows of the frame.
struct Bad {
  const char* value;
  const char* field = nullptr;
};

using Assignments = std::vector<std::string>;  // key=value

struct Row {
  const char* key;
  Assignments base;  // without which the key has no say
  const char* good;
  Effect effect;
  std::vector<Bad> bad;
};

// GoogleTest would print the bytes.
void PrintTo(const Row& row, std::ostream* out) { *out << row.key; }

const Assignments kAzimuth = {"angle=minimum-dot-azimuth", "minimum-dots=-.1,-.6,-.3"};

const std::vector<Row> kRows = {
    {"ambient", {}, "1", Effect::Changes, {{"2"}}},
    {"alias", {}, "1", Effect::Keeps, {{"2"}}},
    {"anchor", {}, "1,2,5,1", Effect::Changes, {{"1,2,5,2", "anchor"}, {"1,2,5"}}},
    {"angle", {}, "cosine", Effect::Changes, {{"acos"}}},
    {"center", kAzimuth, "300,10,5", Effect::Changes, {{"1,2"}, {"1,2,1e39"}}},
    {"chord", {"thickness=camera"}, "1", Effect::Changes, {{"yes"}}},
    {"coherence-threshold",
     {"reuse=coherence"},
     "0.1",
     Effect::Keeps,
     {{"-0.1", "coherenceThreshold"}, {"x"}}},
    {"face", kAzimuth, "1,0,0.3", Effect::Changes, {{"0,2,0", "faceVector"}, {"1,0"}}},
    {"features", {}, "diffusion", Effect::Changes, {{"gather"}}},
    {"filter", {}, ".55,.29,.28", Effect::Changes, {{"1,2,1", "transmittanceFilter"}, {"1,nan,1"}, {"1"}}},
    {"format", {}, "rgba32f", Effect::Keeps, {{"rgba8"}}},
    {"gather", {}, "0", Effect::Changes, {{"7", "gatherSamples"}, {"68", "gatherSamples"}, {"-4"}}},
    {"gather-spacing", {"gather=8"}, "4", Effect::Changes, {{"3"}}},
    {"indirect", {"gather=8"}, "none", Effect::Keeps, {{"2"}}},
    {"mark-bit", {"gather=0"}, "128", Effect::Keeps, {{"3", "materialMarkBit"}, {"1.5"}}},
    {"max-thickness", {}, "1", Effect::Changes, {{"-1", "maximumThickness"}, {"1mm"}}},
    {"minimum-dot",
     {"angle=minimum-dot"},
     "-0.5",
     Effect::Changes,
     {{"0.5", "minimumDot"}, {"-1.5", "minimumDot"}, {""}}},
    {"minimum-dots",
     kAzimuth,
     "-.9,-.9,-.9,-.9",
     Effect::Changes,
     {{"-.5,.5", "minimumDotTable"}, {"-.5,,0"}}},
    {"polynomial",
     {"angle=polynomial"},
     "-.5,.3,0,0",
     Effect::Changes,
     {{"1,2,3"}, {"1,2,3,x"}, {"quartic"}}},
    {"prescale", {"angle=inverse-cosine", "minimum-dot=-.3"}, "1", Effect::Changes, {{"-.3"}}},
    {"rect", {}, "4,4,8,8", Effect::Changes, {{"20,0,8,8", "renderRect"}, {"1,2,3"}, {"0,0,a,1"}}},
    {"reuse", {}, "alternate", Effect::Keeps, {{"both"}}},
    {"thickness", {}, "camera", Effect::Changes, {{"both"}}},
    {"transmittance", {}, "linear", Effect::Changes, {{"burley"}}},
    {"up", kAzimuth, "1,1,0", Effect::Changes, {{"0,0,0", "upAxis"}, {"0,1"}}},
    {"view", {"angle=cosine"}, "constant", Effect::Changes, {{"eye"}}},
};

class Settings : public GpuTest, public testing::WithParamInterface<Row> {
protected:
  Settings() {
    capture_ = makeScene(
        {.name = "ear", .width = 24, .height = 24, .lightType = PELLUCID_LIGHT_POINT, .shadowSize = 32});
    capture_.environment = Environment{{0.1, 0.1, 0.1}, {0.1, 0.1, 0.1}}.harmonics();
  }

  // As `pellucid replay` does.
  Image replay(Assignments set, const std::string& assignment = "") const {
    if (!assignment.empty()) set.push_back(assignment);
    SettingsOptions options;
    options.set = std::move(set);
    const ReplaySettings settings = options.parse();
    const std::vector<PellucidMaterial> materials = compileMaterials(capture_);
    return rgb(replayer().run(capture_, materials, settings).output);
  }

  std::string refusal(bool ofFrame, const Assignments& base, const std::string& assignment) const {
    try {
      replay(base, assignment);
    } catch (const UsageError& error) {
      EXPECT_FALSE(ofFrame) << error.what();
      return error.what();
    } catch (const InputError& error) {
      EXPECT_TRUE(ofFrame) << error.what();
      return error.what();
    }
    return "nothing";
  }

  Capture capture_;
};

TEST_P(Settings, GoodAndBadValues) {
  const Row& row = GetParam();
  const std::string key = std::string(row.key) + "=";
  static std::map<Assignments, Image> bases;
  if (bases.count(row.base) == 0) bases[row.base] = replay(row.base);
  double worst = 0;
  for (const ChannelDifference& channel :
       compareImages(replay(row.base, key + row.good), bases[row.base], {}).channels)
    worst = std::max(worst, channel.max);
  if (row.effect == Effect::Keeps)
    EXPECT_LE(worst, 1e-2);
  else
    EXPECT_GT(worst, 0);
  for (const Bad& bad : row.bad) {
    const std::string said = refusal(bad.field != nullptr, row.base, key + bad.value);
    // The sentence names the field, or the key and its part that is wrong.
    const std::string named = bad.field ? bad.field : std::string("--set ") + row.key + ": \"";
    EXPECT_NE(said.find(named), std::string::npos) << key << bad.value << ": " << said;
  }
}

INSTANTIATE_TEST_SUITE_P(Keys, Settings, testing::ValuesIn(kRows), [](const auto& test) {
  std::string name;
  for (const char c : std::string(test.param.key))
    if (c != '-') name += c;
  return name;
});

// The list of keys that is said when one is not in it.
TEST_F(Settings, EveryOneHasARow) {
  const std::string text = refusal(false, {}, "nothing=1"), there = "there are ";
  const size_t list = text.find(there);
  ASSERT_NE(list, std::string::npos) << text;
  std::istringstream keys(text.substr(list + there.size()));
  std::map<std::string, int> rows;
  for (const Row& row : kRows) ++rows[row.key];
  size_t count = 0;
  for (std::string key; keys >> key; ++count) {
    if (key.back() == ',') key.pop_back();
    EXPECT_EQ(rows[key], 1) << key << " needs one row in kRows";
  }
  EXPECT_EQ(count, kRows.size());
}

}  // namespace
