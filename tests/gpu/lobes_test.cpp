// Surfaces whose reflected and transmitted light have colors of their own, from the rasterizer through the
// replay.
#include "gpu_fixture.h"

#include "gpu/model_builder.h"
#include "raster/raster.h"

namespace {

using namespace pellucid::test;

constexpr double kE = 2;

// A leaf, as KHR_materials_diffuse_transmission has it: half of the light comes through, in (.8, .1, .1).
Model leaf() {
  Model model = emptyModel();
  addSquare(model, 0, 0, 0, 5);
  endPart(model, 0);
  Surface& surface = model.surfaces[0];
  surface.doubleSided = true;
  surface.baseColor = {0.1, 0.6, 0.1};
  surface.addedColor = {0.4, 0.05, 0.05};
  surface.displaced = 0.5;
  surface.lobes = SurfaceLobes::Apart;
  BurleyMaterial medium{{1e-3, 1e-3, 1e-3}, {{}}};
  for (auto& channel : *medium.transmittance) channel = {1, 1e-6, 0, 1e-6};
  model.materials = {medium};
  return model;
}

class Lobes : public GpuTest {
protected:
  // The replayed light in the middle, with the sun travelling along z.
  static std::array<double, 3> middle(Model model, double direction) {
    model.lights = {directional({0, 0, direction}, kE)};
    const RasterOptions options{.width = 33, .height = 33, .shadowSize = 256};
    const Capture capture = rasterize(device(), model, frontCamera(true), options).capture;
    const Image output = replay(capture, inFloats());
    const float* rgb = output.at(16, 16);
    return {rgb[0], rgb[1], rgb[2]};
  }
};

// Half floats of images and shadow texels that straddle the sheet leave a percent.
constexpr double kTolerance = 0.01;

void expectRgb(const std::array<double, 3>& rgb, const std::array<double, 3>& expected) {
  for (std::size_t c = 0; c < 3; ++c)
    EXPECT_NEAR(rgb[c], expected[c], kTolerance * std::max(expected[c], 0.1)) << c;
}

TEST_F(Lobes, ReflectedAndTransmittedLightHaveTheirOwnColors) {
  expectRgb(middle(leaf(), -1), {0.1, 0.6, 0.1});
  expectRgb(middle(leaf(), 1), {0.8, 0.1, 0.1});
}

// No blue light comes through, but blue reflects in spite of an albedo of 0.
TEST_F(Lobes, ChannelsWithoutTransmittedLightReflect) {
  Model model = leaf();
  model.surfaces[0].addedColor = {0.4, 0.05, 0};
  expectRgb(middle(model, -1), {0.1, 0.6, 0.1});
  EXPECT_LT(middle(model, 1)[2], 0.005);
}

// The lobe map's alpha says how much comes through, its color in which color.
TEST_F(Lobes, TheMapMultipliesWhatComesThrough) {
  Model model = leaf();
  model.textures = {Texture{1, 1, {255, 0, 255, 128}}};  // sRGB 1, 0, 1; half
  model.surfaces[0].lobeMap = 0;
  const double alpha = 128 / 255.0;
  expectRgb(middle(model, -1),
            {kE * 0.1 * (1 - 0.5 * alpha), kE * 0.6 * (1 - 0.5 * alpha), kE * 0.1 * (1 - 0.5 * alpha)});
  // An albedo is at least 1 / 1024, because it carries the reflected light, too.
  expectRgb(middle(model, 1), {0.8 * alpha, kE / 1024, 0.1 * alpha});
}

// A thin wall: a third of what scatters comes back.
TEST_F(Lobes, ScatteredLightComesBackToo) {
  Model model = leaf();
  Surface& surface = model.surfaces[0];
  surface.baseColor = {0, 0, 0};
  surface.displaced = 0;
  surface.backscatter = 0.5;
  expectRgb(middle(model, -1), {0.4, 0.05, 0.05});
  expectRgb(middle(model, 1), {0.8, 0.1, 0.1});
}

}  // namespace
