#include "domains.h"

#include <array>
#include <type_traits>

#include "material/transmittance.h"

namespace pellucid {
namespace {

// Lengths in scene units, and what matrices make of them: squares and products of two stay finite in shaders.
constexpr float kLongest = 1e15F;
// mm. A profile or thickness beyond a thousand kilometers is a mistake of units.
constexpr float kLongestMm = 1e9F;
// Irradiance and intensities: times a color and the factor of the angle they stay finite.
constexpr float kBrightest = 1e15F;

template <class Struct>
const Struct& as(const void* object) {
  return *static_cast<const Struct*>(object);
}

bool hasPosition(const void* object, uint32_t) {
  return as<PellucidLight>(object).type != PELLUCID_LIGHT_DIRECTIONAL;
}
bool readsDirection(const void* object, uint32_t) { return hasDirection(as<PellucidLight>(object)); }
bool isSpot(const void* object, uint32_t) { return as<PellucidLight>(object).type == PELLUCID_LIGHT_SPOT; }
bool readsView(const void* object, uint32_t) {
  return as<PellucidShadowMap>(object).encoding != PELLUCID_DEPTH_DEVICE;
}
bool isSolid(const void* object, uint32_t) { return as<PellucidMaterial>(object).thinWalled == 0; }
bool isThinWalled(const void* object, uint32_t) { return as<PellucidMaterial>(object).thinWalled == 1; }
bool diffuses(const void* object, uint32_t) { return as<PellucidMaterial>(object).gaussianCount > 0; }
bool isGaussian(const void* object, uint32_t index) {
  return index % PELLUCID_MAX_GAUSSIANS < as<PellucidMaterial>(object).gaussianCount;
}

#define FIELD(Struct, name) #name, offsetof(Struct, name), sizeof(static_cast <Struct*>(nullptr)->name) / 4

constexpr auto kFrameFloats = std::to_array<FloatDomain>({
    {FIELD(PellucidFrame, metersPerUnit), 1e-6F, 1e3F},
    {FIELD(PellucidFrame, clipFromView), -kLongest, kLongest},
    {FIELD(PellucidFrame, viewFromWorld), -kLongest, kLongest},
    {FIELD(PellucidFrame, options.coherenceThreshold), 0, 2},
    {FIELD(PellucidFrame, options.anchor), -kLongest, kLongest},
    {FIELD(PellucidFrame, options.motionScale), -1e6F, 1e6F},
    {FIELD(PellucidFrame, preExposure), 1e-9F, 1e9F},
});

constexpr auto kFrameIntegers = std::to_array<IntegerDomain>({
    {FIELD(PellucidFrame, options.frontDepthEncoding), 0, PELLUCID_DEPTH_VIEW_Z},
    {FIELD(PellucidFrame, options.backDepthEncoding), 0, PELLUCID_DEPTH_THICKNESS},
    {FIELD(PellucidFrame, options.cameraThickness), 0, 1},
    {FIELD(PellucidFrame, options.debugView), 0, PELLUCID_DEBUG_IRRADIANCE},
    {FIELD(PellucidFrame, options.indirectDispatches), 0, 1},
    {FIELD(PellucidFrame, options.materialShift), 0, 31},
    {FIELD(PellucidFrame, options.addToOutput), 0, 1},
    {FIELD(PellucidFrame, options.lightTableCount), 0, PELLUCID_MAX_LIGHT_TABLES},
});

constexpr auto kThesisFloats = std::to_array<FloatDomain>({
    {FIELD(PellucidThesisOptions, anglePolynomial), -1e6F, 1e6F},
    {FIELD(PellucidThesisOptions, maximumThickness), 0, kLongestMm},
    {FIELD(PellucidThesisOptions, transmittanceFilter), 0, 1},
    {FIELD(PellucidThesisOptions, objectCenter), -kLongest, kLongest},
});

constexpr auto kThesisIntegers = std::to_array<IntegerDomain>({
    {FIELD(PellucidThesisOptions, angleModel), 0, PELLUCID_ANGLE_MINIMUM_DOT},
    {FIELD(PellucidThesisOptions, constantViewDirection), 0, 1},
    {FIELD(PellucidThesisOptions, chordThickness), 0, 1},
    {FIELD(PellucidThesisOptions, prescaleAngle), 0, 1},
});

constexpr auto kMaterialFloats = std::to_array<FloatDomain>({
    {FIELD(PellucidMaterial, transmittance), -kLongestMm, kLongestMm, false, isSolid, "`thinWalled` 0", 5},
    {FIELD(PellucidMaterial, reflectance), 0, 1, true},
    {FIELD(PellucidMaterial, gaussianVariance), 0, kLongestMm* kLongestMm, true, isGaussian,
     "the first `gaussianCount` of a row", PELLUCID_MAX_GAUSSIANS},
    {FIELD(PellucidMaterial, gaussianWeight), 0, 1.001F, false, isGaussian,
     "the first `gaussianCount` of a row", PELLUCID_MAX_GAUSSIANS},
    {FIELD(PellucidMaterial, radius), 0, kLongestMm, true, diffuses, "`gaussianCount` above 0"},
    {FIELD(PellucidMaterial, burleyDistance), 0, kLongestMm, false, diffuses, "`gaussianCount` above 0"},
    {FIELD(PellucidMaterial, wallTransmittance), 0, 1, false, isThinWalled, "`thinWalled` 1"},
});

constexpr auto kMaterialIntegers = std::to_array<IntegerDomain>({
    {FIELD(PellucidMaterial, transmittanceModel), 0, kLastTransmittanceModel},
    {FIELD(PellucidMaterial, gaussianCount), 0, PELLUCID_MAX_GAUSSIANS},
    {FIELD(PellucidMaterial, thinWalled), 0, 1},
});

constexpr auto kLightFloats = std::to_array<FloatDomain>({
    {FIELD(PellucidLight, position), -kLongest, kLongest, false, hasPosition, "point and spot lights"},
    {FIELD(PellucidLight, direction), -kLongest, kLongest, false, readsDirection,
     "directional and spot lights, and with an `angleTable`"},
    {FIELD(PellucidLight, color), 0, kBrightest},
    {FIELD(PellucidLight, intensity), 0, kBrightest},
    {FIELD(PellucidLight, range), 0, kLongest, false, hasPosition, "point and spot lights"},
    // Pi/2 rounds up as a float.
    {FIELD(PellucidLight, innerConeAngle), 0, 1.5707964F, false, isSpot, "spot lights"},
    {FIELD(PellucidLight, outerConeAngle), 0, 1.5707964F, true, isSpot, "spot lights"},
    {FIELD(PellucidLight, minimumDot), -1, 0},
});

constexpr auto kLightIntegers =
    std::to_array<IntegerDomain>({{FIELD(PellucidLight, type), 0, PELLUCID_LIGHT_SPOT}});

constexpr auto kLightTableFloats = std::to_array<FloatDomain>({{FIELD(PellucidLightTable, factor), 0, 1}});

constexpr auto kMapFloats = std::to_array<FloatDomain>({
    {FIELD(PellucidShadowMap, clipFromWorld), -kLongest, kLongest},
    {FIELD(PellucidShadowMap, options.viewFromWorld), -kLongest, kLongest, false, readsView,
     "VIEW_Z and DISTANCE"},
    {FIELD(PellucidShadowMap, options.depthBiasConstant), -kLongest, kLongest},
    {FIELD(PellucidShadowMap, options.depthBiasSlope), -1e6F, 1e6F},
    {FIELD(PellucidShadowMap, options.offsetLength), 0, kLongest},
    {FIELD(PellucidShadowMap, options.depthStep), 0, kLongest},
    {FIELD(PellucidShadowMap, options.casterMaterialScale), 0, 65536},
});

constexpr auto kMapIntegers = std::to_array<IntegerDomain>({
    {FIELD(PellucidShadowMap, options.offset), 0, 65535},
    {FIELD(PellucidShadowMap, extent), 1, 65536},
    {FIELD(PellucidShadowMap, options.layer), 0, 65535},
    {FIELD(PellucidShadowMap, encoding), 0, PELLUCID_DEPTH_DISTANCE},
    {FIELD(PellucidShadowMap, options.backFaces), 0, 1},
});
#undef FIELD

}  // namespace

template <class Struct>
Domains domainsOf() {
  if constexpr (std::is_same_v<Struct, PellucidFrame>) return {kFrameFloats, kFrameIntegers};
  if constexpr (std::is_same_v<Struct, PellucidThesisOptions>) return {kThesisFloats, kThesisIntegers};
  if constexpr (std::is_same_v<Struct, PellucidMaterial>) return {kMaterialFloats, kMaterialIntegers};
  if constexpr (std::is_same_v<Struct, PellucidLight>) return {kLightFloats, kLightIntegers};
  if constexpr (std::is_same_v<Struct, PellucidLightTable>) return {kLightTableFloats, {}};
  if constexpr (std::is_same_v<Struct, PellucidShadowMap>) return {kMapFloats, kMapIntegers};
}
template Domains domainsOf<PellucidFrame>();
template Domains domainsOf<PellucidThesisOptions>();
template Domains domainsOf<PellucidMaterial>();
template Domains domainsOf<PellucidLight>();
template Domains domainsOf<PellucidLightTable>();
template Domains domainsOf<PellucidShadowMap>();

}  // namespace pellucid
