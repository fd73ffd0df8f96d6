// Translucency computed by the shader that draws the back faces, against the fused dispatch.
#include <cmath>

#include "gpu/gpu_fixture.h"
#include "gpu/model_builder.h"
#include "raster/draw.h"
#include "raster/passes.h"
#include "raster/raster.h"

namespace {

using namespace pellucid::harness;
using namespace pellucid::test;

// With lights of all types.
Model litBallAndEar() {
  Model model = ballAndEar();
  Light lamp = pointLight({15, 5, -25}, 900);
  lamp.color = {1, 0.6, 0.3};
  Light spot = lamp;
  spot.type = PELLUCID_LIGHT_SPOT;
  spot.position = {-20, 0, -25};
  spot.direction = {20, 0, 25};
  spot.outerConeAngle = 0.4;
  model.lights = {directional({0.3, -0.2, 1}, 3), lamp, spot};
  return model;
}

// What the dispatch adds to the irradiance, RGB, by the shader that draws back faces (Whelan 2009, 6.2.4).
// `frame` and `plan` are of a replay of `capture` with camera-space thickness and one fused dispatch, and
// `capture` is what rasterize() made of the model and options.
Image rasterizeTransmitted(Device& device, const Model& model, const Capture& capture,
                           const PellucidFrame& frame, const PellucidPlan& plan,
                           const RasterOptions& options) {
  const HostBuffer constants(device, plan.constantsSize,
                             VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT | VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
  EXPECT_EQ(pellucidWriteConstants(&plan, &frame, constants.mapped(), static_cast<size_t>(constants.size())),
            PELLUCID_OK);
  const UploadedModel uploaded(device, model);
  const DrawView view{capture.clipFromView, capture.viewFromWorld, options.reversedZ};
  TargetPool targets(device);
  const FrontTarget front(targets, options);
  const bool keepGreater = options.reversedZ;
  const RenderTarget target(
      device,
      {options.width, options.height, {{VK_FORMAT_R32G32B32A32_SFLOAT, clearTo(0)}}, farDepth(keepGreater)});
  const PlannedInputs planned{plan, frame, constants.handle()};
  device.run([&](VkCommandBuffer commands) {
    front.record(commands, uploaded, view);
    uploaded.record(commands, target, view,
                    {FragmentShader::Transmit, VK_CULL_MODE_FRONT_BIT, nearer(keepGreater), false},
                    VK_CULL_MODE_FRONT_BIT, {&front.depthNormal(), &front.albedoObject(), &planned});
  });
  return rgb(target.image(0).download());
}

const Vector3 kEye = {10, 20, 100};

class Transmit : public GpuTest {
protected:
  struct Difference {
    double peak = 0, sum = 0, difference = 0;
    std::size_t lit = 0, apart = 0;  // values
  };

  // Difference of the raster pass and the light that the dispatch adds to the irradiance. `apart`: values
  // further apart than 1e-3 of 5, about the peak.
  static Difference difference(bool orthographic, const RasterOptions& options, ReplaySettings settings) {
    const Model model = litBallAndEar();
    RasterResult raster = rasterize(device(), model, frontCamera(orthographic, kEye), options);
    EXPECT_EQ(raster.openPixels, 0u);
    Capture& capture = raster.capture;
    capture.albedo = {};  // would multiply the sum
    settings.features = PELLUCID_FEATURE_TRANSLUCENCY;
    settings.outputFormat = VK_FORMAT_R32G32B32A32_SFLOAT;
    settings.translucency.cameraThickness = 1;
    const Context& context = replayer().contextFor(capture);
    const FrameRun run(device(), context, capture, {testMaterial()}, settings);
    const Image fused = record(run);
    const Image drawn = rasterizeTransmitted(device(), model, capture, run.frame(), run.plan(), options);
    Difference d;
    for (std::size_t i = 0; i < drawn.data.size(); ++i) {
      const double added = fused.data[i / 3 * 4 + i % 3] - capture.irradiance.data[i];
      d.apart += std::abs(added - drawn.data[i]) > 5e-3;
      d.peak = std::max(d.peak, added);
      d.sum += added;
      d.difference += std::abs(added - drawn.data[i]);
      d.lit += added > 1e-3;
    }
    return d;
  }
};

// Both evaluate the same functions of the same float depths. Differences are left: the rounding of the sum with the irradiance, and
// the normal of the hidden face, which the pass takes from its triangle and the dispatch from depths. The thesis's models of angles take
// no such normal: there it decides edges of shadows alone.
TEST_F(Transmit, BackFacePassEqualsTheFusedDispatch) {
  ReplaySettings cosine = thesisSettings();
  cosine.transmittance = TransmittanceChoice::Gaussians;
  cosine.translucency.angleModel = PELLUCID_ANGLE_COSINE;
  cosine.translucency.constantViewDirection = true;
  cosine.translucency.transmittanceFilter = {0.55f, 0.29f, 0.28f};
  const ReplaySettings physical;
  const std::pair<const char*, ReplaySettings> kSettings[] = {
      {"physical", physical}, {"thesis", thesisSettings()}, {"cosine", cosine}};
  for (const auto& [name, settings] : kSettings) {
    SCOPED_TRACE(name);
    const bool orthographic = settings.translucency.constantViewDirection,
               reversed = &settings != &kSettings[1].second;
    const RasterOptions options{
        .width = 96,
        .height = 80,
        .reversedZ = reversed,
        .shadowSize = 256,
        .shadowEncoding = orthographic ? PELLUCID_DEPTH_DISTANCE : PELLUCID_DEPTH_DEVICE};
    const Difference d = difference(orthographic, options, settings);
    if (&settings == &kSettings[0].second) {
      EXPECT_LE(d.difference, 0.08 * d.sum) << "6.8 %: triangles of the ball turn by some 10 degrees";
    } else {
      EXPECT_LE(d.apart, d.lit / 12) << "edges of three lights' shadows are up to 8 % of these few pixels";
      EXPECT_LE(d.difference, 0.012 * d.sum) << "1.1 % is the worst";
    }
    EXPECT_GT(d.lit, 300u);
    EXPECT_GT(d.peak, 0.05);
  }
}

}  // namespace
