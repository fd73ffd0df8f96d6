// Procedural captures, made on the CPU: analytic or distance-field geometry cast in double precision.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "capture/capture.h"
#include "scene/camera.h"
#include "scene/turn.h"

namespace pellucid::harness {

// A material for all objects in place of a scene's own, and the scene's albedo with it.
struct SceneMaterial {
  MaterialSource source;
  Vector3 albedo;
};

struct SceneParameters {
  std::string name;                       // one of listScenes()
  int width = 256, height = 256;          // pixels, 1..8192
  unsigned seed = 1;                      // of the scenes that scatter things
  std::map<std::string, double> options;  // the scene's own; see SceneInfo::options

  std::optional<bool> orthographic;  // absent: as the scene prefers
  bool reversedZ = false;
  bool infiniteFar = false;                                     // perspective only
  PellucidDepthEncoding depthEncoding = PELLUCID_DEPTH_VIEW_Z;  // DEVICE or VIEW_Z

  std::optional<PellucidLightType> lightType;  // absent: as the scene prefers; same E at its center
  int shadowSize = 512;                        // texels across a shadow map; 0: no shadow maps
  PellucidDepthEncoding shadowEncoding = PELLUCID_DEPTH_VIEW_Z;

  // About the scene's center. Refused by name: the camera of an endless scene, lights of a painted one.
  Turn turn;
  std::optional<SceneMaterial> material;
};

struct SceneOption {
  std::string name;
  double defaultValue, minimum, maximum;
  std::string description;  // with the unit
};

struct SceneInfo {
  std::string name, description;
  std::vector<SceneOption> options;
};

std::vector<SceneInfo> listScenes();

// The same parameters give the same capture, bit for bit, whatever the number of threads. The scene
// unit is 1 mm. Throws InputError naming the field when a name, size, option or combination is not known.
Capture makeScene(const SceneParameters& parameters);

// World; what a Turn goes round. Throws likewise.
Vector3 sceneCenter(const SceneParameters& parameters);

}  // namespace pellucid::harness
