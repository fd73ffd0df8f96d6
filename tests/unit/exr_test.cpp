// What OpenEXR files may be: every layout that is read, and every one that is refused by name.
#include <ImfChannelList.h>
#include <ImfChromaticities.h>
#include <ImfDeepFrameBuffer.h>
#include <ImfDeepScanLineOutputFile.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfOutputFile.h>
#include <ImfPartType.h>
#include <ImfStandardAttributes.h>
#include <ImfStringAttribute.h>
#include <ImfTileDescriptionAttribute.h>
#include <ImfTiledOutputFile.h>
#include <gtest/gtest.h>

#include <map>
#include <string>
#include <vector>

#include "capture/exr.h"
#include "unit/capture_samples.h"

namespace pellucid::harness {
namespace {

Imf::Slice floats(Image& image, const Imath::Box2i& window) {
  return Imf::Slice::Make(Imf::FLOAT, image.data.data(), window);
}

class ExrFiles : public Manifests {
protected:
  // Reads irradiance from x.exr channel "V" three times.
  Image readV() {
    manifest["buffers"]["irradiance"] = {{"file", "x.exr"}, {"channels", {"V", "V", "V"}}};
    const Capture capture = read();
    Image first(capture.width, capture.height, 1);
    for (std::size_t i = 0; i < first.data.size(); ++i) first.data[i] = capture.irradiance.data[3 * i];
    return first;
  }
  std::string x() { return (directory / "x.exr").string(); }
  // Writes floats as x.exr, in the header's data window.
  void write(Imf::Header header, const std::map<std::string, Image*>& channels) {
    Imf::FrameBuffer frame;
    for (const auto& [name, image] : channels) {
      header.channels().insert(name, Imf::Channel(Imf::FLOAT));
      frame.insert(name, floats(*image, header.dataWindow()));
    }
    Imf::OutputFile file(x().c_str(), header);
    file.setFrameBuffer(frame);
    file.writePixels(header.dataWindow().max.y - header.dataWindow().min.y + 1);
  }

