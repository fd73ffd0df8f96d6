// Plans through an RHI (gbuffer_harness/sample/rhi_pass.h), without pellucidRecordPlan: the same bits, and
// validation that is silent.
#include "capture/shadow_images.h"
#include "gpu_fixture.h"
#include "stress/random_frame.h"
#include "vulkan_rhi.h"

namespace pellucid::test {
namespace {

using RhiPlan = GpuTest;

// A slab that thickens from left to right, lit from behind, with a pattern of irradiance and a hole.
Capture slab() {
  Capture c = flatCapture(150, 90);
  for (int y = 0; y < c.height; ++y)
    for (int x = 0; x < c.width; ++x) {
      const auto i = static_cast<size_t>(y * c.width + x);
      c.backDepth.image.data[i] += 0.04f * static_cast<float>(x);
      c.irradiance.data[3 * i + 1] = 0.1f * static_cast<float>((x / 5 + y / 7) % 9);
      if (x > 100 && x < 120 && y > 30) c.material[i] = 0;
    }
  c.lights.push_back(backLight());
  c.lights[0].shadowMaps = {flatShadowMap(-14, PELLUCID_DEPTH_DEVICE)};
  return c;
}

// A frame as an engine has it: images by pellucidGetImageNeeds, and two buffers of constants.
struct RhiFrame {
  FrameData data;
  InputImages inputs;
  std::vector<std::shared_ptr<GpuImage>> owned;  // that dispatches write; the output is the first
  std::shared_ptr<GpuImage> history;
  std::unique_ptr<HostBuffer> constants, lists;
  PellucidPlan plan;

  RhiFrame(Device& device, const Capture& capture, const ReplaySettings& settings,
           const RhiFrame* previous = nullptr, const std::vector<PellucidMaterial>& materials = {testMaterial()})
      : inputs(device, capture, settings) {
    makeFrame(capture, materials, settings, data);
    inputs.bind(data);
    PellucidFrame& f = data.frame;
    f.output = add(device, {settings.outputFormat, {f.imageExtent[0], f.imageExtent[1]}, 0, 0, 0, 0}, 0);
    PellucidImageNeed needs[kMaxImageNeeds];
    uint32_t count = kMaxImageNeeds;
    requireOk(pellucidGetImageNeeds(&f, &count, needs), f, "needs");
    for (uint32_t i = 0; i < count; ++i)
      if (!needs[i].persistent) {
        f.transients[i] = add(device, needs[i], 0xFF);
      } else if (previous) {
        owned.push_back(history = previous->history);
        f.options.history = history->use();
      } else {
        f.options.history = add(device, needs[i], 0xFF);
        history = owned.back();
      }
    requireOk(pellucidBuildPlan(&f, previous ? &previous->plan : nullptr, &plan), f, "plan");
    std::vector<char> bytes(plan.constantsSize);
    requireOk(pellucidWriteConstants(&plan, &f, bytes.data(), bytes.size()), f, "constants");
    constants = buffer(device, std::span(bytes).first(plan.listsOffset), VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT);
    lists = buffer(device, std::span(bytes).subspan(plan.listsOffset), VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT);
  }

