// One captured frame in memory: what a manifest (version 1) and its EXR files hold, decoded.
// Everything that makes or replays frames speaks this type; only capture/ knows the files.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "common/image.h"
#include "pellucid/pellucid.h"

namespace pellucid::harness {

using Matrix = std::array<double, 16>;  // column-major, column vectors, Vulkan clip space

inline constexpr Matrix kIdentity = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};

// Depth value at which a viewZ or distance image holds nothing (manifest: >= 1e9).
inline constexpr float kNoDepth = 1e10f;
// Stored distances from here on say that nothing is there.
inline constexpr float kLeastNoDepth = 1e9f;
// False where a thickness in mm is not known.
inline bool holdsThickness(float mm) { return mm >= 0 && mm < kLeastNoDepth; }

struct DepthImage {
  Image image;  // one channel; empty: the capture has none
  PellucidDepthEncoding encoding = PELLUCID_DEPTH_VIEW_Z;
};

// The fields of PellucidShadowMap of these names. Images have the size of the map's tile.
struct ShadowMap {
  DepthImage depth;
  Matrix clipFromWorld = kIdentity;
  std::optional<Matrix> viewFromWorld;  // required for VIEW_Z and DISTANCE
  // The images of PellucidShadowMap of these names, in the size of `depth`; empty: not given.
  Image exitDepth;                           // one channel, in depth's encoding
  std::vector<std::uint8_t> casterMaterial;  // index; 0: opaque, or nothing there
  bool backFaces = false;
  double depthBiasConstant = 0, depthBiasSlope = 0, offsetLength = 0, depthStep = 0;
  // Maps of one number are tiles and layers of one image; -1: an image of its own.
  int sharedImage = -1;
  std::array<int, 2> offset = {0, 0};
  int layer = 0;
};

struct Light {
  PellucidLightType type = PELLUCID_LIGHT_DIRECTIONAL;
  std::array<double, 3> position = {0, 0, 0};
  std::array<double, 3> direction = {0, 0, -1};  // of travel
  std::array<double, 3> color = {1, 1, 1};
  double intensity = 1;
  double range = 0;
  double radius = 0;  // scene units; > 0: a point light that is a sphere, which only truth sees as one
  double innerConeAngle = 0, outerConeAngle = 0.785;
  // Factors as PellucidLightTable has them, by angle and by distance; empty: none.
  std::vector<double> angleTable, distanceTable;
  // Largest difference of these from the factors that a file gave, which may be more of them.
  double angleTableError = 0, distanceTableError = 0;
  // A receiver's is the first that contains it: six of a cube, or cascades. Up to
  // PELLUCID_MAX_LIGHT_SHADOW_MAPS; none: nothing shadows the light.
  std::vector<ShadowMap> shadowMaps;
};

// How a manifest describes a material. Coefficients are stored in 1/mm whatever unit the file used.
struct PresetMaterial {
  std::string preset;
};
struct CoefficientMaterial {
  std::array<double, 3> scattering, absorption;  // 1/mm; scattering is sigma_s before similarity
  double g = 0, ior = 1.4;
};
// Profile given directly, with T(d) = a1 e^{-k1 d} + a2 e^{-k2 d} or, absent, Burley's own slab
// 1/4 e^{-d/l} + 3/4 e^{-d/3l}.
struct BurleyMaterial {
  std::array<double, 3> distance;                                     // mm
  std::optional<std::array<std::array<double, 4>, 3>> transmittance;  // per channel a1, k1, a2, k2
};
struct GaussianMaterial {
  std::vector<double> variance;               // mm^2, shared by the channels
  std::vector<std::array<double, 3>> weight;  // RGB per Gaussian
};
// A sheet without thickness: parts of the irradiance of a face that leave by it and by the other, [0, 1],
// with a sum of at most 1.
struct ThinWallMaterial {
  std::array<double, 3> reflectance, transmittance;
  std::optional<std::array<double, 3>> distance;  // mm, of Burley's profile within the sheet; absent: none
};
// The fields of PellucidOpenPbr; the radius in mm.
struct OpenPbrMaterial {
  std::array<double, 3> color = {0.8, 0.8, 0.8};
  double radius = 1;
  std::array<double, 3> radiusScale = {1, 0.5, 0.25};
  double anisotropy = 0, ior = 1.5;
  bool operator==(const OpenPbrMaterial&) const = default;
};
// The fields of PELLUCID_MATERIAL_SKIN, under D65.
struct SkinMaterial {
  double melanin = 0.005, melaninType = 0.5, hemoglobin = 0.005, ior = 1.4;
  bool operator==(const SkinMaterial&) const = default;
};
using MaterialSource = std::variant<PresetMaterial, CoefficientMaterial, BurleyMaterial, GaussianMaterial,
                                    ThinWallMaterial, OpenPbrMaterial, SkinMaterial>;

// A result to compare with.
struct Truth {
  Image image;          // RGB, already times scale
  Image standardError;  // of image, RGB, likewise; empty: not known
  // How `pellucid truth` made it, so that it can go on: samples of each pixel, and what they are of.
  std::uint64_t samples = 0, seed = 0;
  std::string scene;  // empty: made elsewhere
};

// RGB of the coefficients of PellucidFrameOptions::ambient.
using Harmonics = std::array<std::array<double, 3>, 9>;

struct Capture {
  std::string name;  // path it came from, or the scene's name
  int width = 0, height = 0;
  double metersPerUnit = 1;
  Matrix clipFromView = kIdentity, viewFromWorld = kIdentity;

  DepthImage frontDepth;  // required
  DepthImage backDepth;
  Image irradiance;        // RGB; required
  Image hiddenIrradiance;  // RGB; of light from all around where backDepth lies
  // RG: what a surface's place in the image has changed by since the frame before, in parts of width and
  // height; empty: nothing moved.
  Image motion;
  Image albedo;                        // RGB
  std::vector<std::uint8_t> material;  // required; 0 none, i: materials[i - 1]

  std::vector<Light> lights;
  std::optional<Harmonics> environment;  // light from all around; irradiance has it on visible faces
  std::vector<MaterialSource> materials;
  std::optional<Truth> truth;

  std::vector<std::string> warnings;         // sentences for a person: what its files say and no capture holds
  std::vector<std::filesystem::path> files;  // that it was read from
};

}  // namespace pellucid::harness
