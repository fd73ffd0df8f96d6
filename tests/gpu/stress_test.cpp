// The stress: its frames, each of its checks against a fault that it must find, the files of failures, and a
// short run.
// No other test finds a check of the stress that sees no fault any more, or a failure that does not replay.
#include "stress/stress.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <limits>
#include <map>
#include <set>

#include "capture/material.h"
#include "capture/read.h"
#include "cli/settings.h"
#include "cli/stress.h"

namespace {

using namespace pellucid::harness;
using namespace pellucid::harness::stress;

const MaterialPool& pool() {
  static const MaterialPool shared;
  return shared;
}

FrameLimits small() { return {1024, 1024}; }

std::string bytesOf(const std::vector<float>& values) {
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(float)};
}

// Of the frame's settings, G-buffer and lights.
std::string contents(const StressFrame& f) {
  std::string all = settingsJson(f.settings) + debugOption(f.settings);
  for (const Image* image : {&f.capture.frontDepth.image, &f.capture.irradiance}) all += bytesOf(image->data);
  all.append(f.capture.material.begin(), f.capture.material.end());
  for (const Light& light : f.capture.lights) {
    all += std::to_string(light.intensity);
    for (const ShadowMap& map : light.shadowMaps) all += bytesOf(map.depth.image.data);
  }
  return all;
}

TEST(StressFrames, FollowFromSeedAndIndex) {
  std::set<std::string> different;
  for (std::uint64_t i = 0; i < 4; ++i) {
    const std::string first = contents(randomFrame(7, i, pool(), small()));
    EXPECT_EQ(first, contents(randomFrame(7, i, pool(), small()))) << i;
    different.insert(first);
    different.insert(contents(randomFrame(8, i, pool(), small())));
  }
  EXPECT_EQ(different.size(), 8u);
}

// What the module says to the frame; no device is needed.
std::string refusal(const StressFrame& f) {
  FrameData data;
  makeFrame(f.capture, f.materials, f.settings, data);
  std::string sentences;
  return pellucidValidateFrame(&data.frame, &appendError, &sentences) == PELLUCID_OK ? "" : sentences + " ";
}

// The view of a transient or history that the plan binds and the frame lacks; none: 0.
uint32_t unbound(const PellucidFrame& f, const PellucidPlan& plan) {
  for (uint32_t d = 0; d < plan.dispatchCount; ++d) {
    PellucidBinding bound[PELLUCID_MAX_BINDINGS];
    const uint32_t count = pellucidGetBindings(&plan, d, bound);
    for (uint32_t i = 0; i < count; ++i) {
      const uint32_t transient = bound[i].resource - PELLUCID_RESOURCE_TRANSIENT0;
      if (transient < PELLUCID_MAX_TRANSIENTS && !f.transients[transient].view) return bound[i].resource;
      if (bound[i].resource == PELLUCID_RESOURCE_HISTORY && !f.options.history.view) return bound[i].resource;
    }
  }
  return 0;
}

// The images of the whole image are all that any rect binds, and what a plan binds and a frame lacks, validation refuses.
TEST(StressFrames, BindNoViewThatValidationDoesNotAskFor) {
  for (std::uint64_t i = 0; i < 600; ++i) {
    StressFrame f = randomFrame(4, i, pool(), {4096, 256});
    if (i % 3 == 0) f.settings.reuse = PELLUCID_REUSE_ACCUMULATE;
    FrameData data;
    makeFrame(f.capture, f.materials, f.settings, data);
    PellucidFrame& frame = data.frame;
    if (pellucidValidateFrame(&frame, nullptr, nullptr) != PELLUCID_OK) continue;
    PellucidFrame whole = frame;
    std::fill_n(whole.options.renderRect, 4, 0u);
    PellucidImageNeed needs[kMaxImageNeeds];
    uint32_t count = kMaxImageNeeds;
    ASSERT_EQ(pellucidGetImageNeeds(&whole, &count, needs), PELLUCID_OK) << i;
    PellucidImageNeed ofRect[kMaxImageNeeds];
    uint32_t countOfRect = kMaxImageNeeds;
    ASSERT_EQ(pellucidGetImageNeeds(&frame, &countOfRect, ofRect), PELLUCID_OK) << i;
    EXPECT_TRUE(std::equal(needs, needs + count, ofRect, ofRect + countOfRect,
                           [](const PellucidImageNeed& a, const PellucidImageNeed& b) {
                             return a.format == b.format && std::equal(a.extent, a.extent + 2, b.extent) &&
                                    a.persistent == b.persistent;
                           }))
        << i << ": images serve every rect";
    const PellucidImage given = frame.frontDepth;
    std::fill_n(frame.transients, PELLUCID_MAX_TRANSIENTS, PellucidImage{});
    frame.options.history = {};
    for (uint32_t k = 0; k < count; ++k) (needs[k].persistent ? frame.options.history : frame.transients[k]) = given;
    PellucidPlan plan;
    ASSERT_EQ(pellucidBuildPlan(&frame, nullptr, &plan), PELLUCID_OK) << i;
    EXPECT_EQ(unbound(frame, plan), 0u) << i;
    EXPECT_EQ(pellucidValidateFrame(&frame, nullptr, nullptr), PELLUCID_OK) << i;
    for (uint32_t k = 0; k < PELLUCID_MAX_TRANSIENTS; ++k) {
      PellucidFrame lacking = frame;
      lacking.transients[k] = {};
      const bool refused = pellucidValidateFrame(&lacking, nullptr, nullptr) != PELLUCID_OK;
      EXPECT_TRUE(refused || unbound(lacking, plan) == 0) << i << ", transient " << k;
    }
  }
}

