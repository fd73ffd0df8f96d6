// Where the surfaces of a frame lay in the image of the frame before.
#pragma once

#include <glm/glm.hpp>
#include <optional>

#include "capture/capture.h"
#include "reference/camera.h"

namespace pellucid::harness::reference {

// Of surfaces that stand still in the world, seen by two cameras. The capture outlives it.
class CameraMotion {
public:
  // `clipFromView`, `viewFromWorld`: of the earlier camera, whose image has the later one's size. Throws
  // InputError for an oblique or singular projection.
  CameraMotion(const Capture& later, const Matrix& clipFromView, const Matrix& viewFromWorld);

  const Camera& earlierCamera() const { return earlierCamera_; }
  // Of what the later frame's pixel shows, in the earlier camera's view space; none where nothing is seen, or
  // behind the earlier eye.
  std::optional<glm::dvec3> earlierPlace(int x, int y) const;
  // Capture::motion of the later frame; 0 where earlierPlace() is none.
  Image image() const;

private:
  const Capture& later_;
  Camera earlierCamera_, laterCamera_;
  glm::dmat4 earlierFromLater_;
};

}  // namespace pellucid::harness::reference
