#include "raster/raster.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>

#include "common/error.h"
#include "raster/draw.h"
#include "raster/framing.h"
#include "raster/front.h"
#include "raster/irradiance.h"
#include "raster/shadow.h"
#include "raster/simplify.h"
#include "scene/vector.h"

namespace pellucid::harness {

namespace {

constexpr int kLargestSide = 8192;

void checkSide(const Model& model, const char* field, int value, int smallest) {
  if (value < smallest || value > kLargestSide)
    throw InputError(model.name, field,
                     std::to_string(value) + " is outside " + std::to_string(smallest) + " .. " +
                         std::to_string(kLargestSide));
}

Matrix projection(const ModelCamera& camera, const RasterOptions& options) {
  const double aspect = static_cast<double>(options.width) / options.height;
  ClipRange range = camera.range;
  range.reversed = options.reversedZ;
  if (options.infiniteFar) {
    if (camera.orthographic)
      throw InputError("", "infiniteFar",
                       "camera \"" + camera.name + "\" is orthographic and needs a far plane");
    range.farPlane = std::numeric_limits<double>::infinity();
  }
  return camera.orthographic ? orthographic(camera.height * aspect, camera.height, range)
                             : perspective(camera.verticalFov, aspect, range);
}

// Back depth in both encodings and the faces counted along each pixel's ray.
struct BackImages {
  Image planar, deviceDepth, count;
};

BackImages drawBack(Device& device, const UploadedModel& model, const DrawView& view,
                    const FrontTarget& front, const RasterOptions& options) {
  const bool farthest = options.backFace == BackFace::Farthest;
  const bool keepGreater = options.reversedZ != farthest;
  const RenderTarget back(device, options.width, options.height, depthColors(options.reversedZ),
                          farDepth(keepGreater));
  model.draw(back, view, {FragmentShader::Depth, VK_CULL_MODE_FRONT_BIT, nearer(keepGreater), false},
             VK_CULL_MODE_FRONT_BIT, {&front.depthNormal(), &front.albedoObject()});
  // Half floats count to 2048 and every device can blend them.
  const RenderTarget count(device, options.width, options.height,
                           {{VK_FORMAT_R16G16B16A16_SFLOAT, clearTo(0)}}, std::nullopt);
  model.draw(count, view, {FragmentShader::Count, VK_CULL_MODE_NONE, std::nullopt, true}, VK_CULL_MODE_NONE,
             {&back.image(kDeviceDepth), &front.albedoObject()});
  return {back.image(kPlanar).download(), back.image(kDeviceDepth).download(), count.image(0).download()};
}

bool isInFront(float depth, float other, const RasterOptions& options) {
  const bool greaterIsNearer = options.depthEncoding == PELLUCID_DEPTH_DEVICE && options.reversedZ;
  return greaterIsNearer ? depth > other : depth < other;
}

// Between the front and the nearest back face of a closed object lies nothing of it, or as many entrances
// as exits along the whole ray.
bool isClosed(const float* count, BackFace backFace) {
  return count[0] == 0 || (backFace == BackFace::Nearest && count[1] == 1);
}

// Adds the light to `irradiance` and returns it with its shadow maps.
// `transmission`: what the light's way through the model is drawn with.
Light drawLight(Device& device, const Model& model, const UploadedModel& uploaded,
                const UploadedModel& transmission, const Light& light, const RasterOptions& options,
                IrradiancePass& irradiance) {
  Light result = light;
  if (options.shadowSize == 0) {
    if (light.radius == 0) irradiance.add(light, {});
    return result;
  }
  const DrawnShadows drawn = drawShadows(device, model, uploaded, light, options);
  result.shadowMaps =
      &transmission == &uploaded ? drawn.maps : drawShadows(device, model, transmission, light, options).maps;
  if (light.radius == 0) irradiance.add(light, drawn.images);
  return result;
}

bool hasLobesApart(const Model& model) {
  return std::any_of(model.surfaces.begin(), model.surfaces.end(),
                     [](const Surface& s) { return s.lobes == SurfaceLobes::Apart; });
}

Image drawReflectedShare(Device& device, const UploadedModel& model, const DrawView& view,
                         const RasterOptions& options) {
  const RenderTarget target(device, options.width, options.height,
                            {{VK_FORMAT_R32G32B32A32_SFLOAT, clearTo(0)}}, farDepth(options.reversedZ));
  model.draw(target, view,
             {FragmentShader::Reflected, VK_CULL_MODE_BACK_BIT, nearer(options.reversedZ), false},
             VK_CULL_MODE_NONE);
  return rgb(target.image(0).download());
}

// The pixels of the front and back passes as a capture has them.
void fillCapture(const FrontTarget& front, const BackImages& back, const RasterOptions& options,
                 RasterResult& result) {
  Capture& capture = result.capture;
  const bool device = options.depthEncoding == PELLUCID_DEPTH_DEVICE;
  const Image normalPlanar = front.normalPlanar().download();
  const Image albedo = front.albedoObject().download();
  const Image material = front.material().download();
  capture.frontDepth = {channel(front.depthNormal().download(), 0), options.depthEncoding};
  capture.backDepth = {device ? back.deviceDepth : back.planar, options.depthEncoding};
  capture.normal = Image(capture.width, capture.height, 3);
  capture.albedo = Image(capture.width, capture.height, 3);
  capture.material.resize(material.pixels());
  const float nothing = device ? farDepth(options.reversedZ) : kNoDepth;
  const glm::dmat3 rotation =
      options.normalsInViewSpace ? glm::dmat3(toGlm(capture.viewFromWorld)) : glm::dmat3(1);
  for (std::size_t i = 0; i < material.pixels(); ++i) {
    const float* n = &normalPlanar.data[4 * i];
    const float planar = n[3];
    if (!device) capture.frontDepth.image.data[i] = planar > 0 ? planar : kNoDepth;
    if (!(planar > 0)) continue;
    capture.material[i] = static_cast<std::uint8_t>(material.data[i]);
    const glm::dvec3 normal = rotation * glm::dvec3(n[0], n[1], n[2]);
    for (int c = 0; c < 3; ++c) {
      const std::size_t k = 3 * i + static_cast<std::size_t>(c);
      capture.normal.data[k] = static_cast<float>(normal[c]);
      capture.albedo.data[k] = albedo.data[4 * i + static_cast<std::size_t>(c)];
    }
    float& backDepth = capture.backDepth.image.data[i];
    const float frontDepth = capture.frontDepth.image.data[i];
    // At an edge of the silhouette both are one, but for what rounding makes of steep triangles.
    if (isInFront(backDepth, frontDepth, options)) backDepth = frontDepth;
    if (!isClosed(&back.count.data[4 * i], options.backFace)) backDepth = nothing;
    result.openPixels += capture.material[i] != 0 && capture.backDepth.image.data[i] == nothing;
  }
  const std::vector<float>& backs = capture.backDepth.image.data;
  if (result.openPixels > 0 && std::all_of(backs.begin(), backs.end(), [&](float d) { return d == nothing; }))
    capture.backDepth.image = {};
}

void addWarnings(RasterResult& result, const RasterOptions& options) {
  const Capture& capture = result.capture;
  const auto covered = capture.material.size() - static_cast<std::size_t>(std::count(
                                                     capture.material.begin(), capture.material.end(), 0));
  if (covered == 0) result.warnings.push_back("no pixel has a material: nothing is translucent");
  if (result.openPixels > 0)
    result.warnings.push_back(std::to_string(result.openPixels) + " of " + std::to_string(covered) +
                              " material pixels look through an open or single-sided mesh: they have no "
                              "back depth" +
                              (capture.backDepth.image.empty() ? ", and the capture no backDepth" : ""));
  for (std::size_t i = 0; i < capture.lights.size() && options.shadowSize > 0; ++i)
    if (capture.lights[i].shadowMaps.empty())
      result.warnings.push_back("lights[" + std::to_string(i) +
                                "] stands within or too close to the model for one shadow map: it has none "
                                "and nothing shadows it");
}

}  // namespace

RasterResult rasterize(Device& device, const Model& model, const ModelCamera& camera,
                       const RasterOptions& options) {
  boundsOf(model);  // refuses an empty model, of which nothing can be uploaded
  return rasterize(device, model, UploadedModel(device, model), camera, options);
}

RasterResult rasterize(Device& device, const Model& model, const UploadedModel& uploaded,
                       const ModelCamera& camera, const RasterOptions& options) {
  checkSide(model, "width", options.width, 1);
  checkSide(model, "height", options.height, 1);
  checkSide(model, "shadowSize", options.shadowSize, 0);
  if (options.depthEncoding == PELLUCID_DEPTH_DISTANCE)
    throw InputError(model.name, "depthEncoding", "distance is an encoding of shadow maps only");
  checkShadowDrawing(model, options);

  RasterResult result;
  Capture& capture = result.capture;
  capture.name = model.name;
  capture.width = options.width;
  capture.height = options.height;
  capture.metersPerUnit = model.metersPerUnit;
  capture.clipFromView = projection(camera, options);
  capture.viewFromWorld = camera.viewFromWorld;
  capture.normalsInViewSpace = options.normalsInViewSpace;
  capture.materials = model.materials;

  const DrawView view{capture.clipFromView, capture.viewFromWorld, options.reversedZ};
  const FrontTarget front(device, options);
  front.draw(uploaded, view);
  std::optional<Model> simple;
  std::optional<UploadedModel> simpleUploaded;
  if (options.simplify != 1) {
    simple = simplified(model, options.simplify);
    simpleUploaded.emplace(device, *simple);
  }
  const UploadedModel& transmission = simpleUploaded ? *simpleUploaded : uploaded;
  fillCapture(front, drawBack(device, transmission, view, front, options), options, result);

  IrradiancePass irradiance(device, front.normalPlanar(), front.depthNormal(), options.width, options.height,
                            view);
  for (const Light& light : model.lights)
    capture.lights.push_back(drawLight(device, model, uploaded, transmission, light, options, irradiance));
  placeShadowMaps(options.shadow.placement, capture.lights);
  capture.irradiance = irradiance.irradiance();
  if (hasLobesApart(model)) {
    result.reflectedShare = drawReflectedShare(device, uploaded, view, options);
    for (std::size_t i = 0; i < capture.irradiance.data.size(); ++i)
      capture.irradiance.data[i] *= result.reflectedShare.data[i];
  }
  addWarnings(result, options);
  return result;
}

}  // namespace pellucid::harness