TEST(StressFrames, HoldEveryOptionAndAreAccepted) {
  std::map<std::string, int> seen;
  int refused = 0;
  constexpr int kFrames = 500;
  for (std::uint64_t i = 0; i < kFrames; ++i) {
    const StressFrame f = randomFrame(3, i, pool(), {256, 256});
    const std::string said = refusal(f);
    if (f.wild)
      refused += !said.empty();
    else
      EXPECT_EQ(said, "") << i;
    const ReplaySettings& s = f.settings;
    const auto see = [&](const char* what, auto value) {
      ++seen[what + std::to_string(static_cast<int>(value))];
    };
    see("eights of samples ", s.translucency.gatherSamples / 8);
    see("features ", s.features);
    see("debug ", s.debugView);
    see("angle ", s.translucency.angleModel);
    see("reuse ", s.reuse);
    see("alias ", s.aliasOutput);
    see("front ", f.capture.frontDepth.encoding);
    see("transmittance ", f.transmittance);
    see("half ", s.outputFormat == VK_FORMAT_R16G16B16A16_SFLOAT);
    see("perspective ", f.capture.clipFromView[11] != 0);
    see("left-handed ", f.capture.clipFromView[11] > 0);
    for (const Light& light : f.capture.lights) {
      see("light ", light.type);
      see("maps ", light.shadowMaps.size());
      for (const ShadowMap& map : light.shadowMaps) see("map ", map.depth.encoding);
    }
    bool bad = false;
    for (const float e : f.capture.irradiance.data) bad = bad || !std::isfinite(e);
    EXPECT_TRUE(!bad || f.wild) << i;
    see("bad irradiance ", bad);
  }
  // A twentieth at most, or wild frames would stress validation alone.
  EXPECT_LE(refused, kFrames / 40);
  const std::map<std::string, int> counts = {{"eights of samples ", 3},
                                             {"features ", 4},
                                             {"debug ", 5},
                                             {"angle ", 7},
                                             {"reuse ", 3},
                                             {"alias ", 2},
                                             {"front ", 2},
                                             {"transmittance ", 4},
                                             {"half ", 2},
                                             {"light ", 3},
                                             {"map ", 3},
                                             {"perspective ", 2},
                                             {"maps ", 2},
                                             {"left-handed ", 2},
                                             {"bad irradiance ", 2}};
  for (const auto& [what, count] : counts)
    for (int i = 0; i < count; ++i) EXPECT_GE(seen[what + std::to_string(i)], 2) << what << i;
}

// Renders, and damages what comes out.
class Damaging : public Renderer {
public:
  Damaging() : Renderer({"", true}) {}

  using Renderer::render;
  Image render(const StressFrame& frame, const FrameRun& run, std::uint64_t garbage) override {
    Image image = Renderer::render(frame, run, garbage);
    if (damage) damage(count, frame, image);
    ++count;
    return image;
  }

  std::function<void(int, const StressFrame&, Image&)> damage;
  int count = 0;  // of what was rendered before
};

class Stress : public testing::Test {
protected:
  static Damaging& renderer() {
    static Damaging shared;
    shared.damage = {};
    shared.count = 0;
    return shared;
  }
};

std::size_t firstWith(const Pixels& owned, bool is) {
  for (std::size_t i = 0; i < owned.size(); ++i)
    if ((owned[i] != 0) == is) return i;
  return owned.size();
}

// Adds to every pixel of every second output. Energies that compare two or three outputs cannot all agree
// with that.
void brighten(int count, const StressFrame&, Image& image) {
  if (count % 2 == 0) return;
  for (std::size_t i = 0; i < image.data.size(); ++i)
    if (i % 4 < 3) image.data[i] = 1.5f * image.data[i] + 0.5f;
}
void darken(int count, const StressFrame&, Image& image) {
  if (count % 2 == 0) return;
  for (std::size_t i = 0; i < image.data.size(); ++i)
    if (i % 4 < 3) image.data[i] *= 0.5f;
}

