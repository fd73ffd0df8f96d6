#include "reference/camera_motion.h"

#include "scene/vector.h"

namespace pellucid::harness::reference {

CameraMotion::CameraMotion(const Capture& later, const Matrix& clipFromView, const Matrix& viewFromWorld)
    : later_(later),
      earlierCamera_(clipFromView, later.width, later.height),
      laterCamera_(later.clipFromView, later.width, later.height),
      earlierFromLater_(toGlm(viewFromWorld) * glm::inverse(toGlm(later.viewFromWorld))) {}

std::optional<glm::dvec3> CameraMotion::earlierPlace(int x, int y) const {
  const std::optional<double> depth =
      laterCamera_.planarDepth(*later_.frontDepth.image.at(x, y), later_.frontDepth.encoding);
  if (!depth) return std::nullopt;
  const glm::dvec3 place(earlierFromLater_ *
                         glm::dvec4(laterCamera_.position({x + 0.5, y + 0.5}, *depth), 1));
  if (!earlierCamera_.orthographic() && !(earlierCamera_.planarDepth(place) > 0)) return std::nullopt;
  return place;
}

Image CameraMotion::image() const {
  Image motion(later_.width, later_.height, 2);
  const glm::dvec2 extent(later_.width, later_.height);
  for (int y = 0; y < later_.height; ++y)
    for (int x = 0; x < later_.width; ++x) {
      const std::optional<glm::dvec3> place = earlierPlace(x, y);
      if (!place) continue;
      const glm::dvec2 moved = (glm::dvec2(x + 0.5, y + 0.5) - earlierCamera_.project(*place)) / extent;
      motion.at(x, y)[0] = static_cast<float>(moved.x);
      motion.at(x, y)[1] = static_cast<float>(moved.y);
    }
  return motion;
}

}  // namespace pellucid::harness::reference
