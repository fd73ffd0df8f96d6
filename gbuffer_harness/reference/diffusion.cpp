#include "reference/diffusion.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "common/error.h"
#include "reference/profile.h"

namespace pellucid::harness::reference {
namespace {

// Distances in pixels up to which footprints are integrated exactly, and with 2x2 points. Beyond, the
// center alone misses (size / distance)^2 / 24 of a footprint's energy, 1e-4, where the profile goes like
// 1/r, and (size / d)^2 / 24 in its exponential tail, where little energy is left.
constexpr int kIntegrated = 3;
constexpr int kSampled = 20;

std::array<Profile, 3> threeChannels(const std::array<std::optional<Profile>, 3>& channels,
                                     const Profile& filler) {
  return {channels[0].value_or(filler), channels[1].value_or(filler), channels[2].value_or(filler)};
}

}  // namespace

struct Diffusion::Sums {
  ProfileTable::Lanes energy{0}, weight{0};

  void add(const Sums& other) {
    weight += other.weight;
    energy += other.energy;
  }
  void add(const ProfileTable::Lanes& w, const ProfileTable::Lanes& irradiance) {
    weight += w;
    energy += w * irradiance;
  }
};

Diffusion::Diffusion(const Capture& capture, const SurfaceReader& surfaces,
                     const std::vector<PellucidMaterial>& materials,
                     const std::vector<glm::dvec3>& irradiance, double discardedEnergy)
    : capture_(capture),
      surfaces_(surfaces),
      irradiance_(irradiance),
      mmPerUnit_(surfaces.millimetersPerUnit()) {
  for (std::size_t i = 0; i < materials.size(); ++i) {
    try {
      layers_.push_back(makeLayer(i, materials[i], discardedEnergy));
    } catch (const InputError& e) {
      throw InputError(capture.name, "materials[" + std::to_string(i) + "]", e.what());
    }
  }
}

Diffusion::Layer Diffusion::makeLayer(std::size_t material, const PellucidMaterial& compiled,
                                      double discardedEnergy) const {
  Layer layer;
  std::array<std::optional<Profile>, 3> channels;
  double radius = 0;
  for (std::size_t c = 0; c < 3; ++c) {
    channels[c] = channelProfile(compiled, static_cast<int>(c));
    layer.diffuses[c] = channels[c].has_value();
    if (channels[c]) radius = std::max(radius, radiusOfTail(*channels[c], discardedEnergy));
  }
  const auto any =
      std::find_if(channels.begin(), channels.end(), [](const auto& p) { return p.has_value(); });
  if (any == channels.end()) return layer;
  layer.profile.emplace(threeChannels(channels, **any), radius);
  collect(layer, material);
  return layer;
}

void Diffusion::collect(Layer& layer, std::size_t material) const {
  layer.nearestDepth = INFINITY;
  for (int y = 0; y < capture_.height; ++y) {
    for (int x = 0; x < capture_.width; ++x) {
      layer.firstAt.push_back(static_cast<std::uint32_t>(layer.samples.size()));
      const std::size_t pixel = pixelNumber(capture_.irradiance, x, y);
      if (capture_.material[pixel] != material + 1) continue;
      const std::optional<Surface> surface = surfaces_.at(x, y);
      if (!surface) continue;
      const SurfaceReader::Footprint footprint = surfaces_.footprint(x, y, *surface);
      const HalfAxes axes{footprint.halfX * mmPerUnit_, footprint.halfY * mmPerUnit_};
      const glm::dvec3& e = irradiance_[pixel];
      layer.samples.push_back(
          {surface->position * mmPerUnit_, 4 * glm::length(glm::cross(axes.x, axes.y)), {e.x, e.y, e.z, 0}});
      layer.footprints.push_back(axes);
      layer.nearestDepth = std::min(layer.nearestDepth, surfaces_.camera().planarDepth(surface->position));
    }
    layer.firstAt.push_back(static_cast<std::uint32_t>(layer.samples.size()));
  }
}

// Pixels that may see the sphere of the cut-off radius: the projection of its bounding box, whose near
// face is moved no further than the material's nearest pixel.
Diffusion::Window Diffusion::reach(const Layer& layer, const Sample& receiver) const {
  const Camera& camera = surfaces_.camera();
  const double radius = layer.profile->radius() / mmPerUnit_;
  const glm::dvec3 center = receiver.position / mmPerUnit_;
  const double depth = camera.planarDepth(center);
  glm::dvec2 low(INFINITY), high(-INFINITY);
  for (const double cornerDepth : {std::max(depth - radius, layer.nearestDepth), depth + radius})
    for (const double dx : {-radius, radius})
      for (const double dy : {-radius, radius}) {
        const double z = camera.position({0, 0}, cornerDepth).z;
        const glm::dvec2 pixel = camera.project({center.x + dx, center.y + dy, z});
        low = glm::min(low, pixel);
        high = glm::max(high, pixel);
      }
  const auto clampTo = [](double v, int size) { return static_cast<int>(std::clamp(v, 0.0, double(size))); };
  return {clampTo(std::floor(low.x), capture_.width), clampTo(std::floor(low.y), capture_.height),
          clampTo(std::ceil(high.x), capture_.width), clampTo(std::ceil(high.y), capture_.height)};
}

void Diffusion::addRow(const Layer& layer, const Sample& receiver, int x, int y, int row,
                       const Window& window, Sums& sums) const {
  const ProfileTable& profile = *layer.profile;
  const double radiusSquared = profile.radius() * profile.radius();
  const std::uint32_t* firstAt =
      &layer.firstAt[static_cast<std::size_t>(row) * static_cast<std::size_t>(capture_.width + 1)];
  // First sample of the row at or right of a column, inside the window.
  const auto sampleAt = [&](int column) { return firstAt[std::clamp(column, window.left, window.right)]; };
  const int away = std::abs(row - y);
  const int sampledFrom = away <= kSampled ? x - kSampled : x;
  const int sampledTo = away <= kSampled ? x + kSampled + 1 : x;
  const int integratedFrom = away <= kIntegrated ? x - kIntegrated : x;
  const int integratedTo = away <= kIntegrated ? x + kIntegrated + 1 : x;

  const auto addCenters = [&](int from, int to) {
    Sums span;
    for (std::uint32_t i = sampleAt(from), end = sampleAt(to); i < end; ++i) {
      const Sample& s = layer.samples[i];
      const glm::dvec3 offset = s.position - receiver.position;
      const double rSquared = glm::dot(offset, offset);
      if (!(rSquared < radiusSquared)) continue;
      span.add(profile.value(rSquared) * s.area, s.irradiance);
    }
    sums.add(span);
  };
  const auto addFootprints = [&](int from, int to, auto energy) {
    for (std::uint32_t i = sampleAt(from), end = sampleAt(to); i < end; ++i) {
      const Sample& s = layer.samples[i];
      const HalfAxes& axes = layer.footprints[i];
      sums.add(energy(profile, Parallelogram{s.position - receiver.position, axes.x, axes.y}), s.irradiance);
    }
  };
  addCenters(window.left, sampledFrom);
  addFootprints(sampledFrom, integratedFrom, sampledEnergy);
  addFootprints(integratedFrom, integratedTo, integratedEnergy);
  addFootprints(integratedTo, sampledTo, sampledEnergy);
  addCenters(sampledTo, window.right);
}

glm::dvec3 Diffusion::at(int x, int y) const {
  const std::size_t pixel = pixelNumber(capture_.irradiance, x, y);
  glm::dvec3 result = irradiance_[pixel];
  const std::uint8_t material = capture_.material[pixel];
  if (material == 0 || material > layers_.size()) return result;
  const Layer& layer = layers_[material - 1u];
  if (!layer.profile) return result;
  const std::size_t cell = pixel + static_cast<std::size_t>(y);
  if (layer.firstAt[cell] == layer.firstAt[cell + 1]) return result;  // no surface

  const Sample& receiver = layer.samples[layer.firstAt[cell]];
  const Window window = reach(layer, receiver);
  Sums sums;
  for (int row = window.top; row < window.bottom; ++row) addRow(layer, receiver, x, y, row, window, sums);
  for (int c = 0; c < 3; ++c)
    if (layer.diffuses[static_cast<std::size_t>(c)]) result[c] = sums.energy[c] / sums.weight[c];
  return result;
}

double Diffusion::radius() const {
  double widest = 0;
  for (const Layer& layer : layers_)
    if (layer.profile) widest = std::max(widest, layer.profile->radius());
  return widest;
}

}  // namespace pellucid::harness::reference
