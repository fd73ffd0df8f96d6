// Manifests for EXR files in the manner of other programs: each holds a frame that is known, and has to give
// it back.
#include <ImfChannelList.h>
#include <ImfChromaticities.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfMatrixAttribute.h>
#include <ImfOutputFile.h>
#include <ImfStandardAttributes.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <glm/glm.hpp>
#include <numbers>

#include "capture/read.h"
#include "init/manifest.h"
#include "scene/scene.h"
#include "scene/vector.h"
#include "unit/capture_samples.h"

namespace pellucid::harness {
namespace {

// A sphere before a wall, seen from the side.
class Init : public testing::Test {
protected:
  Init() {
    frame_ = makeScene({.name = "sphere", .width = 40, .height = 24, .shadowSize = 8});
    const glm::dmat4 world = glm::inverse(toGlm(frame_.viewFromWorld));
    eye_ = fromGlm(glm::dvec3(world[3]));
    target_ = fromGlm(glm::dvec3(world[3] - 50.0 * world[2]));
    up_ = fromGlm(glm::dvec3(world[1]));
    fov_ = 2 * std::atan(1 / std::abs(frame_.clipFromView[5])) * 180 / std::numbers::pi;
  }

  struct Channel {
    std::string name;
    const Image* image;
    int component;
  };
  void write(const std::string& name, const std::vector<Channel>& channels,
             const std::map<std::string, Imath::M44f>& matrices = {},
             Imf::Header header = Imf::Header(1, 1)) const {
    header.dataWindow() = header.displayWindow() = {{0, 0}, {frame_.width - 1, frame_.height - 1}};
    Imf::FrameBuffer buffer;
    for (const auto& [attribute, matrix] : matrices) header.insert(attribute, Imf::M44fAttribute(matrix));
    for (const Channel& c : channels) {
      header.channels().insert(c.name, Imf::Channel(Imf::FLOAT));
      const auto stride = static_cast<std::size_t>(c.image->channels) * sizeof(float);
      auto* base = const_cast<char*>(reinterpret_cast<const char*>(c.image->data.data() + c.component));
      buffer.insert(c.name,
                    Imf::Slice(Imf::FLOAT, base, stride, stride * static_cast<std::size_t>(frame_.width)));
    }
    Imf::OutputFile file((folder_ / name).string().c_str(), header);
    file.setFrameBuffer(buffer);
    file.writePixels(frame_.height);
  }
  static std::vector<Channel> triple(const std::string& layer, const char* components, const Image& image) {
    std::vector<Channel> result;
    for (int i = 0; i < 3; ++i) result.push_back({layer + components[i], &image, i});
    return result;
  }
  Image materialImage(float value) const {
    Image image(frame_.width, frame_.height, 1);
    for (std::size_t i = 0; i < image.data.size(); ++i) image.data[i] = frame_.material[i] != 0 ? value : 0;
    return image;
  }

  Image constantImage(const std::array<float, 3>& color) const {
    Image image(frame_.width, frame_.height, 3);
    for (std::size_t i = 0; i < image.data.size(); ++i) image.data[i] = color[i % 3];
    return image;
  }
  static Image times(Image image, const Image& by, float factor) {
    for (std::size_t i = 0; i < image.data.size(); ++i) image.data[i] *= by.data[i] * factor;
    return image;
  }
  // Three roundings lie between: factor, product, quotient.
  static void expectLight(const Image& a, const Image& b) {
    ASSERT_EQ(a.data.size(), b.data.size());
    for (std::size_t i = 0; i < a.data.size(); ++i) ASSERT_NEAR(a.data[i], b.data[i], 4e-7f * b.data[i]) << i;
  }
  // The irradiance of a file with these passes of light beside depth, an albedo and numbers of materials.
  struct Pass {
    std::string name;
    Image image;
  };
  GuessedManifest guessPasses(const std::vector<Pass>& passes) const {
    const Image id = materialImage(5);
    std::vector<Channel> channels = {{"Z", &frame_.frontDepth.image, 0}};
    // V-Ray saves numbers as colors.
    for (const char* channel : {"VRayMtlID.R", "VRayMtlID.G", "VRayMtlID.B"})
      channels.push_back({channel, &id, 0});
    for (const Pass& pass : passes)
      for (const Channel& channel : triple(pass.name + ".", "RGB", pass.image)) channels.push_back(channel);
    write("passes.exr", channels);
    InitWords words;
    words.camera.verticalFov = fov_;
    return guess({"passes.exr"}, words);
  }

