// Several views in one recording have the bits that they have alone.
#include <array>

#include "gpu_fixture.h"
#include "pellucid/pellucid_views.h"
#include "scene/scene.h"

namespace pellucid::test {
namespace {

// Two eyes on a head.
const Capture& eye(size_t index) {
  static const std::array<Capture, 2> made = [] {
    std::array<Capture, 2> eyes;
    for (size_t i = 0; i < 2; ++i) {
      SceneParameters p{.name = "head", .width = 96, .height = 80, .shadowSize = 128};
      p.turn.camera = i == 0 ? -0.05 : 0.05;  // radians
      eyes[i] = makeScene(p);
    }
    return eyes;
  }();
  return made[index];
}

std::vector<PellucidMaterial> materials(const Capture& c) {
  return std::vector<PellucidMaterial>(c.materials.size(), skin());
}

ReplaySettings gathered() {
  ReplaySettings s;
  s.translucency.gatherSamples = 8;
  return s;
}

class ViewsTest : public GpuTest {
protected:
  static std::unique_ptr<FrameRun> make(const Capture& c, const ReplaySettings& s,
                                        const FrameRun* previous = nullptr) {
    return std::make_unique<FrameRun>(device(), replayer().contextFor(c), c, materials(c), s, previous);
  }
  static void recordTogether(const std::vector<const FrameRun*>& runs) {
    device().run([&](VkCommandBuffer commands) { FrameRun::recordTogether(commands, runs); });
  }
  // As an engine records its views: from frames with all images, with slices of one buffer.
  static void recordFrames(const Context& context, const std::vector<const PellucidFrame*>& frames) {
    std::vector<PellucidPlan> plans(frames.size());
    VkDeviceSize sliceBytes = 0;
    for (size_t i = 0; i < frames.size(); ++i) {
      ASSERT_EQ(pellucidBuildPlan(frames[i], nullptr, &plans[i]), PELLUCID_OK);
      sliceBytes = std::max(sliceBytes, (plans[i].constantsSize + 255) / 256 * 256);
    }
    const HostBuffer constants(device(), frames.size() * sliceBytes,
                               VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT | VK_BUFFER_USAGE_STORAGE_BUFFER_BIT |
                                   VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT);
    std::vector<PellucidConstantsSlice> slices(frames.size());
    std::vector<PellucidView> views;
    for (size_t i = 0; i < frames.size(); ++i) {
      const VkDeviceSize offset = i * sliceBytes;
      slices[i] = {constants.handle(), offset, sliceBytes, static_cast<char*>(constants.mapped()) + offset};
      ASSERT_EQ(
          pellucidWriteConstants(&plans[i], frames[i], slices[i].mapped, static_cast<size_t>(sliceBytes)),
          PELLUCID_OK);
      views.push_back({&plans[i], frames[i], &slices[i]});
    }
    device().run([&](VkCommandBuffer commands) {
      ASSERT_EQ(
          pellucidRecordViews(context.handle(), commands, static_cast<uint32_t>(views.size()), views.data()),
          PELLUCID_OK)
          << context.message();
    });
  }
};

const Capture& left() { return eye(0); }
const Capture& right() { return eye(1); }
// A capture of another size, without albedo.
const Capture& slab() {
  static const Capture made = [] {
    Capture c = flatCapture(24, 16);
    c.lights = {backLight()};
    return c;
  }();
  return made;
}

struct Kind {
  const char* name;
  const Capture& (*capture)();
  void (*change)(ReplaySettings&);
  bool reuses = false, isEmpty = false;
};

constexpr Kind kKinds[] = {
    {"whole", left, [](ReplaySettings&) {}},
    {"no gather", right, [](ReplaySettings& s) { s.translucency.gatherSamples = 0; }},
    {"rect in place, no lists", right,
     [](ReplaySettings& s) {
       s.aliasOutput = true;
       s.renderRect = {13, 9, 50, 61};
       s.indirectDispatches = 0;
     }},
    {"reuse", left, [](ReplaySettings& s) { s.reuse = PELLUCID_REUSE_ALTERNATE; }, true},
    {"nothing to do", slab, [](ReplaySettings& s) { s.features = 0, s.aliasOutput = true; }, false, true}};

// All kinds in one recording, and then their second frames, of which those that reuse take the light of the
// first.
TEST_F(ViewsTest, MixturesHaveTheSameBitsTogether) {
  using Runs = std::vector<std::unique_ptr<FrameRun>>;
  const auto makeAll = [&](const Runs& previous) {
    Runs runs;
    for (const Kind& kind : kKinds) {
      ReplaySettings s = gathered();
      kind.change(s);
      runs.push_back(make(kind.capture(), s, previous.empty() ? nullptr : previous[runs.size()].get()));
    }
    return runs;
  };
  Runs together, apart;
  for (const bool second : {false, true}) {
    together = makeAll(together);
    apart = makeAll(apart);
    std::vector<const FrameRun*> runs;
    for (const auto& run : together) runs.push_back(run.get());
    recordTogether(runs);
    for (size_t i = 0; i < runs.size(); ++i) {
      EXPECT_EQ(runs[i]->plan().historyAge, second && kKinds[i].reuses ? 1u : 0u) << kKinds[i].name;
      EXPECT_EQ(runs[i]->plan().dispatchCount == 0, kKinds[i].isEmpty) << kKinds[i].name;
      EXPECT_TRUE(sameBits(runs[i]->output(), record(*apart[i])))
          << kKinds[i].name << (second ? ", second frame" : "");
    }
  }
}

// Two players in one image: each half is a view with a rect of its own.
TEST_F(ViewsTest, HalvesOfOneImageHaveTheBitsOfTwo) {
  ReplaySettings halves[] = {gathered(), gathered()};
  halves[0].renderRect = {0, 0, 48, 80};
  halves[1].renderRect = {48, 0, 48, 80};
  const auto cleared = [&](size_t half) {
    std::unique_ptr<FrameRun> run = make(eye(half), halves[half]);
    run->uploadOutput(Image(96, 80, 4));
    return run;
  };
  const auto left = cleared(0), right = cleared(1);
  PellucidFrame intoLeft = right->frame();
  intoLeft.output = left->frame().output;
  recordFrames(replayer().contextFor(eye(0)), {&left->frame(), &intoLeft});
  for (size_t i = 0; i < 2; ++i) {
    const VkRect2D rect{{static_cast<int32_t>(48 * i), 0}, {48, 80}};
    const auto run = cleared(i);
    record(*run);
    EXPECT_TRUE(sameBits(left->output(rect), run->output(rect))) << "half " << i;
  }
}

}  // namespace
}  // namespace pellucid::test
