// Several views in one recording have the bits that they have alone.
#include <array>
#include <cstring>

#include "capture/material.h"
#include "common/owned.h"
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
  static const PellucidMaterial skin = compileMaterial(PresetMaterial{"skin1"}, "skin1");
  return std::vector<PellucidMaterial>(c.materials.size(), skin);
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
  static void record(const std::vector<const FrameRun*>& runs) {
    device().run([&](VkCommandBuffer commands) { FrameRun::recordTogether(commands, runs); });
  }
  static Image alone(const FrameRun& run) {
    device().run([&](VkCommandBuffer commands) { run.record(commands); });
    return run.output();
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

TEST_F(ViewsTest, EyesHaveTheSameBitsTogether) {
  for (const bool indirect : {0, 1}) {
    ReplaySettings s = gathered();
    s.indirectDispatches = indirect;
    const auto left = make(eye(0), s), right = make(eye(1), s);
    record({left.get(), right.get()});
    const Image images[] = {left->output(), right->output()};
    EXPECT_FALSE(sameBits(images[0], images[1])) << "the eyes see the same";
    for (size_t i = 0; i < 2; ++i)
      EXPECT_TRUE(sameBits(images[i], alone(*make(eye(i), s)))) << "eye " << i << ", indirect " << indirect;
  }
}

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
    {"reuse without a gather", right,
     [](ReplaySettings& s) { s.reuse = PELLUCID_REUSE_ALTERNATE, s.translucency.gatherSamples = 0; }, true},
    {"slab", slab, [](ReplaySettings&) {}},
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
    record(runs);
    for (size_t i = 0; i < runs.size(); ++i) {
      EXPECT_EQ(runs[i]->plan().historyAge, second && kKinds[i].reuses ? 1u : 0u) << kKinds[i].name;
      EXPECT_EQ(runs[i]->plan().dispatchCount == 0, kKinds[i].isEmpty) << kKinds[i].name;
      EXPECT_TRUE(sameBits(runs[i]->output(), alone(*apart[i])))
          << kKinds[i].name << (second ? ", second frame" : "");
    }
  }
}

// ---- Layers

void waitForAll(VkCommandBuffer commands) {
  const VkMemoryBarrier all{VK_STRUCTURE_TYPE_MEMORY_BARRIER, nullptr, VK_ACCESS_MEMORY_WRITE_BIT,
                            VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT};
  vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, 0, 1,
                       &all, 0, nullptr, 0, nullptr);
}

// An array of two layers with a 2D view of each, in GENERAL.
class Layers {
public:
  Layers(Device& device, int width, int height, VkFormat format)
      : device_(device), array_(device, width, height, format, 0, 2), views_{View(device), View(device)} {
    for (uint32_t i = 0; i < 2; ++i) {
      VkImageViewCreateInfo info{VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO};
      info.image = array_.handle();
      info.viewType = VK_IMAGE_VIEW_TYPE_2D;
      info.format = format;
      info.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, i, 1};
      check(vkCreateImageView(device.handle(), &info, nullptr, views_[i].receive()), "vkCreateImageView");
    }
    device.run([&](VkCommandBuffer commands) {
      VkImageMemoryBarrier b{VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER};
      b.dstAccessMask = VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT;
      b.newLayout = VK_IMAGE_LAYOUT_GENERAL;
      b.srcQueueFamilyIndex = b.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
      b.image = array_.handle();
      b.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 2};
      vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_TOP_OF_PIPE_BIT, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, 0,
                           0, nullptr, 0, nullptr, 1, &b);
    });
  }

  GpuImage& array() { return array_; }
  PellucidImage layer(size_t index) const { return {views_[index], VK_IMAGE_LAYOUT_GENERAL}; }
  Image download(uint32_t layer) const {
    GpuImage copy(device_, array_.width(), array_.height(), array_.format());
    copy.clear();
    device_.run([&](VkCommandBuffer commands) {
      waitForAll(commands);
      VkImageCopy region{};
      region.srcSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, layer, 1};
      region.dstSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
      region.extent = {static_cast<uint32_t>(array_.width()), static_cast<uint32_t>(array_.height()), 1};
      vkCmdCopyImage(commands, array_.handle(), VK_IMAGE_LAYOUT_GENERAL, copy.handle(),
                     VK_IMAGE_LAYOUT_GENERAL, 1, &region);
      waitForAll(commands);
    });
    return copy.download();
  }

