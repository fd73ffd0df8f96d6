// The transmittance passes against their equations in float64.
#include <cmath>

#include "baselines/kernels.h"
#include "baselines/whole_frames.h"
#include "common/error.h"
#include "diffusions.h"
#include "reference/light.h"
#include "reference/surface.h"
#include "scene.h"
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
      if (!surface || !surface->normal ||
          capture.material[static_cast<size_t>(y) * static_cast<size_t>(capture.width) +
                           static_cast<size_t>(x)] == 0)
        continue;
      const glm::dvec3 position = surfaces.worldFromView() * glm::dvec4(surface->position, 1);
      const glm::dvec3 normal = glm::dmat3(surfaces.worldFromView()) * *surface->normal;
      for (const Light& light : capture.lights) {
        const glm::dvec3 t = transmitted(position, normal, light, surfaces.millimetersPerUnit());
        for (int c = 0; c < 3; ++c) result.at(x, y)[c] += static_cast<float>(t[c]);
      }
    }
  return result;
}

// Jimenez et al. 2010, over six Gaussians fitted to the profile.
Transmitted sixGaussians(const PellucidMaterial& material) {
  return [kernel = sharedGaussians(material)](const glm::dvec3& position, const glm::dvec3& normal,
                                              const Light& light, double mmPerUnit) {
    const glm::dvec3 inner = position - 0.584 / mmPerUnit * normal;
    const auto arrival = reference::arrivalAt(light, inner);
    const std::optional<double> d = thicknessAt(light, inner, mmPerUnit);
    glm::dvec3 t(0);
    if (!d) return t;
    double variance = 0;
    for (const glm::vec4& gaussian : kernel) {
      variance += std::pow(static_cast<double>(gaussian.w), 2);
      t += glm::dvec3(gaussian) * std::exp(-*d * *d / (2 * variance));
    }
    return t * arrival.irradiance * std::clamp(0.3 - glm::dot(normal, arrival.toLight), 0.0, 1.0);
  };
}

// HDRP: e^{-d/l} / 4 + 3/4 e^{-d/3l} under a cosine that wraps around by 15 degrees.
Transmitted burleySlab(const PellucidMaterial& material) {
  return [&material](const glm::dvec3& position, const glm::dvec3& normal, const Light& light,
                     double mmPerUnit) {
    const auto arrival = reference::arrivalAt(light, position);
    const std::optional<double> d = thicknessAt(light, position, mmPerUnit);
    glm::dvec3 t(0);
    if (!d) return t;
    for (int c = 0; c < 3; ++c) {
      const double x = std::max(*d, 0.0) / static_cast<double>(material.burleyDistance[c]);
      t[c] = 0.25 * std::exp(-x) + 0.75 * std::exp(-x / 3);
    }
    const double w = std::sin(15 * 3.14159265358979 / 180);
    const double cosine = (w - glm::dot(normal, arrival.toLight)) / ((1 + w) * (1 + w));
    return t * arrival.irradiance * std::clamp(cosine, 0.0, 1.0);
  };
}

// Both stages of the slab's answer are closed: its light comes from straight behind, through its thickness.
void requireSlab(const Variant& v, const Image& image, const Capture& c, const glm::dvec3& expected) {
  for (int k = 0; k < 3; ++k) {
    const double got = static_cast<double>(image.data[static_cast<size_t>(k)]),
                 right = static_cast<double>(c.irradiance.data[static_cast<size_t>(k)]) + expected[k];
    if (!(std::abs(got - right) < 2e-3 * right))  // halves, twice, and normals of 8 bits
      throw DeviceError(v.name + " on a slab gives " + std::to_string(got) + " and not " +
                        std::to_string(right));
  }
}

Capture ear() {
  SceneParameters p;
  p.name = "ear";
  p.width = p.height = 128;
  p.shadowSize = 512;
  p.depthEncoding = PELLUCID_DEPTH_DEVICE;
  Capture capture = makeScene(p);
  Light directional;
  directional.shadowMaps = {};
  p.lightType = PELLUCID_LIGHT_DIRECTIONAL;
  p.shadowEncoding = PELLUCID_DEPTH_DEVICE;
  capture.lights.push_back(makeScene(p).lights.at(0));
  capture.albedo = {};
  return capture;
}

}  // namespace

void requireRightTransmittance(Device& device, const Context& context, const PellucidMaterial& material) {
  const Site site{device, context, material, 0.1};
  struct Case {
    TransmittancePass (*pass)(const std::shared_ptr<const BenchFrame>&);
    Transmitted equation;
    double wrappedCosine, innerShift;  // of light from straight behind; mm
  };
  const double w = std::sin(15 * 3.14159265358979 / 180);
  const Case cases[] = {{&gaussianTransmittance, sixGaussians(material), 1, 0.584},
                        {&burleyTransmittance, burleySlab(material), 1 / (1 + w), 0}};
  const Capture slabCapture = slab(64, 48, 1, site.pixel), earCapture = ear();
  for (const Case& c : cases) {
    const auto run = [&](const Capture& capture) {
      const TransmittancePass pass = c.pass(site.frame(capture, transmittanceSettings()));
      return std::pair(pass.variant, site.run(pass.variant));
    };
    const auto [onSlab, slabImage] = run(slabCapture);
    const double d = slabThickness(slabCapture) - c.innerShift;
    glm::dvec3 t(0);
    if (c.innerShift > 0) {
      double variance = 0;
      for (const glm::vec4& g : sharedGaussians(material)) {
        variance += std::pow(static_cast<double>(g.w), 2);
        t += glm::dvec3(g) * std::exp(-d * d / (2 * variance));
      }
    } else {
      for (int k = 0; k < 3; ++k) {
        const double x = d / static_cast<double>(material.burleyDistance[k]);
        t[k] = 0.25 * std::exp(-x) + 0.75 * std::exp(-x / 3);
      }
    }
    requireSlab(onSlab, slabImage, slabCapture, c.wrappedCosine * t);
    const auto [onEar, earImage] = run(earCapture);
    // A pixel in a hundred reads the next texel of a map, by the rounding of floats and normals of 8 bits.
    requireNear(onEar, earImage, evaluate(earCapture, c.equation), earCapture, 1e-2);
  }
}

}  // namespace pellucid::bench
