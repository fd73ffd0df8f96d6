#include "view/frames.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/packing.hpp>
#include <memory>
#include <utility>

#include "capture/material.h"
#include "common/gpu_image.h"
#include "metrics/spots.h"
#include "raster/rasterizer.h"
#include "replay/exposure.h"
#include "replay/inputs.h"
#include "shared/pellucid_shared.h"

namespace pellucid::harness {

namespace {

// Images that a frame of these settings reads. Nothing goes to the host, but for what is to be stored in
// ways that no engine's images have here: distances in shadow maps, maps drawn as an engine does or in one
// image, other formats than floats and halves.
std::shared_ptr<const InputImages> drawnInputs(const DrawnFrame& drawn, const ReplaySettings& settings) {
  const RasterOptions& options = drawn.options;
  if (!areOnDevice(options) || preExposureOf(settings) != 1 || settings.materialMask != 0)
    return std::make_shared<const InputImages>(drawn.device, drawn.capture(), settings);
  InputImages::Images inputs;
  inputs.shape.backDepth = drawn.hasBackDepth();
  inputs.shape.albedo = true;
  inputs.frontDepth = drawn.frontDepth;
  if (drawn.hasBackDepth()) inputs.backDepth = drawn.backDepth;
  const auto& front = drawn.front.target;
  inputs.albedo = sharedImage(front, FrontTarget::kAlbedoObject);
  inputs.material = sharedImage(front, FrontTarget::kMaterial);
  inputs.irradiance = drawn.irradianceIn(irradianceFormat(settings));
  const int size = options.shadowSize;
  for (const std::vector<DrawnMap>& maps : drawn.maps)
    for (const DrawnMap& map : maps) {
      FrameShape::Map& place = inputs.shape.maps.emplace_back();
      place.extent = {size, size};
      const DeviceMap mapped = deviceMap(map, options);
      std::size_t i = 0;
      for (const auto& image : {mapped.depth, mapped.exit, mapped.casterMaterial}) {
        if (image) {
          place.images[i] = static_cast<int>(inputs.shadows.size());
          inputs.shadows.push_back(image);
        }
        ++i;
      }
    }
  inputs.shape.shadowImages = inputs.shadows.size();
  return std::make_shared<const InputImages>(std::move(inputs));
}

// RGB as an image of the format holds it.
void store(float* rgb, VkFormat format) {
  if (format == VK_FORMAT_R16G16B16A16_SFLOAT)
    for (int c = 0; c < 3; ++c) rgb[c] = glm::unpackHalf1x16(glm::packHalf1x16(rgb[c]));
  if (format != VK_FORMAT_B10G11R11_UFLOAT_PACK32) return;
  const glm::vec3 packed = unpackB10G11R11(packB10G11R11({rgb[0], rgb[1], rgb[2]}));
  for (int c = 0; c < 3; ++c) rgb[c] = packed[c];
}

// Irradiance times albedo: what a replay leaves where no material is.
Image composited(const Capture& capture, VkFormat format) {
  Image result = litAlbedo(capture);
  for (std::size_t i = 0; i < result.pixels(); ++i) store(&result.data[3 * i], format);
  return result;
}

VkRect2D rectOf(int x, int y, int width, int height) {
  return {{x, y}, {static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height)}};
}

double coveredPartOf(const Scene& scene) {
  const Capture& capture = scene.capture;
  const double pixels = static_cast<double>(capture.width) * capture.height;
  if (scene.drawn) return scene.drawn->counts.material / pixels;
  return 1 - static_cast<double>(std::count(capture.material.begin(), capture.material.end(), 0)) / pixels;
}

// Names the frame whose output or inputs a picture shows.
Shown frameOf(Shown shown) { return shown == Shown::Through || shown == Shown::Debug ? shown : Shown::After; }

}  // namespace

ViewFrames::ViewFrames(Device& device, Contexts& contexts, Source& source)
    : device_(device), source_(source), contexts_(contexts), pool_(device) {}

