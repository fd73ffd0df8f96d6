#include "raster/shadow.h"

#include <cmath>

#include "common/error.h"
#include "raster/framing.h"
#include "raster/passes.h"
#include "scene/vector.h"
#include "shared/pellucid_shared.h"

namespace pellucid::harness {

namespace {

constexpr bool kReversed = true;
constexpr int kMostCascades = 6;  // maps that the irradiance reads

std::size_t depthIndex(PellucidDepthEncoding encoding) {
  return encoding == PELLUCID_DEPTH_DEVICE ? kDeviceDepth : kPlanar;
}

Image downloadDepth(const RenderTarget& target, const ShadowImage& view, PellucidDepthEncoding encoding) {
  Image depth = target.image(depthIndex(encoding)).download();
  if (encoding != PELLUCID_DEPTH_DISTANCE || !view.perspective) return depth;
  // Length of the ray through a texel per planar distance.
  const double tangent = 1 / view.clipFromView[0];
  for (int y = 0; y < view.size; ++y)
    for (int x = 0; x < view.size; ++x) {
      const double u = ((x + 0.5) / view.size * 2 - 1) * tangent;
      const double v = ((y + 0.5) / view.size * 2 - 1) * tangent;
      float& value = *depth.at(x, y);
      if (value < kNoDepth) value = static_cast<float>(value * std::sqrt(1 + u * u + v * v));
    }
  return depth;
}

using Target = std::shared_ptr<const RenderTarget>;

// A light's view of the model: its shadow map's surface, and with `casters` what casts the shadow.
Target recordSurface(VkCommandBuffer commands, TargetPool& targets, const UploadedModel& model,
                     const DrawView& view, int size, bool casters) {
  std::vector<RenderTarget::Color> colors = depthColors(view.reversedDepth);
  if (casters) {
    colors.push_back({VK_FORMAT_R32_SFLOAT, clearTo(0)});
    colors.push_back({VK_FORMAT_R8_UNORM, clearTo(0)});
  }
  Target target = targets.take({size, size, colors, farDepth(view.reversedDepth)});
  model.record(commands, *target, view,
               {casters ? FragmentShader::Caster : FragmentShader::Depth, VK_CULL_MODE_NONE,
                nearer(view.reversedDepth), false},
               VK_CULL_MODE_NONE);
  return target;
}

// The nearest back face behind the map's surface, of the object that is entered there, or what is opaque
// before it.
Target recordExit(VkCommandBuffer commands, TargetPool& targets, const UploadedModel& model,
                  const DrawView& view, const RenderTarget& surface, int size) {
  Target target = targets.take({size, size, depthColors(view.reversedDepth), farDepth(view.reversedDepth)});
  EarlierPass earlier{&surface.image(kDeviceDepth)};
  earlier.caster = &surface.image(kCasterObject);
  model.record(commands, *target, view,
               {FragmentShader::Depth, VK_CULL_MODE_FRONT_BIT, nearer(view.reversedDepth), false},
               VK_CULL_MODE_FRONT_BIT, earlier);
  return target;
}

bool isPlain(const ShadowDrawing& drawing) {
  return drawing.cull == MapCull::None && drawing.depthBiasConstant == 0 && drawing.depthBiasSlope == 0 &&
         drawing.normalOffset == 0 && drawing.bits == 32;
}

// Scene units by which a view's vertices move.
double offsetOf(const LightView& view, const RasterOptions& options) {
  return options.shadow.normalOffset * 2 / view.clipFromView[0] / options.shadowSize;
}

VkFormat formatOf(const ShadowDrawing& drawing) {
  return drawing.bits == 16   ? VK_FORMAT_D16_UNORM
         : drawing.bits == 24 ? VK_FORMAT_X8_D24_UNORM_PACK32
                              : VK_FORMAT_D32_SFLOAT;
}

// Difference of neighboring depths of that many bits; of floats that between depths of .5 and 1.
double depthUnit(const ShadowDrawing& drawing) { return drawing.bits == 16 ? 1.0 / 65535 : std::exp2(-24); }

// Draws the map as an engine's depth buffer holds it.
Target recordAsEngine(VkCommandBuffer commands, TargetPool& targets, const UploadedModel& model,
                      const DrawView& view, const RasterOptions& options) {
  const ShadowDrawing& drawing = options.shadow;
  Target target = targets.take({options.shadowSize, options.shadowSize, depthColors(kReversed),
                                farDepth(kReversed), formatOf(drawing)});
  PipelineState state{FragmentShader::Depth, VK_CULL_MODE_NONE, nearer(kReversed), false};
  state.cull = drawing.cull == MapCull::Front  ? VK_CULL_MODE_FRONT_BIT
               : drawing.cull == MapCull::Back ? VK_CULL_MODE_BACK_BIT
                                               : VK_CULL_MODE_NONE;
  state.depthBiasConstant = static_cast<float>(-drawing.depthBiasConstant);
  state.depthBiasSlope = static_cast<float>(-drawing.depthBiasSlope);
  // Engines cull nothing of double-sided surfaces.
  model.record(commands, *target, view, state, VK_CULL_MODE_NONE);
  return target;
}

ShadowMap outlineOf(const LightView& view, const RasterOptions& options) {
  ShadowMap map;
  map.depth.encoding = options.shadowEncoding;
  map.clipFromWorld = multiply(view.clipFromView, view.viewFromWorld);
  map.viewFromWorld = view.viewFromWorld;
  if (isPlain(options.shadow)) return map;
  const ShadowDrawing& drawing = options.shadow;
  map.backFaces = drawing.cull == MapCull::Front;
  map.depthBiasConstant = -drawing.depthBiasConstant * depthUnit(drawing);
  map.depthBiasSlope = -drawing.depthBiasSlope;
  map.offsetLength = offsetOf(view, options);
  map.depthStep = drawing.bits == 32 ? 0 : depthUnit(drawing);
  return map;
}

}  // namespace

std::vector<LightView> shadowViews(const ModelPoints& points, const Light& light, const ModelCamera& camera,
                                   const RasterOptions& options) {
  const int cascades = options.shadow.cascades;
  if (cascades == 0 || light.type != PELLUCID_LIGHT_DIRECTIONAL)
    return frameLight(points, light, options.pointMaps, options.shadowSize);
  return frameCascades(points.bounds, light, camera, static_cast<double>(options.width) / options.height,
                       cascades, options.shadowSize);
}

std::vector<DrawnMap> recordShadows(VkCommandBuffer commands, TargetPool& targets,
                                    const std::vector<LightView>& views, const UploadedModel& uploaded,
                                    const Light& light, const RasterOptions& options) {
  std::vector<DrawnMap> maps;
  const int size = options.shadowSize;
  // Six maps with images of their own would have more than a dispatch binds.
  const bool few =
      options.shadow.placement != MapPlacement::Separate || 3 * views.size() <= PELLUCID_SHADOW_IMAGE_COUNT;
  const bool casters = few && options.shadow.cull != MapCull::Front;
  for (const LightView& lightView : views) {
    const DrawView view{lightView.clipFromView, lightView.viewFromWorld, kReversed};
    DrawnMap& map = maps.emplace_back();
    map.outline = outlineOf(lightView, options);
    map.surface = recordSurface(commands, targets, uploaded, view, size, casters);
    map.image = {map.surface->image(kPlanar).use(), size, view.clipFromView, view.viewFromWorld,
                 light.type != PELLUCID_LIGHT_DIRECTIONAL};
    if (!isPlain(options.shadow) || options.shadow.filter > 0) {
      DrawView drawn = view;
      drawn.normalOffset = offsetOf(lightView, options);
      map.engine = recordAsEngine(commands, targets, uploaded, drawn, options);
    }
    if (options.shadow.filter > 0) map.image.depths = map.engine->depthUse();
    if (casters) map.exit = recordExit(commands, targets, uploaded, view, *map.surface, size);
  }
  return maps;
}

ShadowMap downloadMap(const DrawnMap& map, const RasterOptions& options) {
  ShadowMap result = map.outline;
  result.depth.image =
      map.engine ? map.engine->depth() : downloadDepth(*map.surface, map.image, options.shadowEncoding);
  if (!map.exit) return result;
  result.exitDepth = downloadDepth(*map.exit, map.image, options.shadowEncoding);
  for (const float material : map.surface->image(kCasterMaterial).download().data)
    result.casterMaterial.push_back(static_cast<std::uint8_t>(std::lround(255 * material)));
  return result;
}

bool areOnDevice(const RasterOptions& options) {
  return isPlain(options.shadow) && options.shadow.filter == 0 &&
         options.shadow.placement == MapPlacement::Separate &&
         options.shadowEncoding != PELLUCID_DEPTH_DISTANCE;
}

DeviceMap deviceMap(const DrawnMap& map, const RasterOptions& options) {
  const std::size_t depth = depthIndex(options.shadowEncoding);
  if (!map.exit) return {sharedImage(map.surface, depth), nullptr, nullptr};
  return {sharedImage(map.surface, depth), sharedImage(map.exit, depth),
          sharedImage(map.surface, kCasterMaterial)};
}

void checkShadowDrawing(const Model& model, const ModelCamera& camera, const RasterOptions& options) {
  const ShadowDrawing& drawing = options.shadow;
  const auto refuse = [&](const char* field, const std::string& why) {
    throw InputError(model.name, field, why);
  };
  if (!(drawing.normalOffset >= 0 && drawing.normalOffset <= 100))
    refuse("shadowNormalOffset", std::to_string(drawing.normalOffset) + " is outside 0 .. 100");
  if (drawing.normalOffset > 0)
    for (const Light& light : model.lights)
      if (light.type != PELLUCID_LIGHT_DIRECTIONAL)
        refuse("shadowNormalOffset", "needs directional lights alone");
  if (drawing.cascades < 0 || drawing.cascades > kMostCascades)
    refuse("shadowCascades", std::to_string(drawing.cascades) + " is outside 0 .. 6");
  if (drawing.cascades > 0 && camera.orthographic)
    refuse("shadowCascades", "camera \"" + camera.name + "\" is orthographic: its depths have no slices");
  if (drawing.filter != 0 && (drawing.filter < 0 || drawing.filter > 15 || drawing.filter % 2 == 0))
    refuse("shadowFilter", std::to_string(drawing.filter) + " is not 0 or an odd number of at most 15");
  constexpr double kMostBias = 1e3;
  for (const double bias : {drawing.depthBiasConstant, drawing.depthBiasSlope})
    if (!(std::abs(bias) <= kMostBias))
      throw InputError(model.name, "shadowDepthBias", std::to_string(bias) + " is outside -1000 .. 1000");
  if (drawing.bits != 16 && drawing.bits != 24 && drawing.bits != 32)
    throw InputError(model.name, "shadowBits", std::to_string(drawing.bits) + " is not 16, 24 or 32");
  const bool isDrawn = !isPlain(drawing) || drawing.filter > 0;
  if (isDrawn && options.shadowEncoding != PELLUCID_DEPTH_DEVICE)
    throw InputError(
        model.name, "shadowDepth",
        "must be device where maps are culled, biased, offset, filtered or of other than 32 bits: "
        "only depth buffers are");
  if (options.shadowSize == 0 &&
      (isDrawn || drawing.cascades > 0 || drawing.placement != MapPlacement::Separate))
    throw InputError(model.name, "shadowSize", "is 0, but something is asked of the shadow maps");
}

void placeShadowMaps(MapPlacement placement, int size, std::vector<Light>& lights) {
  if (placement == MapPlacement::Separate) return;
  int count = 0;
  for (const Light& light : lights) count += static_cast<int>(light.shadowMaps.size());
  const int columns = static_cast<int>(std::ceil(std::sqrt(count)));
  int index = 0;
  for (Light& light : lights)
    for (ShadowMap& map : light.shadowMaps) {
      map.sharedImage = 0;
      if (placement == MapPlacement::Array)
        map.layer = index;
      else
        map.offset = {index % columns * size, index / columns * size};
      ++index;
    }
}

}  // namespace pellucid::harness
