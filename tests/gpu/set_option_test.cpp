// Every key of `--set`: what a good value does to a picture, and how a bad one is refused.
#include "cli/settings.h"

#include <map>
#include <ostream>
#include <sstream>
#include <vector>

#include "capture/material.h"
#include "cli/capture_checks.h"
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

enum class By {
  Key,
  Frame
};  // who refuses a value: the key's own type, or what the module knows of the frame

struct Bad {
  const char* value;
  By by;
  const char* says;  // names the key or its field, the value and the reason
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
    {"ambient", {}, "1", Effect::Changes, {{"2", By::Key, "--set ambient: \"2\" is not one of 0, 1, auto"}}},
    {"alias", {}, "1", Effect::Keeps, {{"2", By::Key, "--set alias: \"2\" is not one of 0, 1"}}},
    {"anchor",
     {},
     "1,2,5,1",
     Effect::Changes,
     {{"1,2,5,2", By::Frame, "options.anchor has w 2"},
      {"1,2,5", By::Key, "--set anchor: \"1,2,5\" is not 4 numbers"}}},
    {"angle",
     {},
     "cosine",
     Effect::Changes,
     {{"acos", By::Key, "--set angle: \"acos\" is not one of cosine, "}}},
    {"center",
     kAzimuth,
     "300,10,5",
     Effect::Changes,
     {{"1,2", By::Key, "--set center: \"1,2\" is not 3 numbers"},
      {"1,2,1e39", By::Key, "--set center: \"1e39\" is not a number"}}},
    {"chord",
     {"thickness=camera"},
     "1",
     Effect::Changes,
     {{"yes", By::Key, "chord: \"yes\" is not one of 0, 1"}}},
    {"coherence-threshold",
     {"reuse=coherence"},
     "0.1",
     Effect::Keeps,
     {{"-0.1", By::Frame, "coherenceThreshold is -0.1, outside [0, 2]"},
      {"x", By::Key, "--set coherence-threshold: \"x\" is not a number"}}},
    {"face",
     kAzimuth,
     "1,0,0.3",
     Effect::Changes,
     {{"0,2,0", By::Frame,
       "faceVector is 0, 2, 0 and upAxis 0, 1, 0; must be finite, longer than 0 and not parallel"},
      {"1,0", By::Key, "--set face: \"1,0\" is not 3 numbers"}}},
    {"features",
     {},
     "diffusion",
     Effect::Changes,
     {{"gather", By::Key, "--set features: \"gather\" is not one of diffusion, none, translucency"}}},
    {"filter",
     {},
     ".55,.29,.28",
     Effect::Changes,
     {{"1,2,1", By::Frame, "transmittanceFilter [1] is 2, outside [0, 1]"},
      {"1,nan,1", By::Key, "--set filter: \"nan\" is not a number"},
      {"1", By::Key, "--set filter: \"1\" is not 3 numbers"}}},
    {"format",
     {},
     "rgba32f",
     Effect::Keeps,
     {{"rgba8", By::Key, "format: \"rgba8\" is not one of rg11b10f, rgba16f, rgba32f"}}},
    {"gather",
     {},
     "0",
     Effect::Changes,
     {{"7", By::Frame, "gatherSamples is 7; needs a multiple of 4, at most 64"},
      {"68", By::Frame, "gatherSamples is 68; needs a multiple of 4, at most 64"},
      {"-4", By::Key, "--set gather: \"-4\" is not a whole number"}}},
    {"gather-spacing",
     {"gather=8"},
     "4",
     Effect::Changes,
     {{"3", By::Key, "--set gather-spacing: \"3\" is not one of 0, 1, 2, 4"}}},
    {"indirect",
     {"gather=8"},
     "none",
     Effect::Keeps,
     {{"2", By::Key, "--set indirect: \"2\" is not one of material, none"}}},
    {"mark-bit",
     {"gather=0"},
     "128",
     Effect::Keeps,
     {{"3", By::Frame, "materialMarkBit is 3; must be 0 or a power of two above the 1 materials"},
      {"1.5", By::Key, "--set mark-bit: \"1.5\" is not a whole number"}}},
    {"max-thickness",
     {},
     "1",
     Effect::Changes,
     {{"-1", By::Frame, "maximumThickness is -1, outside [0, "},
      {"1mm", By::Key, "--set max-thickness: \"1mm\" is not a number"}}},
    {"minimum-dot",
     {"angle=minimum-dot"},
     "-0.5",
     Effect::Changes,
     {{"0.5", By::Frame, "minimumDot is 0.5, outside [-1, 0]"},
      {"-1.5", By::Frame, "minimumDot is -1.5, outside [-1, 0]"},
      {"", By::Key, "--set minimum-dot: \"\" is not a number"}}},
    {"minimum-dots",
     kAzimuth,
     "-.9,-.9,-.9,-.9",
     Effect::Changes,
     {{"-.5,.5", By::Frame, "minimumDotTable [1] is 0.5, outside [-1, 0]"},
      {"-.5,,0", By::Key, "--set minimum-dots: \"\" is not a number"}}},
    {"nearest-distance",
     {},
     "10",
     Effect::Keeps,
     {{"-1", By::Frame, "nearestDistance is -1, outside [0, "},
      {"10000", By::Frame, "nearest-distance: is 10000, but at pixel "},
      {"nan", By::Key, "--set nearest-distance: \"nan\" is not a number"}}},
    {"polynomial",
     {"angle=polynomial"},
     "-.5,.3,0,0",
     Effect::Changes,
     {{"1,2,3", By::Key, "--set polynomial: \"1,2,3\" is not 4 numbers"},
      {"1,2,3,x", By::Key, "--set polynomial: \"x\" is not a number"},
      {"quartic", By::Key, "--set polynomial: \"quartic\" is not one of cubic, quadratic"}}},
    {"prescale",
     {"angle=inverse-cosine", "minimum-dot=-.3"},
     "1",
     Effect::Changes,
     {{"-.3", By::Key, "--set prescale: \"-.3\" is not one of 0, 1"}}},
    {"rect",
     {},
     "4,4,8,8",
     Effect::Changes,
     {{"20,0,8,8", By::Frame, "renderRect is 20, 0 + 8 x 8, outside the 24 x 24 image"},
      {"1,2,3", By::Key, "--set rect: \"1,2,3\" is not 4 numbers"},
      {"0,0,a,1", By::Key, "--set rect: \"a\" is not a whole number"}}},
    {"reuse",
     {},
     "alternate",
     Effect::Keeps,
     {{"both", By::Key, "--set reuse: \"both\" is not one of accumulate, alternate, coherence, none"}}},
    {"thickness",
     {},
     "camera",
     Effect::Changes,
     {{"both", By::Key, "thickness: \"both\" is not one of camera, light"}}},
    {"transmittance",
     {},
     "linear",
     Effect::Changes,
     {{"burley", By::Key,
       "transmittance: \"burley\" is not one of gaussians, gaussians-as-printed, linear, material"}}},
    {"up",
     kAzimuth,
     "1,1,0",
     Effect::Changes,
     {{"0,0,0", By::Frame, "and upAxis 0, 0, 0; must be finite, longer than 0"},
      {"0,1", By::Key, "--set up: \"0,1\" is not 3 numbers"}}},
    {"view",
     {"angle=cosine"},
     "constant",
     Effect::Changes,
     {{"eye", By::Key, "--set view: \"eye\" is not one of constant, pixel"}}},
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
    requireNearestDistance(capture_, materials, settings);
    return rgb(replayer().run(capture_, materials, settings).output);
  }

  std::string refusal(By by, const Assignments& base, const std::string& assignment) const {
    try {
      replay(base, assignment);
    } catch (const UsageError& error) {
      EXPECT_EQ(by, By::Key) << error.what();
      return error.what();
    } catch (const InputError& error) {
      EXPECT_EQ(by, By::Frame) << error.what();
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
    const std::string said = refusal(bad.by, row.base, key + bad.value);
    EXPECT_NE(said.find(bad.says), std::string::npos) << key << bad.value << ": " << said;
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
  const std::string text = refusal(By::Key, {}, "nothing=1"), there = "there are ";
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
