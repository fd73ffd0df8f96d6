#include "fuzz/frame_input.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <limits>
#include <map>

#include "stress/random_frame.h"

namespace pellucid::fuzz {

namespace {

using harness::stress::StressFrame;

constexpr uint32_t kFew = 5;

// Making a frame takes longer than all that a target does with it.
const StressFrame& randomFrame(uint8_t number) {
  static const harness::stress::MaterialPool pool;
  static std::map<uint8_t, StressFrame> made;
  const auto found = made.find(number);
  if (found != made.end()) return found->second;
  return made.emplace(number, harness::stress::randomFrame(1, number, pool, {64, 64})).first->second;
}

// None more mostly, then few; from 240 on many, up to `most`. Further ones are the first.
template <class T>
void lengthen(std::vector<T>& array, uint8_t byte, uint32_t most) {
  const uint32_t count = byte < 240 ? byte % (kFew + 1) : (byte - 239u) * most / 16u;
  if (!array.empty() && array.size() < count) array.resize(count, T(array[0]));
}

const float kExtremes[] = {0.0f,
                           -0.0f,
                           1.0f,
                           -1.0f,
                           std::numeric_limits<float>::quiet_NaN(),
                           std::numeric_limits<float>::infinity(),
                           -std::numeric_limits<float>::infinity(),
                           std::numeric_limits<float>::denorm_min(),
                           std::numeric_limits<float>::max(),
                           1e-30f,
                           1e15f,
                           1e9f};
const uint32_t kIntegers[] = {0,   1,   2,     3,     4,          8,          64,
                              255, 256, 65535, 65536, 0x7FFFFFFF, 0x80000000, 0xFFFFFFFF};

uint32_t valueOf(uint8_t kind, uint32_t word) {
  switch (kind % 4) {
    case 0:
      return word;
    case 1:
      return std::bit_cast<uint32_t>(kExtremes[word % std::size(kExtremes)]);
    case 2:
      return kIntegers[word % std::size(kIntegers)];
    default:  // fractions and small numbers, which are valid most often
      return std::bit_cast<uint32_t>(static_cast<float>(static_cast<int32_t>(word) % 4096) / 64.0f);
  }
}

// Vulkan's enumerations end at 0x7FFFFFFF: what is beyond is no value of theirs, and no caller can have it.
template <class Enum>
void bound(Enum& value) {
  uint32_t word;
  std::memcpy(&word, &value, sizeof word);
  word &= 0x7FFFFFFFu;
  std::memcpy(&value, &word, sizeof word);
}

template <class Struct>
void edit(std::span<Struct> array, uint8_t index, uint16_t word, uint32_t value) {
  if (array.empty()) return;
  auto* object = reinterpret_cast<unsigned char*>(&array[index % array.size()]);
  constexpr size_t kWords = std::is_same_v<Struct, PellucidMaterial> ? offsetof(PellucidMaterial, tables) / 4 : sizeof(Struct) / 4;
  std::memcpy(object + word % kWords * 4, &value, 4);
}

}  // namespace

FrameInput::FrameInput(std::span<const uint8_t> bytes, size_t edits) {
  uint8_t header[kHeaderBytes] = {};
  std::memcpy(header, bytes.data(), std::min(bytes.size(), kHeaderBytes));
  bytes = bytes.subspan(std::min(bytes.size(), kHeaderBytes));

  const StressFrame& random = randomFrame(header[0]);
  harness::makeFrame(random.capture, random.materials, random.settings, data_);
  frame = data_.frame;
  lengthen(data_.materials, header[1], 256);
  lengthen(data_.lights, header[2], 340);
  lengthen(data_.shadowMaps, header[3], 340);
  lengthen(data_.shadowImages, header[3], 680);
  // Edits may ask for images that the random frame does not need.
  const PellucidImage view{reinterpret_cast<VkImageView>(uintptr_t{1}), VK_IMAGE_LAYOUT_GENERAL};
  if (header[4] & 1)
    for (PellucidImage* image : {&frame.albedo, &frame.hiddenIrradiance, &frame.motion, &frame.options.history})
      *image = view;
  if (header[4] & 2) std::fill(std::begin(frame.transients), std::end(frame.transients), view);
  if (header[4] & 4) frame.backDepth = {};
  choice = header[5];

  PellucidFrame edited = frame;
  PellucidThesisOptions thesis = data_.thesis;
  for (size_t i = 0; i < edits && (i + 1) * kEditBytes <= bytes.size(); ++i) {
    const uint8_t* e = bytes.data() + i * kEditBytes;
    uint16_t word;
    uint32_t value;
    std::memcpy(&word, e + 2, 2);
    std::memcpy(&value, e + 4, 4);
    value = valueOf(e[0] / 8, value);
    switch (e[0] % 8) {
      case 0:
      case 1:
      case 2:
        edit(std::span(&edited, 1), e[1], word, value);
        break;
      case 3:
        edit(std::span(&thesis, 1), e[1], word, value);
        break;
      case 4:
        edit(std::span(data_.materials), e[1], word, value);
        break;
      case 5:
        edit(std::span(data_.lights), e[1], word, value);
        break;
      case 6:
        edit(std::span(data_.shadowMaps), e[1], word, value);
        break;
      default:
        edit(std::span(data_.shadowImages), e[1], word, value);
    }
  }
  frame = edited;
  bound(frame.options.outputFormat);
  for (PellucidImage* image :
       {&frame.frontDepth, &frame.backDepth, &frame.irradiance, &frame.hiddenIrradiance, &frame.albedo,
        &frame.material, &frame.motion, &frame.output, &frame.options.history})
    bound(image->layout);
  for (PellucidImage& image : frame.transients) bound(image.layout);
  for (PellucidImage& image : data_.shadowImages) bound(image.layout);
  // Arrays are the caller's promise: pointers are right, or NULL.
  const auto use = [&](auto& array, uint32_t& count, auto*& pointer, uint8_t isNull) {
    array.shrink_to_fit();
    count = static_cast<uint32_t>(array.size());
    pointer = header[6] & isNull ? nullptr : array.data();
  };
  use(data_.materials, frame.materialCount, frame.materials, 1);
  use(data_.lights, frame.lightCount, frame.lights, 2);
  use(data_.shadowMaps, frame.shadowMapCount, frame.shadowMaps, 4);
  use(data_.shadowImages, frame.shadowImageCount, frame.shadowImages, 8);
  data_.thesis = thesis;
  frame.options.thesis = header[6] & 32 ? nullptr : &data_.thesis;
  if (header[6] & 64) data_.ambient.assign(27, header[7] < 200 ? 0.25f : -1e30f);
  frame.options.ambient = data_.ambient.empty() ? nullptr : data_.ambient.data();
  // More light tables than there may be are refused before they are read.
  data_.lightTables.resize(PELLUCID_MAX_LIGHT_TABLES);
  frame.options.lightTables = data_.lightTables.data();
  // Else edits of materials are refused at once, as the tables are of other fields. Tables take milliseconds.
  for (size_t i = 0; header[4] & 64 && i < data_.materials.size(); ++i)
    if (i > 0 && std::memcmp(&data_.materials[i], &data_.materials[i - 1], offsetof(PellucidMaterial, tables)) == 0)
      data_.materials[i] = data_.materials[i - 1];
    else
      pellucidMakeMaterialTables(&data_.materials[i], nullptr, nullptr);
}

}  // namespace pellucid::fuzz
