// Sound inputs and what seeded damage makes of them.
#include <algorithm>
#include <cstddef>
#include <random>
#include <vector>

#include "fuzz/files.h"
#include "fuzz/frame_input.h"
#include "fuzz/targets.h"
#include "unit/capture_samples.h"

namespace pellucid::fuzz {

namespace {

using harness::TemporaryDirectory;
using nlohmann::json;
using Use = std::function<void(const std::string&)>;

class Damage {
public:
  explicit Damage(const Use& use) : use_(use) {}

  void cut(const std::string& sound, int count) {
    for (int i = 0; i < count; ++i) use_(sound.substr(0, below(sound.size())));
  }
  // Up to three bits of the first `region` bytes.
  void flipBits(const std::string& sound, std::size_t region, int count) {
    for (int i = 0; i < count; ++i) {
      std::string text = sound;
      for (std::size_t k = 1 + below(3); k > 0; --k)
        text[below(std::min(region, text.size()))] ^= static_cast<char>(1 << below(8));
      use_(text);
    }
  }
  // Four bytes that are often a size, a count or a coordinate.
  void setIntegers(const std::string& sound, std::size_t region, int count) {
    const std::string values[] = {std::string(4, '\0'), std::string(4, '\xff'),
                                  std::string("\xff\xff\xff\x7f", 4), std::string("\0\0\0\x80", 4),
                                  std::string("\0\0\x01\0", 4)};
    for (int i = 0; i < count; ++i)
      use_(std::string(sound).replace(below(std::min(region, sound.size()) - 4), 4,
                                      values[below(std::size(values))]));
  }
  // Bytes of what JSON is made of, so that some results still are JSON.
  void setCharacters(const std::string& sound, int count) {
    const std::string characters = "0123456789-eE.,:\"[]{}";
    for (int i = 0; i < count; ++i) {
      std::string text = sound;
      for (std::size_t k = 1 + below(4); k > 0; --k)
        text[below(text.size())] =
            below(2) ? characters[below(characters.size())] : static_cast<char>(below(256));
      use_(text);
    }
  }
  // Every value, object and array of the document replaced by each of these, and left out, and renamed.
  void setValues(const json& sound) {
    const json values[] = {nullptr,
                           -1,
                           1e308,
                           4294967296.0,
                           "",
                           "viewZ",
                           "/dev/zero",
                           std::string(1000, 'x'),
                           json::array(),
                           json::object(),
                           std::vector<double>(1000, 1.0)};
    const json flat = sound.flatten();
    std::vector<json::json_pointer> pointers;
    for (const auto& [path, value] : flat.items())
      for (json::json_pointer pointer(path); !pointer.empty(); pointer = pointer.parent_pointer())
        if (std::find(pointers.begin(), pointers.end(), pointer) == pointers.end())
          pointers.push_back(pointer);
    for (const json::json_pointer& pointer : pointers) {
      for (const json& value : values) {
        json changed = sound;
        changed[pointer] = value;
        use_(changed.dump());
      }
      json changed = sound;
      json& parent = changed[pointer.parent_pointer()];
      if (!parent.is_object()) continue;
      const json value = parent[pointer.back()];
      parent.erase(pointer.back());
      use_(changed.dump());
      parent["unheard of"] = value;
      use_(changed.dump());
    }
  }

  std::size_t below(std::size_t count) {
    return std::uniform_int_distribution<std::size_t>(0, count - 1)(random_);
  }

private:
  const Use& use_;
  std::mt19937 random_{20240611};
};

// The box of a header's attribute becomes 0..x, 0..y.
std::string withBox(std::string exr, const std::string& attribute, std::uint32_t x, std::uint32_t y) {
  const std::string name = attribute + std::string("\0box2i\0", 7);
  const std::size_t at = exr.find(name) + name.size() + 4;  // after the size of the attribute
  const std::uint32_t box[] = {0, 0, x, y};
  return exr.replace(at, sizeof box, reinterpret_cast<const char*>(box), sizeof box);
}

void exrSeeds(Damage& damage, const Use& use) {
  const std::string capture = soundCapture(), tiles = soundTiles();
  use(capture);
  use(tiles);
  // The header, with the embedded manifest, is the part of a file that says how much to allocate.
  constexpr std::size_t kHeaderBytes = 4000;
  for (const std::string& sound : {capture, tiles}) {
    damage.cut(sound, 60);
    damage.flipBits(sound, kHeaderBytes, 100);
    damage.flipBits(sound, sound.size(), 100);
    damage.setIntegers(sound, kHeaderBytes, 150);
    for (const char* attribute : {"dataWindow", "displayWindow"})
      for (const std::uint32_t side : {0u, 1023u, 32767u, 65535u, 0x7FFFFFFEu, 0x7FFFFFFFu, 0x80000000u})
        for (const std::uint32_t other : {0u, 65535u, 0x7FFFFFFEu}) {
          use(withBox(sound, attribute, side, other));
          use(withBox(sound, attribute, other, side));
        }
  }
}

void manifestSeeds(Damage& damage, const Use& use) {
  const TemporaryDirectory folder;
  const json sound = harness::writeSampleFiles(folder);
  const std::string text = sound.dump();
  use(text);
  damage.cut(text, 50);
  damage.flipBits(text, text.size(), 100);
  use(std::string(1000000, '['));
  damage.setValues(sound);
}

void gltfSeeds(Damage& damage, const Use& use) {
  const std::string sound = soundGlb();
  use(sound);
  damage.cut(sound, 50);
  damage.flipBits(sound, sound.size(), 100);
  damage.setCharacters(sound, 200);
  // A document without its buffer, as .gltf.
  const std::size_t jsonBytes =
      static_cast<unsigned char>(sound[12]) + 256u * static_cast<unsigned char>(sound[13]);
  const json document = json::parse(sound.substr(20, jsonBytes));
  use(document.dump());
  damage.setValues(document);
}

// A tame frame's header without pointers to nothing, then edits.
void frameSeeds(Damage& damage, const Use& use) {
  const std::string header("\0\0\0\0\2\0\0\0", FrameInput::kHeaderBytes);
  use(header);
  // Every second random frame is wild.
  for (int number = 1; number < 256; ++number) use(std::string(header).replace(0, 1, 1, static_cast<char>(number)));
  for (int i = 0; i < 500; ++i) {
    std::string bytes = header;
    for (std::size_t k = 0; k < 6; ++k)
      if (damage.below(3) == 0) bytes[k] = static_cast<char>(damage.below(256));
    if (damage.below(20) == 0) bytes[6] = static_cast<char>(1 << damage.below(5));
    for (std::size_t k = damage.below(4) * damage.below(3) * FrameInput::kEditBytes; k > 0; --k)
      bytes += static_cast<char>(damage.below(256));
    use(bytes);
  }
}

}  // namespace

void forEachSeed(const std::string& target, const Use& use) {
  Damage damage(use);
  if (target == "exr")
    exrSeeds(damage, use);
  else if (target == "manifest")
    manifestSeeds(damage, use);
  else if (target == "gltf")
    gltfSeeds(damage, use);
  else if (target == "frame")
    frameSeeds(damage, use);
  else
    throw std::invalid_argument("no target is named " + target);
}

}  // namespace pellucid::fuzz
