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

ChannelGroup numberOf(const std::string& file, const std::string& layer) { return {file, 0, layer, true, "", false, {layer + ".Z"}}; }
ChannelGroup colorOf(const std::string& file, const std::string& layer) {
  return {file, 0, layer, true, "", false, {layer + ".R", layer + ".G", layer + ".B"}};
}
std::string takenBy(Role role, const std::vector<ChannelGroup>& groups, const std::map<Role, std::string>& given = {}) {
  const std::map<Role, Guess> guesses = guessRoles(groups, given);
  const auto found = guesses.find(role);
  return found == guesses.end() ? "" : found->second.group.file.string();
}

// Two renders of one scene have passes of equal names; the shell sorts "back" before "front".
TEST(InitNames, BackFacesAreTakenFromTheFileThatIsNamedAfterThem) {
  struct Row {
    std::string front, back;
  };
  for (const Row& row : {Row{"scene_front.exr", "scene_back.exr"}, Row{"front.0001.exr", "back.0001.exr"},
                         Row{"headFront.exr", "headBack.exr"}, Row{"head.exr", "head_backfaces.exr"}, Row{"headfront.exr", "headback.exr"},
                         Row{"head.exr", "headback.exr"}, Row{"front/r.exr", "back/r.exr"}}) {
    SCOPED_TRACE(row.back);
    std::vector<ChannelGroup> groups;
    for (const std::string& file : {row.back, row.front}) {
      groups.push_back(numberOf(file, "V.Depth"));
      groups.push_back(colorOf(file, "V.DiffDir"));
      groups.push_back(colorOf(file, "V.DiffCol"));
      groups.push_back({file, 0, "V.IndexMA", true, "", false, {"V.IndexMA.X"}});
    }
    for (int order = 0; order < 2; ++order) {
      EXPECT_EQ(takenBy(Role::BackDepth, groups), row.back);
      for (const Role role : {Role::FrontDepth, Role::Irradiance, Role::Albedo, Role::Material}) EXPECT_EQ(takenBy(role, groups), row.front);
      EXPECT_EQ(guessRoles(groups, {}).at(Role::Irradiance).doubt, "");
      std::rotate(groups.begin(), groups.begin() + 4, groups.end());
    }
  }
}

// Light groups, views from behind and other words are no back faces.
TEST(InitNames, OtherWordsThanBackSayNothing) {
  for (const char* file : {"hero_back.exr", "background.exr", "playback.exr"}) {
    const std::vector<ChannelGroup> groups = {numberOf(file, "Depth"), colorOf(file, "diffuse_direct_back")};
    EXPECT_EQ(takenBy(Role::FrontDepth, groups), file);
    EXPECT_EQ(takenBy(Role::BackDepth, groups), "");
    EXPECT_EQ(guessRoles(groups, {}).at(Role::Irradiance).doubt, "");
  }
  EXPECT_EQ(takenBy(Role::FrontDepth, {numberOf("back.exr", "Depth"), colorOf("light.exr", "irradiance")}), "");
  EXPECT_EQ(takenBy(Role::BackDepth, {numberOf("r.exr", "V.Depth"), numberOf("r.exr", "BackFaces.V.Depth"), colorOf("r.exr", "V.DiffDir")}),
            "r.exr");
  const std::map<Role, Guess> onlyLight = guessRoles({numberOf("front.exr", "Depth"), colorOf("back.exr", "DiffDir")}, {});
  EXPECT_NE(onlyLight.at(Role::Irradiance).doubt.find("of a file of back faces"), std::string::npos);
}

