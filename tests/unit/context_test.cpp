// Creation of contexts where memory ends, and one context that many threads plan and record with.
#include <gtest/gtest.h>

#include <atomic>
#include <fstream>
#include <functional>
#include <iterator>
#include <new>
#include <string>
#include <thread>
#include <vector>

#include "frame_fixture.h"
#include "null_device.h"

namespace {

// Of the process' own nothrow new, which the module allocates with: the n-th call from now on fails.
std::atomic<int> failingNew = -1;

}  // namespace

void* operator new(size_t size, const std::nothrow_t&) noexcept {
  if (failingNew >= 0 && failingNew-- == 0) return nullptr;
  try {
    return ::operator new(size);
  } catch (const std::bad_alloc&) {
    return nullptr;
  }
}
// new[] does not call new here: sanitizers tell what delete[] frees from what delete frees.
void* operator new[](size_t size, const std::nothrow_t&) noexcept {
  if (failingNew >= 0 && failingNew-- == 0) return nullptr;
  try {
    return ::operator new[](size);
  } catch (const std::bad_alloc&) {
    return nullptr;
  }
}

namespace {

using namespace pellucid::test;

struct Sentences {
  int count = 0;
  std::string last;
  static void add(void* user, PellucidSeverity, const char* field, const char* message) {
    auto& self = *static_cast<Sentences*>(user);
    ++self.count;
    self.last = std::string(field) + " " + message;
  }
};

// Vulkan's allocation callbacks, one call of which fails. They live as long as the allocator. Neither the library nor the
// null device reallocates.
class FailingAllocator {
public:
  explicit FailingAllocator(int failing) : failing_(failing) {
    callbacks.pUserData = this;
    callbacks.pfnAllocation = [](void* user, size_t size, size_t alignment, VkSystemAllocationScope) -> void* {
      auto& self = *static_cast<FailingAllocator*>(user);
      if (self.calls++ == self.failing_) return nullptr;
      return *self.live.insert(std::aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment)).first;
    };
    callbacks.pfnFree = [](void* user, void* memory) {
      static_cast<FailingAllocator*>(user)->live.erase(memory);
      std::free(memory);
    };
  }
  FailingAllocator(const FailingAllocator&) = delete;

  VkAllocationCallbacks callbacks{};
  int calls = 0;
  std::set<void*> live;

private:
  int failing_;  // the number of the call that fails, from 0
};

PellucidContextDesc descOf(NullDevice& device, Sentences& sentences) {
  PellucidContextDesc desc = device.desc();
  desc.message = Sentences::add;
  desc.messageUser = &sentences;
  return desc;
}

// Records on a null device, with a slice of the plan's size that keeps its content.
PellucidResult recordOnNull(const PellucidContext* context, NullCommands& commands, const PellucidPlan& plan,
                            const PellucidFrame& frame, std::vector<unsigned char>& constants) {
  constants.resize(plan.constantsSize);
  commands.sliceSize = plan.constantsSize;
  const PellucidConstantsSlice slice{reinterpret_cast<VkBuffer>(uintptr_t{1}), 0, plan.constantsSize,
                                     constants.data()};
  const PellucidResult written = pellucidWriteConstants(&plan, &frame, constants.data(), constants.size());
  return written == PELLUCID_OK ? pellucidRecordPlan(context, commands.handle(), &plan, &frame, &slice)
                                : written;
}

TEST(ContextMemory, EveryFailingAllocationIsReportedAndNothingLeaks) {
  int allocations = 0;
  for (int n = 0;; ++n) {
    SCOPED_TRACE(n);
    NullDevice device;
    FailingAllocator allocator(n);
    Sentences sentences;
    PellucidContextDesc desc = descOf(device, sentences);
    desc.options.allocator = &allocator.callbacks;
    auto* context = reinterpret_cast<PellucidContext*>(&device);  // to be overwritten
    const PellucidResult result = pellucidCreateContext(&desc, &context);
    if (result == PELLUCID_OK) {
      allocations = allocator.calls;
      EXPECT_GT(allocator.live.size(), 0u);
      pellucidDestroyContext(context);
      EXPECT_EQ(allocator.live.size(), 0u);
      EXPECT_EQ(device.live, 0);
      break;
    }
    ASSERT_EQ(result, PELLUCID_ERROR_OUT_OF_MEMORY);
    EXPECT_EQ(context, nullptr);
    EXPECT_EQ(allocator.live.size(), 0u);
    EXPECT_EQ(device.live, 0);
    EXPECT_EQ(sentences.count, 1) << sentences.last;
    EXPECT_EQ(sentences.last.find("device "), 0u) << sentences.last;
    EXPECT_NE(sentences.last.find("returned VkResult -1"), std::string::npos) << sentences.last;
  }
  // Of each pipeline two layouts, its shader, itself and what the call takes.
  EXPECT_EQ(allocations, static_cast<int>(5 * pellucidGetPipelineCount()));
}