private:
  using View = Owned<VkImageView, vkDestroyImageView>;
  Device& device_;
  GpuImage array_;
  std::array<View, 2> views_;
};

// Inputs, transients and outputs of both eyes are the layers of one array each.
TEST_F(ViewsTest, LayersOfArraysHaveTheBitsOfImages) {
  ReplaySettings s;
  s.translucency.gatherSamples = 0;  // each way to bind images makes llvmpipe compile shaders again
  const Context& context = replayer().contextFor(eye(0));
  const int width = eye(0).width, height = eye(0).height;
  FrameData data[2];
  std::vector<std::unique_ptr<InputImages>> shadows;
  for (size_t i = 0; i < 2; ++i) {
    makeFrame(eye(i), materials(eye(i)), s, data[i]);
    // The shadow maps of these images stay in the frame.
    shadows.push_back(std::make_unique<InputImages>(device(), eye(i), s));
    shadows[i]->bind(data[i]);
  }
  std::vector<std::unique_ptr<Layers>> owned;
  const auto add = [&](VkFormat format, int w, int h) -> Layers& {
    return *owned.emplace_back(std::make_unique<Layers>(device(), w, h, format));
  };
  const auto upload = [&](PellucidImage PellucidFrame::*field, VkFormat format,
                          const std::function<void(GpuImage&, const Capture&, int)>& content) {
    Layers& layers = add(format, width, height);
    for (int i = 0; i < 2; ++i) {
      content(layers.array(), eye(static_cast<size_t>(i)), i);
      data[i].frame.*field = layers.layer(static_cast<size_t>(i));
    }
    return owned.size() - 1;
  };
  upload(&PellucidFrame::frontDepth, VK_FORMAT_R32_SFLOAT,
         [](GpuImage& to, const Capture& c, int layer) { to.upload(c.frontDepth.image, layer); });
  upload(&PellucidFrame::backDepth, VK_FORMAT_R32_SFLOAT,
         [](GpuImage& to, const Capture& c, int layer) { to.upload(c.backDepth.image, layer); });
  upload(&PellucidFrame::irradiance, irradianceFormat(s),
         [](GpuImage& to, const Capture& c, int layer) { to.upload(c.irradiance, layer); });
  upload(&PellucidFrame::normal, s.normalFormat,
         [](GpuImage& to, const Capture& c, int layer) { to.upload(c.normal, layer); });
  upload(&PellucidFrame::albedo, VK_FORMAT_R32G32B32A32_SFLOAT,
         [](GpuImage& to, const Capture& c, int layer) { to.upload(c.albedo, layer); });
  upload(&PellucidFrame::material, VK_FORMAT_R8_UINT,
         [](GpuImage& to, const Capture& c, int layer) { to.upload(c.material, layer); });
  const size_t output = upload(
      &PellucidFrame::output, s.outputFormat,
      [](GpuImage& to, const Capture& c, int layer) { to.upload(Image(c.width, c.height, 4), layer); });
  PellucidImageNeed needs[kMaxImageNeeds];
  uint32_t count = kMaxImageNeeds;
  ASSERT_EQ(pellucidGetImageNeeds(&data[0].frame, &count, needs), PELLUCID_OK);
  for (uint32_t t = 0; t < count; ++t) {
    const Layers& layers =
        add(needs[t].format, static_cast<int>(needs[t].extent[0]), static_cast<int>(needs[t].extent[1]));
    for (size_t i = 0; i < 2; ++i) data[i].frame.transients[t] = layers.layer(i);
  }
  recordFrames(context, {&data[0].frame, &data[1].frame});
  for (size_t i = 0; i < 2; ++i) {
    const auto inputs = std::make_shared<const InputImages>(device(), eye(i), s);
    const FrameRun run(device(), context, eye(i), materials(eye(i)), s, inputs);
    EXPECT_TRUE(sameBits(owned[output]->download(static_cast<uint32_t>(i)), alone(run))) << "layer " << i;
  }
}

// ---- Split screen

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
    alone(*run);
    EXPECT_TRUE(sameBits(left->output(rect), run->output(rect))) << "half " << i;
  }
}

}  // namespace
}  // namespace pellucid::test
