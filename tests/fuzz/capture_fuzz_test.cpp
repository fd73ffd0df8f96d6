// Damaged captures: the reader names what is wrong, or reads what is left; it never crashes, hangs or
// takes memory by the gigabyte. The damage is seeded, so a failure comes back.
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfTileDescriptionAttribute.h>
#include <ImfTiledOutputFile.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <functional>
#include <random>
#include <vector>

#include "capture/read.h"
#include "capture/write.h"
#include "common/error.h"
#include "unit/capture_samples.h"

namespace pellucid::harness {
namespace {

using nlohmann::json;

// While it lives the process may take half a gigabyte more than it has; beyond, new throws bad_alloc.
class MemoryLimit {
public:
  MemoryLimit() {
    getrlimit(RLIMIT_AS, &before_);
    std::size_t pages = 0;
    std::ifstream("/proc/self/statm") >> pages;
    rlimit limit = before_;
    limit.rlim_cur = pages * 4096 + (rlim_t{512} << 20);
    setrlimit(RLIMIT_AS, &limit);
  }
  ~MemoryLimit() { setrlimit(RLIMIT_AS, &before_); }
  MemoryLimit(const MemoryLimit&) = delete;
  MemoryLimit& operator=(const MemoryLimit&) = delete;

private:
  rlimit before_;
};

class Fuzz : public testing::Test {
protected:
  void read(const std::filesystem::path& path) {
    const auto start = std::chrono::steady_clock::now();
    try {
      const MemoryLimit limit;
      readCapture(path);
      ++read_;
    } catch (const InputError& error) {
      const std::string sentence = error.what();
      EXPECT_EQ(sentence.find("bad_alloc"), std::string::npos) << sentence;
      EXPECT_TRUE(sentence.starts_with(path.parent_path().string()) || sentence.starts_with("/dev/zero"))
          << sentence;
      ++refused_;
    }
    // A sound capture of this size takes a millisecond.
    EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(5));
  }
  // Writes what `damage` makes of the text to `path`, many times, and reads the capture `main`.
  void run(int cases, const std::filesystem::path& path, const std::filesystem::path& main,
           const std::function<std::string(std::string)>& damage) {
    const std::string sound = readText(path);
    for (int i = 0; i < cases; ++i) {
      SCOPED_TRACE(i);
      writeText(path, damage(sound));
      read(main);
    }
    writeText(path, sound);
    EXPECT_NO_THROW(readCapture(main));
    EXPECT_GT(refused_, 0);
  }
  std::size_t below(std::size_t count) {
    return std::uniform_int_distribution<std::size_t>(0, count - 1)(random_);
  }

  std::string flipBits(std::string text, std::size_t region) {
    const std::size_t flips = 1 + below(3);
    for (std::size_t i = 0; i < flips; ++i) text[below(region)] ^= static_cast<char>(1 << below(8));
    return text;
  }
  // Four bytes that are often a size, a count or a coordinate.
  std::string setInteger(std::string text, std::size_t region) {
    const std::vector<std::string> values = {std::string(4, '\0'), std::string(4, '\xff'),
                                             std::string("\xff\xff\xff\x7f", 4), std::string("\0\0\0\x80", 4),
                                             std::string("\0\0\x01\0", 4)};
    text.replace(below(region - 4), 4, values[below(values.size())]);
    return text;
  }

