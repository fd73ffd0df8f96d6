// OpenEXR files as planes of floats. Nothing of OpenEXR's own types or exceptions gets out.
#pragma once

#include <array>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/image.h"

namespace pellucid::harness {

// Largest image that is read: larger ones are refused before memory is taken.
inline constexpr int kMaxExrSide = 32768;
inline constexpr long long kMaxExrPixels = 1LL << 27;

// Which of a part's rectangles is the image: the display window, or the data window, the pixels that
// are in the file. All parts of a file have one display window.
enum class ExrWindow { Display, Data };

// One channel of a part, and the component of the image it goes to.
struct ExrPlane {
  std::string channel;
  Image* image;
  int component;
  float outside;  // value of pixels that the data window leaves out
};

// A scanline or tiled (level 0) file of half, float or uint channels, one or many parts. Every
// member throws InputError naming the file.
class ExrFile {
public:
  // `field`, the manifest's name for the file, is said when the file cannot be opened.
  explicit ExrFile(const std::filesystem::path& path, const std::string& field = "");
  ~ExrFile();
  ExrFile(ExrFile&&) noexcept;

  int partCount() const;
  std::vector<std::string> channels(int part) const;                      // in the file's order: by name
  std::string channelFormat(int part, const std::string& channel) const;  // "half", "float", "uint"
  // The compression that quantizes this channel, which depths and ids do not survive; "": none.
  std::string lossyCompression(int part, const std::string& channel) const;
  std::string partName(int part) const;                                   // "": it has none
  // The eye of stereo files that a channel is of; "": of all.
  std::string viewOf(int part, const std::string& channel) const;
  // Sentences that name attributes by which a part's colors are others than they are read as.
  std::vector<std::string> unusedAttributes(int part) const;
  // The attribute of the first part that has it. A matrix is column-major for column vectors.
  std::optional<std::string> findText(const std::string& attribute) const;
  std::optional<std::array<double, 16>> findMatrix(const std::string& attribute, int first = 0) const;
  std::optional<double> findNumber(const std::string& attribute, int first = 0) const;
  std::optional<std::array<double, 2>> findPair(const std::string& attribute, int first = 0) const;

  // The part that has all of `channels`: `part`, or when absent the only one. `field` is named in errors.
  int findPart(const std::vector<std::string>& channels, std::optional<int> part,
               const std::string& field) const;

  int width(int part, ExrWindow window) const;
  int height(int part, ExrWindow window) const;
  // The first pixel of the data window.
  std::array<int, 2> dataOrigin(int part) const;
  // False: some pixels of the display window are not in the file.
  bool coversDisplay(int part) const;

  // Reads all planes in one pass. Each image has its `channels` set; width, height and data are set here.
  void read(int part, ExrWindow window, const std::vector<ExrPlane>& planes) const;

private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

// True when the file starts with OpenEXR's magic number. Throws InputError, naming `field`, unless `path`
// is a regular file that can be opened.
bool isExr(const std::filesystem::path& path, const std::string& field = "");

enum class ExrFormat { Half, Float, Uint };

struct ExrChannel {
  std::string name;
  ExrFormat format;
  const Image* image;
  int component;
};

struct ExrPart {
  std::string name;                  // used when there are several parts
  std::vector<ExrChannel> channels;  // images of one size
  std::map<std::string, std::string> attributes;
};

// Scanline, ZIP; the bytes depend on the arguments only. The first part's size is the display window
// of all. Throws InputError when a value does not fit
// its format or the file cannot be written.
void writeExrParts(const std::filesystem::path& path, const std::vector<ExrPart>& parts);

// One part of float channels, `channels` naming the image's components in order.
void writeExr(const std::filesystem::path& path, const Image& image, const std::vector<std::string>& channels,
              const std::map<std::string, std::string>& attributes = {});

// The color of a file: channels R, G, B, or else those of the only layer that has them
// ("diffuse.R", ...); with `layer` those of this one, whose name may lack what stands before a dot. Pixels
// outside the data window are 0. The error lists the channels that exist.
Image readExrImage(const std::filesystem::path& path, const std::string& layer = "");

}  // namespace pellucid::harness