TEST(ContextMemory, FailingHostMemoryIsReported) {
  NullDevice device;
  const PellucidContextDesc desc = device.desc();
  int failures = 0;
  for (;; ++failures) {
    failingNew = failures;
    PellucidContext* context = nullptr;
    const PellucidResult result = pellucidCreateContext(&desc, &context);
    failingNew = -1;
    if (result == PELLUCID_OK) {
      pellucidDestroyContext(context);
      break;
    }
    ASSERT_EQ(result, PELLUCID_ERROR_OUT_OF_MEMORY);
    EXPECT_EQ(context, nullptr);
    EXPECT_EQ(device.live, 0);
  }
  EXPECT_EQ(failures, static_cast<int>(1 + pellucidGetPipelineCount()))
      << "the context, and each shader while its output format is written into it";
}

// The sentence that a context of this device is refused with; empty if it is made.
std::string refusalOf(NullDevice& device, const std::function<void(PellucidContextDesc&)>& change = {}) {
  Sentences sentences;
  PellucidContextDesc desc = descOf(device, sentences);
  if (change) change(desc);
  PellucidContext* context = nullptr;
  const PellucidResult result = pellucidCreateContext(&desc, &context);
  EXPECT_EQ(result, sentences.count > 0 ? PELLUCID_ERROR_MISSING_FEATURE : PELLUCID_OK);
  pellucidDestroyContext(context);
  return sentences.last;
}

TEST(ContextLimits, MissingFunctionsAreNamed) {
  for (const char* name : {"vkCmdPushDescriptorSetKHR", "vkCreateShaderModule", "vkCmdDispatchIndirect"}) {
    NullDevice device;
    device.missing = name;
    EXPECT_NE(refusalOf(device).find(name), std::string::npos) << name;
  }
}

TEST(ContextLimits, AreNamedWithBothNumbers) {
  using Limits = VkPhysicalDeviceLimits;
  const struct {
    const char* name;
    uint32_t Limits::*limit;
    uint32_t needed;
  } rows[] = {{"maxComputeWorkGroupInvocations", &Limits::maxComputeWorkGroupInvocations, 256},
              {"maxComputeSharedMemorySize", &Limits::maxComputeSharedMemorySize, 16384},
              {"maxPushConstantsSize", &Limits::maxPushConstantsSize, 16},
              {"maxUniformBufferRange", &Limits::maxUniformBufferRange, 16128},
              {"maxPerStageDescriptorUniformBuffers", &Limits::maxPerStageDescriptorUniformBuffers, 3},
              {"maxPerStageDescriptorStorageBuffers", &Limits::maxPerStageDescriptorStorageBuffers, 1},
              {"maxPerStageDescriptorStorageImages", &Limits::maxPerStageDescriptorStorageImages, 3},
              {"maxPerStageDescriptorSampledImages", &Limits::maxPerStageDescriptorSampledImages, 15},
              {"maxPerStageResources", &Limits::maxPerStageResources, 21}};
  std::ifstream file(PELLUCID_SOURCE_DIR "/docs/integration.md");
  const std::string page{std::istreambuf_iterator<char>(file), {}};
  for (const auto& [name, limit, needed] : rows) {
    EXPECT_NE(page.find("| `" + std::string(name) + "` | " + std::to_string(needed) + " |"), std::string::npos)
        << "docs/integration.md does not say that " << name << " is " << needed;
    NullDevice enough, less;
    enough.limits.*limit = needed;
    less.limits.*limit = needed - 1;
    EXPECT_EQ(refusalOf(enough), "") << name;
    const std::string both =
        std::string(name) + " " + std::to_string(needed - 1) + "; " + std::to_string(needed);
    EXPECT_NE(refusalOf(less).find(both), std::string::npos) << refusalOf(less);
  }
}

TEST(ContextLimits, DescriptorsThatArePushedAndFormatsAreNamed) {
  NullDevice few;
  few.mostPushed = 20;
  EXPECT_NE(refusalOf(few).find("maxPushDescriptors 20; 21"), std::string::npos);
  EXPECT_EQ(refusalOf(few, [](PellucidContextDesc& d) { d.options.descriptorPools = 1; }), "");
  NullDevice fixed;
  fixed.writesWithoutFormat = false;
  const auto anyFormat = [](PellucidContextDesc& d) { d.options.outputFormat = VK_FORMAT_UNDEFINED; };
  EXPECT_NE(refusalOf(fixed, anyFormat).find("shaderStorageImageWriteWithoutFormat"), std::string::npos);
  EXPECT_EQ(refusalOf(fixed), "") << "formats that are fixed need no such feature";
  fixed.writesWithoutFormat = true;
  EXPECT_EQ(refusalOf(fixed, anyFormat), "");
  for (const VkFormat format :
       {VK_FORMAT_R32_UINT, VK_FORMAT_R32G32B32A32_UINT, VK_FORMAT_R16G16B16A16_SFLOAT}) {
    NullDevice device;
    device.notStorage = format;
    EXPECT_NE(refusalOf(device).find("VkFormat " + std::to_string(format)), std::string::npos);
  }
}

