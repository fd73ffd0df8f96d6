// Motion vectors of a moving camera.
#pragma once

#include <glm/glm.hpp>
#include <optional>

#include "capture/capture.h"
#include "reference/camera.h"

namespace pellucid::harness::reference {

// The motion of surfaces that stand still in the world, between the images of two cameras. The capture
// outlives the object.
class CameraMotion {
public:
  // `clipFromView`, `viewFromWorld`: of the earlier camera, whose image has the later one's size. Throws
  // InputError for an oblique or singular projection.
  CameraMotion(const Capture& later, const Matrix& clipFromView, const Matrix& viewFromWorld);

  const Camera& earlierCamera() const { return earlierCamera_; }
  // The place of the surface that the later frame's pixel shows, in the earlier camera's view space; none
  // where the pixel shows no surface, or where the place lies behind the earlier eye.
  std::optional<glm::dvec3> earlierPlace(int x, int y) const;
  // Capture::motion of the later frame; 0 where earlierPlace() is none.
  Image image() const;

private:
  const Capture& later_;
  Camera earlierCamera_, laterCamera_;
  glm::dmat4 earlierFromLater_;
};

}  // namespace pellucid::harness::reference
