#include "raster/rasterizer.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "common/error.h"
#include "raster/bodies.h"
#include "raster/mesh.h"
#include "scene/vector.h"

namespace pellucid::harness {

std::vector<std::string> DrawnFrame::warnings() const {
  std::vector<std::string> warnings;
  if (counts.material == 0) warnings.push_back("no pixel has a material: nothing is translucent");
  if (counts.open > 0)
    warnings.push_back(std::to_string(counts.open) + " of " + std::to_string(counts.material) +
                       " material pixels have no back depth: the mesh is open or single-sided, its faces are "
                       "turned inward, or its "
                       "back lies beyond the camera's far plane" +
                       (hasBackDepth() ? "" : ", and the capture no backDepth"));
  for (std::size_t i = 0; i < outline.lights.size() && options.shadowSize > 0; ++i)
    if (outline.lights[i].shadowMaps.empty())
      warnings.push_back("lights[" + std::to_string(i) +
                         "] stands within or too close to the model for one shadow map: it has none "
                         "and nothing shadows it");
  return warnings;
}

std::shared_ptr<GpuImage> DrawnFrame::irradianceIn(VkFormat format) const {
  if (format == VK_FORMAT_R32G32B32A32_SFLOAT) return irradianceImage;
  const std::shared_ptr<GpuImage> image = passes->images.take(options.width, options.height, format);
  if (format == VK_FORMAT_R16G16B16A16_SFLOAT)
    device.run([&](VkCommandBuffer commands) { passes->recordHalves(commands, *irradianceImage, *image); });
  else
    image->upload(rgb(irradianceImage->download()));
  return image;
}

Capture DrawnFrame::surfaces(const VkRect2D& rect) const {
  Capture capture = outline;
  capture.width = static_cast<int>(rect.extent.width);
  capture.height = static_cast<int>(rect.extent.height);
  capture.frontDepth.image = frontDepth->download(rect);
  if (hasBackDepth()) capture.backDepth.image = backDepth->download(rect);
  capture.irradiance = rgb(irradianceImage->download(rect));
  capture.albedo = rgb(front.albedoObject().download(rect));
  const Image material = front.material().download(rect);
  capture.material.assign(material.data.begin(), material.data.end());
  return capture;
}

std::vector<Light> DrawnFrame::lights() const {
  std::vector<Light> lights = outline.lights;
  for (std::size_t i = 0; i < maps.size(); ++i)
    for (std::size_t k = 0; k < maps[i].size(); ++k)
      lights[i].shadowMaps[k] = downloadMap(maps[i][k], options);
  placeShadowMaps(options.shadow.placement, options.shadowSize, lights);
  return lights;
}

std::vector<std::uint8_t> DrawnFrame::material() const {
  const Image material = front.material().download();
  return {material.data.begin(), material.data.end()};
}

Capture DrawnFrame::capture() const {
  Capture capture = surfaces(
      {{0, 0}, {static_cast<std::uint32_t>(options.width), static_cast<std::uint32_t>(options.height)}});
  capture.lights = lights();
  return capture;
}

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
  Matrix clip = camera.orthographic ? orthographic(camera.height * aspect, camera.height, range)
                                    : perspective(camera.verticalFov, aspect, range);
  const double moved[] = {2 * options.jitter[0] / options.width, 2 * options.jitter[1] / options.height};
  for (std::size_t axis = 0; axis < 2; ++axis)
    for (std::size_t column = 0; column < 4; ++column)
      clip[4 * column + axis] += moved[axis] * clip[4 * column + 3];
  return clip;
}

void checkOptions(const Model& model, const ModelCamera& camera, const RasterOptions& options) {
  checkSide(model, "width", options.width, 1);
  checkSide(model, "height", options.height, 1);
  checkSide(model, "shadowSize", options.shadowSize, 0);
  if (options.depthEncoding == PELLUCID_DEPTH_DISTANCE)
    throw InputError(model.name, "depthEncoding", "distance is an encoding of shadow maps only");
  for (const double pixels : options.jitter)
    if (!(std::abs(pixels) <= 1))
      throw InputError(model.name, "jitter", std::to_string(pixels) + " is outside -1 .. 1");
  checkShadowDrawing(model, camera, options);
}

