// Callers of other versions of the header: structs that end before fields that this library knows, and
// structs with more. Each struct lies in memory of exactly its size, so that a sanitizer sees reads beyond
// it.
#include <gtest/gtest.h>

#include <cstdlib>
#include <cstring>
#include <functional>
#include <memory>

#include "frame_fixture.h"

namespace {

using pellucid::test::Frame;
using pellucid::test::plainMaterial;

// A struct as a caller has it whose header makes it `size` bytes long.
template <class Struct>
class Sized {
public:
  Sized(const Struct& from, size_t size) : bytes_(static_cast<unsigned char*>(std::malloc(size))) {
    std::memset(bytes_.get(), 0, size);
    std::memcpy(bytes_.get(), &from, std::min(size, sizeof from));
    get()->structSize = static_cast<uint32_t>(size);
  }
  Struct* get() { return reinterpret_cast<Struct*>(bytes_.get()); }
  unsigned char* bytes() { return bytes_.get(); }

private:
  struct Free {
    void operator()(unsigned char* p) const { std::free(p); }
  };
  std::unique_ptr<unsigned char, Free> bytes_;
};

// A hash of the plan and its constants, all that a frame decides, or the error.
std::string resultOf(const PellucidFrame& frame) {
  PellucidPlan plan;
  if (const PellucidResult result = pellucidBuildPlan(&frame, nullptr, &plan); result != PELLUCID_OK)
    return pellucidResultName(result);
  std::string constants(plan.constantsSize, ' ');
  EXPECT_EQ(pellucidWriteConstants(&plan, &frame, constants.data(), constants.size()), PELLUCID_OK);
  return std::to_string(std::hash<std::string>()(bytesOf(plan) + constants));
}

std::string errorsOf(const PellucidFrame& frame) {
  std::string all;
  pellucidValidateFrame(
      &frame,
      [](void* user, PellucidSeverity severity, const char* field, const char* message) {
        if (severity == PELLUCID_SEVERITY_ERROR)
          *static_cast<std::string*>(user) += std::string(field) + " " + message + "\n";
      },
      &all);
  return all;
}

// Where the fields begin that may be missing, as the headers say.
constexpr size_t kLeastFrame = offsetof(PellucidFrame, options);
constexpr size_t kLeastThesis = offsetof(PellucidThesisOptions, angleModel);
constexpr size_t kLeastMaterial = offsetof(PellucidMaterial, burleyDistance);
constexpr size_t kLeastDesc = offsetof(PellucidContextDesc, options);

// Nothing at its default.
struct Unusual : Frame {
  Unusual() : Frame(2) {
    frame.options.debugView = PELLUCID_DEBUG_NONE;
    thesis.angleModel = PELLUCID_ANGLE_MINIMUM_DOT;
    thesis.maximumThickness = 3;
    thesis.transmittanceFilter[1] = 0.25f;
    frame.options.gatherSamples = 0;
    frame.options.reuse = PELLUCID_REUSE_ALTERNATE;
    frame.options.indirectDispatches = 1;
    frame.options.materialShift = 1;
    frame.options.materialMask = 0x1FE;
    frame.options.addToOutput = 1;
    frame.preExposure = 0.5f;
  }
};

// What a caller of this header gets who sets the fields before the cut. `frameOf` gives the frame that has
// the struct.
template <class Struct, class FrameOf>
void expectDefaultsBeyond(const Struct& whole, size_t least, void (*init)(Struct*), const FrameOf& frameOf) {
  std::set<std::string> results;
  for (size_t size = least; size <= sizeof(Struct); size += alignof(Struct)) {
    Struct expected;
    init(&expected);
    std::memcpy(static_cast<void*>(&expected), &whole, size);
    expected.structSize = sizeof expected;
    Sized<Struct> cut(whole, size);
    const std::string result = resultOf(frameOf(&expected)), errors = errorsOf(frameOf(&expected));
    results.insert(result);
    EXPECT_EQ(resultOf(frameOf(cut.get())), result) << size;
    EXPECT_EQ(errorsOf(frameOf(cut.get())), errors) << size;
  }
  EXPECT_GT(results.size(), 3u) << "the fields that are cut off decide nothing";
}

TEST(StructSize, StructsCutShortHaveDefaults) {
  Unusual f;
  expectDefaultsBeyond<PellucidFrame>(
      f.frame, kLeastFrame, [](PellucidFrame* p) { pellucidInitFrame(p); },
      [](PellucidFrame* frame) -> const PellucidFrame& { return *frame; });
  expectDefaultsBeyond<PellucidThesisOptions>(
      f.thesis, kLeastThesis, [](PellucidThesisOptions* p) { pellucidInitThesisOptions(p); },
      [&](PellucidThesisOptions* thesis) -> const PellucidFrame& {
        f.frame.options.thesis = thesis;
        return f.frame;
      });
}

TEST(StructSize, NoThesisOptionsAreTheirDefaults) {
  Frame f;
  const std::string result = resultOf(f.frame);
  f.frame.options.thesis = nullptr;
  EXPECT_EQ(resultOf(f.frame), result);
}

// Three materials of a caller to whom burleyDistance is not known, and of one who knows more.
TEST(StructSize, MaterialsLieAsFarApartAsTheyAreLong) {
  for (const size_t size : {kLeastMaterial, sizeof(PellucidMaterial), sizeof(PellucidMaterial) + 20}) {
    std::vector<PellucidMaterial> whole(3, plainMaterial());
    std::vector<unsigned char> packed(3 * size);
    for (size_t i = 0; i < whole.size(); ++i) {
      whole[i].reflectance[1] = 0.25f + 0.125f * static_cast<float>(i);
      whole[i].structSize = static_cast<uint32_t>(size);
      std::memcpy(packed.data() + i * size, &whole[i], std::min(size, sizeof whole[i]));
      whole[i].structSize = sizeof whole[i];
    }
    Frame f;
    f.frame.materialCount = 3;
    f.frame.materials = whole.data();
    const std::string result = resultOf(f.frame);
    f.frame.materials = reinterpret_cast<const PellucidMaterial*>(packed.data());
    EXPECT_EQ(resultOf(f.frame), result) << size;
  }
}

TEST(StructSize, MaterialsHaveOneSize) {
  PellucidMaterial materials[2] = {plainMaterial(), plainMaterial()};
  materials[1].structSize -= 12;
  Frame f;
  f.frame.materialCount = 2;
  f.frame.materials = materials;
  EXPECT_EQ(f.problems().find("materials[1].structSize is "), 0u) << f.problems();
}

// A newer caller's further fields are refused unless they are off.
TEST(StructSize, LongerStructsAreTakenWhereTheRestIsZero) {
  const Frame f;
  Sized<PellucidFrame> longer(f.frame, sizeof(PellucidFrame) + 16);
  EXPECT_EQ(resultOf(*longer.get()), resultOf(f.frame));
  longer.bytes()[sizeof(PellucidFrame) + 15] = 1;
  EXPECT_EQ(resultOf(*longer.get()), "PELLUCID_ERROR_VERSION");
  EXPECT_EQ(errorsOf(*longer.get()).find("structSize is "), 0u) << errorsOf(*longer.get());
}

TEST(StructSize, SizesOfNoVersionAreRefused) {
  const Frame f;
  for (const size_t size : {size_t{8}, kLeastFrame - 8, kLeastFrame + 4, size_t{4104}, size_t{0xCDCDCDCD}}) {
    PellucidFrame frame = f.frame;
    frame.structSize = static_cast<uint32_t>(size);
    EXPECT_EQ(resultOf(frame), "PELLUCID_ERROR_VERSION") << size;
    EXPECT_NE(errorsOf(frame).find("structSize is " + std::to_string(size)), std::string::npos);
  }
  PellucidThesisOptions thesis;
  pellucidInitThesisOptions(&thesis);
  thesis.structSize = 3;
  PellucidFrame frame = f.frame;
  frame.options.thesis = &thesis;
  EXPECT_EQ(resultOf(frame), "PELLUCID_ERROR_VERSION");
  EXPECT_NE(errorsOf(frame).find("thesis.structSize is 3"), std::string::npos) << errorsOf(frame);
}

// The defaults of this library's fields do not run over a shorter struct of the caller's.
TEST(StructSize, InitStaysInTheCallersStruct) {
  PellucidFrame frame;
  std::memset(static_cast<void*>(&frame), 0xAB, sizeof frame);
  pellucidInitFrameSized(&frame, kLeastFrame);
  EXPECT_EQ(frame.structSize, kLeastFrame);
  EXPECT_EQ(frame.metersPerUnit, 1);
  EXPECT_EQ(frame.options.cameraThickness, 0xABABABABu);
  PellucidContextDesc desc;
  std::memset(static_cast<void*>(&desc), 0xAB, sizeof desc);
  pellucidInitContextDescSized(&desc, kLeastDesc);
  EXPECT_EQ(desc.headerVersion, PELLUCID_HEADER_VERSION);
  EXPECT_EQ(desc.options.parallelUser, reinterpret_cast<void*>(0xABABABABABABABAB));
}

// Without a device: what is checked next is that a driver's functions are found.
TEST(StructSize, ContextDescCutShortIsRead) {
  PellucidContextDesc desc;
  pellucidInitContextDesc(&desc);
  desc.instance = reinterpret_cast<VkInstance>(uintptr_t{1});
  desc.physicalDevice = reinterpret_cast<VkPhysicalDevice>(uintptr_t{1});
  desc.device = reinterpret_cast<VkDevice>(uintptr_t{1});
  static int asked;
  asked = 0;
  desc.getInstanceProcAddr = [](VkInstance, const char*) -> PFN_vkVoidFunction {
    ++asked;
    return nullptr;
  };
  PellucidContext* context = nullptr;
  int expected = 0;
  for (size_t size = kLeastDesc; size <= sizeof desc; size += alignof(PellucidContextDesc)) {
    Sized<PellucidContextDesc> cut(desc, size);
    EXPECT_EQ(pellucidCreateContext(cut.get(), &context), PELLUCID_ERROR_INVALID_ARGUMENT) << size;
    EXPECT_EQ(asked, ++expected) << size;
  }
  static int said;
  said = 0;
  desc.message = [](void*, PellucidSeverity, const char*, const char*) { ++said; };
  desc.structSize = kLeastDesc - 8;
  EXPECT_EQ(pellucidCreateContext(&desc, &context), PELLUCID_ERROR_VERSION);
  EXPECT_EQ(said, 0) << "the callback lies beyond the struct";
  desc.structSize = sizeof desc - 4;
  EXPECT_EQ(pellucidCreateContext(&desc, &context), PELLUCID_ERROR_VERSION);
  EXPECT_EQ(said, 1);
  desc.structSize = sizeof desc;
  desc.headerVersion = PELLUCID_HEADER_VERSION + 1;
  EXPECT_EQ(pellucidCreateContext(&desc, &context), PELLUCID_ERROR_VERSION);
  EXPECT_EQ(asked, expected);
}

}  // namespace
