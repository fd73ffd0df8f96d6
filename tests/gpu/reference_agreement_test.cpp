// The GPU passes against the float64 reference, which shares no code with them.
// No other test finds an option of the thesis, or a kind of light, whose formula errs in the shaders alone.
#include "gpu_fixture.h"

#include <iterator>
#include <map>
#include <numbers>
#include <ostream>
#include <random>
#include <sstream>

#include "common/compare.h"
#include "reference/reference.h"
#include "cli/settings.h"
#include "reference_frame.h"
#include "scene/scene.h"
#include "unit/reference_captures.h"

namespace {

using namespace pellucid::test;
namespace reference = pellucid::harness::reference;

struct Scene {
  std::string name;
  bool reversedZ = false, infiniteFar = false;
  std::optional<bool> orthographic = std::nullopt;
  PellucidDepthEncoding depth = PELLUCID_DEPTH_VIEW_Z, shadow = PELLUCID_DEPTH_VIEW_Z;
  std::optional<PellucidLightType> light = std::nullopt;
  // Share of pixels that a rounding of the projection may move to the next shadow texel.
  double outliers = 2e-3;

  auto operator<=>(const Scene&) const = default;
};

// GoogleTest would print the bytes.
void PrintTo(const Scene& value, std::ostream* out) { *out << value.name; }

// Made once: scenes take longer than the passes over them.
const Capture& make(const Scene& scene) {
  static std::map<Scene, Capture> made;
  if (const auto found = made.find(scene); found != made.end()) return found->second;
  Capture c = makeScene({.name = scene.name,
                                 .width = 96,
                                 .height = 80,
                                 .orthographic = scene.orthographic,
                                 .reversedZ = scene.reversedZ,
                                 .infiniteFar = scene.infiniteFar,
                                 .depthEncoding = scene.depth,
                                 .lightType = scene.light,
                                 .shadowSize = 128,
                                 .shadowEncoding = scene.shadow});
  // The picture lies in the penumbra.
  for (Light& light : c.lights) light.innerConeAngle = 0;
  return made.emplace(scene, std::move(c)).first->second;
}

std::vector<PellucidMaterial> testMaterials(const Capture& c) {
  return std::vector<PellucidMaterial>(std::max<size_t>(c.materials.size(), 1), testMaterial());
}

// The diffusion alone.
ReplaySettings diffusionOnly() {
  ReplaySettings s;
  s.features = PELLUCID_FEATURE_DIFFUSION;
  return s;
}

Image diffusionTruth(const Capture& c, const std::vector<PellucidMaterial>& materials,
                     const std::vector<std::uint8_t>& wanted) {
  reference::Settings r;
  r.features = PELLUCID_FEATURE_DIFFUSION;
  r.wanted = wanted;
  return reference::compute(c, materials, r).image;
}

// One in `every` of the pixels with a material, at random, so that every phase of the pyramid is among them:
// errors over them are near those over all, and brute force takes that part of its time.
std::vector<std::uint8_t> sampled(const Capture& c, unsigned every) {
  std::mt19937 random(1);
  std::vector<std::uint8_t> wanted(c.material.size());
  for (size_t i = 0; i < wanted.size(); ++i) wanted[i] = random() % every == 0 && c.material[i] != 0;
  return wanted;
}

// Largest |gpu - reference| over the material's pixels but for the worst `outliers` of them, relative to
// `scale` or, when 0, to the reference's own value.
double worst(const Capture& c, const Image& gpu, const Image& ref, int channels, double scale,
             double outliers) {
  std::vector<double> errors;
  for (size_t i = 0; i < gpu.pixels(); ++i) {
    if (c.material[i] == 0) continue;
    double worstOfPixel = 0;
    for (size_t k = 0; k < static_cast<size_t>(channels); ++k) {
      const double a = static_cast<double>(gpu.data[i * 4 + k]), b = static_cast<double>(ref.data[i * 3 + k]);
      const double size = scale > 0 ? scale : std::max(std::abs(b), 1e-30);
      worstOfPixel = std::max(worstOfPixel, std::abs(a - b) / size);
    }
    errors.push_back(worstOfPixel);
  }
  EXPECT_GT(errors.size(), 100u) << "the scene shows no material";
  std::sort(errors.begin(), errors.end());
  return errors[static_cast<size_t>(static_cast<double>(errors.size() - 1) * (1 - outliers))];
}

class Agreement : public GpuTest, public testing::WithParamInterface<Scene> {
protected:
  void compare(PellucidDebugView view, bool source, uint32_t features, int channels, double scale,
               double tolerance, double outliers) {
    const Capture& c = make(GetParam());
    const std::vector<PellucidMaterial> materials = testMaterials(c);
    ReplaySettings s = inFloats();
    s.debugView = view;
    s.translucency.cameraThickness = source;
    s.features = features;
    const Image gpu = replayer().run(c, materials, s).output, ref = referenceOf(c, materials, s);
    EXPECT_LT(worst(c, gpu, ref, channels, scale, outliers), tolerance);
  }
};

TEST_P(Agreement, ThicknessTransmittanceOcclusionAndLight) {
  const double outliers = GetParam().outliers;
  // Float depths near 100 mm carry 4e-6 mm; the thinnest parts are some tenths of a mm.
  compare(PELLUCID_DEBUG_THICKNESS, 1, 3, 1, 0, 1e-5, 0);
  compare(PELLUCID_DEBUG_OCCLUSION, 1, 3, 3, 1, 1e-4, 2 * outliers);
  for (const bool source : {false, true}) {
    compare(PELLUCID_DEBUG_TRANSMITTANCE, source, 3, 3, 1, 2e-4, outliers);
    compare(PELLUCID_DEBUG_NONE, source, PELLUCID_FEATURE_TRANSLUCENCY, 3, 1, 1e-3, outliers);
  }
}

// Tilted about the horizontal axis: a texel boundary takes a whole row of the 80 with it.
const Scene kTiltedRows{
    "near_far", false, false, std::nullopt, PELLUCID_DEPTH_VIEW_Z, PELLUCID_DEPTH_VIEW_Z, std::nullopt, 0.03};

INSTANTIATE_TEST_SUITE_P(Scenes, Agreement,
                         testing::Values(Scene{"sphere"},
                                         Scene{"sphere", true, true, false, PELLUCID_DEPTH_DEVICE,
                                               PELLUCID_DEPTH_DEVICE, PELLUCID_LIGHT_POINT},
                                         Scene{"wedge", false, false, true, PELLUCID_DEPTH_DEVICE,
                                               PELLUCID_DEPTH_DEVICE, PELLUCID_LIGHT_DIRECTIONAL},
                                         Scene{"slab", true, false, false, PELLUCID_DEPTH_DEVICE,
                                               PELLUCID_DEPTH_DISTANCE, PELLUCID_LIGHT_SPOT},
                                         Scene{"torus"}, Scene{"two_sheets"}, Scene{"ear"}, Scene{"blades"},
                                         Scene{"hollow_sphere"}, kTiltedRows),
                         [](const auto& test) { return test.param.name + std::to_string(test.index); });

// Every option of the thesis, on the scene where all of it shows.
struct Option {
  const char* name;
  const char* settings;  // of --set, with spaces between
  PellucidTransmittanceModel model = PELLUCID_TRANSMITTANCE_EXP2;
};

// GoogleTest would print the bytes.
void PrintTo(const Option& value, std::ostream* out) { *out << value.name; }

const Option kOptions[] = {
    {"Cosine", "angle=cosine"},
    {"InverseCosine", "angle=inverse-cosine"},
    {"Polynomial", "angle=polynomial polynomial=2.14506,-2.27844,.595752,0"},  // negative in between
    {"MinimumDot", "angle=minimum-dot minimum-dot=-.4"},
    {"MinimumDotOfMinusOne", "angle=minimum-dot minimum-dot=-1"},
    {"PrescaledCosine", "angle=cosine minimum-dot=-.4 prescale=1"},
    {"PrescaledInverseCosine", "angle=inverse-cosine minimum-dot=-.7 prescale=1"},
    {"PrescaledPolynomial",
     "angle=polynomial polynomial=-5.07621,7.75534,-3.9017,.650897 minimum-dot=-.5 prescale=1"},
    {"PrescaledByMinusOne", "angle=inverse-cosine minimum-dot=-1 prescale=1"},
    {"MinimumDotAzimuth", "angle=minimum-dot-azimuth face=.3,.1,1 up=.1,2,0"},
    {"MinimumDotSphere", "angle=minimum-dot-sphere face=.3,.1,1"},
    {"ConstantView", "angle=cosine view=constant"},
    {"Chord", "chord=1"},
    {"MaximumThickness", "max-thickness=2.5"},
    {"Filter", "filter=.55,.29,.28"},
    {"Linear", "", PELLUCID_TRANSMITTANCE_LINEAR},
    {"SinhExp", "", PELLUCID_TRANSMITTANCE_SINH_EXP},
    {"Gaussians", "", PELLUCID_TRANSMITTANCE_GAUSSIANS},
    {"GaussiansAsPrinted", "", PELLUCID_TRANSMITTANCE_GAUSSIANS_AS_PRINTED},
};

// The eye of an orthographic camera may stand anywhere along its rays, also behind what it shows.
TEST_F(GpuTest, OrthographicEyesMayStandBehindSurfaces) {
  for (const std::uint32_t samples : {0u, 8u}) {
    Capture c = flatCapture(64, 64, 4);
    for (DepthImage* depth : {&c.frontDepth, &c.backDepth}) {
      depth->encoding = PELLUCID_DEPTH_DEVICE;
      for (float& v : depth->image.data) v /= 100;
    }
    c.lights = {backLight()};
    c.lights[0].shadowMaps = {flatShadowMap(-14, PELLUCID_DEPTH_VIEW_Z)};
    const Image expected = replay(c, testMaterial(), gathering(samples));
    for (const double behind : {-5.0, 12.0, 40.0}) {  // mm; surfaces lie from 10 to 14 mm
      Capture moved = c;
      moved.viewFromWorld[14] += behind;
      moved.clipFromView[14] += behind / 100;
      EXPECT_LT(relativeRmse(replay(moved, testMaterial(), gathering(samples)), expected), 1e-4)
          << samples << " samples, " << behind << " mm";
    }
  }
}

// A body diffuses as far under a sheared camera, whose rays meet the image at an angle, as under a straight
// one along the same rays.
TEST_F(GpuTest, ShearedCamerasDiffuseAsStraightOnes) {
  // A kernel of 3 mm, on a ball of 8 mm.
  std::vector<PellucidMaterial> materials{reference::gaussianMaterial(9)};
  std::fill(materials[0].radius, materials[0].radius + 3, 11.4f);
  double error[2];
  for (const bool sheared : {false, true}) {
    std::vector<double> cosines(80 * 80);
    const Capture c = reference::obliqueBall(sheared, cosines.data(), [](const glm::dvec3& point) {
      return std::max(point.x / 8, 0.0);  // from the side
    });
    ReplaySettings s = diffusionOnly();
    s.outputFormat = VK_FORMAT_R32G32B32A32_SFLOAT;
    const Image gpu = replayer().run(c, materials, s).output;
    const std::vector<std::uint8_t> pixels = sampled(c, 5);
    const Image ref = diffusionTruth(c, materials, pixels);
    double square = 0, of = 0;
    for (size_t i = 0; i < c.material.size(); ++i) {
      if (!pixels[i] || cosines[i] < 0.35) continue;  // limbs have few pixels
      const double truth = static_cast<double>(ref.data[3 * i]),
                   off = static_cast<double>(gpu.data[4 * i]) - truth;
      square += off * off;
      of += truth * truth;
    }
    error[sheared] = std::sqrt(square / of);
  }
  // Pixels lie elsewhere on the body. Without the rays' angle in the tangent planes' weights the sheared
  // camera errs by 2.4 times as much.
  EXPECT_LT(error[1], 1.15 * error[0]);
}

// Table lookups where the light's direction is the receiver's own: point lights, from all around.
TEST_F(GpuTest, MinimumDotTablesAgreeForLightsAllAround) {
  Capture c = make({"slab"});
  const Light from = c.lights.at(0);
  for (const auto model : {kMinimumDotAzimuth, kMinimumDotSphere}) {
    ReplaySettings s = inFloats(PELLUCID_FEATURE_TRANSLUCENCY);
    s.translucency.angleModel = model;
    s.translucency.objectCenter = {1, 2, 3};
    // Away from the camera, so that lights from behind lie between the last entry and the first.
    s.translucency.faceVector = {0.2f, 0, -1};
    for (int i = 0; i < 36; ++i)
      s.translucency.minimumDotTable.push_back(-0.95f + static_cast<float>(i * 5 % 36) / 40);
    c.lights.clear();
    for (int i = 0; i < 36; ++i) {
      Light light;
      light.type = PELLUCID_LIGHT_POINT;
      // Between two entries each, among them the last and the first.
      const double turn = (i + 0.4) * std::numbers::pi / 18, height = std::cos(1.9 * i);
      light.position = {200 * std::cos(turn), 200 * height, 200 * std::sin(turn)};
      light.intensity = 4e4;
      c.lights.push_back(light);
    }
    const Image gpu = replay(c, testMaterial(), s), ref = referenceOf(c, {testMaterial()}, s);
    EXPECT_LT(worst(c, gpu, ref, 3, 1, 0), 1e-3);
  }
}

// Marked pixels: irradiance without translucency, and of the same material to their neighbors' diffusion.
TEST_F(GpuTest, MarkedPixelsAgreeWithTheReference) {
  Capture c = make({"ear"});
  c.albedo = {};
  const Capture plain = c;
  for (int y = 0; y < c.height; ++y)
    for (int x = 0; x < c.width / 2; ++x) {
      std::uint8_t& m = c.material[static_cast<size_t>(y * c.width + x)];
      if (m != 0) m |= 128;
    }
  ReplaySettings s = inFloats();
  s.translucency.materialMarkBit = 128;
  for (const uint32_t features : {1u, 3u}) {
    s.features = features;
    const Image gpu = replay(c, testMaterial(), s);
    if (features == 1) {
      EXPECT_LT(worst(c, gpu, referenceOf(c, {testMaterial()}, s), 3, 1, 2e-3), 1e-3);
      for (size_t i = 0; i < 3 * c.material.size(); ++i)
        if (c.material[i / 3] & 128) {
          ASSERT_EQ(gpu.data[i / 3 * 4 + i % 3], c.irradiance.data[i]);
        }
    }
    // Where there is no light, marks change nothing: diffusion crosses their border.
    Capture dark = c, darkPlain = plain;
    dark.lights.clear();
    darkPlain.lights.clear();
    EXPECT_TRUE(sameBits(replay(dark, testMaterial(), s), replay(darkPlain, testMaterial(), s)));
  }
}

class ThesisOptions : public GpuTest, public testing::WithParamInterface<Option> {};

TEST_P(ThesisOptions, AgreeWithTheReference) {
  const Capture& c = make({"ear"});
  PellucidMaterial material = testMaterial();
  material.transmittanceModel = GetParam().model;
  if (material.transmittanceModel == PELLUCID_TRANSMITTANCE_LINEAR)
    for (int k = 0; k < 3; ++k) material.transmittance[k][0] = 4.0f / static_cast<float>(k + 1);
  if (material.transmittanceModel == PELLUCID_TRANSMITTANCE_SINH_EXP) {
    const float parameters[3][5] = {
        {0.5f, 0.3f, 0.8f, 0.1f, 2}, {1e-4f, 1e-4f, 2e-4f, 0.2f, 1}, {0.4f, 3, 1, 0.3f, 3.5f}};
    std::memcpy(material.transmittance, parameters, sizeof parameters);
  }
  SettingsOptions options;
  std::istringstream words(GetParam().settings);
  options.set.assign(std::istream_iterator<std::string>(words), {});
  ReplaySettings s = inFloats(PELLUCID_FEATURE_TRANSLUCENCY);
  s.translucency = options.parse().translucency;
  s.translucency.gatherSamples = 0;
  const int entries = s.translucency.angleModel == kMinimumDotSphere ? 49 : 36;
  for (int i = 0; s.translucency.hasMinimumDotTable() && i < entries; ++i)
    s.translucency.minimumDotTable.push_back(-static_cast<float>(i * 11 % entries) / 60);
  for (const auto source : {0, 1}) {
    s.translucency.cameraThickness = source;
    const Image gpu = replay(c, material, s), ref = referenceOf(c, {material}, s);
    EXPECT_LT(worst(c, gpu, ref, 3, 1, 4e-3), 1e-3);
  }
}

INSTANTIATE_TEST_SUITE_P(Reference, ThesisOptions, testing::ValuesIn(kOptions),
                         [](const auto& test) { return std::string(test.param.name); });

// The pyramid is another algorithm than the reference's sum over all pixels; this is how far it is.
TEST_F(GpuTest, DiffusionDistanceToBruteForce) {
  // A wrong profile or a missing renormalization shows as tens of percent. The sphere is lit at its limb
  // alone, where every pixel is a silhouette and a texel holds lit and unlit ones.
  struct Row {
    const char* name;
    double limit;    // a tenth above what is measured
    unsigned every;  // all where few pixels, of silhouettes, make most of the error
  };
  for (const auto& [name, limit, every] : {Row{"checker", 0.0232, 4},
                                           {"step", 0.008, 4},
                                           {"sphere", 0.353, 1},
                                           {"ear", 0.058, 1}}) {
    const Capture& c = make({name});
    const std::vector<PellucidMaterial> materials = testMaterials(c);
    const std::vector<std::uint8_t> pixels = sampled(c, every);
    const Image truth = diffusionTruth(c, materials, pixels);
    const Image gpu = rgb(replayer().run(c, materials, diffusionOnly()).output);
    const Comparison d = compareImages(gpu, truth, pixels);
    for (const ChannelDifference& k : d.channels) EXPECT_LT(k.relativeRmse, limit) << name;
  }
}

// Checkers of 8 pixels on planes that face the camera and that are tilted, about the columns, the rows and
// diagonals, away from the image's border.
TEST_F(GpuTest, DiffusionOnPlanesIsNearBruteForceInEveryDirection) {
  constexpr int kSize = 128, kBorder = 32;
  constexpr double kCell = 8;
  struct Row {
    double tilt;
    int x, y;      // direction in which the plane recedes, in pixels
    double limit;  // a tenth above what is measured
  };
  for (const auto& [tilt, dx, dy, limit] : {Row{0, 1, 0, 0.0153},
                                            {18, 0, 1, 0.0148},
                                            {34, 1, 1, 0.0195},
                                            {46, 1, -1, 0.0263},
                                            {60, 1, 0, 0.0553},
                                            {60, -1, 1, 0.0393}}) {
    const double cosine = std::cos(glm::radians(tilt)), sine = std::sin(glm::radians(tilt));
    Capture c = flatCapture(kSize, kSize);
    const double pixel = 2 / (c.clipFromView[0] * kSize), scale = 1 / std::hypot(dx, dy);
    std::vector<std::uint8_t> middle = sampled(c, 4);
    for (int y = 0; y < kSize; ++y)
      for (int x = 0; x < kSize; ++x) {
        const double along = (dx * x + dy * y) * scale, across = (dx * y - dy * x) * scale;
        c.frontDepth.image.at(x, y)[0] = static_cast<float>(100 + sine / cosine * along * pixel);
        const double cells = std::floor(along / cosine / kCell) + std::floor(across / kCell);
        for (int k = 0; k < 3; ++k) c.irradiance.at(x, y)[k] = std::fmod(cells + 1000, 2) == 0 ? 1.0f : 0.0f;
        if (std::min({x, y, kSize - 1 - x, kSize - 1 - y}) < kBorder)
          middle[static_cast<size_t>(kSize * y + x)] = 0;
      }
    PellucidMaterial m = testMaterial();
    m.gaussianCount = 4;
    for (int k = 0; k < 4; ++k)
      for (int channel = 0; channel < 3; ++channel) {
        const double deviation = pixel * std::exp2(k - 1) / (1 + 0.4 * channel);  // 1/2 to 4 pixels
        m.gaussianVariance[channel][k] = static_cast<float>(deviation * deviation);
        m.gaussianWeight[channel][k] = 0.25f;
        m.radius[channel] = static_cast<float>(3.8 * deviation);
      }
    const Image truth = diffusionTruth(c, {m}, middle);
    const Comparison d = compareImages(rgb(replayer().run(c, {m}, diffusionOnly()).output), truth, middle);
    for (const ChannelDifference& k : d.channels)
      EXPECT_LT(k.relativeRmse, limit) << tilt << " degrees, " << dx << " " << dy;
  }
}

// Burley's profile, 99.9 % of whose energy lies within `radius` mm.
PellucidMaterial burley(double radius) {
  // 3/4 e^{-r / 3d} + 1/4 e^{-r / d} = .001 (Christensen & Burley 2015, the cdf).
  const double d = radius / 19.86;
  return compileMaterial(BurleyMaterial{{d, d, d}, {}}, "test");
}

// Where the rect cuts most of a kernel off, all levels are renormalized by how much of them lies in it.
TEST_F(GpuTest, KernelLargerThanTheImageKeepsItsContrast) {
  constexpr int kSize = 96, kCell = 12;
  constexpr double kRadius = 128;  // pixels, of 99.9 % of the energy
  Capture c = flatCapture(kSize, kSize);
  const double pixel = 2 / (c.clipFromView[0] * kSize);
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x) {
      const double cells = std::floor((x + 0.3 * y) / kCell) + std::floor((y - 0.3 * x) / kCell);
      for (int k = 0; k < 3; ++k) c.irradiance.at(x, y)[k] = std::fmod(cells + 1000, 2) == 0 ? 1.0f : 0.0f;
    }
  const PellucidMaterial m = burley(kRadius * pixel);
  const std::vector<std::uint8_t> pixels = sampled(c, 8);
  const Comparison d = compareImages(rgb(replayer().run(c, {m}, diffusionOnly()).output),
                                     diffusionTruth(c, {m}, pixels), pixels);
  for (const ChannelDifference& k : d.channels) EXPECT_LT(k.relativeRmse, 0.0078);
}

}  // namespace
