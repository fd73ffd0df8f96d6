#include "replay/frame.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "capture/shadow_images.h"
#include "common/error.h"
#include "common/far_origin.h"
#include "pellucid/pellucid_material.h"
#include "reference/translucency.h"
#include "replay/exposure.h"

namespace pellucid::harness {
namespace {

void copy(const Matrix& from, float (&to)[16]) {
  std::transform(from.begin(), from.end(), to, [](double v) { return static_cast<float>(v); });
}

void copy(const std::array<double, 3>& from, float (&to)[3]) {
  std::transform(from.begin(), from.end(), to, [](double v) { return static_cast<float>(v); });
}

using Origin = std::array<double, 3>;

Origin minus(Origin position, const Origin& origin) {
  for (std::size_t i = 0; i < 3; ++i) position[i] -= origin[i];
  return position;
}

// Index plus 1 of the table among the frame's, where lights with equal ones share it; 0: none.
uint32_t addTable(const std::vector<double>& factors, FrameData& data) {
  if (factors.empty()) return 0;
  PellucidLightTable table{};
  std::transform(factors.begin(), factors.end(), table.factor,
                 [](double v) { return static_cast<float>(v); });
  std::vector<PellucidLightTable>& all = data.lightTables;
  const auto same = std::find_if(all.begin(), all.end(), [&](const PellucidLightTable& other) {
    return std::equal(table.factor, std::end(table.factor), other.factor);
  });
  const auto index = same - all.begin();
  if (same == all.end()) all.push_back(table);
  return static_cast<uint32_t>(index + 1);
}

void addLight(const Light& light, const Origin& origin, const FrameShape& shape, FrameData& data) {
  PellucidLight l = pellucidLight(light);
  l.angleTable = addTable(light.angleTable, data);
  l.distanceTable = addTable(light.distanceTable, data);
  copy(minus(light.position, origin), l.position);
  l.firstShadowMap = static_cast<uint32_t>(data.shadowMaps.size());
  l.shadowMapCount = static_cast<uint32_t>(light.shadowMaps.size());
  for (const ShadowMap& map : light.shadowMaps) {
    PellucidShadowMap s{};
    const auto& [images, extent] = shape.maps[data.shadowMaps.size()];
    const auto& [depth, exit, caster] = images;
    s.image = static_cast<uint32_t>(depth);
    s.options.exitImage = static_cast<uint32_t>(exit + 1);
    s.options.casterMaterialImage = static_cast<uint32_t>(caster + 1);
    for (std::size_t i = 0; i < 2; ++i) s.options.offset[i] = static_cast<uint32_t>(map.offset[i]);
    s.options.layer = static_cast<uint32_t>(map.layer);
    s.options.backFaces = map.backFaces;
    s.options.depthBiasConstant = static_cast<float>(map.depthBiasConstant);
    s.options.depthBiasSlope = static_cast<float>(map.depthBiasSlope);
    s.options.offsetLength = static_cast<float>(map.offsetLength);
    s.options.depthStep = static_cast<float>(map.depthStep);
    for (std::size_t i = 0; i < 2; ++i) s.extent[i] = static_cast<uint32_t>(extent[i]);
    s.encoding = map.depth.encoding;
    copy(fromOrigin(map.clipFromWorld, origin), s.clipFromWorld);
    copy(fromOrigin(map.viewFromWorld.value_or(kIdentity), origin), s.options.viewFromWorld);
    data.shadowMaps.push_back(s);
  }
  data.lights.push_back(l);
}

// The dmax whose line has the least RMS distance to T over 0..10 mm; skin is dark beyond. A fine
// geometric search is enough: the RMS is smooth in dmax.
float nearestLine(const PellucidMaterial& m, uint32_t channel) {
  double best = INFINITY, bestLength = 1;
  for (double length = 0.05; length < 200; length *= 1.005) {
    double sum = 0;
    for (int i = 0; i <= 200; ++i) {
      const double d = 0.05 * i,
                   error = std::max(0.0, 1 - d / length) - pellucidEvaluateTransmittance(&m, channel, d);
      sum += error * error;
    }
    if (sum < best) {
      best = sum;
      bestLength = length;
    }
  }
  return static_cast<float>(bestLength);
}

void exchangeTransmittance(PellucidMaterial& m, TransmittanceChoice choice) {
  switch (choice) {
    case TransmittanceChoice::Material:
      break;
    case TransmittanceChoice::Linear:
      for (uint32_t c = 0; c < 3; ++c) m.transmittance[c][0] = nearestLine(m, c);
      m.transmittanceModel = PELLUCID_TRANSMITTANCE_LINEAR;
      break;
    case TransmittanceChoice::Gaussians:
      m.transmittanceModel = PELLUCID_TRANSMITTANCE_GAUSSIANS;
      break;
    case TransmittanceChoice::GaussiansAsPrinted:
      m.transmittanceModel = PELLUCID_TRANSMITTANCE_GAUSSIANS_AS_PRINTED;
      break;
  }
}

// Views of different images that are never dereferenced: planning and validation only ask whether a view is
// there and which are of one image.
class Placeholders {
public:
  PellucidImage operator()() { return {reinterpret_cast<VkImageView>(++count_), VK_IMAGE_LAYOUT_GENERAL}; }

private:
  std::uintptr_t count_ = 0;
};

void fillPlaceholders(const FrameShape& shape, bool hidden, bool inPlace, FrameData& data) {
  PellucidFrame& f = data.frame;
  Placeholders next;
  for (PellucidImage& map : data.shadowImages) map = next();
  f.frontDepth = next();
  if (shape.backDepth) f.backDepth = next();
  f.irradiance = next();
  if (hidden) f.hiddenIrradiance = next();
  if (shape.albedo) f.albedo = next();
  f.material = next();
  if (f.options.reuse == PELLUCID_REUSE_ACCUMULATE) f.motion = next();
  f.output = inPlace ? f.irradiance : next();
  PellucidImageNeed needs[kMaxImageNeeds];
  uint32_t count = kMaxImageNeeds;
  // Where the frame is wrong there are none, and validation says what is.
  if (pellucidGetImageNeeds(&f, &count, needs) != PELLUCID_OK) return;
  for (uint32_t i = 0; i < count; ++i) (needs[i].persistent ? f.options.history : f.transients[i]) = next();
}

}  // namespace

PellucidLight pellucidLight(const Light& light) {
  PellucidLight l{};
  l.type = light.type;
  copy(light.position, l.position);
  copy(light.direction, l.direction);
  copy(light.color, l.color);
  l.intensity = static_cast<float>(light.intensity);
  l.range = static_cast<float>(light.range);
  l.innerConeAngle = static_cast<float>(light.innerConeAngle);
  l.outerConeAngle = static_cast<float>(light.outerConeAngle);
  return l;
}

std::vector<PellucidMaterial> withTransmittance(std::vector<PellucidMaterial> materials, TransmittanceChoice choice) {
  for (std::size_t i = 0; i < materials.size(); ++i) {
    if (!materials[i].thinWalled) exchangeTransmittance(materials[i], choice);
    std::string sentences;
    if (pellucidMakeMaterialTables(&materials[i], &appendError, &sentences) != PELLUCID_OK)
      throw InputError("", "materials[" + std::to_string(i) + "]", sentences);
  }
  return materials;
}

FrameShape shapeOf(const Capture& capture) {
  FrameShape shape;
  shape.backDepth = !capture.backDepth.image.empty();
  shape.hiddenIrradiance = !capture.hiddenIrradiance.empty();
  shape.albedo = !capture.albedo.empty();
  const ShadowImages images = shadowImages(capture.lights);
  shape.shadowImages = images.images.size();
  for (const Light& light : capture.lights)
    for (const ShadowMap& map : light.shadowMaps)
      shape.maps.push_back(
          {images.ofMap[shape.maps.size()], {map.depth.image.width, map.depth.image.height}});
  return shape;
}

void makeFrame(const Capture& capture, const std::vector<PellucidMaterial>& materials,
               const ReplaySettings& settings, FrameData& data) {
  makeFrame(capture, shapeOf(capture), materials, settings, data);
}

void makeFrame(const Capture& capture, const FrameShape& shape,
               const std::vector<PellucidMaterial>& materials, const ReplaySettings& settings,
               FrameData& data) {
  data.materials = withTransmittance(materials, settings.transmittance);
  const Origin origin = worldOrigin(capture);
  for (const Light& light : capture.lights) {
    addLight(light, origin, shape, data);
    data.lights.back().minimumDot = static_cast<float>(reference::minimumDot(settings.translucency, light));
  }
  data.shadowImages.resize(shape.shadowImages);

  PellucidFrame& f = data.frame;
  pellucidInitFrame(&f);
  pellucidInitThesisOptions(&data.thesis);
  setOptions(settings, f.options, data.thesis);
  data.thesis.angleModel = settings.translucency.moduleModel();
  for (std::size_t i = 0; i < 3; ++i)
    data.thesis.objectCenter[i] = static_cast<float>(static_cast<double>(settings.translucency.objectCenter[i]) - origin[i]);
  f.options.thesis = &data.thesis;
  f.imageExtent[0] = static_cast<uint32_t>(capture.width);
  f.imageExtent[1] = static_cast<uint32_t>(capture.height);
  f.metersPerUnit = static_cast<float>(capture.metersPerUnit);
  copy(capture.clipFromView, f.clipFromView);
  copy(fromOrigin(capture.viewFromWorld, origin), f.viewFromWorld);
  for (std::size_t i = 0; i < 3; ++i)
    f.options.anchor[i] = static_cast<float>(static_cast<double>(settings.anchor[i]) - origin[i]);
  f.options.frontDepthEncoding = capture.frontDepth.encoding;
  f.options.backDepthEncoding = capture.backDepth.encoding;
  f.materialCount = static_cast<uint32_t>(data.materials.size());
  f.materials = data.materials.data();
  f.lightCount = static_cast<uint32_t>(data.lights.size());
  f.lights = data.lights.data();
  f.options.lightTableCount = static_cast<uint32_t>(data.lightTables.size());
  f.options.lightTables = data.lightTables.data();
  f.shadowMapCount = static_cast<uint32_t>(data.shadowMaps.size());
  f.shadowMaps = data.shadowMaps.data();
  f.shadowImageCount = static_cast<uint32_t>(data.shadowImages.size());
  f.shadowImages = data.shadowImages.data();
  const bool ambient = settings.ambient.value_or(shape.hiddenIrradiance);
  if (capture.environment && ambient) {
    for (const std::array<double, 3>& coefficient : *capture.environment)
      for (const double channel : coefficient) data.ambient.push_back(static_cast<float>(channel));
    f.options.ambient = data.ambient.data();
  }
  f.options.materialShift = settings.materialShift;
  f.options.materialMask = settings.materialMask;
  f.options.addToOutput = settings.addToOutput;
  f.preExposure = preExposureOf(settings);
  f.options.debugView = settings.debugView;
  fillPlaceholders(shape, ambient && shape.hiddenIrradiance, settings.inPlace(), data);
}

void appendError(void* user, PellucidSeverity severity, const char* field, const char* message) {
  if (severity != PELLUCID_SEVERITY_ERROR) return;
  auto& all = *static_cast<std::string*>(user);
  all += (all.empty() ? "" : "; ") + std::string(field) + " " + message;
}

void requireOk(PellucidResult result, const PellucidFrame& frame, const std::string& name) {
  if (result == PELLUCID_OK) return;
  std::string sentences;
  pellucidValidateFrame(&frame, &appendError, &sentences);
  throw InputError(name, "", sentences.empty() ? pellucidResultName(result) : sentences);
}

}  // namespace pellucid::harness
