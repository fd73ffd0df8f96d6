// The matrices of a camera that nobody wrote down as such.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "scene/camera.h"

namespace pellucid::harness {

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

// From `words`, else from the OpenEXR attributes worldToCamera, worldToNDC and screenWindowWidth of the
// files. Throws UsageError, which names the option, where neither says the projection, and InputError for
// attributes that are no camera's.
GuessedCamera guessCamera(const std::vector<std::filesystem::path>& files, int width, int height,
                          const CameraWords& words, const DepthFacts& depth);

}  // namespace pellucid::harness
