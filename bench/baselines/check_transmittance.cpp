// Light that comes through others' passes against their equations.
#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>

#include "baselines/kernels.h"
#include "baselines/whole_frames.h"
#include "common/compare.h"
#include "common/error.h"
#include "reference/light.h"
#include "reference/surface.h"
#include "frame_sources.h"
#include "scene/scene.h"

namespace pellucid::bench {

using namespace harness;

namespace {

using Transmitted = std::function<glm::dvec3(const glm::dvec3& position, const glm::dvec3& normal,
                                             const Light& light, double mmPerUnit)>;

// mm behind the surface of the light's map; nothing where the map says nothing.
std::optional<double> thicknessAt(const Light& light, const glm::dvec3& point, double mmPerUnit) {
  for (const ShadowMap& map : light.shadowMaps) {
    const auto lookup = reference::ShadowView(light, map).at(point);
    if (lookup.kind == reference::ShadowView::Kind::Outside) continue;
    if (lookup.kind == reference::ShadowView::Kind::Empty) return std::nullopt;
    return lookup.distance * mmPerUnit;
  }
  return std::nullopt;
}

Image evaluate(const Capture& capture, const Transmitted& transmitted) {
  const reference::SurfaceReader surfaces(capture);
  Image result = capture.irradiance;
  for (int y = 0; y < capture.height; ++y)
    for (int x = 0; x < capture.width; ++x) {
      const auto surface = surfaces.at(x, y);
      if (!surface || capture.material[reference::pixelNumber(result, x, y)] == 0) continue;
      const glm::dvec3 position = surfaces.worldFromView() * glm::dvec4(surface->position, 1);
      const glm::dvec3 normal = glm::dmat3(surfaces.worldFromView()) * surface->normal;
      for (const Light& light : capture.lights) {
        const glm::dvec3 t = transmitted(position, normal, light, surfaces.millimetersPerUnit());
        for (int c = 0; c < 3; ++c) result.at(x, y)[c] += static_cast<float>(t[c]);
      }
    }
  return result;
}

using Slab = std::function<glm::dvec3(double)>;  // T(d), d in mm

// T(d) of six Gaussians fitted to the profile.
Slab gaussianSlab(const PellucidMaterial& material) {
  return [kernel = sharedGaussians(material)](double d) {
    glm::dvec3 t(0);
    double variance = 0;
    for (const glm::vec4& gaussian : kernel) {
      variance += std::pow(static_cast<double>(gaussian.w), 2);
      t += glm::dvec3(gaussian) * std::exp(-d * d / (2 * variance));
    }
    return t;
  };
}

// e^{-d/l} / 4 + 3/4 e^{-d/3l}
Slab burleySlab(const PellucidMaterial& material) {
  return [&material](double d) {
    glm::dvec3 t(0);
    for (int c = 0; c < 3; ++c) {
      const double x = d / static_cast<double>(material.burleyDistance[c]);
      t[c] = 0.25 * std::exp(-x) + 0.75 * std::exp(-x / 3);
    }
    return t;
  };
}

struct Case {
  TransmittancePass (*pass)(const std::shared_ptr<const BenchFrame>&);
  Slab (*slab)(const PellucidMaterial&);
  double inwards;         // mm that the point is moved, before its thickness
  double wrap, wrapped;   // cosine: (wrap - N.L) times `wrapped`, 0 to 1
  double leastThickness;  // mm
};

const double kBurleyWrap = std::sin(15 * 3.14159265358979 / 180);
const Case kCases[] = {
    {&gaussianTransmittance, &gaussianSlab, 0.584, 0.3, 1, -INFINITY},
    {&burleyTransmittance, &burleySlab, 0, kBurleyWrap, 1 / std::pow(1 + kBurleyWrap, 2), 0}};

Transmitted equationOf(const Case& c, const Slab& transmittance) {
  return [&c, &transmittance](const glm::dvec3& position, const glm::dvec3& normal, const Light& light,
                              double mmPerUnit) {
    const glm::dvec3 inner = position - c.inwards / mmPerUnit * normal;
    const auto arrival = reference::arrivalAt(light, inner);
    const std::optional<double> d = thicknessAt(light, inner, mmPerUnit);
    if (!d) return glm::dvec3(0);
    const double cosine = std::clamp((c.wrap - glm::dot(normal, arrival.toLight)) * c.wrapped, 0.0, 1.0);
    return transmittance(std::max(*d, c.leastThickness)) * arrival.irradiance * cosine;
  };
}

// `image`, where there is a material, within `limit`: root mean square over the channels of the relative
// RMSE.
void requireNear(const Variant& v, const Image& image, const Image& truth, const Capture& capture,
                 double limit) {
  const Comparison c =
      compareImages(image, truth, comparisonMask(capture.material, capture.irradiance, Subset::All));
  double sum = 0;
  for (const ChannelDifference& k : c.channels) sum += k.relativeRmse * k.relativeRmse;
  const double error = std::sqrt(sum / static_cast<double>(c.channels.size()));
  if (!(error <= limit) || c.nonFiniteA > 0)
    throw DeviceError(v.name + " on \"" + capture.name + "\" is off by " + std::to_string(error));
}

Capture ear() {
  SceneParameters p{
      .name = "ear", .width = 128, .height = 128, .depthEncoding = PELLUCID_DEPTH_DEVICE, .shadowSize = 256};
  Capture capture = makeScene(p);
  p.lightType = PELLUCID_LIGHT_DIRECTIONAL;
  p.shadowEncoding = PELLUCID_DEPTH_DEVICE;
  capture.lights.push_back(makeScene(p).lights.at(0));
  capture.albedo = {};
  return withMapsAlone(std::move(capture));
}

}  // namespace

void requireRightTransmittance(Device& device, const Context& context, const PellucidMaterial& material) {
  const Capture capture = ear();
  const auto frame =
      std::make_shared<const BenchFrame>(device, context, capture, std::vector{material},
                                         transmittanceSettings(), nullptr, normalsOf(device, capture));
  for (const Case& c : kCases) {
    const Slab transmittance = c.slab(material);
    const Variant pass = c.pass(frame).variant;
    // A pixel in a hundred reads the next texel of a map, by the rounding of floats and normals of 8 bits.
    requireNear(pass, outputOf(device, pass), evaluate(capture, equationOf(c, transmittance)), capture, 1e-2);
  }
}

}  // namespace pellucid::bench
