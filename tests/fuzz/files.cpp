#include "fuzz/files.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfTileDescriptionAttribute.h>
#include <ImfTiledOutputFile.h>

#include "capture/write.h"
#include "common/png.h"
#include "gltf_builder.h"
#include "unit/capture_samples.h"

namespace pellucid::fuzz {

using namespace pellucid::harness;

std::string soundCapture() {
  const TemporaryDirectory folder;
  writeCapture(sampleCapture(), folder / "c.exr");
  return readText(folder / "c.exr");
}

std::string soundTiles() {
  const TemporaryDirectory folder;
  Imf::Header header(16, 16);
  header.channels().insert("ViewLayer.Depth.Z", Imf::Channel(Imf::FLOAT));
  header.setTileDescription(Imf::TileDescription(8, 8, Imf::MIPMAP_LEVELS));
  {
    Image image = sampleImage(16, 16, 1, 1);
    Imf::TiledOutputFile file((folder / "t.exr").string().c_str(), header);
    Imf::FrameBuffer frame;
    frame.insert("ViewLayer.Depth.Z", Imf::Slice::Make(Imf::FLOAT, image.data.data(), header.dataWindow()));
    file.setFrameBuffer(frame);
    for (int level = 0; level < file.numLevels(); ++level)
      file.writeTiles(0, file.numXTiles(level) - 1, 0, file.numYTiles(level) - 1, level);
  }
  return readText(folder / "t.exr");
}

std::string soundGlb() {
  const TemporaryDirectory folder;
  writePng(folder / "c.png", 2, 1, {255, 0, 0, 0, 0, 255});
  const std::string png = readText(folder / "c.png");
  test::GltfBuilder b;
  const int position = b.vectors({0, 0, 0, 2, 0, 0, 2, 2, 0, 0, 2, 0});
  const int normal = b.vectors({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1});
  const int uv = b.accessor(std::vector<float>{0, 1, 1, 1, 1, 0, 0, 0}, 5126, "VEC2", 2);
  const int indices = b.indices({0, 1, 2, 0, 2, 3});
  const int joints = b.accessor(std::vector<std::uint8_t>(16, 0), 5121, "VEC4", 4);
  const int weights = b.accessor(std::vector<float>(16, 0.25f), 5126, "VEC4", 4);
  const std::vector<std::uint16_t> replaced = {1};
  const int sparse = b.view(replaced.data(), 2);
  b.json["accessors"][static_cast<std::size_t>(normal)]["sparse"] = {
      {"count", 1},
      {"indices", {{"bufferView", sparse}, {"componentType", 5123}}},
      {"values", {{"bufferView", 0}}}};
  b.json["meshes"] = {{{"weights", {0.5}},
                       {"primitives",
                        {{{"attributes",
                           {{"POSITION", position},
                            {"NORMAL", normal},
                            {"TEXCOORD_0", uv},
                            {"JOINTS_0", joints},
                            {"WEIGHTS_0", weights}}},
                          {"targets", {{{"POSITION", normal}}}},
                          {"indices", indices},
                          {"material", 0}}}}}};
  b.json["skins"] = {{{"joints", {0}}}};
  b.json["nodes"] = {
      {{"mesh", 0},
       {"skin", 0},
       {"scale", {1, 2, 3}},
       {"children", {1}}},
      {{"camera", 0}, {"translation", {0, 0, 5}}},
      {{"rotation", {0, 0, 0, 1}}, {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}}};
  b.json["scenes"][0]["nodes"] = {0, 2};
  b.json["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 0.5}, {"znear", 0.1}}}}};
  b.json["extensionsUsed"] = {"KHR_lights_punctual", "KHR_materials_volume"};
  b.json["extensions"]["KHR_lights_punctual"]["lights"] = {
      {{"type", "spot"}, {"range", 7}, {"spot", {{"innerConeAngle", 0.1}, {"outerConeAngle", 0.3}}}}};
  const int image = b.view(png.data(), png.size());
  b.json["images"] = {{{"bufferView", image}, {"mimeType", "image/png"}}};
  b.json["samplers"] = {{{"wrapS", 33071}, {"wrapT", 33648}}};
  b.json["textures"] = {{{"source", 0}, {"sampler", 0}}};
  b.json["materials"] = {
      {{"name", "m"},
       {"pbrMetallicRoughness",
        {{"baseColorTexture",
          {{"index", 0},
           {"extensions", {{"KHR_texture_transform", {{"offset", {0.5, 0}}, {"rotation", 1}}}}}}}}},
       {"normalTexture", {{"index", 0}, {"scale", 0.5}}},
       {"extensions",
        {{"KHR_materials_volume",
          {{"thicknessFactor", 1}, {"attenuationDistance", 0.002}, {"attenuationColor", {0.5, 0.25, 0.125}}}},
         {"KHR_materials_volume_scatter",
          {{"multiscatterColor", {0.8, 0.5, 0.2}},
           {"multiscatterColorTexture", {{"index", 0}}},
           {"scatterAnisotropy", 0.25}}},
         {"KHR_materials_diffuse_transmission", {{"diffuseTransmissionFactor", 1.0}}}}}}};
  return b.glb();
}

}  // namespace pellucid::fuzz
