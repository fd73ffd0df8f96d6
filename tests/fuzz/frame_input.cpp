#include "fuzz/frame_input.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <limits>

#include "frame_fixture.h"

namespace pellucid::fuzz {

namespace {

constexpr uint32_t kFew = 5;

// Few of each mostly; from 240 on many, up to `most`.
uint32_t countOf(uint8_t byte, uint32_t most) {
  return byte < 240 ? byte % (kFew + 1) : (byte - 239u) * most / 16u;
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

  const test::Frame valid(1);
  frame = valid.frame;
  thesis_ = valid.thesis;
  materials_.assign(countOf(header[0], 256), valid.material);
  const uint32_t lights = countOf(header[1], 340), maps = countOf(header[2], 340);
  maps_.assign(maps, valid.maps[0]);
  images_.assign(countOf(header[3], 680), test::Frame::view());
  for (uint32_t i = 0; i < maps && !images_.empty(); ++i)
    maps_[i].image = i % static_cast<uint32_t>(images_.size());
  for (uint32_t i = 0; i < lights; ++i) lights_.push_back(test::Frame::light(i, i < maps ? 1 : 0));
  for (PellucidImage& image : frame.transients)
    if (header[4] & 1) image = test::Frame::view();
  if (header[4] & 4) frame.albedo = test::Frame::view();
  if (header[4] & 64) frame.hiddenIrradiance = test::Frame::view();
  if (header[4] & 8) frame.backDepth = {};
  if (header[4] & 16) frame.options.history = test::Frame::view();
  if (header[4] & 32) frame.options.gatherSamples = 8;
  choice = header[5];

  PellucidFrame edited = frame;
  PellucidThesisOptions thesis = thesis_;
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
        edit(std::span(materials_), e[1], word, value);
        break;
      case 5:
        edit(std::span(lights_), e[1], word, value);
        break;
      case 6:
        edit(std::span(maps_), e[1], word, value);
        break;
      default:
        edit(std::span(images_), e[1], word, value);
    }
  }
  frame = edited;
  bound(frame.options.outputFormat);
  for (PellucidImage* image :
       {&frame.frontDepth, &frame.backDepth, &frame.irradiance, &frame.hiddenIrradiance, &frame.albedo,
        &frame.material, &frame.output, &frame.options.history})
    bound(image->layout);
  for (PellucidImage& image : frame.transients) bound(image.layout);
  for (PellucidImage& image : images_) bound(image.layout);
  // Arrays are the caller's promise: pointers are right, or NULL.
  const auto use = [&](auto& array, uint32_t& count, auto*& pointer, uint8_t isNull) {
    array.shrink_to_fit();
    count = static_cast<uint32_t>(array.size());
    pointer = header[6] & isNull ? nullptr : array.data();
  };
  use(materials_, frame.materialCount, frame.materials, 1);
  use(lights_, frame.lightCount, frame.lights, 2);
  use(maps_, frame.shadowMapCount, frame.shadowMaps, 4);
  use(images_, frame.shadowImageCount, frame.shadowImages, 8);
  thesis_ = thesis;
  ambient_.assign(27, header[7] < 200 ? 0.25f : -1e30f);
  frame.options.ambient = header[6] & 64 ? ambient_.data() : nullptr;
  frame.options.thesis = header[6] & 32 ? nullptr : &thesis_;
  // More light tables than there may be are refused before they are read.
  lightTables_.resize(PELLUCID_MAX_LIGHT_TABLES);
  frame.options.lightTables = lightTables_.data();
  // Else the edits are refused at once, as the tables are of other fields.
  if (header[4] & 64)
    for (PellucidMaterial& material : materials_) pellucidMakeMaterialTables(&material, nullptr, nullptr);
}

}  // namespace pellucid::fuzz
