// Files of others: EXR, manifests, glTF.
#include <filesystem>

#include "capture/exr.h"
#include "capture/read.h"
#include "common/error.h"
#include "fuzz/files.h"
#include "fuzz/targets.h"
#include "gltf/gltf.h"
#include "unit/capture_samples.h"

namespace pellucid::fuzz {

namespace {

using namespace pellucid::harness;

std::filesystem::path write(const std::filesystem::path& path, std::span<const uint8_t> bytes) {
  writeText(path, std::string(bytes.begin(), bytes.end()));
  return path;
}

// A folder with the sound files that a target's input refers to.
struct Folder : TemporaryDirectory {
  explicit Folder(nlohmann::json (*fill)(const std::filesystem::path&)) { fill(*this); }
};

// True where `read` accepts the file; otherwise it threw a sentence about a file.
template <class Read>
bool accepts(const Read& read) {
  try {
    read();
    return true;
  } catch (const InputError& error) {
    const std::string sentence = error.what();
    require(sentence.starts_with('/'), "a sentence begins with the file: " + sentence);
    require(sentence.size() > sentence.find(": ") + 2, "there is a sentence: " + sentence);
    for (const char* end : {"bad_alloc", "more memory than there is"})
      require(!sentence.ends_with(end), "small files need little memory: " + sentence);
    require(sentence.size() < 9000, "a person can read it");
    return false;
  }
}

// Files whose images are this large are opened and not read: reading them is allowed to take seconds.
constexpr long long kMaxPixels = 1 << 20;

bool isSmall(const ExrFile& file, int part) {
  for (const ExrWindow window : {ExrWindow::Data, ExrWindow::Display})
    if (static_cast<long long>(file.width(part, window)) * file.height(part, window) > kMaxPixels)
      return false;
  return true;
}

// Every channel of every part, in both windows.
bool readAll(const std::filesystem::path& path) {
  bool small = true;
  const ExrFile file(path);
  for (int part = 0; part < file.partCount(); ++part) {
    if (!isSmall(file, part)) {
      small = false;
      continue;
    }
    const std::vector<std::string> names = file.channels(part);
    std::vector<Image> images(std::min<std::size_t>(names.size(), 16));
    std::vector<ExrPlane> planes;
    for (std::size_t i = 0; i < images.size(); ++i) {
      file.channelFormat(part, names[i]);
      images[i].channels = 1;
      planes.push_back({names[i], &images[i], 0, -1});
    }
    for (const ExrWindow window : {ExrWindow::Data, ExrWindow::Display}) {
      file.read(part, window, planes);
      for (const Image& image : images)
        require(image.pixels() == image.data.size(), "an image has its pixels");
    }
  }
  file.findText(kManifestAttribute);
  return small;
}

}  // namespace

bool fuzzExr(std::span<const uint8_t> bytes) {
  static const TemporaryDirectory folder;
  const std::filesystem::path path = write(folder / "f.exr", bytes);
  bool small = true;
  // The image, the capture, and all else are three readers of one file: each may refuse it for its own
  // reason.
  const bool all = accepts([&] { small = readAll(path); });
  if (!small) return all;
  const bool image = accepts([&] { readExrImage(path); });
  const bool capture = accepts([&] { readCapture(path); });
  return all || image || capture;
}

bool fuzzManifest(std::span<const uint8_t> bytes) {
  static const Folder folder(writeSampleFiles);
  const std::filesystem::path path = write(folder / "m.json", bytes);
  return accepts([&] { readCapture(path); });
}

bool fuzzGltf(std::span<const uint8_t> bytes) {
  static const TemporaryDirectory folder;
  const std::filesystem::path path = write(folder / "f.glb", bytes);
  return accepts([&] {
    const Model model = loadGltf(path).model;
    for (const std::uint32_t index : model.indices)
      require(index < model.vertices.size(), "indices are those of vertices");
    for (const auto& part : model.parts)
      require(part.surface < model.surfaces.size() && part.firstIndex <= model.indices.size() &&
                  part.indexCount <= model.indices.size() - part.firstIndex,
              "parts are of the model's indices and surfaces");
  });
}

}  // namespace pellucid::fuzz
