// Casts a scene model into the images of a capture.
#pragma once

#include "scene/model.h"

namespace pellucid::harness {

// Where a ray first enters an object, and where it leaves the union of that object and those
// overlapping it.
struct Hit {
  const Object* object;
  double enter, exit;
};
std::optional<Hit> firstHit(const std::vector<Object>& objects, const Ray& ray, double tMin);

// Whether the light reaches the surface point, by casting a ray. `bias`: length by which the ray is
// lifted off the surface along the normal.
bool reaches(const std::vector<Object>& objects, const Light& light, const glm::dvec3& point,
             const glm::dvec3& normal, double bias);

// E of a light that nothing blocks, at a point of the given outward normal (KHR_lights_punctual).
glm::dvec3 unshadowedIrradiance(const Light& light, const glm::dvec3& point, const glm::dvec3& normal);

// The capture of a scene model, whose parameters say size and encodings.
Capture renderCapture(const SceneModel& model, const SceneParameters& parameters);

}  // namespace pellucid::harness