// Without push descriptors, sets come from the frame's pool: as many recordings of a slice as there may be,
// each dispatch with a set of its own.
TEST(ContextRecording, SetsComeFromTheFramesPool) {
  NullDevice device;
  device.missing = "vkCmdPushDescriptorSetKHR";
  Sentences sentences;
  PellucidContextDesc desc = descOf(device, sentences);
  PellucidContext* context = nullptr;
  EXPECT_EQ(pellucidCreateContext(&desc, &context), PELLUCID_ERROR_MISSING_FEATURE);
  EXPECT_NE(sentences.last.find("descriptorPools"), std::string::npos) << sentences.last;
  desc.options.descriptorPools = 2;
  EXPECT_EQ(pellucidCreateContext(&desc, &context), PELLUCID_ERROR_INVALID_ARGUMENT);
  EXPECT_NE(sentences.last.find("descriptorPools is 2"), std::string::npos) << sentences.last;
  desc.options.descriptorPools = 1;
  ASSERT_EQ(pellucidCreateContext(&desc, &context), PELLUCID_OK) << sentences.last;
  CompleteFrame f;
  const PellucidPlan plan = f.plan();
  std::vector<unsigned char> constants;
  NullCommands refused;
  EXPECT_EQ(recordOnNull(context, refused, plan, f.frame, constants), PELLUCID_ERROR_INVALID_ARGUMENT);
  EXPECT_NE(sentences.last.find("descriptorPool is NULL"), std::string::npos) << sentences.last;
  ASSERT_EQ(pellucidCreateDescriptorPool(context, &f.frame.options.descriptorPool), PELLUCID_OK);
  for (int times = 0; times < 3; ++times) {
    NullCommands commands;
    ASSERT_EQ(recordOnNull(context, commands, plan, f.frame, constants), PELLUCID_OK) << sentences.last;
    EXPECT_EQ(commands.problem, "");
    EXPECT_EQ(commands.dispatches, plan.dispatchCount);
    EXPECT_EQ(commands.sets.size(), plan.dispatchCount);
  }
  EXPECT_EQ(pellucidCreateDescriptorPool(context, nullptr), PELLUCID_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(pellucidCreateDescriptorPool(nullptr, &f.frame.options.descriptorPool),
            PELLUCID_ERROR_INVALID_ARGUMENT);
  reinterpret_cast<PFN_vkDestroyDescriptorPool>(device.function("vkDestroyDescriptorPool"))(
      desc.device, f.frame.options.descriptorPool, nullptr);
  pellucidDestroyContext(context);
}

// A plan of a valid frame and a frame that is not: its constants are refused before what is not there is
// read.
TEST(ContextRecording, ConstantsOfFramesThatAreNotValidAreRefused) {
  const std::pair<const char*, void (*)(Frame&)> damages[] = {
      {"NULL", [](Frame& f) { f.frame.materials = nullptr; }},
      {"NULL", [](Frame& f) { f.frame.lights = nullptr; }},
      {"NULL", [](Frame& f) { f.frame.shadowMaps = nullptr; }},
      {"NULL", [](Frame& f) { f.frame.shadowImages = nullptr; }},
      // The transients of such a frame cannot be counted.
      {"imageExtent",
       [](Frame& f) {
         f.frame.options.reuse = PELLUCID_REUSE_ALTERNATE;
         f.frame.imageExtent[0] = 0;
       }}};
  for (const auto& [words, damage] : damages) {
    CompleteFrame f;
    ASSERT_EQ(f.problems(), "");
    const PellucidPlan plan = f.plan();
    damage(f);
    std::vector<unsigned char> constants(plan.constantsSize, 0xAB);
    EXPECT_EQ(pellucidWriteConstants(&plan, &f.frame, constants.data(), constants.size()),
              PELLUCID_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(std::count(constants.begin(), constants.end(), 0xAB),
              static_cast<std::ptrdiff_t>(constants.size()));
    EXPECT_NE(f.problems().find(words), std::string::npos) << f.problems();
  }
}

// Layouts of all passes stay, and only pipelines of the uses are made.
TEST(ContextPipelines, AreThoseOfTheUses) {
  NullDevice device;
  PellucidContextDesc desc = device.desc();
  const auto live = [&](uint32_t uses) {
    desc.options.uses = uses;
    PellucidContext* context = nullptr;
    EXPECT_EQ(pellucidCreateContext(&desc, &context), PELLUCID_OK);
    const int count = device.live;
    pellucidDestroyContext(context);
    return count;
  };
  const int all = static_cast<int>(pellucidGetPipelineCount());
  EXPECT_EQ(live(0), 3 * all);
  EXPECT_EQ(live(PELLUCID_USE_DIFFUSION), 2 * all + 5) << "base level, downsample, coarse levels, upsample, diffuse";
}

// Frames of different kinds, so that threads run different code at once.
void shape(Frame& f, uint32_t kind) {
  for (PellucidImage& image : f.frame.transients) image = Frame::view();
  f.frame.imageExtent[0] = 64 + 100 * (kind % 7);
  if (kind % 3 == 1) f.frame.options.gatherSamples = 8;
  if (kind % 3 == 2) f.frame.options.features = PELLUCID_FEATURE_DIFFUSION;
  if (kind % 4 == 1) f.frame.options.outputFormat = VK_FORMAT_R32G32B32A32_SFLOAT;
  if (kind % 5 == 1) f.frame.albedo = Frame::view();
}

struct Recorded {
  std::vector<unsigned char> constants;
  std::string plan;  // bytesOf
  uint32_t dispatches = 0;
  bool operator==(const Recorded&) const = default;
};

// Through every function of the API that planning and recording call. No expectations: threads call it.
std::string record(const PellucidContext* context, uint32_t kind, Recorded* out) {
  Frame f(kind % 4);
  shape(f, kind);
  if (pellucidValidateFrame(&f.frame, nullptr, nullptr) != PELLUCID_OK) return "the frame is not valid";
  PellucidImageNeed needs[PELLUCID_MAX_TRANSIENTS + 1];
  uint32_t count = PELLUCID_MAX_TRANSIENTS + 1;
  if (pellucidGetImageNeeds(&f.frame, &count, needs) != PELLUCID_OK) return "no needs";
  PellucidPlan plan;
  if (pellucidBuildPlan(&f.frame, nullptr, &plan) != PELLUCID_OK) return "no plan";
  NullCommands commands;
  if (recordOnNull(context, commands, plan, f.frame, out->constants) != PELLUCID_OK) return "not recorded";
  out->dispatches = commands.dispatches;
  out->plan = bytesOf(plan);
  return commands.problem;
}

// Also run with ThreadSanitizer: ./run sanitize.
TEST(ContextThreads, RecordTheSameAsOne) {
  constexpr uint32_t kKinds = 60, kThreads = 8, kRounds = 10;
  NullDevice device;
  PellucidContextDesc desc = device.desc();
  desc.options.outputFormat = VK_FORMAT_UNDEFINED;  // frames have several
  PellucidContext* context = nullptr;
  ASSERT_EQ(pellucidCreateContext(&desc, &context), PELLUCID_OK);
  std::vector<Recorded> expected(kKinds);
  for (uint32_t kind = 0; kind < kKinds; ++kind) {
    ASSERT_EQ(record(context, kind, &expected[kind]), "") << kind;
    EXPECT_GT(expected[kind].dispatches, 0u);
  }
  std::vector<std::string> problems(kThreads);
  {
    std::vector<std::jthread> threads;
    for (uint32_t thread = 0; thread < kThreads; ++thread)
      threads.emplace_back([&, thread] {
        for (uint32_t i = 0; i < kKinds * kRounds && problems[thread].empty(); ++i) {
          const uint32_t kind = (i * 7 + thread * 11) % kKinds;
          Recorded recorded;
          problems[thread] = record(context, kind, &recorded);
          if (problems[thread].empty() && !(recorded == expected[kind]))
            problems[thread] = "frame " + std::to_string(kind) + " was recorded otherwise than alone";
        }
      });
  }
  for (const std::string& problem : problems) EXPECT_EQ(problem, "");
  pellucidDestroyContext(context);
}

// Contexts are made and destroyed on several threads of one device, too.
TEST(ContextThreads, EachMakesItsOwnContext) {
  NullDevice device;
  std::vector<std::string> problems(4);
  {
    std::vector<std::jthread> threads;
    for (std::string& problem : problems)
      threads.emplace_back([&] {
        for (int i = 0; i < 20 && problem.empty(); ++i) {
          PellucidContextDesc desc = device.desc();
          desc.options.outputFormat = VK_FORMAT_UNDEFINED;
          PellucidContext* context = nullptr;
          if (pellucidCreateContext(&desc, &context) != PELLUCID_OK) problem = "no context";
          Recorded recorded;
          if (problem.empty()) problem = record(context, static_cast<uint32_t>(i), &recorded);
          pellucidDestroyContext(context);
        }
      });
  }
  for (const std::string& problem : problems) EXPECT_EQ(problem, "");
  EXPECT_EQ(device.live, 0);
}

}  // namespace