  Image values = sampleImage(kSampleWidth, kSampleHeight, 1, 0.3f);
  const Imath::Box2i window{{0, 0}, {kSampleWidth - 1, kSampleHeight - 1}};
};

// DWA changes channels that are named as colors are.
TEST_F(ExrFiles, LossyCompressionIsOfColors) {
  Imf::Header header(kSampleWidth, kSampleHeight);
  header.compression() = Imf::DWAA_COMPRESSION;
  write(header, {{"depth.R", &values}, {"front.Z", &values}});
  const ExrFile file(x());
  EXPECT_EQ(file.lossyCompression(0, "depth.R"), "DWAA");
  EXPECT_EQ(file.lossyCompression(0, "front.Z"), "");
}

TEST_F(ExrFiles, TiledIsReadAtLevelZero) {
  for (const Imf::LevelMode mode : {Imf::ONE_LEVEL, Imf::MIPMAP_LEVELS}) {
    Imf::Header header(kSampleWidth, kSampleHeight);
    header.channels().insert("V", Imf::Channel(Imf::FLOAT));
    header.setTileDescription(Imf::TileDescription(4, 2, mode));
    header.lineOrder() = Imf::RANDOM_Y;
    {
      Imf::TiledOutputFile file(x().c_str(), header);
      Imf::FrameBuffer frame;
      frame.insert("V", floats(values, window));
      file.setFrameBuffer(frame);
      for (int level = 0; level < file.numLevels(); ++level)
        file.writeTiles(0, file.numXTiles(level) - 1, 0, file.numYTiles(level) - 1, level);
    }
    EXPECT_TRUE(sameBits(readV(), values));
  }
}

TEST_F(ExrFiles, ScanlinesOfEveryLosslessCompressionAndOrder) {
  for (const Imf::Compression compression : {Imf::NO_COMPRESSION, Imf::RLE_COMPRESSION, Imf::ZIPS_COMPRESSION,
                                             Imf::ZIP_COMPRESSION, Imf::PIZ_COMPRESSION}) {
    for (const Imf::LineOrder order : {Imf::INCREASING_Y, Imf::DECREASING_Y}) {
      write(Imf::Header(kSampleWidth, kSampleHeight, 1, {0, 0}, 1, order, compression), {{"V", &values}});
      EXPECT_TRUE(sameBits(readV(), values)) << compression << " " << order;
    }
  }
}

TEST_F(ExrFiles, HalfAndUintBecomeFloat) {
  std::vector<Imath::half> halves;
  std::vector<unsigned> integers;
  for (unsigned i = 0; i < kSampleWidth * kSampleHeight; ++i) {
    halves.push_back(Imath::half(0.1f * static_cast<float>(i)));
    integers.push_back(1000 + i);
  }
  Imf::Header header(kSampleWidth, kSampleHeight);
  header.channels().insert("H", Imf::Channel(Imf::HALF));
  header.channels().insert("U", Imf::Channel(Imf::UINT));
  {
    Imf::OutputFile file(x().c_str(), header);
    Imf::FrameBuffer frame;
    frame.insert("H", Imf::Slice::Make(Imf::HALF, halves.data(), window));
    frame.insert("U", Imf::Slice::Make(Imf::UINT, integers.data(), window));
    file.setFrameBuffer(frame);
    file.writePixels(kSampleHeight);
  }
  manifest["buffers"]["irradiance"] = {{"file", "x.exr"}, {"channels", {"H", "U", "H"}}};
  const Capture capture = read();
  for (std::size_t i = 0; i < halves.size(); ++i) {
    EXPECT_EQ(capture.irradiance.data[3 * i], static_cast<float>(halves[i]));
    EXPECT_EQ(capture.irradiance.data[3 * i + 1], static_cast<float>(integers[i]));
  }
}

TEST_F(ExrFiles, PixelsOutsideTheDataWindowHoldNothing) {
  // 4x3 pixels at (2, 1) in a display window that starts at (-1, -1); some lie outside of it.
  const Imath::Box2i display({-1, -1}, {kSampleWidth - 2, kSampleHeight - 2}), data({2, 1}, {8, 9});
  Image part = sampleImage(7, 9, 1, 1.0f);
  Image ones(7, 9, 1, 1.0f);
  write(Imf::Header(display, data), {{"V", &part}, {"Z", &part}, {"id", &ones}});
  manifest["buffers"]["frontDepth"] = {{"file", "x.exr"}, {"channel", "Z"}, {"encoding", "viewZ"}};
  manifest["buffers"]["material"] = {{"file", "x.exr"}, {"channel", "id"}, {"map", {{"0", 1}, {"1", 1}}}};
  manifest["buffers"]["irradiance"] = {{"file", "x.exr"}, {"channels", {"V", "V", "V"}}};
  const Capture capture = read();
  for (int y = 0; y < kSampleHeight; ++y)
    for (int x = 0; x < kSampleWidth; ++x) {
      const bool inside = x - 1 >= 2 && y - 1 >= 1;
      const float stored = inside ? *part.at(x - 3, y - 2) : 0;
      EXPECT_EQ(capture.irradiance.at(x, y)[1], stored);
      EXPECT_EQ(*capture.frontDepth.image.at(x, y), inside ? stored : kNoDepth);
      EXPECT_EQ(capture.material[static_cast<std::size_t>(y * kSampleWidth + x)],
                inside);  // whatever 0 maps to
    }
  manifest["buffers"]["frontDepth"]["encoding"] = "device";
  expectNames(error(), {"x.exr", "buffers.frontDepth", "data window", "device"});
}

TEST_F(ExrFiles, PartsAreFoundByChannelOrNumber) {
  std::vector<ExrPart> parts(3);
  Image other = sampleImage(kSampleWidth, kSampleHeight, 1, 5.0f);
  parts[0] = {"a", {{"Y", ExrFormat::Float, &other, 0}}, {}};
  parts[1] = {"b", {{"V", ExrFormat::Float, &values, 0}}, {}};
  parts[2] = {"c", {{"Y", ExrFormat::Float, &values, 0}}, {}};
  writeExrParts(x(), parts);
  EXPECT_TRUE(sameBits(readV(), values));

  manifest["buffers"]["irradiance"] = {{"file", "x.exr"}, {"channels", {"Y", "Y", "Y"}}};
  expectNames(error(), {"x.exr", "buffers.irradiance", "\"Y\"", "parts 0 and 2"});
  manifest["buffers"]["irradiance"]["part"] = 2;
  EXPECT_EQ(read().irradiance.data[0], values.data[0]);
  manifest["buffers"]["irradiance"]["part"] = 1;
  expectNames(error(), {"x.exr", "buffers.irradiance", "part 1", "it has: V"});
}

TEST_F(ExrFiles, SubsampledChannelsAreRefusedByName) {
  Imf::Header header(6, 4);
  header.channels().insert("V", Imf::Channel(Imf::FLOAT, 2, 2));
  {
    Image quarter(3, 2, 1);
    Imf::OutputFile file(x().c_str(), header);
    Imf::FrameBuffer frame;
    frame.insert("V", Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(quarter.data.data()), 4, 12, 2, 2));
    file.setFrameBuffer(frame);
    file.writePixels(4);
  }
  manifest["lights"][0]["shadowMap"]["file"] = "x.exr";  // the only buffer of any size
  manifest["lights"][0]["shadowMap"]["channel"] = "V";
  expectNames(error(), {"x.exr", "\"V\"", "subsampled 2x2"});
}

TEST_F(ExrFiles, DeepPartsAreRefusedByName) {
  Imf::Header header(2, 1);
  header.setType(Imf::DEEPSCANLINE);
  header.compression() = Imf::ZIPS_COMPRESSION;
  header.channels().insert("V", Imf::Channel(Imf::FLOAT));
  {
    float value = 1;
    float* pointers[2] = {&value, &value};
    unsigned counts[2] = {1, 1};
    Imf::DeepScanLineOutputFile file(x().c_str(), header);
    Imf::DeepFrameBuffer frame;
    frame.insertSampleCountSlice(Imf::Slice(Imf::UINT, reinterpret_cast<char*>(counts), 4, 8));
    frame.insert("V", Imf::DeepSlice(Imf::FLOAT, reinterpret_cast<char*>(pointers), sizeof(float*),
                                     2 * sizeof(float*), 4));
    file.setFrameBuffer(frame);
    file.writePixels(1);
  }
  manifest["buffers"]["albedo"] = {{"file", "x.exr"}, {"channels", {"V", "V", "V"}}};
  expectNames(error(), {"x.exr", "part 0", "deepscanline"});
}

// ACES' primaries, as renderers write them.
const Imf::Chromaticities kAces({0.713f, 0.293f}, {0.165f, 0.83f}, {0.128f, 0.044f}, {0.32168f, 0.33767f});

TEST_F(ExrFiles, AttributesThatChangeColorsAreNamed) {
  manifest["buffers"]["irradiance"] = {{"file", "x.exr"}, {"channels", {"V", "V", "V"}}};
  const auto warnings = [&](const auto& change) {
    Imf::Header header(kSampleWidth, kSampleHeight);
    change(header);
    write(header, {{"V", &values}});
    return read().warnings;
  };
  const auto none = warnings([](Imf::Header&) {});
  EXPECT_EQ(none, std::vector<std::string>());
  EXPECT_EQ(warnings([](Imf::Header& h) { Imf::addChromaticities(h, Imf::Chromaticities()); }), none);
  EXPECT_EQ(warnings([](Imf::Header& h) { h.insert("oiio:ColorSpace", Imf::StringAttribute("lin_rec709")); }),
            none);
  EXPECT_EQ(warnings([](Imf::Header& h) {
              Imf::addWhiteLuminance(h, 100.0f);  // a scale for displays
              h.insert("somebody's", Imf::StringAttribute("own"));
            }),
            none);
  const auto aces = warnings([](Imf::Header& h) { Imf::addChromaticities(h, kAces); });
  ASSERT_EQ(aces.size(), 1u);
  expectNames(aces[0],
              {"buffers.irradiance", "x.exr", "chromaticities", "red", "(0.713, 0.293)", "linear Rec. 709"});
  for (const char* name : {"colorInteropID", "oiio:ColorSpace"}) {
    const auto said =
        warnings([&](Imf::Header& h) { h.insert(name, Imf::StringAttribute("lin_ap1_scene")); });
    ASSERT_EQ(said.size(), 1u) << name;
    expectNames(said[0], {name, "lin_ap1_scene"});
  }
}

TEST_F(ExrFiles, PanoramasAreRefused) {
  Imf::Header header(kSampleWidth, kSampleHeight);
  Imf::addEnvmap(header, Imf::ENVMAP_LATLONG);
  write(header, {{"V", &values}});
  manifest["buffers"]["albedo"] = {{"file", "x.exr"}, {"channels", {"V", "V", "V"}}};
  expectNames(error(), {"x.exr", "part 0 envmap", "panorama"});
}

TEST_F(ExrFiles, BuffersAreOfOneEye) {
  Imf::Header header(kSampleWidth, kSampleHeight);
  Imf::addMultiView(header, {"left", "right"});
  write(header, {{"V", &values}, {"light.right.V", &values}, {"color.left.V", &values}});
  manifest["buffers"]["irradiance"] = {{"file", "x.exr"}, {"channels", {"V", "V", "V"}}};
  manifest["buffers"]["albedo"] = {{"file", "x.exr"},
                                   {"channels", {"color.left.V", "color.left.V", "color.left.V"}}};
  read();
  manifest["buffers"]["irradiance"]["channels"] = {"light.right.V", "light.right.V", "light.right.V"};
  expectNames(error(), {"x.exr", "buffers.albedo", "\"right\"", "\"left\"", "one eye"});
}

TEST_F(ExrFiles, HugeImagesAreRefusedBeforeTheyAreRead) {
  Image one(1, 1, 1);
  write(Imf::Header({{0, 0}, {kMaxExrSide, 0}}, Imath::Box2i({0, 0}, {0, 0})), {{"V", &one}});
  manifest["buffers"]["albedo"] = {{"file", "x.exr"}, {"channels", {"V", "V", "V"}}};
  expectNames(error(), {"x.exr", "displayWindow", std::to_string(kMaxExrSide + 1) + "x1"});
}

// ---- Images

TEST(ExrImages, FindTheirColor) {
  const TemporaryDirectory directory;
  const Image image = sampleImage(3, 2, 3, 0.5f);
  writeExr(directory / "a.exr", image, {"R", "G", "B"}, {{"note", "x"}});
  EXPECT_TRUE(sameBits(readExrImage(directory / "a.exr"), image));
  writeExr(directory / "b.exr", image, {"diffuse.R", "diffuse.G", "diffuse.B"});
  EXPECT_TRUE(sameBits(readExrImage(directory / "b.exr"), image));
  writeExr(directory / "c.exr", image, {"X", "Y", "B"});
  expectNames(refusalOf([&] { readExrImage(directory / "c.exr"); }), {"c.exr", "channels", "B, X, Y"});
  writeExrParts(directory / "d.exr", {{"a",
                                       {{"a.R", ExrFormat::Half, &image, 0},
                                        {"a.G", ExrFormat::Half, &image, 1},
                                        {"a.B", ExrFormat::Half, &image, 2},
                                        {"b.R", ExrFormat::Half, &image, 0},
                                        {"b.G", ExrFormat::Half, &image, 1},
                                        {"b.B", ExrFormat::Half, &image, 2}},
                                       {}}});
  expectNames(refusalOf([&] { readExrImage(directory / "d.exr"); }), {"d.exr", "channels", "a.R, b.R"});
  EXPECT_TRUE(sameBits(readExrImage(directory / "b.exr", "diffuse"), image));
  EXPECT_EQ(readExrImage(directory / "d.exr", "b").width, 3);
  expectNames(refusalOf([&] { readExrImage(directory / "d.exr", "c"); }),
              {"d.exr", "no layer \"c\"", "a.R, b.R"});
  writeExr(directory / "e.exr", image, {"View.Combined.R", "View.Combined.G", "View.Combined.B"});
  EXPECT_TRUE(sameBits(readExrImage(directory / "e.exr", "Combined"), image));
}

}  // namespace
}  // namespace pellucid::harness