// A file, with or without a layer, names what is in it.
TEST(InitNames, FilesTellPassesOfOneNameApart) {
  const std::vector<ChannelGroup> groups = {numberOf("b.0007.exr", "Depth"), colorOf("b.0007.exr", "DiffDir"), numberOf("a.exr", "Depth"),
                                            colorOf("a.exr", "DiffDir")};
  for (const char* name : {"b", "b.0007", "b.0007.exr", "b:Depth", "b.0007:Depth.Z", "b.0007.exr:Depth"}) {
    const std::map<Role, std::string> given = {{Role::BackDepth, name}};
    EXPECT_EQ(takenBy(Role::BackDepth, groups, given), "b.0007.exr") << name;
    EXPECT_EQ(takenBy(Role::FrontDepth, groups, given), "a.exr") << name;
    EXPECT_EQ(takenBy(Role::Irradiance, groups, given), "a.exr") << name;
  }
  EXPECT_EQ(takenBy(Role::Irradiance, groups, {{Role::FrontDepth, "a"}}), "a.exr");
  const auto refused = [&](Role role, const std::string& name) { return refusalOf([&] { guessRoles(groups, {{role, name}}); }); };
  expectNames(refused(Role::BackDepth, "Depth"), {"backDepth: several have the name \"Depth\"", "b.0007:Depth, a:Depth"});
  expectNames(refused(Role::Irradiance, "c"), {"there is no \"c\"", "b.0007:DiffDir, a:DiffDir"});
  EXPECT_NE(guessRoles(groups, {}).at(Role::FrontDepth).doubt.find("\"a:Depth\" may be another depth: --back-depth"), std::string::npos);
}

// As pbrt writes them: names that end in z, and are no depths.
TEST(InitNames, PartsOfVectorsAreNoDepths) {
  const auto channels = [](std::vector<std::string> names, const std::string& stem = "r") {
    std::vector<ChannelGroup> groups = {colorOf("r.exr", "diffuse")};
    for (const std::string& name : names) {
      const std::size_t dot = name.rfind('.');
      groups.push_back({"r.exr", 0, dot == name.npos ? stem : name.substr(0, dot), dot != name.npos, "", false, {name}});
    }
    return groups;
  };
  const std::vector<std::vector<std::string>> rows = {{"Nx", "Ny", "Nz", "Px", "Py", "Pz"}, {"Nz"},  {"cam_Nz"}, {"dPdux", "dPduy", "dPduz"},
                                                      {"N.Z"},                              {"normal.Z"}, {"normalZ"}, {"aux.ux", "aux.uz"}};
  for (const std::vector<std::string>& row : rows) {
    EXPECT_EQ(takenBy(Role::FrontDepth, channels(row)), "") << row[0];
    EXPECT_EQ(takenBy(Role::FrontDepth, channels(row, "topaz")), "") << row[0];
  }
  for (const char* depth : {"Z", "Main.Z", "linZ", "camera_z", "composition.Z"}) {
    const std::map<Role, Guess> guesses = guessRoles(channels({"Nx", "Ny", "Nz", depth}), {});
    ASSERT_EQ(guesses.count(Role::FrontDepth), 1u) << depth;
    EXPECT_EQ(guesses.at(Role::FrontDepth).group.channels[0], depth);
  }
}

