// Every key of `--set`: what a good value does to a picture, and how a bad one is refused.
#include <map>
#include <ostream>
#include <sstream>
#include <vector>

#include "cli_fixture.h"

namespace {

using namespace pellucid::test;

enum class Effect {
  Changes,
  Keeps  // up to the rounding of half floats in three passes, relative to the mean of a dark picture
};

struct Bad {
  const char* value;
  int code;          // 2: refused as it is; 3: by what the module knows of the frame
  const char* says;  // names the key or its field, the value and the reason
};

struct Row {
  const char* key;
  const char* base;  // settings without which the key has no say
  const char* good;
  Effect effect;
  std::vector<Bad> bad;
};

// GoogleTest would print the bytes.
void PrintTo(const Row& row, std::ostream* out) { *out << row.key; }

const char* const kAzimuth = "--set angle=minimum-dot-azimuth --set minimum-dots=-.1,-.6,-.3 ";

const std::vector<Row> kRows = {
    {"alias", "", "1", Effect::Keeps, {{"2", 2, "--set alias: \"2\" is not one of 0, 1"}}},
    {"angle", "", "cosine", Effect::Changes, {{"acos", 2, "--set angle: \"acos\" is not one of cosine, "}}},
    {"center",
     kAzimuth,
     "300,10,5",
     Effect::Changes,
     {{"1,2", 2, "--set center: \"1,2\" is not 3 numbers"},
      {"1,2,1e39", 2, "--set center: \"1e39\" is not a number"}}},
    {"chord",
     "--set thickness=camera",
     "1",
     Effect::Changes,
     {{"yes", 2, "chord: \"yes\" is not one of 0, 1"}}},
    {"coherence-threshold",
     "--set reuse=coherence",
     "0.1",
     Effect::Keeps,
     {{"-0.1", 3, "coherenceThreshold is -0.1, outside [0, 2]"},
      {"x", 2, "--set coherence-threshold: \"x\" is not a number"}}},
    {"face",
     kAzimuth,
     "1,0,0.3",
     Effect::Changes,
     {{"0,2,0", 3,
       "faceVector is 0, 2, 0 and upAxis 0, 1, 0; must be finite, longer than 0 and not parallel"},
      {"1,0", 2, "--set face: \"1,0\" is not 3 numbers"}}},
    {"features",
     "",
     "diffusion",
     Effect::Changes,
     {{"gather", 2, "--set features: \"gather\" is not one of diffusion, none, translucency"}}},
    {"filter",
     "",
     ".55,.29,.28",
     Effect::Changes,
     {{"1,2,1", 3, "transmittanceFilter [1] is 2, outside [0, 1]"},
      {"1,nan,1", 2, "--set filter: \"nan\" is not a number"},
      {"1", 2, "--set filter: \"1\" is not 3 numbers"}}},
    {"format",
     "",
     "rgba32f",
     Effect::Keeps,
     {{"rgba8", 2, "format: \"rgba8\" is not one of rg11b10f, rgba16f, rgba32f"}}},
    {"frame-load",
     "--set reuse=coherence",
     "2",
     Effect::Keeps,
     {{"-2", 3, "frameLoad is -2, outside [0, "}, {"inf", 2, "--set frame-load: \"inf\" is not a number"}}},
    {"gather",
     "",
     "0",
     Effect::Changes,
     {{"7", 3, "gatherSamples is 7; needs a multiple of 4, at most 64"},
      {"68", 3, "gatherSamples is 68; needs a multiple of 4, at most 64"},
      {"-4", 2, "--set gather: \"-4\" is not a whole number"}}},
    {"gather-spacing",
     "--set gather=8",
     "4",
     Effect::Changes,
     {{"3", 3, "gatherSpacing is 3; use 1, 2 or 4, or 0 to choose by the image's size"},
      {"-2", 2, "--set gather-spacing: \"-2\" is not a whole number"}}},
    {"indirect",
     "--set gather=8",
     "0",
     Effect::Keeps,
     {{"2", 2, "--set indirect: \"2\" is not one of 0, 1"}}},
    {"mark-bit",
     "",
     "128",
     Effect::Keeps,
     {{"3", 3, "materialMarkBit is 3; must be 0 or a power of two above the 1 materials"},
      {"1.5", 2, "--set mark-bit: \"1.5\" is not a whole number"}}},
    {"max-thickness",
     "",
     "1",
     Effect::Changes,
     {{"-1", 3, "maximumThickness is -1, outside [0, "},
      {"1mm", 2, "--set max-thickness: \"1mm\" is not a number"}}},
    {"minimum-dot",
     "--set angle=minimum-dot",
     "-0.5",
     Effect::Changes,
     {{"0.5", 3, "minimumDot is 0.5, outside [-1, 0]"},
      {"-1.5", 3, "minimumDot is -1.5, outside [-1, 0]"},
      {"", 2, "--set minimum-dot: \"\" is not a number"}}},
    {"minimum-dots",
     kAzimuth,
     "-.9,-.9,-.9,-.9",
     Effect::Changes,
     {{"-.5,.5", 3, "minimumDotTable [1] is 0.5, outside [-1, 0]"},
      {"-.5,,0", 2, "--set minimum-dots: \"\" is not a number"}}},
    {"nearest-distance",
     "",
     "10",
     Effect::Keeps,
     {{"-1", 3, "nearestDistance is -1, outside [0, "},
      {"10000", 3, "nearest-distance: is 10000, but at pixel "},
      {"nan", 2, "--set nearest-distance: \"nan\" is not a number"}}},
    {"polynomial",
     "--set angle=polynomial",
     "0,0,1,0",
     Effect::Changes,
     {{"1,2,3", 2, "--set polynomial: \"1,2,3\" is not 4 numbers"},
      {"1,2,3,x", 2, "--set polynomial: \"x\" is not a number"},
      {"quartic", 2, "--set polynomial: \"quartic\" is not one of cubic, quadratic"}}},
    {"prescale",
     "--set angle=inverse-cosine --set minimum-dot=-.3",
     "1",
     Effect::Changes,
     {{"-.3", 2, "--set prescale: \"-.3\" is not one of 0, 1"}}},
    {"quality",
     "",
     "0",
     Effect::Changes,
     {{"3", 3, "quality is 3, outside 0..2"}, {"best", 2, "--set quality: \"best\" is not a whole number"}}},
    {"rect",
     "",
     "4,4,8,8",
     Effect::Changes,
     {{"20,0,8,8", 3, "renderRect is 20, 0 + 8 x 8, outside the 24 x 24 image"},
      {"1,2,3", 2, "--set rect: \"1,2,3\" is not x,y,width,height"},
      {"0,0,a,1", 2, "--set rect: \"a\" is not a whole number"}}},
    {"reuse",
     "",
     "alternate",
     Effect::Keeps,
     {{"both", 2, "--set reuse: \"both\" is not one of alternate, coherence, none"}}},
    {"target-error",
     "",
     "0.5",
     Effect::Changes,
     {{"-0.1", 3, "targetError is -0.1, outside [0, "},
      {"inf", 2, "--set target-error: \"inf\" is not a number"}}},
    {"thickness",
     "",
     "camera",
     Effect::Changes,
     {{"both", 2, "thickness: \"both\" is not one of camera, light"}}},
    {"transmittance",
     "",
     "linear",
     Effect::Changes,
     {{"burley", 2,
       "transmittance: \"burley\" is not one of gaussians, gaussians-as-printed, linear, material"}}},
    {"up",
     kAzimuth,
     "1,1,0",
     Effect::Changes,
     {{"0,0,0", 3, "and upAxis 0, 0, 0; must be finite, longer than 0"},
      {"0,1", 2, "--set up: \"0,1\" is not 3 numbers"}}},
    {"view",
     "--set angle=cosine",
     "constant",
     Effect::Changes,
     {{"eye", 2, "--set view: \"eye\" is not one of constant, pixel"}}},
};

class Settings : public Cli, public testing::WithParamInterface<Row> {
protected:
  void SetUp() override {
    Cli::SetUp();
    expect(0, "capture --procedural ear --size 24x24 --shadow-size 32 --light point -o " + path("ear.exr"),
           "");
  }
  std::string replay(const std::string& settings) const {
    return "replay " + path("ear.exr") + " -o " + path("out.exr") + " " + settings;
  }
};

TEST_P(Settings, GoodAndBadValues) {
  const Row& row = GetParam();
  const std::string base = std::string(row.base) + " ", key = std::string("--set ") + row.key + "=";
  expect(0, replay(base), "wrote");
  std::filesystem::rename(path("out.exr"), path("base.exr"));
  expect(0, replay(base + key + row.good), "wrote");
  const bool keeps = row.effect == Effect::Keeps;
  expect(keeps ? 0 : 1,
         "compare " + path("out.exr") + " " + path("base.exr") + " --limit max=" + (keeps ? "1e-2" : "0"),
         "max");
  for (const Bad& bad : row.bad) expect(bad.code, replay(base + key + bad.value), bad.says);
}

INSTANTIATE_TEST_SUITE_P(Keys, Settings, testing::ValuesIn(kRows), [](const auto& test) {
  std::string name;
  for (const char c : std::string(test.param.key))
    if (c != '-') name += c;
  return name;
});

// The command's own list of keys, which it prints when one is not in it.
TEST_F(Cli, EverySettingHasARow) {
  const std::string text = run("replay x.exr --set nothing=1").text, there = "there are ";
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