ViewFrames::Frame ViewFrames::make(const ViewState& state, Shown shown, const Capture& outline,
                                   const std::vector<PellucidMaterial>& materials,
                                   const std::shared_ptr<const InputImages>& inputs) {
  const auto before = runs_.find(shown);
  const bool goesOn = before != runs_.end() && !forget_ && outline.width == this->outline().width &&
                      outline.height == this->outline().height;
  Frame frame;
  frame.run = std::make_shared<const FrameRun>(device_, contexts_.of(outline), outline, materials,
                                               settingsFor(state, shown), inputs,
                                               goesOn ? before->second.get() : nullptr, &pool_);
  const PellucidPlan& plan = frame.run->plan();
  const Timestamps timestamps(device_, plan.dispatchCount + 1);
  device_.run([&](VkCommandBuffer commandBuffer) {
    timestamps.reset(commandBuffer);
    timestamps.mark(commandBuffer, 0);
    for (std::uint32_t i = 0; i < plan.dispatchCount; ++i) {
      frame.run->record(commandBuffer, i);
      timestamps.mark(commandBuffer, i + 1);
    }
  });
  const std::vector<double> intervals = timestamps.intervals();
  for (std::uint32_t i = 0; i < plan.dispatchCount; ++i)
    frame.times.push_back({plan.dispatches[i].name, intervals[i]});
  return frame;
}

void ViewFrames::update(const ViewState& state, const Changes& changes) {
  const bool scene = changes.scene || !inputs_ || (changes.materials && source_.drawsMaterials());
  const bool upload = scene || state.settings.outputFormat != format_;
  const bool compile = changes.materials || !inputs_;
  const bool frames = upload || compile || changes.frame;
  std::optional<Scene> rendered;
  if (scene) {
    rendered = source_.render(state);
    constexpr double kLargestHalf = 65504;
    if (const double light = largestLight(rendered->capture); light > kLargestHalf)
      rendered->warnings.push_back("lights bring an irradiance of " + std::to_string(std::lround(light)) +
                                   ": the view cuts it at 65504; `pellucid replay` does not");
  }
  const Scene& seen = rendered ? *rendered : scene_;
  const std::shared_ptr<const InputImages> inputs =
      !upload      ? inputs_
      : seen.drawn ? drawnInputs(*seen.drawn, state.settings)
                   : std::make_shared<const InputImages>(device_, seen.capture, state.settings);
  const std::vector<MaterialSource> sources = source_.materials(state);
  std::vector<PellucidMaterial> materials = materials_;
  if (compile) {
    materials.clear();
    for (std::size_t i = 0; i < sources.size(); ++i)
      materials.push_back(compileMaterial(sources[i], "materials[" + std::to_string(i) + "]"));
  }
  std::map<Shown, Frame> made;
  const auto need = [&](Shown shown) {
    const Shown of = frameOf(shown);
    if ((frames || runs_.count(of) == 0) && made.count(of) == 0)
      made[of] = make(state, of, seen.capture, materials, inputs);
  };
  if (frames) pool_.nextFrame();
  need(Shown::After);
  need(state.display.shown);
  if (state.display.split) need(state.display.left);
  // All is made; nothing below throws but for memory.
  if (frames) {
    runs_.clear();
    images_.clear();
    truth_.reset();
    materials_ = std::move(materials);
  }
  for (auto& [of, frame] : made) {
    runs_[of] = std::move(frame.run);
    if (of != Shown::After) continue;
    times_ = std::move(frame.times);
    ++recorded_;
    forget_ = false;
  }
  if (scene) {
    scene_ = std::move(*rendered);
    hasSurfaces_ = hasMaps_ = hasMaterial_ = !scene_.drawn;
    coveredPart_ = coveredPartOf(scene_);
  }
  scene_.capture.materials = sources;
  inputs_ = inputs;
  format_ = state.settings.outputFormat;
  uploadTruth();
}

void ViewFrames::uploadTruth() {
  if (!outline().truth || truth_) return;
  truth_ = std::make_unique<GpuImage>(device_, outline().width, outline().height, VK_FORMAT_R32G32B32A32_SFLOAT);
  truth_->upload(outline().truth->image);
}

const FrameRun& ViewFrames::run(Shown shown) const {
  const auto found = runs_.find(frameOf(shown));
  return *(found != runs_.end() ? found : runs_.find(Shown::After))->second;
}

