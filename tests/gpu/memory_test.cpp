// Files that claim more than they hold or than the process may have: the command refuses them with a sentence
// that names the file, and takes no memory for the claim.
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfOutputFile.h>

#include <cstdint>
#include <cstring>
#include <nlohmann/json.hpp>
#include <vector>

#include "cli_fixture.h"
#include "gltf_builder.h"

namespace {

using namespace pellucid::test;

class Memory : public Cli {
protected:
  // Of a process that may have `megabytes` of addresses.
  void expectWithin(int megabytes, int code, const std::string& arguments,
                    const std::vector<std::string>& words) const {
    const Outcome outcome = run(arguments, "ulimit -v " + std::to_string(megabytes * 1024) + "; ");
    EXPECT_EQ(outcome.code, code) << arguments << "\n" << outcome.text;
    for (const std::string& word : words)
      EXPECT_NE(outcome.text.find(word), std::string::npos) << arguments << "\n" << outcome.text;
    EXPECT_EQ(outcome.text.find("bad_alloc"), std::string::npos) << outcome.text;
    EXPECT_EQ(outcome.text.find("terminate"), std::string::npos) << outcome.text;
  }

  void write(const std::string& name, const std::string& bytes) const {
    std::ofstream(path(name), std::ios::binary) << bytes;
  }

  // One pixel in a display window of this size, with the channels of a capture, and the manifest.
  void writeCapture(const std::string& name, int width, int height) const {
    const char* const channels[] = {"Z", "R", "G", "B"};
    Imf::Header header(Imath::Box2i({0, 0}, {width - 1, height - 1}), Imath::Box2i({0, 0}, {0, 0}));
    Imf::FrameBuffer frame;
    float value = 1;
    for (const char* channel : channels) {
      header.channels().insert(channel, Imf::Channel(Imf::FLOAT));
      frame.insert(channel,
                   Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(&value), sizeof value, sizeof value));
    }
    Imf::OutputFile file(path(name + ".exr").c_str(), header);
    file.setFrameBuffer(frame);
    file.writePixels(1);
    const std::string exr = name + ".exr";
    const nlohmann::json identity = {1, 0, 0, 0, 0, -1, 0, 0, 0, 0, -0.01, 0, 0, 0, 0, 1};
    write(name + ".json",
          nlohmann::json{{"pellucid", 1},
                         {"camera",
                          {{"clipFromView", identity},
                           {"viewFromWorld", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}}}},
                         {"buffers",
                          {{"frontDepth", {{"file", exr}, {"channel", "Z"}, {"encoding", "viewZ"}}},
                           {"irradiance", {{"file", exr}, {"channels", {"R", "G", "B"}}}},
                           {"material", {{"constant", {1}}}}}},
                         {"materials", {{{"preset", "skin1"}}}}}
              .dump());
  }

  // The attribute's box ends at x, y.
  void setBox(const std::string& name, const std::string& attribute, int32_t x, int32_t y) const {
    std::string file = bytes(name);
    const std::string key = attribute + std::string("\0box2i\0", 7);
    const size_t at = file.find(key);
    ASSERT_NE(at, std::string::npos);
    std::memcpy(file.data() + at + key.size() + 4 + 8, &x, 4);
    std::memcpy(file.data() + at + key.size() + 4 + 12, &y, 4);
    write(name, file);
  }
};

// 8192 x 8192 pixels of 4 channels need a gigabyte, which the limit does not allow.
TEST_F(Memory, CapturesThatDoNotFitAreRefused) {
  writeCapture("large", 8192, 8192);
  ASSERT_LT(bytes("large.exr").size(), 1000u);
  const std::string out = " -o " + path("o.exr");
  expectWithin(600, 3, "replay " + path("large.json") + out,
               {path("large"), "needs more memory than there is"});
  EXPECT_FALSE(std::filesystem::exists(path("o.exr")));
}

// The first check of all is the header's.
TEST_F(Memory, HeadersThatClaimTooMuchAreRefusedAtOnce) {
  const struct {
    const char* attribute;
    int32_t x, y;
    const char* sentence;
  } rows[] = {{"displayWindow", 65535, 65535, "65536x65536 pixels"},
              {"displayWindow", 32767, 32767, "32768x32768 pixels"},
              {"dataWindow", 65535, 0, ""},
              {"dataWindow", 0x7FFFFFFE, 0x7FFFFFFE, ""},
              {"displayWindow", 0x7FFFFFFE, 0, ""}};
  for (const auto& row : rows) {
    SCOPED_TRACE(std::string(row.attribute) + " " + std::to_string(row.x));
    writeCapture("claim", 4, 4);
    setBox("claim.exr", row.attribute, row.x, row.y);
    expectWithin(300, 3, "info " + path("claim.json"), {path("claim.exr"), row.sentence});
  }
}

std::string bigEndian(uint32_t value) {
  std::string bytes;
  for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(value >> shift);
  return bytes;
}

// A PNG of this size without pixels. Checksums are not looked at.
std::string pngOf(uint32_t width, uint32_t height) {
  return "\x89PNG\r\n\x1a\n" + bigEndian(13) + "IHDR" + bigEndian(width) + bigEndian(height) +
         std::string("\x08\x02\0\0\0", 5) + bigEndian(0) + bigEndian(0) + "IEND" + bigEndian(0);
}

TEST_F(Memory, ImagesOfModelsThatClaimTooMuchAreRefusedAtOnce) {
  for (const auto& [width, height, sentence] : {std::tuple{65536u, 65536u, ""},
                                                {65536u, 1024u, "pixels cannot be in"},
                                                {8192u, 8192u, "8192 x 8192"}}) {
    const std::string png = pngOf(width, height);
    GltfBuilder b = GltfBuilder::triangle(
        {0, 0, 0, 2, 0, 0, 2, 2, 0},
        {{"name", "m"}, {"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}});
    const int uv = b.accessor(std::vector<float>{0, 1, 1, 1, 1, 0}, 5126, "VEC2", 2);
    b.json["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] = uv;
    const int view = b.view(png.data(), png.size());
    b.json["images"] = {{{"bufferView", view}, {"mimeType", "image/png"}}};
    b.json["textures"] = {{{"source", 0}}};
    write("m.glb", b.glb());
    expectWithin(300, 3, "capture " + path("m.glb") + " -o " + path("o.exr"),
                 {path("m.glb"), "images[0]", sentence});
  }
}

// What is no file: what command reads it names it.
TEST_F(Memory, WorkThatDoesNotFitIsRefused) {
  expectWithin(600, 3, "capture --procedural sphere --size 8192x8192 --shadow-size 8192 -o " + path("o.exr"),
               {"not enough memory for: capture --procedural sphere"});
}

// Outputs that are there and no regular files, here by way of a link, are written to or refused, and stay
// what they are. Where nothing can be written a sentence says so.
TEST_F(Memory, DevicesAreNotReplaced) {
  writeCapture("small", 8, 8);
  const std::string image = path("small.exr"),
                    small = "capture --procedural sphere --size 8x8 --shadow-size 8 -o ";
  for (const auto& [command, name] : {std::pair(small, "full.exr"),
                                      {"replay " + path("small.json") + " --repeat 0 -o ", "full.exr"},
                                      {"compare " + image + " " + image + " --ratio ", "full.png"}}) {
    std::filesystem::create_symlink("/dev/full", path(name));
    expect(3, command + path(name), path(name));
    EXPECT_TRUE(std::filesystem::is_symlink(path(name))) << command;
    std::filesystem::remove(path(name));
  }
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/full"));
}

}  // namespace
