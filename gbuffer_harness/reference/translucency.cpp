#include "reference/translucency.h"

#include <algorithm>
#include <cmath>

#include "reference/transmittance.h"

namespace pellucid::harness::reference {
namespace {

// Cosine of the light on the unseen entry face, taken antiparallel to the exit face. Without a
// normal, the cosine between the viewing ray and the light (thesis 4.2).
double angularFactor(const std::optional<glm::dvec3>& normal, const glm::dvec3& ray,
                     const glm::dvec3& toLight) {
  return std::max(0.0, normal ? -glm::dot(*normal, toLight) : glm::dot(ray, toLight));
}

}  // namespace

Translucency::Translucency(const Capture& capture, const SurfaceReader& surfaces,
                           PellucidThicknessSource source, double shadowBias)
    : capture_(capture), surfaces_(surfaces), source_(source), shadowBias_(shadowBias) {
  for (const Light& light : capture.lights) {
    shadows_.emplace_back();
    if (light.shadowMap) shadows_.back().emplace(light, *light.shadowMap);
  }
}

Translucency::Receiver Translucency::toWorld(const Surface& s) const {
  const glm::dmat4& m = surfaces_.worldFromView();
  const glm::dmat3 rotation(m);
  Receiver r{glm::dvec3(m * glm::dvec4(s.position, 1)), rotation * s.ray, std::nullopt, s.chord};
  if (s.normal) r.normal = rotation * *s.normal;
  return r;
}

bool Translucency::usesLightSpace(std::size_t light) const {
  return shadows_[light] && source_ == PELLUCID_THICKNESS_LIGHT;
}

Translucency::LightPath Translucency::lightSpacePath(std::size_t light, const Receiver& r) const {
  const Arrival arrival = arrivalAt(capture_.lights[light], r.position);
  LightPath path;
  path.arriving = arrival.irradiance * angularFactor(r.normal, r.ray, arrival.toLight);
  const ShadowView::Lookup lookup = shadows_[light]->at(r.position);
  path.reaches = lookup.kind == ShadowView::Kind::Surface;
  path.thickness = std::max(0.0, lookup.distance);
  return path;
}

bool Translucency::backPointLit(std::size_t light, const glm::dvec3& backPoint) const {
  if (!shadows_[light]) return true;
  const ShadowView::Lookup lookup = shadows_[light]->at(backPoint);
  return lookup.kind == ShadowView::Kind::Surface && lookup.distance <= shadowBias_;
}

Translucency::LightPath Translucency::cameraSpacePath(std::size_t light, const Receiver& r) const {
  LightPath path;
  if (!r.chord) return path;
  const glm::dvec3 backPoint = r.position + *r.chord * r.ray;
  const Arrival arrival = arrivalAt(capture_.lights[light], backPoint);
  path.arriving = arrival.irradiance * angularFactor(r.normal, r.ray, arrival.toLight);
  path.reaches = backPointLit(light, backPoint);
  path.thickness = *r.chord * (r.normal ? std::abs(glm::dot(*r.normal, r.ray)) : 1);
  return path;
}

std::optional<double> Translucency::firstLightDistance(const Receiver& r) const {
  for (const std::optional<ShadowView>& shadow : shadows_) {
    if (!shadow) continue;
    const ShadowView::Lookup lookup = shadow->at(r.position);
    if (lookup.kind == ShadowView::Kind::Surface) return std::max(0.0, lookup.distance);
    if (lookup.kind == ShadowView::Kind::Empty) return std::nullopt;
  }
  return std::nullopt;
}

Transmission Translucency::at(const Surface& surface, const PellucidMaterial& material) const {
  const double mmPerUnit = surfaces_.millimetersPerUnit();
  const Receiver receiver = toWorld(surface);
  Transmission t;
  if (receiver.chord) t.cameraThickness = *receiver.chord * mmPerUnit;
  if (const auto distance = firstLightDistance(receiver)) t.lightThickness = *distance * mmPerUnit;
  for (std::size_t i = 0; i < capture_.lights.size(); ++i) {
    const LightPath path = usesLightSpace(i) ? lightSpacePath(i, receiver) : cameraSpacePath(i, receiver);
    t.arriving += path.arriving;
    if (!path.reaches) continue;
    const double thickness = path.thickness * mmPerUnit;
    t.unoccluded += path.arriving;
    t.transmitted += transmittance(material, thickness) * path.arriving;
    if (!t.usedThickness && path.arriving != glm::dvec3(0)) t.usedThickness = thickness;
  }
  return t;
}

}  // namespace pellucid::harness::reference
