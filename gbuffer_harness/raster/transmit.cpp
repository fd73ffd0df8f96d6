#include "raster/transmit.h"

#include "common/error.h"
#include "raster/draw.h"
#include "raster/front.h"

namespace pellucid::harness {

namespace {

// The plan's first dispatch is the one fused dispatch.
void requireFused(const PellucidFrame& frame, const PellucidPlan& plan, const std::string& name) {
  if (frame.options.cameraThickness == 0)
    throw InputError(name, "cameraThickness", "light-space thickness does not need the back faces");
  for (std::uint32_t i = 0; i < frame.shadowMapCount; ++i)
    if (frame.shadowMaps[i].options.layer > 0)
      throw InputError(name, "lights", "have shadow maps in layers; the back-face pass reads 2D images");
  if (plan.activeLights == 0) throw InputError(name, "lights", "none can contribute");
  // Lights are read from the first dispatch on, so all are in it when it has as many as are active.
  if (plan.dispatches[0].pushConstants[1] != plan.activeLights)
    throw InputError(name, "lights", "have more shadow images than one dispatch binds");
}

}  // namespace

Image rasterizeTransmitted(Device& device, const Model& model, const Capture& capture,
                           const PellucidFrame& frame, const PellucidPlan& plan,
                           const RasterOptions& options) {
  requireFused(frame, plan, model.name);
  const HostBuffer constants(device, plan.constantsSize,
                             VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT | VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
  const PellucidResult written =
      pellucidWriteConstants(&plan, &frame, constants.mapped(), static_cast<std::size_t>(constants.size()));
  if (written != PELLUCID_OK) throw InputError(model.name, "", pellucidResultName(written));

  const UploadedModel uploaded(device, model);
  const DrawView view{capture.clipFromView, capture.viewFromWorld, options.reversedZ};
  TargetPool targets(device);
  const FrontTarget front(targets, options);
  const bool keepGreater = options.reversedZ != (options.backFace == BackFace::Farthest);
  const RenderTarget target(device, options.width, options.height,
                            {{VK_FORMAT_R32G32B32A32_SFLOAT, clearTo(0)}}, farDepth(keepGreater));
  const PlannedInputs planned{plan, frame, constants.handle()};
  device.run([&](VkCommandBuffer commands) {
    front.record(commands, uploaded, view);
    uploaded.record(commands, target, view,
                    {FragmentShader::Transmit, VK_CULL_MODE_FRONT_BIT, nearer(keepGreater), false},
                    VK_CULL_MODE_FRONT_BIT, {&front.depthNormal(), &front.albedoObject(), &planned});
  });
  return rgb(target.image(0).download());
}

}  // namespace pellucid::harness