  Image render(VulkanRhi& rhi, RhiPass& pass) const {
    for (const auto& image : owned) rhi.own(*image);
    rhi.run([&] { pass.record(plan, data.frame, {constants->handle(), lists->handle()}); });
    return owned[0]->download();
  }

private:
  PellucidImage add(Device& device, const PellucidImageNeed& need, std::uint8_t byte) {
    owned.push_back(std::make_shared<GpuImage>(device, static_cast<int>(need.extent[0]),
                                               static_cast<int>(need.extent[1]), need.format));
    owned.back()->clear(byte);
    return owned.back()->use();
  }
  static std::unique_ptr<HostBuffer> buffer(Device& device, std::span<const char> bytes,
                                            VkBufferUsageFlags usage) {
    auto made = std::make_unique<HostBuffer>(device, std::max<size_t>(bytes.size(), 256),
                                             usage | VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
    std::copy(bytes.begin(), bytes.end(), static_cast<char*>(made->mapped()));
    return made;
  }
};

PellucidContextOptions passOptions(uint32_t uses = 0) {
  PellucidContextDesc desc;
  pellucidInitContextDesc(&desc);
  desc.options.uses = uses;
  desc.options.outputFormat = VK_FORMAT_R32G32B32A32_SFLOAT;
  desc.options.lightTables = 1;
  return desc.options;
}

TEST_F(RhiPlan, HasTheBitsOfARecording) {
  struct Row {
    const char* name;
    uint32_t samples;
    PellucidReuse reuse;
    int frames;
  };
  const Capture capture = slab();
  VulkanRhi rhi(device());
  RhiPass pass(rhi, passOptions());
  for (const Row& row :
       {Row{"gather", 8, PELLUCID_REUSE_NONE, 1}, Row{"one thickness a pixel", 0, PELLUCID_REUSE_NONE, 1},
        Row{"accumulated", 8, PELLUCID_REUSE_ACCUMULATE, 3},
        Row{"kept probes", 8, PELLUCID_REUSE_ALTERNATE, 2},
        Row{"kept light", 0, PELLUCID_REUSE_ALTERNATE, 2}}) {
    SCOPED_TRACE(row.name);
    ReplaySettings settings = gathering(row.samples);
    settings.reuse = row.reuse;
    std::unique_ptr<FrameRun> run;
    std::unique_ptr<RhiFrame> frame;
    for (int i = 0; i < row.frames; ++i) {
      run = std::make_unique<FrameRun>(device(), replayer().contextFor(capture), capture,
                                       std::vector{testMaterial()}, settings, run.get());
      run->uploadOutput(Image(capture.width, capture.height, 4, 0));  // pixels without a material keep it
      frame = std::make_unique<RhiFrame>(device(), capture, settings, frame.get());
      const Image recorded = record(*run), image = frame->render(rhi, pass);
      EXPECT_TRUE(sameBits(image, recorded)) << "frame " << i;
      EXPECT_GT(image.data[4], 0.5f);
    }
  }
}

// Of every option: lights, maps, materials, rects, debug views, the thesis's options, lists.
TEST_F(RhiPlan, RandomFramesHaveTheBitsOfRecordings) {
  const stress::MaterialPool pool;
  VulkanRhi rhi(device());
  RhiPass pass(rhi, passOptions());
  constexpr int kFrames = 12;  // 60 had the same bits, too, and take minutes
  int compared = 0;
  for (std::uint64_t index = 0; compared < kFrames && index < 100; ++index) {
    stress::StressFrame f = stress::randomFrame(7, index, pool, {4096, 1024});
    if (hasLayers(f.capture.lights)) continue;  // a context of arrays has other pipelines
    f.settings.outputFormat = VK_FORMAT_R32G32B32A32_SFLOAT;
    f.settings.aliasOutput = false;
    SCOPED_TRACE(index);
    const FrameRun run(device(), replayer().contextFor(f.capture), f.capture, f.materials, f.settings);
    if (run.plan().inPlaceDispatches > 0) continue;
    run.uploadOutput(Image(f.capture.width, f.capture.height, 4, 0));
    const Image recorded = record(run);
    EXPECT_TRUE(sameBits(RhiFrame(device(), f.capture, f.settings, nullptr, f.materials).render(rhi, pass), recorded));
    ++compared;
  }
  EXPECT_EQ(compared, kFrames);
}

// APIs that have one state a texture cannot run such plans.
TEST_F(RhiPlan, RefusesDispatchesInPlace) {
  VulkanRhi rhi(device());
  RhiPass pass(rhi, passOptions(PELLUCID_USE_GATHER | PELLUCID_USE_DIFFUSION));
  ReplaySettings settings = gathering(8);
  settings.addToOutput = true;
  const RhiFrame adds(device(), slab(), settings);
  EXPECT_THROW(adds.render(rhi, pass), std::invalid_argument);
}

TEST_F(RhiPlan, RefusesPipelinesThatItLacks) {
  VulkanRhi rhi(device());
  RhiPass pass(rhi, passOptions(PELLUCID_USE_DIFFUSION));
  const RhiFrame gathers(device(), slab(), gathering(8));
  EXPECT_THROW(gathers.render(rhi, pass), std::invalid_argument);
}

// Leaves out one change of a state, or one member of a set.
class ForgetfulRhi : public VulkanRhi {
public:
  using VulkanRhi::VulkanRhi;
  int forgottenChange = -1, forgottenItem = -1;
  int changes = 0;

