// Frames of a moving camera, of moving lights and of a body that turns.
#pragma once

#include <string>
#include <vector>

#include "raster/model.h"

namespace pellucid::harness {

// From frame to frame: the angle by which the camera, the body or the lights turn, and the part of the distance to the
// model's center by which a dolly moves.
inline constexpr double kPathDegrees = 0.5, kPathDolly = 0.01;
// Frames for which the last light of a blink stays on or off.
inline constexpr int kBlinkFrames = 6;

inline constexpr const char* kPaths[] = {"pan", "dolly", "orbit", "head", "lights", "blink"};

class CameraPath {
public:
  struct Pose {
    ModelCamera camera;
    std::vector<Light> lights;
    bool switches;  // a light goes on or off before this frame: it cannot look like the frame before
  };

  // name: one of kPaths, of the model as the camera sees it in frame 0.
  CameraPath(const std::string& name, const Model& model, const ModelCamera& camera);

  Pose at(int frame) const;

private:
  std::string name_;
  Pose still_;
  Vector3 center_;
};

}  // namespace pellucid::harness