// Ids and depths that are saved as colors have equal channels, or, of a debugger, only the first.
TEST_F(Init, ColorsAreNoNumbers) {
  const Image& depth = frame_.frontDepth.image;
  const Image id = materialImage(1), none = materialImage(0);
  Image rest = id;
  for (float& value : rest.data) value = 1 - value;
  using Samples = std::vector<const Image*>;
  const auto groups = [&](const std::string& idName, const Samples& ids, const std::string& depthName, const Samples& depths) {
    std::vector<Channel> channels = triple("irradiance.", "RGB", frame_.irradiance);
    for (std::size_t i = 0; i < 3; ++i) {
      channels.push_back({idName + "." + "RGB"[i], ids[i], 0});
      channels.push_back({depthName + "." + "RGB"[i], depths[i], 0});
    }
    write("colors.exr", channels);
  };
  InitWords words;
  words.camera.verticalFov = fov_;
  for (const Samples& ids : {Samples{&id, &id, &id}, Samples{&id, &none, &none}}) {
    groups("VRayMtlID", ids, "ZDepth", {&depth, &depth, &depth});
    EXPECT_EQ(read(guess({"colors.exr"}, words)).material, frame_.material);
  }
  groups("VRayMtlID", {&rest, &id, &none}, "ZDepth", {&depth, &none, &none});
  const GuessedManifest guessed = guess({"colors.exr"}, words);
  EXPECT_EQ(guessed.json["buffers"]["frontDepth"]["channel"], "ZDepth.R");
  expectNames(guessed.json["// material"].get<std::string>(),
              {"everything is", "colors.exr VRayMtlID: its R, G and B differ: a color, no number", "VRayMtlID.G"});
  words.roles = {{Role::Material, "VRayMtlID.G"}};
  EXPECT_EQ(read(guess({"colors.exr"}, words)).material, frame_.material);
  words.roles = {{Role::Material, "VRayMtlID"}};
  expectNames(refusalOf([&] { guess({"colors.exr"}, words); }), {"colors.exr VRayMtlID: its R, G and B differ", "name one of VRayMtlID.R"});
  words.roles = {};
  groups("MtlID", {&id, &id, &id}, "DepthColors", {&depth, &id, &none});
  expectNames(refusalOf([&] { guess({"colors.exr"}, words); }),
              {"--front-depth: no name", "colors.exr DepthColors: its R, G and B differ: a color, no number"});
}