  void commitBarriers() override {
    for (auto next = newTextures_.begin(); next != newTextures_.end();) {
      RhiState& state = textures_.at(next->first).state;
      const bool forget = state != next->second && changes++ == forgottenChange;
      if (forget) state = next->second;
      next = forget ? newTextures_.erase(next) : std::next(next);
    }
    for (auto next = newBuffers_.begin(); next != newBuffers_.end();) {
      const auto old = buffers_.find(next->first);
      // After reads alone, the barriers of textures order a write, too.
      const bool wrote = old != buffers_.end() && (old->second & kRhiStored) != 0;
      const bool forget = wrote && old->second != next->second && changes++ == forgottenChange;
      if (forget) old->second = next->second;
      next = forget ? newBuffers_.erase(next) : std::next(next);
    }
    VulkanRhi::commitBarriers();
  }
  void bind(const RhiPipeline& pipeline, std::span<const RhiItem> items,
            std::span<const uint32_t> pushConstants) override {
    std::vector<RhiItem> some(items.begin(), items.end());
    if (forgottenItem >= 0) some.erase(some.begin() + forgottenItem);
    VulkanRhi::bind(pipeline, some, pushConstants);
  }
};

// The other tests trust validation: here it finds each change of a state that is left out and orders what was written, and the RHI
// each member of a set.
TEST(RhiMistakes, AreSeen) {
  const Capture capture = slab();
  int changes = 1;
  for (int i = -1; i < changes; ++i) {
    SCOPED_TRACE(testing::Message() << "without change " << i);
    Device device({"", true});  // a layer repeats a message ten times, and then no more
    ForgetfulRhi rhi(device);
    RhiPass pass(rhi, passOptions(PELLUCID_USE_GATHER | PELLUCID_USE_DIFFUSION));
    const RhiFrame frame(device, capture, gathering(8));
    rhi.forgottenChange = i;
    frame.render(rhi, pass);
    EXPECT_EQ(device.validationMessages().empty(), i == -1);
    changes = rhi.changes;
    if (i >= 0) continue;
    rhi.forgottenItem = 1;
    EXPECT_THROW(frame.render(rhi, pass), DeviceError);
  }
  EXPECT_GT(changes, 8);
}

// The other GPU tests trust the validation layers, too.
TEST(Validation, ReportsAMissingBarrier) {
  Device device({"", true});
  HostBuffer buffer(device, 256, VK_BUFFER_USAGE_TRANSFER_DST_BIT);
  device.run([&](VkCommandBuffer commandBuffer) {
    vkCmdFillBuffer(commandBuffer, buffer.handle(), 0, 256, 1);
    vkCmdFillBuffer(commandBuffer, buffer.handle(), 0, 256, 2);
  });
  ASSERT_FALSE(device.validationMessages().empty());
  EXPECT_NE(device.validationMessages()[0].find("WRITE_AFTER_WRITE"), std::string::npos);
}

TEST(Validation, ReportsWrongUsage) {
  Device device({"", true});
  HostBuffer buffer(device, 256, VK_BUFFER_USAGE_TRANSFER_SRC_BIT);  // not a destination
  device.run(
      [&](VkCommandBuffer commandBuffer) { vkCmdFillBuffer(commandBuffer, buffer.handle(), 0, 256, 1); });
  EXPECT_FALSE(device.validationMessages().empty());
}

}  // namespace
}  // namespace pellucid::test