BackFaces recordBack(VkCommandBuffer commands, TargetPool& targets, const UploadedModel& model,
                     const DrawView& view, const FrontTarget& front, const RasterOptions& options) {
  const bool keepGreater = options.reversedZ != (options.backFace == BackFace::Farthest);
  // Half floats count to 2048 and every device can blend them.
  const BackFaces back{
      targets.take({options.width, options.height, depthColors(options.reversedZ), farDepth(keepGreater)}),
      targets.take({options.width, options.height, {{VK_FORMAT_R16G16B16A16_SFLOAT, clearTo(0)}}})};
  model.record(commands, *back.depths, view,
               {FragmentShader::Depth, VK_CULL_MODE_FRONT_BIT, nearer(keepGreater), false},
               VK_CULL_MODE_FRONT_BIT, {&front.depthNormal(), &front.albedoObject()});
  model.record(commands, *back.counts, view, {FragmentShader::Count, VK_CULL_MODE_NONE, std::nullopt, true},
               VK_CULL_MODE_NONE, {&back.depths->image(kDeviceDepth), &front.albedoObject()});
  return back;
}

bool hasLobesApart(const Model& model) {
  return std::any_of(model.surfaces.begin(), model.surfaces.end(),
                     [](const Surface& s) { return s.lobes == SurfaceLobes::Apart; });
}

// Parts of a frame, timed one by one.
class Steps {
public:
  void add(std::string name, std::function<void(VkCommandBuffer)> record) {
    steps_.emplace_back(std::move(name), std::move(record));
  }

  std::vector<DispatchTime> run(Device& device) const {
    const Timestamps timestamps(device, static_cast<std::uint32_t>(steps_.size()) + 1);
    device.run([&](VkCommandBuffer commands) {
      timestamps.reset(commands);
      timestamps.mark(commands, 0);
      for (std::size_t i = 0; i < steps_.size(); ++i) {
        steps_[i].second(commands);
        timestamps.mark(commands, static_cast<std::uint32_t>(i) + 1);
      }
    });
    const std::vector<double> intervals = timestamps.intervals();
    std::vector<DispatchTime> times;
    for (std::size_t i = 0; i < steps_.size(); ++i) times.push_back({steps_[i].first, intervals[i]});
    return times;
  }

private:
  std::vector<std::pair<std::string, std::function<void(VkCommandBuffer)>>> steps_;
};

}  // namespace

struct Rasterizer::Simplified {
  double ratio;
  Model model;
  UploadedModel uploaded;

  Simplified(Device& device, const Model& whole, double share)
      : ratio(share), model(simplified(whole, share)), uploaded(device, model) {}
};

Rasterizer::Rasterizer(Device& device, const Model& model)
    : device_(device),
      model_(model),
      points_(pointsOf(model)),
      uploaded_(device, model),
      passes_(std::make_shared<DrawPasses>(device)) {}

Rasterizer::~Rasterizer() = default;

const UploadedModel& Rasterizer::transmission(double simplify) {
  if (simplify == 1) return uploaded_;
  if (!simplified_ || simplified_->ratio != simplify)
    simplified_ = std::make_unique<Simplified>(device_, model_, simplify);
  return simplified_->uploaded;
}

