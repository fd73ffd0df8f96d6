// A manifest for EXR files that another program wrote: which channels are the buffers of a capture, what the
// camera's matrices are, and, in the manifest, what could not be known.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "capture/exr.h"
#include "scene/camera.h"

namespace pellucid::harness {

// Channels of one layer.
struct ChannelGroup {
  std::filesystem::path file;
  int part = 0;
  std::string name;      // of the layer; else of the part, or of the file without extension
  bool isNamed = false;  // by a layer
  std::string view;      // of stereo files; empty: of all
  bool hasBeside = false;  // the file has several parts
  // Full names: of a color R, G, B, of a vector X, Y, Z, else of each channel by itself.
  std::vector<std::string> channels;
  std::string partName = "";  // empty: it has none
};

// The groups of all files, of which none is empty. Alpha is left out, and so are Cryptomatte's. Throws
// InputError.
std::vector<ChannelGroup> survey(const std::vector<std::filesystem::path>& files);

// The channels of a group as one image. Throws InputError.
Image readGroup(const ChannelGroup& group);

enum class Role { FrontDepth, BackDepth, Irradiance, Albedo, Material };

// The key of a manifest's "buffers".
const char* roleName(Role role);

struct Guess {
  ChannelGroup group;  // its first channel, of depths and materials
  std::string why;     // a sentence's end: "its name is that of ..."
  std::string doubt;   // what it would take to be sure; empty: nothing
  double scale = 1;
  bool includesAlbedo = false;
  double metersPerUnit = 0;  // 0: the name says nothing
};

// True of three channels that differ, so that none of them is the number of the pixel.
using IsColor = std::function<bool(Role, const ChannelGroup&)>;
inline constexpr const char* kIsColor = "its R, G and B differ: a color, no number";

// By names that Blender, Arnold, Nuke, V-Ray, Unreal, Unity, RenderDoc and this program use. Depths of files or layers that are
// named "back" are back depths. `given`: the person's own, layer, channel, file without extension, or file:layer. Empty `isColor`:
// no pixels are read. Throws UsageError for a name that is not there, or that several groups have.
std::map<Role, Guess> guessRoles(const std::vector<ChannelGroup>& groups, const std::map<Role, std::string>& given,
                                 const IsColor& isColor = {});

// Statements of the person; all are optional.
struct CameraWords {
  std::optional<double> verticalFov;          // degrees
  std::optional<double> orthographicHeight;   // scene units
  std::optional<double> nearPlane, farPlane;  // scene units
  std::optional<bool> reversedZ;
  std::optional<Vector3> eye, target;
  Vector3 up = {0, 1, 0};
};

// Facts that the depths tell.
struct DepthFacts {
  bool isDevice = false, looksReversed = true;
  double nearest = 1;  // planar distance; of viewZ
};

struct GuessedCamera {
  Matrix clipFromView = kIdentity, viewFromWorld = kIdentity;
  std::string why;                   // where the projection is from
  std::vector<std::string> unknown;  // sentences: what had to be assumed
  bool isPlaced = false;             // viewFromWorld is known
};

// A part whose header may have a camera.
struct CameraSource {
  std::filesystem::path file;
  int part = 0;
  bool isUsed = false;  // a buffer is of it
};

// From `words`, else from the OpenEXR attributes worldToCamera, worldToNDC and screenWindowWidth of the first source that has them.
// Throws UsageError, which names the option, where neither says the projection, and InputError for attributes that are no camera's,
// or of which used sources have others.
GuessedCamera guessCamera(const std::vector<CameraSource>& sources, int width, int height, const CameraWords& words,
                          const DepthFacts& depth);

struct InitWords {
  CameraWords camera;
  std::map<Role, std::string> roles;
  std::optional<bool> deviceDepth;
  std::optional<double> irradianceScale, metersPerUnit;
  std::vector<int> materialIds;                // stored values that are translucent; empty: all but 0
  std::string material = "skin1";              // of parseMaterial()
  std::vector<nlohmann::ordered_json> lights;  // as in a manifest
};

struct GuessedManifest {
  nlohmann::ordered_json json;       // keys that begin with // are sentences for a person
  std::vector<std::string> found;    // a line for each buffer: what it is and why
  std::vector<std::string> missing;  // what would make the picture better, the most important first
};

// Paths in the manifest are relative to `folder`. Throws UsageError where words are missing, and InputError
// for files that cannot be a capture: without a depth or a color, or of several sizes.
GuessedManifest guessManifest(const std::vector<std::filesystem::path>& files,
                              const std::filesystem::path& folder, const InitWords& words);

}  // namespace pellucid::harness