// Sets one channel of the first pixel that is owned, or is not.
auto set(std::size_t channel, float value, bool owned = true) {
  return [=](int, const StressFrame& frame, Image& image) {
    const std::size_t pixel = firstWith(ownedPixels(frame), owned);
    if (4 * pixel < image.data.size()) image.data[4 * pixel + channel] = value;
  };
}

float untouched() {
  const std::uint32_t bits = 0xFFFFFFFF;
  float value;
  std::memcpy(&value, &bits, sizeof value);
  return value;
}

using Damage = std::function<void(int, const StressFrame&, Image&)>;

// What each check must find.
std::vector<Damage> faultsFor(const std::string& check) {
  constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
  if (check == "finite") return {set(0, kNaN), set(2, std::numeric_limits<float>::infinity())};
  if (check == "not-negative") return {set(1, -1e-12f)};
  if (check == "outside") return {set(1, 0.25f, false)};
  if (check == "alpha") return {set(3, 2.0f)};
  if (check == "written")
    return {[](int, const StressFrame& frame, Image& image) {
      const std::size_t pixel = firstWith(ownedPixels(frame), true);
      for (std::size_t k = 0; k < 4 && 4 * pixel < image.data.size(); ++k)
        image.data[4 * pixel + k] = untouched();
    }};
  return {brighten, darken};
}

// On a frame that a check is asked of, some fault makes a violation.
TEST_F(Stress, EveryCheckFindsAFault) {
  std::set<std::string> missing;
  for (const Check& check : checks()) missing.insert(check.name);
  for (std::uint64_t i = 0; i < 400 && !missing.empty(); i += 2) {
    const StressFrame frame = randomFrame(11, i, pool(), {256, 256});
    if (firstWith(ownedPixels(frame), true) == ownedPixels(frame).size()) continue;
    Damaging& r = renderer();
    for (const Check& check : checks())
      for (const Damage& fault : faultsFor(check.name)) {
        if (missing.count(check.name) == 0) continue;
        r.count = 0;
        r.damage = fault;
        Subject damaged(r, frame);
        const std::optional<Worst> worst = check.run(damaged);
        if (worst && worst->value > check.tame) missing.erase(check.name);
      }
  }
  for (const std::string& check : missing) ADD_FAILURE() << check << " has no frame, or finds no fault";
}

TEST_F(Stress, FailuresReplayToTheSameBits) {
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / ("pellucid_stress_" + std::to_string(::getpid()));
  int compared = 0;
  for (std::uint64_t i = 0; compared < 2; ++i) {
    const StressFrame frame = randomFrame(5, i, pool(), small());
    if (!frame.notInCapture.empty() || !refusal(frame).empty()) continue;
    ++compared;
    const std::string command = writeFailure(folder, frame);
    EXPECT_NE(command.find(frame.capture.name + ".exr"), std::string::npos);
    StressFrame again = frame;
    again.capture = readCapture(folder / (frame.capture.name + ".exr"));
    SettingsOptions options;
    options.set = {"@" + (folder / (frame.capture.name + ".json")).string()};
    options.debug = debugOption(frame.settings);
    const ReplaySettings settings = options.parse();
    EXPECT_EQ(settingsJson(settings), [&] {
      ReplaySettings s = frame.settings;
      s.transmittance = frame.transmittance;
      return settingsJson(s);
    }());
    again.settings = settings;
    again.materials = compileMaterials(again.capture);
    // A material that the capture describes is compiled to the same bits.
    Damaging& r = renderer();
    EXPECT_EQ(differentBits(r.render(frame), r.render(again), ownedPixels(frame)).value, 0) << i;
  }
  std::filesystem::remove_all(folder);
}

TEST_F(Stress, ShortRunHolds) {
  StressOptions options;
  options.seed = 40;
  options.frames = 4;
  options.limits = small();
  options.validate = true;
  StressEvents events;
  events.violated = [](const StressFrame& frame, const std::vector<Violation>& violations) {
    for (const Violation& v : violations)
      ADD_FAILURE() << (frame.wild ? "wild" : "tame") << " frame " << frame.index << ": " << v.check << " "
                    << v.worst.value << " at " << v.worst.x << ", " << v.worst.y << ", " << v.worst.channel
                    << " " << v.sentence;
  };
  const StressResult result = runStress(renderer(), options, events);
  EXPECT_EQ(result.frames, 4u);
  EXPECT_EQ(result.checks.size(), checks().size() + 2);
  EXPECT_EQ(result.checks[1].tame.done, 2u);
}

}  // namespace