std::shared_ptr<const DrawnFrame> Rasterizer::draw(const ModelCamera& camera, const RasterOptions& options) {
  checkOptions(model_, camera, options);
  passes_->nextFrame();
  const UploadedModel& transmission = this->transmission(options.simplify);

  Capture outline;
  outline.name = model_.name;
  outline.width = options.width;
  outline.height = options.height;
  outline.metersPerUnit = model_.metersPerUnit;
  outline.clipFromView = projection(camera, options);
  outline.viewFromWorld = camera.viewFromWorld;
  outline.frontDepth.encoding = outline.backDepth.encoding = options.depthEncoding;
  outline.materials = withBodies(model_.materials, model_.bodies);
  outline.lights = model_.lights;

  const DrawView view{outline.clipFromView, outline.viewFromWorld, options.reversedZ};
  const auto image = [&](VkFormat format) {
    return passes_->images.take(options.width, options.height, format);
  };
  const auto frame = std::make_shared<DrawnFrame>(DrawnFrame{
      device_, passes_, options, std::move(outline), FrontTarget(passes_->targets, options),
      image(VK_FORMAT_R32_SFLOAT), image(VK_FORMAT_R32_SFLOAT), image(VK_FORMAT_R32G32B32A32_SFLOAT)});
  DrawnFrame& f = *frame;
  f.maps.resize(model_.lights.size());
  Steps steps;
  steps.add("surfaces", [&](VkCommandBuffer commands) {
    f.irradianceImage->recordClear(commands);
    barrier(commands, {VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT}, kComputing);
    f.front.record(commands, uploaded_, view);
  });
  steps.add("back faces", [&](VkCommandBuffer commands) {
    const BackFaces back = recordBack(commands, passes_->targets, transmission, view, f.front, options);
    passes_->recordDepths(commands, f.front, back, *f.frontDepth, *f.backDepth, options);
  });
  const LitSurfaces surfaces{f.front.normalPlanar(), f.front.depthNormal(), *f.irradianceImage, view};
  // Maps of all triangles shadow the irradiance where the capture's have fewer.
  std::vector<std::vector<DrawnMap>> shadows(model_.lights.size());
  for (std::size_t i = 0; i < model_.lights.size(); ++i) {
    const Light& light = model_.lights[i];
    const std::vector<LightView> views =
        options.shadowSize > 0 ? shadowViews(points_, light, camera, options) : std::vector<LightView>();
    const auto draw = [&, views](VkCommandBuffer commands, const UploadedModel& model) {
      return recordShadows(commands, passes_->targets, views, model, light, options);
    };
    if (options.shadowSize > 0)
      steps.add("shadow maps", [&, draw, i](VkCommandBuffer commands) {
        shadows[i] = draw(commands, uploaded_);
        f.maps[i] = &transmission == &uploaded_ ? shadows[i] : draw(commands, transmission);
      });
    if (light.radius == 0)
      steps.add("irradiance", [&, i](VkCommandBuffer commands) {
        std::vector<ShadowImage> images;
        for (const DrawnMap& map : shadows[i]) images.push_back(map.image);
        passes_->recordIrradiance(commands, surfaces, model_.lights[i], images, options.shadow.filter);
      });
  }
  if (hasLobesApart(model_))
    steps.add("reflected share", [&](VkCommandBuffer commands) {
      f.share = passes_->targets.take({options.width,
                                       options.height,
                                       {{VK_FORMAT_R32G32B32A32_SFLOAT, clearTo(0)}},
                                       farDepth(options.reversedZ)});
      uploaded_.record(commands, *f.share, view,
                       {FragmentShader::Reflected, VK_CULL_MODE_BACK_BIT, nearer(options.reversedZ), false},
                       VK_CULL_MODE_NONE);
      passes_->recordReflection(commands, *f.irradianceImage, f.share->image(0));
    });
  f.times = steps.run(device_);
  f.counts = passes_->counts();
  for (std::size_t i = 0; i < f.maps.size(); ++i)
    for (const DrawnMap& map : f.maps[i]) f.outline.lights[i].shadowMaps.push_back(map.outline);
  placeShadowMaps(options.shadow.placement, options.shadowSize, f.outline.lights);
  return frame;
}

RasterResult rasterize(Device& device, const Model& model, const ModelCamera& camera,
                       const RasterOptions& options) {
  const std::shared_ptr<const DrawnFrame> frame = Rasterizer(device, model).draw(camera, options);
  return {frame->capture(), frame->counts.open,
          frame->share ? rgb(frame->share->image(0).download()) : Image(), frame->warnings()};
}

}  // namespace pellucid::harness