  static constexpr float kPi = std::numbers::pi_v<float>;

  GuessedManifest guess(const std::vector<std::string>& names, const InitWords& words) const {
    std::vector<std::filesystem::path> files;
    for (const std::string& name : names) files.push_back(folder_ / name);
    return guessManifest(files, folder_, words);
  }
  Capture read(const GuessedManifest& guessed) const {
    writeText(folder_ / "capture.json", guessed.json.dump(1));
    return readCapture(folder_ / "capture.json");
  }
  // Compares the pixels' rays: all that the x, y and w rows of a projection say.
  static void expectSameRays(const Matrix& a, const Matrix& b) {
    for (const std::size_t i : {0u, 5u, 8u, 9u, 11u, 12u, 13u, 15u}) EXPECT_NEAR(a[i], b[i], 1e-5) << i;
  }
  static void expectSameView(const Matrix& a, const Matrix& b, double tolerance) {
    for (std::size_t i = 0; i < 16; ++i) EXPECT_NEAR(a[i], b[i], i < 12 ? 1e-5 : tolerance) << i;
  }

  TemporaryDirectory folder_;
  Capture frame_;
  Vector3 eye_, target_, up_;
  double fov_ = 0;
};

// Passes whose names hold those of other roles: denoisers' guides, mist, other light, other view layers, places.
TEST(InitNames, PassesOfOtherContentAreNotTaken) {
  const auto number = [](const std::string& name) { return ChannelGroup{"f.exr", 0, name, true, "", false, {name + ".Z"}}; };
  const auto color = [](const std::string& name) {
    return ChannelGroup{"f.exr", 0, name, true, "", false, {name + ".R", name + ".G", name + ".B"}};
  };
  struct Row {
    std::vector<ChannelGroup> groups;
    Role role;
    const char* taken;  // empty: none
  };
  const Row rows[] = {{{number("Denoising Depth"), number("Depth")}, Role::FrontDepth, "Depth"},
                      {{color("Denoising Albedo"), color("DiffCol")}, Role::Albedo, "DiffCol"},
                      {{number("ViewLayer.Mist")}, Role::FrontDepth, ""},
                      {{number("BG.Depth"), number("Char.Depth"), color("Char.DiffDir")}, Role::FrontDepth, "Char.Depth"},
                      {{color("depth"), color("irradiance")}, Role::FrontDepth, "depth"},
                      {{number("WorldDepth"), color("irradiance")}, Role::FrontDepth, "WorldDepth"},
                      {{color("indirectDiffuse"), color("directDiffuse")}, Role::Irradiance, "directDiffuse"},
                      {{color("VolumeLighting"), color("DiffuseLighting")}, Role::Irradiance, "DiffuseLighting"},
                      {{color("P"), color("motion"), color("N")}, Role::Irradiance, ""}};
  for (const Row& row : rows) {
    const std::map<Role, Guess> guesses = guessRoles(row.groups, {});
    const auto found = guesses.find(row.role);
    EXPECT_EQ(found == guesses.end() ? "" : found->second.group.name, row.taken);
  }
  EXPECT_NE(guessRoles({color("diffuse_direct_key"), color("diffuse_direct_rim")}, {}).at(Role::Irradiance).doubt.find("_rim\" has the same name"),
            std::string::npos);
  EXPECT_EQ(guessRoles({number("WorldDepth"), color("irradiance")}, {}).at(Role::FrontDepth).metersPerUnit, 0.01);
}

// Ids that floats do not tell apart, and depths of a file of several parts.
TEST_F(Init, LargeIdsAreRefused) {
  const Image id = materialImage(5);
  std::vector<Channel> channels = triple("irradiance.", "RGB", frame_.irradiance);
  channels.push_back({"Z", &frame_.frontDepth.image, 0});
  channels.push_back({"id", &id, 0});
  write("ids.exr", channels);
  InitWords words;
  words.camera.verticalFov = fov_;
  words.materialIds = {2000000001};
  EXPECT_NE(refusalOf([&] { guess({"ids.exr"}, words); }).find("--material-id: 2000000001 is above 16777216"), std::string::npos);
}

// Transposed, a view matrix has its translation in the last column.
TEST_F(Init, TransposedCamerasAreRefused) {
  std::vector<Channel> channels = triple("irradiance.", "RGB", frame_.irradiance);
  channels.push_back({"Z", &frame_.frontDepth.image, 0});
  Imath::M44f worldToCamera;
  worldToCamera[0][3] = 50;
  write("t.exr", channels, {{"worldToCamera", worldToCamera}});
  InitWords words;
  words.camera.verticalFov = fov_;
  EXPECT_NE(refusalOf([&] { guess({"t.exr"}, words); }).find("worldToCamera"), std::string::npos);
}

// One file of layers and OpenEXR's camera attributes, as Arnold and Nuke write them.
TEST_F(Init, LayersWithOpenExrsCameraNeedNoWords) {
  const Image id = materialImage(1), albedo = constantImage({0.5f, 0.25f, 0.125f});
  const Image product = times(frame_.irradiance, albedo, 1 / kPi);
  std::vector<Channel> channels = {
      {"Z", &frame_.frontDepth.image, 0}, {"back.Z", &frame_.backDepth.image, 0}, {"id", &id, 0}};
  for (const auto& layer : {triple("direct_diffuse.", "RGB", product), triple("N.", "XYZ", frame_.irradiance),
                            triple("albedo.", "RGB", albedo)})
    channels.insert(channels.end(), layer.begin(), layer.end());
  // OpenEXR: a left-handed camera space, row vectors; the image is 0 .. 1 with y down.
  Imath::M44f worldToCamera, worldToNdc;
  const glm::dmat4 flipped =
      glm::dmat4(1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1) * toGlm(frame_.viewFromWorld);
  const glm::dmat4 clip = toGlm(frame_.clipFromView) * toGlm(frame_.viewFromWorld);
  const glm::dmat4 half(0.5, 0, 0, 0, 0, 0.5, 0, 0, 0, 0, 1, 0, 0.5, 0.5, 0, 1);
  const glm::dmat4 ndc = half * clip;
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) {
      worldToCamera[i][j] = static_cast<float>(flipped[i][j]);
      worldToNdc[i][j] = static_cast<float>(ndc[i][j]);
    }
  write("beauty.exr", channels, {{"worldToCamera", worldToCamera}, {"worldToNDC", worldToNdc}});
  const GuessedManifest guessed = guess({"beauty.exr"}, {});
  const Capture capture = read(guessed);
  expectSameView(capture.viewFromWorld, frame_.viewFromWorld, 1e-3);
  expectSameRays(capture.clipFromView, frame_.clipFromView);
  EXPECT_TRUE(sameBits(capture.frontDepth.image, frame_.frontDepth.image));
  EXPECT_TRUE(sameBits(capture.backDepth.image, frame_.backDepth.image));
  expectLight(capture.irradiance, frame_.irradiance);
  EXPECT_EQ(std::count(guessed.found.begin(), guessed.found.end(), "not used: beauty.exr N.X"), 1);
  EXPECT_FALSE(guessed.json["buffers"].contains("normal"));
  EXPECT_EQ(capture.material, frame_.material);
  ASSERT_FALSE(guessed.missing.empty());
  EXPECT_NE(guessed.missing[0].find("lights: without a light"), std::string::npos);
  EXPECT_TRUE(guessed.json.contains("// lights"));
  EXPECT_TRUE(guessed.json["buffers"]["irradiance"]["includesAlbedo"]);
}

// A window of other pixels, off the axis, and of other primaries: the camera has it, and the colors are
// named.
TEST_F(Init, HeadersSayWindowsAndColors) {
  Imf::Header header(1, 1);
  header.pixelAspectRatio() = 2;
  header.screenWindowWidth() = 0.5f;
  header.screenWindowCenter() = {0.1f, -0.05f};
  Imf::addChromaticities(
      header, Imf::Chromaticities({0.708f, 0.292f}, {0.17f, 0.797f}, {0.131f, 0.046f}, {0.3127f, 0.329f}));
  std::vector<Channel> channels = triple("irradiance.", "RGB", frame_.irradiance);
  channels.push_back({"Z", &frame_.frontDepth.image, 0});
  write("window.exr", channels, {}, header);
  const GuessedManifest guessed = guess({"window.exr"}, {});
  const Matrix clip = read(guessed).clipFromView;
  EXPECT_NEAR(clip[0], 4, 1e-6);  // 2 / width
  EXPECT_NEAR(clip[5], -4 * 2 * frame_.width / double(frame_.height), 1e-5);
  // The window's center, at distance 1, is the image's.
  for (const int row : {0, 1}) {
    const double x = clip[row] * 0.1f + clip[4 + row] * -0.05f - clip[8 + row];
    EXPECT_NEAR(x, 0, 1e-6) << row;
  }
  EXPECT_EQ(std::count_if(guessed.missing.begin(), guessed.missing.end(),
                          [](const std::string& s) {
                            return s.find("colors of irradiance: chromaticities: red") == 0;
                          }),
            1);
}

// A file of two eyes gives the frame of the first.
TEST_F(Init, StereoFilesGiveOneEye) {
  const Image other = times(frame_.irradiance, frame_.irradiance, 3);
  std::vector<Channel> channels = triple("irradiance.right.", "RGB", other);
  for (const auto& layer : {triple("irradiance.left.", "RGB", frame_.irradiance)})
    channels.insert(channels.end(), layer.begin(), layer.end());
  channels.push_back({"Z", &frame_.frontDepth.image, 0});
  channels.push_back({"depth.right.Z", &frame_.irradiance, 0});
  Imf::Header header(1, 1);
  Imf::addMultiView(header, {"left", "right"});
  write("eyes.exr", channels, {}, header);
  InitWords words;
  words.camera.verticalFov = fov_;
  const GuessedManifest guessed = guess({"eyes.exr"}, words);
  const Capture capture = read(guessed);
  EXPECT_TRUE(sameBits(capture.irradiance, frame_.irradiance));
  EXPECT_TRUE(sameBits(capture.frontDepth.image, frame_.frontDepth.image));
  EXPECT_EQ(
      std::count(guessed.found.begin(), guessed.found.end(), "view: \"left\" is taken; left out: \"right\""),
      1);
}

// A file for each texture of four channels, a reversed depth buffer: what RenderDoc saves.
TEST_F(Init, TexturesOfADebuggerNeedTheCamerasNumbers) {
  const double nearPlane = 5, aspect = static_cast<double>(frame_.width) / frame_.height;
  const Matrix clip = perspective(fov_ * std::numbers::pi / 180, aspect, {nearPlane, INFINITY, true});
  Image device = frame_.frontDepth.image;
  for (float& depth : device.data)
    depth = depth < kNoDepth ? static_cast<float>(deviceDepth(clip, depth)) : 0;
  const Image id = materialImage(7);
  const auto save = [&](const std::string& name, std::vector<Channel> channels) {
    while (channels.size() < 4) channels.push_back({"", channels[0].image, 0});
    const char* const names[] = {"R", "G", "B", "A"};
    for (std::size_t i = 0; i < 4; ++i) channels[i].name = names[i];
    write(name, channels);
  };
  save("SceneDepthZ.exr", {{"", &device, 0}});
  save("GBufferA.exr", triple("", "RGB", frame_.irradiance));
  save("DiffuseIrradiance.exr", triple("", "RGB", frame_.irradiance));
  save("MaterialID.exr", {{"", &id, 0}});
  const std::vector<std::string> names = {"SceneDepthZ.exr", "GBufferA.exr", "DiffuseIrradiance.exr",
                                          "MaterialID.exr"};
  InitWords words;
  EXPECT_NE(refusalOf([&] { guess(names, words); }).find("--near: is needed"), std::string::npos);
  words.camera.nearPlane = nearPlane;
  EXPECT_NE(refusalOf([&] { guess(names, words); }).find("--fov: is needed"), std::string::npos);
  words.camera.verticalFov = fov_;
  words.camera.eye = eye_;
  words.camera.target = target_;
  words.camera.up = up_;
  words.metersPerUnit = 0.001;
  words.materialIds = {7};
  words.lights = {{{"type", "directional"}, {"direction", {0, 0, 1}}}};
  const GuessedManifest guessed = guess(names, words);
  const Capture capture = read(guessed);
  EXPECT_EQ(capture.frontDepth.encoding, PELLUCID_DEPTH_DEVICE);
  expectSameView(capture.viewFromWorld, frame_.viewFromWorld, 1e-9);
  for (std::size_t i = 0; i < 16; ++i) EXPECT_NEAR(capture.clipFromView[i], clip[i], 1e-9) << i;
  EXPECT_EQ(capture.material, frame_.material);
  EXPECT_EQ(capture.metersPerUnit, 0.001);
  EXPECT_EQ(guessed.missing.size(), 1u) << guessed.missing[0];
  EXPECT_NE(guessed.missing[0].find("backDepth: without"), std::string::npos);
}

// Backgrounds of id passes are -1, the largest number, or no number; a person's ids hold beside any of them.
TEST_F(Init, NumbersOfNoMaterialAreBackground) {
  for (const float background : {-1.0f, 4294967295.0f, std::numeric_limits<float>::quiet_NaN(), 0.25f}) {
    Image id = materialImage(3);
    for (float& value : id.data) value = value == 0 ? background : value;
    std::vector<Channel> channels = triple("irradiance.", "RGB", frame_.irradiance);
    channels.push_back({"depth.Z", &frame_.frontDepth.image, 0});
    channels.push_back({"id.X", &id, 0});
    channels.push_back({"fog.X", &id, 0});
    write("ids.exr", channels);
    InitWords words;
    words.camera.verticalFov = fov_;
    const auto found = [&] { return read(guess({"ids.exr"}, words)).material; };
    if (background != 0.25f) {
      EXPECT_EQ(found(), frame_.material) << background;
    }
    words.materialIds = {3};
    EXPECT_EQ(found(), frame_.material) << background;
    EXPECT_EQ(guess({"ids.exr"}, words).found.back(), "not used: ids.exr fog.X");
    words.materialIds = {4};
    EXPECT_NE(guess({"ids.exr"}, words).json["// material"].get<std::string>().find("no pixel holds 4"),
              std::string::npos);
  }
}

// Layers of a view layer, E / pi, no camera: Blender's multilayer file without its script.
TEST_F(Init, BlendersPassesAreKnown) {
  const Image id = materialImage(3);
  Image combined = frame_.irradiance;
  std::vector<Channel> channels = {{"ViewLayer.Depth.Z", &frame_.frontDepth.image, 0},
                                   {"ViewLayer.IndexMA.X", &id, 0}};
  for (const auto& layer : {triple("ViewLayer.DiffDir.", "RGB", frame_.irradiance),
                            triple("ViewLayer.Combined.", "RGB", combined),
                            triple("ViewLayer.Normal.", "XYZ", frame_.irradiance)})
    channels.insert(channels.end(), layer.begin(), layer.end());
  write("render.exr", channels);
  InitWords words;
  words.camera.verticalFov = fov_;
  const GuessedManifest guessed = guess({"render.exr"}, words);
  const Capture capture = read(guessed);
  EXPECT_EQ(guessed.json["buffers"]["irradiance"]["scale"], std::numbers::pi);
  EXPECT_EQ(capture.irradiance.data[300], static_cast<float>(std::numbers::pi) * frame_.irradiance.data[300]);
  EXPECT_EQ(capture.viewFromWorld, kIdentity);
  EXPECT_TRUE(guessed.json.contains("// camera"));
  expectSameRays(capture.clipFromView, frame_.clipFromView);
  EXPECT_EQ(guessed.json["buffers"]["material"]["map"],
            (nlohmann::ordered_json{{"0", 0}, {"3", 1}, {"*", 0}}));

  words.roles = {{Role::Irradiance, "ViewLayer.Combined"}};
  EXPECT_EQ(guess({"render.exr"}, words).json["buffers"]["irradiance"]["channels"][0],
            "ViewLayer.Combined.R");
  words.roles = {{Role::Irradiance, "ViewLayer.None"}};
  EXPECT_NE(refusalOf([&] { guess({"render.exr"}, words); }).find("ViewLayer.Combined"), std::string::npos);
}

// Renderers store E / pi, the albedo's part of it, or both; all give back E.
TEST_F(Init, PassesOfLightOfEachRendererGiveTheIrradiance) {
  const Image& light = frame_.irradiance;
  const Image white = constantImage({1, 1, 1}), albedo = constantImage({0.5f, 0.25f, 0.125f});
  const Image rawPass = times(light, white, 1 / kPi), product = times(light, albedo, 1 / kPi),
              half = times(rawPass, white, 0.5f);
  struct Case {
    const char* renderer;
    std::vector<Pass> passes;
    const char* taken;
  };
  const std::vector<Case> cases = {
      {"V-Ray",
       {{"VRayDiffuseFilter", albedo}, {"VRayLighting", product}, {"VRayRawLighting", rawPass}},
       "VRayRawLighting.R"},
      {"V-Ray, with indirect light",
       {{"VRayDiffuseFilter", albedo},
        {"VRayRawLighting", half},
        {"VRayRawTotalLighting", rawPass},
        {"VRayTotalLighting", product}},
       "VRayRawTotalLighting.R"},
      {"V-Ray, the product alone",
       {{"VRayDiffuseFilter", albedo}, {"VRayLighting", product}},
       "VRayLighting.R"},
      {"V-Ray of Maya", {{"diffuse", albedo}, {"lighting", product}, {"rawLight", rawPass}}, "rawLight.R"},
      {"Arnold",
       {{"diffuse_albedo", albedo}, {"diffuse_direct", half}, {"diffuse", product}, {"albedo", white}},
       "diffuse.R"},
      {"Arnold, direct light", {{"diffuse_albedo", albedo}, {"diffuse_direct", product}}, "diffuse_direct.R"},
      {"Redshift",
       {{"DiffuseFilter", albedo}, {"DiffuseLighting", product}, {"DiffuseLightingRaw", rawPass}},
       "DiffuseLightingRaw.R"},
      {"Redshift, with indirect light",
       {{"DiffuseFilter", albedo}, {"DiffuseLightingRaw", half}, {"TotalDiffuseLightingRaw", rawPass}},
       "TotalDiffuseLightingRaw.R"},
      {"Blender 5", {{"V.Diffuse Color", albedo}, {"V.Diffuse Direct", rawPass}}, "V.Diffuse Direct.R"},
      {"a total of products beside its direct part",
       {{"DiffuseFilter", albedo},
        {"DiffuseLighting", times(product, white, 0.5f)},
        {"TotalDiffuseLighting", product}},
       "TotalDiffuseLighting.R"},
      {"highlights, whose names come first",
       {{"DiffuseFilter", albedo},
        {"A.SpecularLightingRaw", white},
        {"B.ReflectedLighting", white},
        {"Lighting", product}},
       "Lighting.R"},
  };
  for (const Case& c : cases) {
    SCOPED_TRACE(c.renderer);
    const GuessedManifest guessed = guessPasses(c.passes);
    EXPECT_EQ(guessed.json["buffers"]["irradiance"]["channels"][0], c.taken);
    const Capture capture = read(guessed);
    expectLight(capture.irradiance, light);
    EXPECT_TRUE(sameBits(capture.albedo, albedo));
    EXPECT_EQ(capture.material, frame_.material);
    EXPECT_EQ(guessed.json["buffers"]["material"]["channel"], "VRayMtlID.R");
  }
}

TEST_F(Init, AProductNeedsAnAlbedoAboveZero) {
  Image black = constantImage({0.5f, 0, 0.5f});
  expectNames(refusalOf([&] {
                read(guessPasses({{"VRayDiffuseFilter", black},
                                  {"VRayLighting", times(frame_.irradiance, black, 1 / kPi)}}));
              }),
              {"capture.json", "buffers.irradiance.includesAlbedo", "pixel (", "in G"});
  // Where nothing is translucent there is no light to know.
  for (std::size_t i = 0; i < black.data.size(); ++i)
    if (frame_.material[i / 3] != 0) black.data[i] = 0.5f;
  const Capture capture = read(guessPasses(
      {{"VRayDiffuseFilter", black}, {"VRayLighting", times(frame_.irradiance, black, 1 / kPi)}}));
  for (std::size_t i = 0; i < black.data.size(); ++i)
    ASSERT_NEAR(capture.irradiance.data[i], black.data[i] > 0 ? frame_.irradiance.data[i] : 0, 1e-5f) << i;
  // Without an albedo the product stays, and the person is told.
  const GuessedManifest alone = guessPasses({{"VRayLighting", frame_.irradiance}});
  EXPECT_FALSE(alone.json["buffers"]["irradiance"].contains("includesAlbedo"));
  EXPECT_NE(alone.json["// irradiance"].get<std::string>().find("--albedo"), std::string::npos);
}

TEST_F(Init, WhatCannotBeACaptureIsNamed) {
  InitWords words;
  words.camera.verticalFov = 30;
  const Image empty(frame_.width, frame_.height, 1, kNoDepth);
  write("a.exr", triple("", "RGB", frame_.irradiance));
  write("z.exr", {{"Z", &frame_.frontDepth.image, 0}});
  write("empty.exr", {{"Z", &empty, 0}});
  const auto refused = [&](const std::vector<std::string>& files, const std::string& named) {
    EXPECT_NE(refusalOf([&] { guess(files, words); }).find(named), std::string::npos) << named;
  };
  refused({"a.exr"}, "--front-depth: ");
  refused({"z.exr"}, "--irradiance");
  refused({"a.exr", "empty.exr"}, "empty.exr: frontDepth: ");
  words.camera.eye = {0, 0, 1};
  refused({"a.exr", "z.exr"}, "--eye: needs --target");
}

}  // namespace
}  // namespace pellucid::harness