  std::mt19937 random_{20240611};
  TemporaryDirectory directory_;
  int read_ = 0, refused_ = 0;
};

// The header, with the embedded manifest, is the part of a file that says how much to allocate.
constexpr std::size_t kHeaderBytes = 4000;

TEST_F(Fuzz, CutNativeCapture) {
  writeCapture(sampleCapture(), directory_ / "c.exr");
  run(300, directory_ / "c.exr", directory_ / "c.exr",
      [&](const std::string& sound) { return sound.substr(0, below(sound.size())); });
}

TEST_F(Fuzz, FlippedBitsOfNativeCapture) {
  writeCapture(sampleCapture(), directory_ / "c.exr");
  run(500, directory_ / "c.exr", directory_ / "c.exr",
      [&](const std::string& sound) { return flipBits(sound, kHeaderBytes); });
  run(300, directory_ / "c.exr", directory_ / "c.exr",
      [&](const std::string& sound) { return flipBits(sound, sound.size()); });
}

TEST_F(Fuzz, WrongIntegersInNativeCapture) {
  writeCapture(sampleCapture(), directory_ / "c.exr");
  run(500, directory_ / "c.exr", directory_ / "c.exr",
      [&](const std::string& sound) { return setInteger(sound, kHeaderBytes); });
}

TEST_F(Fuzz, DamagedTiledFile) {
  writeText(directory_ / "m.json", [&] {
    json manifest = writeSampleFiles(directory_);
    json& map = manifest["lights"][0]["shadowMap"];
    map["file"] = "t.exr";
    map.erase("exit");  // of another size
    map.erase("casterMaterial");
    return manifest.dump();
  }());
  Imf::Header header(16, 16);
  header.channels().insert("ViewLayer.Depth.Z", Imf::Channel(Imf::FLOAT));
  header.setTileDescription(Imf::TileDescription(8, 8, Imf::MIPMAP_LEVELS));
  {
    Image image = sampleImage(16, 16, 1, 1);
    Imf::TiledOutputFile file((directory_ / "t.exr").string().c_str(), header);
    Imf::FrameBuffer frame;
    frame.insert("ViewLayer.Depth.Z", Imf::Slice::Make(Imf::FLOAT, image.data.data(), header.dataWindow()));
    file.setFrameBuffer(frame);
    for (int level = 0; level < file.numLevels(); ++level)
      file.writeTiles(0, file.numXTiles(level) - 1, 0, file.numYTiles(level) - 1, level);
  }
  const auto file = directory_ / "t.exr", manifest = directory_ / "m.json";
  run(200, file, manifest, [&](const std::string& sound) { return sound.substr(0, below(sound.size())); });
  run(300, file, manifest, [&](const std::string& sound) { return flipBits(sound, sound.size()); });
  run(300, file, manifest, [&](const std::string& sound) { return setInteger(sound, sound.size()); });
}

TEST_F(Fuzz, ManifestText) {
  writeText(directory_ / "m.json", writeSampleFiles(directory_).dump());
  const auto manifest = directory_ / "m.json";
  run(300, manifest, manifest, [&](const std::string& sound) { return flipBits(sound, sound.size()); });
  run(100, manifest, manifest,
      [&](const std::string& sound) { return sound.substr(0, below(sound.size())); });
  run(1, manifest, manifest, [](const std::string&) { return std::string(1000000, '['); });
}

TEST_F(Fuzz, ManifestValuesAndKeys) {
  const json sound = writeSampleFiles(directory_);
  const json flat = sound.flatten();
  std::vector<json::json_pointer> pointers;  // of every value, object and array
  for (const auto& [path, value] : flat.items())
    for (json::json_pointer pointer(path); !pointer.empty(); pointer = pointer.parent_pointer())
      if (std::find(pointers.begin(), pointers.end(), pointer) == pointers.end()) pointers.push_back(pointer);
  const std::vector<json> values = {nullptr,
                                    true,
                                    -1,
                                    0,
                                    1e308,
                                    4294967296.0,
                                    1e-320,
                                    "",
                                    "viewZ",
                                    "../../..",
                                    "/dev/zero",
                                    std::string(100000, 'x'),
                                    json::array(),
                                    json::object(),
                                    json::array({json::array()}),
                                    std::vector<double>(100000, 1.0)};
  writeText(directory_ / "m.json", sound.dump());
  for (const json::json_pointer& pointer : pointers) {
    SCOPED_TRACE(pointer.to_string());
    for (const json& value : values) {
      json changed = sound;
      changed[pointer] = value;
      writeText(directory_ / "m.json", changed.dump());
      read(directory_ / "m.json");
    }
    json changed = sound;
    if (changed[pointer.parent_pointer()].is_object()) {
      changed[pointer.parent_pointer()]["unheard of"] = changed[pointer];
      changed[pointer.parent_pointer()].erase(pointer.back());
      writeText(directory_ / "m.json", changed.dump());
      const int refused = refused_;
      read(directory_ / "m.json");
      EXPECT_EQ(refused_, refused + 1);
    }
  }
  EXPECT_GT(read_, 0);  // some changes are harmless
}

}  // namespace
}  // namespace pellucid::harness
