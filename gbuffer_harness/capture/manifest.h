// The capture manifest, version 1, as written: what it says and where the pixels are, before any pixel is
// read.
#pragma once

#include <array>
#include <filesystem>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "capture/capture.h"

namespace pellucid::harness {

// As manifests spell it.
const char* encodingName(PellucidDepthEncoding encoding);

// Where one buffer's numbers come from.
struct BufferSource {
  std::string field;                  // JSON path, for messages
  std::filesystem::path file;         // absolute or relative to the working directory; empty for a constant
  std::optional<int> part;            // absent: the one part that has the channels
  std::vector<std::string> channels;  // full EXR names, layer included
  std::vector<double> constant;       // the same value in every pixel, instead of a file
  double scale = 1;                   // of what is stored, > 0; distances >= kLeastNoDepth stay

  bool isConstant() const { return !constant.empty(); }
};

// Stored material values are read as floats: these are the integers that a float counts without gaps.
inline constexpr int kMaxStoredMaterial = 1 << 24;  // of either sign

// String attribute of an EXR that embeds its manifest.
inline constexpr const char* kManifestAttribute = "pellucid.manifest";

using MaterialMap = std::map<int, int>;  // stored value -> material index; empty: the value is the index
// Key of every value that the map does not name, whole or not: "*" in a manifest.
inline constexpr int kOtherValues = std::numeric_limits<int>::min();

// Where a shadow map and what lies beside it come from.
struct ShadowSources {
  BufferSource depth;
  std::optional<BufferSource> exit, casterMaterial;
  MaterialMap casterMaterialMap;
  std::optional<std::array<int, 2>> tile;  // size, from ShadowMap::offset on; absent: the whole image
};

struct Manifest {
  std::filesystem::path path;
  Capture capture;  // everything but the images and the size

  BufferSource frontDepth, irradiance, material;
  std::optional<BufferSource> backDepth, hiddenIrradiance, motion, albedo, truth, truthStandardError;
  std::array<double, 2> motionScale = {1, 1};               // by which reading multiplies the motion
  std::optional<BufferSource> irradianceTimes, truthTimes;  // by which reading multiplies the other
  std::vector<std::vector<ShadowSources>> shadowMaps;       // per light, as Light::shadowMaps
  MaterialMap materialMap;
  bool hasNormal = false;                 // a buffer of normals, which nothing reads
  bool irradianceIncludesAlbedo = false;  // by which reading divides it
};

// Reads `path`: a JSON manifest, or an EXR with one in the string attribute `pellucid.manifest`; the
// file's first bytes tell which. Throws InputError naming file, field and value.
// No pixel is read.
Manifest readManifest(const std::filesystem::path& path);

}  // namespace pellucid::harness