const Capture& ViewFrames::surfaces() const {
  if (!hasSurfaces_) {
    Capture& capture = scene_.capture;
    Capture downloaded = scene_.drawn->surfaces(rectOf(0, 0, capture.width, capture.height));
    downloaded.lights = std::move(capture.lights);
    downloaded.materials = std::move(capture.materials);
    capture = std::move(downloaded);
    hasSurfaces_ = hasMaterial_ = true;
  }
  return scene_.capture;
}

const Capture& ViewFrames::capture() const {
  surfaces();
  if (!hasMaps_) scene_.capture.lights = scene_.drawn->lights();
  hasMaps_ = true;
  return scene_.capture;
}

const std::vector<std::uint8_t>& ViewFrames::material() const {
  if (!hasMaterial_) scene_.capture.material = scene_.drawn->material();
  hasMaterial_ = true;
  return scene_.capture.material;
}

const std::vector<DispatchTime>& ViewFrames::sceneTimes() const {
  static const std::vector<DispatchTime> kNone;
  return scene_.drawn ? scene_.drawn->times : kNone;
}

const Image& ViewFrames::image(Shown shown) const {
  const auto found = images_.find(shown);
  if (found != images_.end()) return found->second;
  const Image image = pixels(shown, surfaces(), rectOf(0, 0, outline().width, outline().height));
  return images_.emplace(shown, image).first->second;
}

std::vector<float> ViewFrames::value(Shown shown, int x, int y) const {
  const VkRect2D rect = rectOf(x, y, 1, 1);
  const bool isHosts = hasSurfaces_ || images_.count(shown) > 0;
  if (isHosts) return cropped(image(shown), x, y, 1, 1).data;
  return pixels(shown, scene_.drawn->surfaces(rect), rect).data;
}

// `surfaces`: of the pixels in `rect`.
Image ViewFrames::pixels(Shown shown, const Capture& surfaces, const VkRect2D& rect) const {
  const std::vector<std::uint8_t>& material = surfaces.material;
  const Image& irradiance = surfaces.irradiance;
  const int width = irradiance.width, height = irradiance.height;
  switch (shown) {
    case Shown::After: {
      const FrameRun& frame = run(shown);
      const Image output = rgb(frame.output(rect));
      Image result = composited(surfaces, frame.frame().options.outputFormat);
      for (std::size_t i = 0; i < result.pixels(); ++i)
        if (material[i] != 0) std::copy_n(&output.data[3 * i], 3, &result.data[3 * i]);
      return result;
    }
    case Shown::Before:
      return composited(surfaces, VK_FORMAT_R32G32B32A32_SFLOAT);
    case Shown::Through: {
      Image result = rgb(run(shown).output(rect));
      const Image before = pixels(Shown::Before, surfaces, rect);
      for (std::size_t i = 0; i < result.pixels(); ++i)
        for (std::size_t c = 0; c < 3; ++c) {
          float& value = result.data[3 * i + c];
          value = material[i] != 0 ? std::max(value - before.data[3 * i + c], 0.0f) : 0;
        }
      return result;
    }
    case Shown::Difference: {
      Image result = pixels(Shown::After, surfaces, rect);
      const Image other = pixels(outline().truth ? Shown::Truth : Shown::Before, surfaces, rect);
      for (std::size_t i = 0; i < result.data.size(); ++i)
        result.data[i] = std::abs(result.data[i] - other.data[i]);
      return result;
    }
    case Shown::Truth:
      return outline().truth ? cropped(outline().truth->image, rect.offset.x, rect.offset.y, width, height)
                             : Image(width, height, 3);
    case Shown::Debug:
      return rgb(run(shown).output(rect));
    case Shown::FrontDepth:
      return surfaces.frontDepth.image;
    case Shown::Albedo:
      return surfaces.albedo.empty() ? Image(width, height, 3, 1.0f) : surfaces.albedo;
    case Shown::Material: {
      Image result(width, height, 1);
      std::copy(material.begin(), material.end(), result.data.begin());
      return result;
    }
  }
  return {};
}

}  // namespace pellucid::harness
