#include "replay/frame.h"

#include <algorithm>

#include "common/error.h"

namespace pellucid::harness {
namespace {

void copy(const Matrix& from, float (&to)[16]) {
  std::transform(from.begin(), from.end(), to, [](double v) { return static_cast<float>(v); });
}

void copy(const std::array<double, 3>& from, float (&to)[3]) {
  std::transform(from.begin(), from.end(), to, [](double v) { return static_cast<float>(v); });
}

void addLight(const Light& light, FrameData& data) {
  PellucidLight l{};
  l.type = light.type;
  copy(light.position, l.position);
  copy(light.direction, l.direction);
  copy(light.color, l.color);
  l.intensity = static_cast<float>(light.intensity);
  l.range = static_cast<float>(light.range);
  l.innerConeAngle = static_cast<float>(light.innerConeAngle);
  l.outerConeAngle = static_cast<float>(light.outerConeAngle);
  if (light.shadowMap) {
    const ShadowMap& map = *light.shadowMap;
    PellucidShadowMap s{};
    s.image = static_cast<uint32_t>(data.shadowDepths.size());
    s.extent[0] = static_cast<uint32_t>(map.depth.image.width);
    s.extent[1] = static_cast<uint32_t>(map.depth.image.height);
    s.encoding = map.depth.encoding;
    copy(map.clipFromWorld, s.clipFromWorld);
    copy(map.viewFromWorld.value_or(kIdentity), s.viewFromWorld);
    l.firstShadowMap = static_cast<uint32_t>(data.shadowMaps.size());
    l.shadowMapCount = 1;
    data.shadowMaps.push_back(s);
    data.shadowDepths.push_back(&map.depth.image);
  }
  data.lights.push_back(l);
}

}  // namespace

void makeFrame(const Capture& capture, const std::vector<PellucidMaterial>& materials,
               const ReplaySettings& settings, FrameData& data) {
  data.materials = materials;
  for (const Light& light : capture.lights) addLight(light, data);
  // Never dereferenced: planning only asks whether a view is there.
  const PellucidImage placeholder{reinterpret_cast<VkImageView>(uintptr_t{1}), VK_IMAGE_LAYOUT_GENERAL};
  data.shadowImages.assign(data.shadowDepths.size(), placeholder);

  PellucidFrame& f = data.frame;
  pellucidInitFrame(&f);
  f.features = settings.features;
  f.imageExtent[0] = static_cast<uint32_t>(capture.width);
  f.imageExtent[1] = static_cast<uint32_t>(capture.height);
  std::copy(settings.renderRect.begin(), settings.renderRect.end(), f.renderRect);
  f.metersPerUnit = static_cast<float>(capture.metersPerUnit);
  copy(capture.clipFromView, f.clipFromView);
  copy(capture.viewFromWorld, f.viewFromWorld);
  f.frontDepth = f.irradiance = f.material = f.output = placeholder;
  if (!capture.backDepth.image.empty()) f.backDepth = placeholder;
  if (!capture.normal.empty()) f.normal = placeholder;
  if (!capture.albedo.empty()) f.albedo = placeholder;
  f.outputFormat = settings.outputFormat;
  f.frontDepthEncoding = capture.frontDepth.encoding;
  f.backDepthEncoding = capture.backDepth.encoding;
  f.normalsInViewSpace = capture.normalsInViewSpace;
  f.materialCount = static_cast<uint32_t>(data.materials.size());
  f.materials = data.materials.data();
  f.lightCount = static_cast<uint32_t>(data.lights.size());
  f.lights = data.lights.data();
  f.shadowMapCount = static_cast<uint32_t>(data.shadowMaps.size());
  f.shadowMaps = data.shadowMaps.data();
  f.shadowImageCount = static_cast<uint32_t>(data.shadowImages.size());
  f.shadowImages = data.shadowImages.data();
  f.thicknessSource = settings.thicknessSource;
  f.debugView = settings.debugView;
}

void requireOk(PellucidResult result, const PellucidFrame& frame, const std::string& name) {
  if (result == PELLUCID_OK) return;
  std::string sentences;
  pellucidValidateFrame(
      &frame,
      [](void* user, PellucidSeverity severity, const char* field, const char* message) {
        if (severity != PELLUCID_SEVERITY_ERROR) return;
        auto& all = *static_cast<std::string*>(user);
        all += (all.empty() ? "" : "; ") + std::string(field) + " " + message;
      },
      &sentences);
  throw InputError(name, "", sentences.empty() ? pellucidResultName(result) : sentences);
}

}  // namespace pellucid::harness
