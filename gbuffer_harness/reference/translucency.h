// Light through thin parts, pixel by pixel: thickness, occlusion, transmitted exitance.
#pragma once

#include <array>
#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "capture/capture.h"
#include "common/translucency_settings.h"
#include "reference/light.h"
#include "reference/surface.h"

namespace pellucid::harness::reference {

// Whelan 2009, 4.6.2: the minimum dot of a light, from a table by where the light is around the object;
// settings.minimumDot for models without a table. Throws InputError for a table that does not fit the model, or holds other values, and
// for a face along the up axis.
double minimumDot(const TranslucencySettings& settings, const Light& light);

// Light that one pixel receives from behind. Thickness in mm; irradiance and exitance RGB, summed over lights.
struct Transmission {
  std::optional<double> cameraThickness;  // ray chord between front and back depth
  std::optional<double> lightThickness;   // first light with a map that contains the pixel
  std::optional<double> usedThickness;    // the one that T(d) of the first contributing light took
  glm::dvec3 arriving{0};                 // back irradiance, shadow maps ignored
  glm::dvec3 unoccluded{0};               // the part of it that the shadow maps let by
  glm::dvec3 transmitted{0};              // sum of T(d) times the unoccluded back irradiance
};

// Value of settings.angleModel, any but NORMAL, for x, the cosine between the view ray and the direction to
// the light, -1..1. minimumDot: the light's, of the models that have one.
double angleFactor(const TranslucencySettings& settings, double x, double minimumDot);

class Translucency {
public:
  // Keeps references to the capture and the reader.
  Translucency(const Capture& capture, const SurfaceReader& surfaces, const TranslucencySettings& settings);

  // `index`: of the material, from 1.
  Transmission at(const Surface& surface, const PellucidMaterial& material, int index) const;

private:
  // A receiver in world space.
  struct Receiver {
    glm::dvec3 position, ray;
    glm::dvec3 normal;            // of the front depths at its pixel
    std::optional<double> chord;  // scene units
    int material;
    const PellucidMaterial* medium;
    const Surface* surface;
  };
  // One light's part of a Transmission.
  struct LightPath {
    double thickness = 0;  // scene units
    glm::dvec3 arriving{0};
    double reaches = 0;   // part of the texels that let it by
    double opposite = 1;  // factor of how far both faces are opposite
  };
  using Taps = std::array<ShadowView::Tap, 4>;

  Receiver toWorld(const Surface& surface, const PellucidMaterial& material, int index) const;
  double hiddenCosine(const Receiver& r, std::size_t light, const glm::dvec3& toLight) const;
  LightPath lightSpacePath(std::size_t light, const Receiver& r) const;
  LightPath cameraSpacePath(std::size_t light, const Receiver& r) const;
  LightPath thinWallPath(std::size_t light, const Receiver& r) const;
  // Part of the light that no surface but the sheet itself holds back.
  double unblockedPart(std::size_t light, const Receiver& r, double facing) const;
  std::optional<double> firstLightDistance(const Receiver& r) const;  // scene units
  bool usesLightSpace(std::size_t light) const;
  // In the first of the light's maps that contains the point.
  std::optional<Taps> texelsAround(std::size_t light, const glm::dvec3& point) const;
  // True if light enters the receiver's own medium where the map's surface is.
  static bool entersMedium(const ShadowView::Lookup& lookup, const Receiver& r);
  // True if light has left that medium before the receiver.
  static bool beyondExit(const ShadowView::Lookup& lookup, const Receiver& r, const glm::dvec3& toLight);
  // Scene units along the light that a point of a stored surface may lie off the depth of its own texel.
  static double ownTolerance(const ShadowView::Lookup& lookup, double cosine);
  // Part of the light that a texel says comes through to the receiver.
  double comesThrough(const ShadowView::Lookup& lookup, const Receiver& r, const glm::dvec3& toLight) const;
  // Scene units. `weights`: of the taps; not all 0.
  double meanThickness(const Taps& taps, const std::array<double, 4>& weights, const Receiver& r) const;
  // Part of the light that the map's texels let come to a hidden face. `facing`: cosine of the face's normal with the light.
  double litPart(std::size_t light, const Receiver& r, const glm::dvec3& backPoint, double facing) const;

  const Capture& capture_;
  const SurfaceReader& surfaces_;
  TranslucencySettings settings_;
  std::vector<std::vector<ShadowView>> shadows_;  // per light
  std::vector<double> minimumDots_;               // one per light
};

}  // namespace pellucid::harness::reference
