#include "scene/turn.h"

#include <cmath>

#include "scene/vector.h"

namespace pellucid::harness {

namespace {

glm::dmat4 aboutY(double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return {c, 0, -s, 0, 0, 1, 0, 0, s, 0, c, 0, 0, 0, 0, 1};
}

}  // namespace

Matrix turnedView(const Matrix& viewFromWorld, const Vector3& center, double angle) {
  if (angle == 0) return viewFromWorld;
  glm::dmat4 fromCenter(1), toCenter(1);
  fromCenter[3] = {toGlm(center), 1};
  toCenter[3] = {-toGlm(center), 1};
  return fromGlm(toGlm(viewFromWorld) * fromCenter * aboutY(-angle) * toCenter);
}

Light turnedLight(const Light& light, const Vector3& center, double angle) {
  Light turned = light;
  turned.shadowMaps.clear();
  if (angle == 0) return turned;
  const glm::dmat3 rotation(aboutY(angle));
  turned.position = fromGlm(toGlm(center) + rotation * (toGlm(light.position) - toGlm(center)));
  turned.direction = fromGlm(rotation * toGlm(light.direction));
  return turned;
}

}  // namespace pellucid::harness