// A color beside its depth, in a file that is named after depths or ids.
TEST_F(Init, FilesNamesAreNotThoseOfTheirColors) {
  std::vector<Channel> channels = triple("", "RGB", frame_.irradiance);
  channels.push_back({"Z", &frame_.frontDepth.image, 0});
  write("hero_depth_id.exr", channels);
  InitWords words;
  words.camera.verticalFov = fov_;
  const Capture capture = read(guess({"hero_depth_id.exr"}, words));
  EXPECT_TRUE(sameBits(capture.frontDepth.image, frame_.frontDepth.image));
  EXPECT_TRUE(sameBits(capture.irradiance, frame_.irradiance));
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

// Buffers of two cameras are no frame. Attributes of files that no buffer is of do not matter, nor do planes of depth.
TEST_F(Init, FilesOfTwoCamerasAreRefused) {
  Imath::M44f camera, moved, ndc, planes, wide;
  moved[3][0] = 0.05f;
  ndc[0][0] = 0.9f, ndc[1][1] = -1.2f, ndc[2][0] = ndc[2][1] = -0.5f, ndc[2][3] = -1, ndc[3][3] = 0;
  camera[2][2] = moved[2][2] = -1;
  planes = wide = ndc;
  planes[2][2] = -3, planes[3][2] = -7;
  wide[0][0] = 0.8f;
  write("depth.exr", {{"depth.Z", &frame_.frontDepth.image, 0}}, {{"worldToCamera", camera}, {"worldToNDC", ndc}});
  const auto light = [&](const Imath::M44f& toCamera, const Imath::M44f& toNdc) {
    write("irradiance.exr", triple("irradiance.", "RGB", frame_.irradiance), {{"worldToCamera", toCamera}, {"worldToNDC", toNdc}});
  };
  const auto refusal = [&](const InitWords& words) { return refusalOf([&] { guess({"depth.exr", "irradiance.exr"}, words); }); };
  light(camera, planes);
  EXPECT_EQ(refusal({}), "accepted");
  light(moved, ndc);
  expectNames(refusal({}), {"depth.exr: worldToCamera: holds 0 where that of ", "irradiance.exr holds 0.05: these are files of two cameras",
                            "Render all buffers with one"});
  light(camera, wide);
  expectNames(refusal({}), {"depth.exr: worldToNDC: holds 0.9 where that of ", "irradiance.exr holds 0.8"});
  InitWords words;
  words.camera.verticalFov = fov_;
  EXPECT_NE(refusal(words).find("two cameras"), std::string::npos);
  words.camera.eye = {0, 0, 1};
  words.camera.target = {0, 0, 0};
  EXPECT_EQ(refusal(words), "accepted");
  light(camera, ndc);
  write("notes.exr", triple("notes.", "RGB", frame_.irradiance), {{"worldToCamera", moved}});
  EXPECT_NO_THROW(guess({"notes.exr", "depth.exr", "irradiance.exr"}, {}));
}

TEST_F(Init, WindowsOfTwoLensesAreRefused) {
  Imf::Header wide(1, 1), narrow(1, 1);
  wide.screenWindowWidth() = 0.7f;
  narrow.screenWindowWidth() = 0.5f;
  write("depth.exr", {{"depth.Z", &frame_.frontDepth.image, 0}}, {}, narrow);
  write("irradiance.exr", triple("irradiance.", "RGB", frame_.irradiance), {}, wide);
  InitWords words;
  const auto refusal = [&] { return refusalOf([&] { guess({"depth.exr", "irradiance.exr"}, words); }); };
  expectNames(refusal(), {"depth.exr: screenWindowWidth: is 0.5, but that of ", "irradiance.exr is 0.7"});
  words.camera.verticalFov = fov_;
  EXPECT_EQ(refusal(), "accepted");
}

// A matrix to 0 .. 1 has y down, and one to -1 .. 1 has y up, wherever the axis meets the image.
TEST_F(Init, LensesShiftAndOrthographicCamerasNeedNoFarPlane) {
  std::vector<Channel> channels = triple("irradiance.", "RGB", frame_.irradiance);
  channels.push_back({"Z", &frame_.frontDepth.image, 0});
  Imath::M44f identity;
  const auto clipOf = [&](const glm::dmat4& rows, const InitWords& words = {}) {
    Imath::M44f ndc;
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j < 4; ++j) ndc[i][j] = static_cast<float>(rows[j][i]);
    write("lens.exr", channels, {{"worldToCamera", identity}, {"worldToNDC", ndc}});
    return read(guess({"lens.exr"}, words)).clipFromView;
  };
  for (const double shift : {0.0, 0.3, -0.45}) {
    const double x = 2 * shift, y = -2 * shift;  // of the image's half sides, y down
    const Matrix fromZero = clipOf({0.75, 0, -0.5 - shift, 0, 0, -1, -0.5 + shift, 0, 0, 0, -1, -1, 0, 0, -1, 0});
    const Matrix fromMinusOne = clipOf({1.5, 0, -x, 0, 0, 2, y, 0, 0, 0, -1, -1, 0, 0, -1, 0});
    for (const Matrix& clip : {fromZero, fromMinusOne}) {
      EXPECT_NEAR(clip[0], 1.5, 1e-6) << shift;
      EXPECT_NEAR(clip[5], -2, 1e-6) << shift;
      EXPECT_NEAR(clip[8], -x, 1e-6) << shift;
      EXPECT_NEAR(clip[9], -y, 1e-6) << shift;
    }
  }
  const glm::dmat4 orthographic(0.02, 0, 0, 0.5, 0, -0.025, 0, 0.5, 0, 0, -1, 0, 0, 0, 0, 1);
  const Matrix clip = clipOf(orthographic);
  EXPECT_NEAR(clip[0], 0.04, 1e-6);
  EXPECT_NEAR(clip[5], -0.05, 1e-6);
  EXPECT_EQ(clip[15], 1);
  InitWords words;
  words.deviceDepth = true;
  words.camera.nearPlane = 1;
  Image device = frame_.frontDepth.image;
  for (float& value : device.data) value = 0.5f;
  channels.back().image = &device;
  EXPECT_NE(refusalOf([&] { clipOf(orthographic, words); }).find("--far: is needed with an orthographic camera"), std::string::npos);
  EXPECT_NE(refusalOf([&] { clipOf(glm::dmat4(1)); }).find("--fov: is needed"), std::string::npos) << "an identity says nothing";
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
