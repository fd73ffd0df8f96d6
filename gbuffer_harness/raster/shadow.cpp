#include "raster/shadow.h"

#include <cmath>

#include "common/error.h"
#include "raster/framing.h"
#include "raster/front.h"
#include "scene/vector.h"
#include "shared/pellucid_shared.h"

namespace pellucid::harness {

namespace {

constexpr bool kReversed = true;

DepthImage encodeShadow(const RenderTarget& target, const ShadowImage& view, PellucidDepthEncoding encoding) {
  if (encoding == PELLUCID_DEPTH_DEVICE) return {target.image(kDeviceDepth).download(), encoding};
  DepthImage depth{target.image(kPlanar).download(), encoding};
  if (encoding != PELLUCID_DEPTH_DISTANCE || !view.perspective) return depth;
  // Length of the ray through a texel per planar distance.
  const double tangent = 1 / view.clipFromView[0];
  for (int y = 0; y < view.size; ++y)
    for (int x = 0; x < view.size; ++x) {
      const double u = ((x + 0.5) / view.size * 2 - 1) * tangent;
      const double v = ((y + 0.5) / view.size * 2 - 1) * tangent;
      float& value = *depth.image.at(x, y);
      if (value < kNoDepth) value = static_cast<float>(value * std::sqrt(1 + u * u + v * v));
    }
  return depth;
}

// A light's view of the model: its shadow map's surface, and with `casters` what casts the shadow.
std::unique_ptr<RenderTarget> drawShadow(Device& device, const UploadedModel& model, const DrawView& view,
                                         int size, bool casters) {
  std::vector<RenderTarget::Color> colors = depthColors(view.reversedDepth);
  if (casters) colors.push_back({VK_FORMAT_R32G32_SFLOAT, clearTo(0)});
  auto target = std::make_unique<RenderTarget>(device, size, size, colors, farDepth(view.reversedDepth));
  model.draw(*target, view,
             {casters ? FragmentShader::Caster : FragmentShader::Depth, VK_CULL_MODE_NONE,
              nearer(view.reversedDepth), false},
             VK_CULL_MODE_NONE);
  return target;
}

// The nearest back face behind the map's surface, of the object that is entered there.
DepthImage exitDepth(Device& device, const UploadedModel& model, const DrawView& view,
                     const RenderTarget& shadow, const ShadowImage& image, PellucidDepthEncoding encoding) {
  const RenderTarget target(device, image.size, image.size, depthColors(view.reversedDepth),
                            farDepth(view.reversedDepth));
  EarlierPass earlier{&shadow.image(kDeviceDepth)};
  earlier.caster = &shadow.image(kCaster);
  model.draw(target, view, {FragmentShader::Depth, VK_CULL_MODE_FRONT_BIT, nearer(view.reversedDepth), false},
             VK_CULL_MODE_FRONT_BIT, earlier);
  return encodeShadow(target, image, encoding);
}

std::vector<std::uint8_t> casterMaterial(const RenderTarget& shadow) {
  const Image caster = shadow.image(kCaster).download();
  std::vector<std::uint8_t> materials(caster.pixels());
  for (std::size_t i = 0; i < materials.size(); ++i)
    materials[i] = static_cast<std::uint8_t>(caster.data[2 * i]);
  return materials;
}

bool isPlain(const ShadowDrawing& drawing) {
  return drawing.cull == MapCull::None && drawing.depthBiasConstant == 0 && drawing.depthBiasSlope == 0 &&
         drawing.bits == 32;
}

VkFormat formatOf(const ShadowDrawing& drawing) {
  return drawing.bits == 16   ? VK_FORMAT_D16_UNORM
         : drawing.bits == 24 ? VK_FORMAT_X8_D24_UNORM_PACK32
                              : VK_FORMAT_D32_SFLOAT;
}

// Difference of neighboring depths of that many bits; of floats that between depths of .5 and 1.
double depthUnit(const ShadowDrawing& drawing) { return drawing.bits == 16 ? 1.0 / 65535 : std::exp2(-24); }

// Draws the map as an engine's depth buffer holds it.
void drawAsEngine(Device& device, const UploadedModel& model, const DrawView& view,
                  const RasterOptions& options, ShadowMap& map) {
  const ShadowDrawing& drawing = options.shadow;
  const RenderTarget target(device, options.shadowSize, options.shadowSize, depthColors(kReversed),
                            farDepth(kReversed), formatOf(drawing));
  PipelineState state{FragmentShader::Depth, VK_CULL_MODE_NONE, nearer(kReversed), false};
  state.cull = drawing.cull == MapCull::Front  ? VK_CULL_MODE_FRONT_BIT
               : drawing.cull == MapCull::Back ? VK_CULL_MODE_BACK_BIT
                                               : VK_CULL_MODE_NONE;
  state.depthBiasConstant = static_cast<float>(-drawing.depthBiasConstant);
  state.depthBiasSlope = static_cast<float>(-drawing.depthBiasSlope);
  // Engines cull nothing of double-sided surfaces.
  model.draw(target, view, state, VK_CULL_MODE_NONE);
  map.depth = {target.depth(), PELLUCID_DEPTH_DEVICE};
  map.faces = drawing.cull == MapCull::Front ? PELLUCID_FACES_BACK : PELLUCID_FACES_FRONT;
  map.depthBiasConstant = -drawing.depthBiasConstant * depthUnit(drawing);
  map.depthBiasSlope = -drawing.depthBiasSlope;
  map.depthStep = drawing.bits == 32 ? 0 : depthUnit(drawing);
}

}  // namespace

DrawnShadows drawShadows(Device& device, const Model& model, const UploadedModel& uploaded,
                         const Light& light, const RasterOptions& options) {
  DrawnShadows drawn;
  const std::vector<LightView> views = frameLight(model, light, options.pointMaps, options.shadowSize);
  // Six maps with images of their own would have more than a dispatch binds.
  const bool few =
      options.shadow.placement != MapPlacement::Separate || 3 * views.size() <= PELLUCID_SHADOW_IMAGE_COUNT;
  const bool casters = few && options.shadow.cull != MapCull::Front;
  for (const LightView& lightView : views) {
    const DrawView view{lightView.clipFromView, lightView.viewFromWorld, kReversed};
    drawn.targets.push_back(drawShadow(device, uploaded, view, options.shadowSize, casters));
    const RenderTarget& target = *drawn.targets.back();
    drawn.images.push_back({&target.image(kPlanar), options.shadowSize, view.clipFromView, view.viewFromWorld,
                            light.type != PELLUCID_LIGHT_DIRECTIONAL});
    ShadowMap& map = drawn.maps.emplace_back();
    if (isPlain(options.shadow))
      map.depth = encodeShadow(target, drawn.images.back(), options.shadowEncoding);
    else
      drawAsEngine(device, uploaded, view, options, map);
    map.clipFromWorld = multiply(view.clipFromView, view.viewFromWorld);
    map.viewFromWorld = view.viewFromWorld;
    if (!casters) continue;
    map.exitDepth =
        exitDepth(device, uploaded, view, target, drawn.images.back(), options.shadowEncoding).image;
    map.casterMaterial = casterMaterial(target);
  }
  return drawn;
}

void checkShadowDrawing(const Model& model, const RasterOptions& options) {
  const ShadowDrawing& drawing = options.shadow;
  constexpr double kMostBias = 1e3;
  for (const double bias : {drawing.depthBiasConstant, drawing.depthBiasSlope})
    if (!(std::abs(bias) <= kMostBias))
      throw InputError(model.name, "shadowDepthBias", std::to_string(bias) + " is outside -1000 .. 1000");
  if (drawing.bits != 16 && drawing.bits != 24 && drawing.bits != 32)
    throw InputError(model.name, "shadowBits", std::to_string(drawing.bits) + " is not 16, 24 or 32");
  if (!isPlain(drawing) && options.shadowEncoding != PELLUCID_DEPTH_DEVICE)
    throw InputError(
        model.name, "shadowDepth",
        "must be device where maps are culled, biased or of other than 32 bits: only depth buffers are");
  if (options.shadowSize == 0 && (!isPlain(drawing) || drawing.placement != MapPlacement::Separate))
    throw InputError(model.name, "shadowSize", "is 0, but something is asked of the shadow maps");
}

void placeShadowMaps(MapPlacement placement, std::vector<Light>& lights) {
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
        map.offset = {index % columns * map.depth.image.width, index / columns * map.depth.image.height};
      ++index;
    }
}

}  // namespace pellucid::harness
