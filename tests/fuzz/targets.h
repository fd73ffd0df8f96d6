// Fuzz targets. Each function takes any bytes: it returns, or throws BrokenPromise where the code under
// test answers otherwise than documented. A crash, a sanitizer's report and a hang are findings, too.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <stdexcept>
#include <string>

namespace pellucid::fuzz {

struct BrokenPromise : std::logic_error {
  using std::logic_error::logic_error;
};

inline void require(bool holds, const std::string& promise) {
  if (!holds) throw BrokenPromise(promise);
}

// True: accepted; false: refused with a sentence.
bool fuzzFrame(std::span<const uint8_t> bytes);     // edits of a frame's structs: frame_input.h
bool fuzzExr(std::span<const uint8_t> bytes);       // an EXR file, as image and as capture
bool fuzzManifest(std::span<const uint8_t> bytes);  // a capture's JSON manifest, beside sound EXR files
bool fuzzGltf(std::span<const uint8_t> bytes);      // a .glb or .gltf file

struct Target {
  const char* name;
  bool (*run)(std::span<const uint8_t>);
};
inline constexpr Target kTargets[] = {{"frame", fuzzFrame},
                                      {"exr", fuzzExr},
                                      {"manifest", fuzzManifest},
                                      {"gltf", fuzzGltf}};

// Small inputs, most of them broken, in an order and with contents that never change. The first is sound.
void forEachSeed(const std::string& target, const std::function<void(const std::string&)>& use);

}  // namespace pellucid::fuzz
