#include "capture/exr.h"

#include <ImfChannelList.h>
#include <ImfChromaticitiesAttribute.h>
#include <ImfFloatAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputPart.h>
#include <ImfMatrixAttribute.h>
#include <ImfMultiPartInputFile.h>
#include <ImfMultiPartOutputFile.h>
#include <ImfMultiView.h>
#include <ImfOutputPart.h>
#include <ImfPartType.h>
#include <ImfStandardAttributes.h>
#include <ImfStdIO.h>
#include <ImfStringAttribute.h>
#include <ImfTileDescriptionAttribute.h>
#include <ImfVecAttribute.h>
#include <openexr.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <limits>
#include <set>
#include <utility>

#include "common/error.h"
#include "common/parse.h"

namespace pellucid::harness {

namespace {

constexpr std::array<unsigned char, 4> kMagic = {0x76, 0x2f, 0x31, 0x01};

// OpenEXR's C++ reader allocates what a header's size fields say, up to 2 GiB, before it finds the file
// to be shorter. Its C reader, when strict, checks them against the file first.
void checkHeader(const std::filesystem::path& path) {
  thread_local std::string complaint;  // the handler is given no user pointer
  complaint.clear();
  exr_context_initializer_t settings = EXR_DEFAULT_CONTEXT_INITIALIZER;
  settings.flags = EXR_CONTEXT_FLAG_STRICT_HEADER;
  settings.error_handler_fn = [](exr_const_context_t, exr_result_t, const char* sentence) {
    if (complaint.empty()) complaint = sentence;
  };
  exr_context_t context = nullptr;
  const exr_result_t result = exr_start_read(&context, path.string().c_str(), &settings);
  if (context) exr_finish(&context);
  if (result == EXR_ERR_SUCCESS) return;
  if (complaint.empty()) complaint = exr_get_default_error_message(result);
  throw InputError(path.string(), "", "damaged OpenEXR header: " + complaint);
}

// Three decimals are what programs write; ACES' red differs from Rec. 709's by .07.
constexpr float kSamePoint = 0.002f;

constexpr const char* kAdvice = "; they are read as they are: convert them to linear Rec. 709";

std::string otherPrimaries(const Imf::Chromaticities& found) {
  const Imf::Chromaticities rec709;
  const struct {
    const char* name;
    Imath::V2f found, wanted;
  } points[] = {{"red", found.red, rec709.red},
                {"green", found.green, rec709.green},
                {"blue", found.blue, rec709.blue},
                {"white", found.white, rec709.white}};
  for (const auto& point : points) {
    if ((point.found - point.wanted).length() <= kSamePoint) continue;
    char text[160];
    std::snprintf(text, sizeof text,
                  "chromaticities: %s of its colors is at (%.4g, %.4g), not at Rec. 709's (%.4g, %.4g)",
                  point.name, double(point.found.x), double(point.found.y), double(point.wanted.x),
                  double(point.wanted.y));
    return std::string(text) + kAdvice;
  }
  return "";
}

// True of names that OpenImageIO, OpenColorIO and Blender have for linear colors of Rec. 709, and for data.
bool keepsRec709(std::string name) {
  static const std::set<std::string> known = {
      "",          "data",           "linear",           "scenelinear",  "raw",          "unknown",
      "linrec709", "linrec709scene", "linsrgb",          "linearrec709", "linearsrgb",   "linearrec709srgb",
      "noncolor",  "linearbt709",    "utilitylinearsrgb", "utilityraw"};
  std::erase_if(name, [](unsigned char c) { return !std::isalnum(c); });
  return known.count(lower(name)) > 0;
}

struct Size {
  std::int64_t width, height;
};

Size sizeOf(const Imath::Box2i& box) {
  return {static_cast<std::int64_t>(box.max.x) - box.min.x + 1,
          static_cast<std::int64_t>(box.max.y) - box.min.y + 1};
}

std::string formatName(Imf::PixelType type) {
  return type == Imf::HALF ? "half" : type == Imf::FLOAT ? "float" : "uint";
}

std::string listed(const std::vector<std::string>& names) {
  constexpr std::size_t kMost = 64;
  std::string list;
  for (std::size_t i = 0; i < std::min(names.size(), kMost); ++i) list += (i ? ", " : "") + names[i];
  if (names.size() > kMost) list += ", ... (" + std::to_string(names.size()) + " in all)";
  return list.empty() ? "none" : list;
}

Imf::PixelType pixelType(ExrFormat format) {
  return format == ExrFormat::Half ? Imf::HALF : format == ExrFormat::Float ? Imf::FLOAT : Imf::UINT;
}

// One channel's pixels in the file's own format; 4 bytes per pixel are enough for each.
class Plane {
public:
  Plane(const std::filesystem::path& path, const ExrChannel& channel) : format_(channel.format) {
    const Image& image = *channel.image;
    const std::size_t count = image.pixels();
    if (format_ == ExrFormat::Half) half_.resize(count);
    if (format_ == ExrFormat::Float) float_.resize(count);
    if (format_ == ExrFormat::Uint) uint_.resize(count);
    for (std::size_t i = 0; i < count; ++i) {
      const float value = image.data[i * static_cast<std::size_t>(image.channels) +
                                     static_cast<std::size_t>(channel.component)];
      if (format_ == ExrFormat::Float) {
        float_[i] = value;
      } else if (format_ == ExrFormat::Half) {
        half_[i] = value;
        if (std::isfinite(value) && !half_[i].isFinite())
          throw InputError(path.string(), channel.name,
                           std::to_string(value) + " does not fit a half float (65504)");
      } else {
        if (!(value >= 0.0f && value < 4294967296.0f && value == std::floor(value)))
          throw InputError(path.string(), channel.name,
                           std::to_string(value) + " is not an unsigned integer");
        uint_[i] = static_cast<std::uint32_t>(value);
      }
    }
  }

  Imf::Slice slice(const Imath::Box2i& window) {
    void* const data = format_ == ExrFormat::Half    ? static_cast<void*>(half_.data())
                       : format_ == ExrFormat::Float ? static_cast<void*>(float_.data())
                                                     : static_cast<void*>(uint_.data());
    return Imf::Slice::Make(pixelType(format_), data, window);
  }

private:
  ExrFormat format_;
  std::vector<Imath::half> half_;
  std::vector<float> float_;
  std::vector<std::uint32_t> uint_;
};

void writeParts(Imf::OStream& stream, const std::filesystem::path& path, const std::vector<ExrPart>& parts,
                const std::vector<Imf::Header>& headers) {
  Imf::MultiPartOutputFile file(stream, headers.data(), static_cast<int>(headers.size()));
  for (std::size_t i = 0; i < parts.size(); ++i) {
    std::vector<Plane> planes;
    Imf::FrameBuffer frame;
    planes.reserve(parts[i].channels.size());
    for (const ExrChannel& channel : parts[i].channels) {
      planes.emplace_back(path, channel);
      frame.insert(channel.name, planes.back().slice(headers[i].dataWindow()));
    }
    Imf::OutputPart output(file, static_cast<int>(i));
    output.setFrameBuffer(frame);
    output.writePixels(parts[i].channels.front().image->height);
  }
}

}  // namespace

struct ExrFile::Impl {
  std::filesystem::path path;
  std::unique_ptr<Imf::MultiPartInputFile> file;

  [[noreturn]] void fail(const std::string& field, const std::string& sentence) const {
    throw InputError(path.string(), field, sentence);
  }
  // Runs an OpenEXR call; its exceptions become InputError.
  template <class Call>
  auto guarded(Call&& call) const {
    try {
      return withinMemory(path.string(), call);
    } catch (const InputError&) {
      throw;
    } catch (const std::exception& error) {
      fail("", error.what());
    }
  }

  // Refuses, before OpenEXR takes memory for it, a part that this reader does not read.
  void checkReadable(int part) const {
    const Imf::Header& header = file->header(part);
    const std::string name = "part " + std::to_string(part);
    if (header.hasType() && header.type() != Imf::SCANLINEIMAGE && header.type() != Imf::TILEDIMAGE)
      fail(name, "type \"" + header.type() + "\" is not read; only scanline and tiled images are");
    if (Imf::hasEnvmap(header))
      fail(name + " envmap",
           "a panorama, which no camera's matrix is; render a perspective or orthographic picture");
    std::int64_t bytesPerPixel = 0;
    for (auto channel = header.channels().begin(); channel != header.channels().end(); ++channel)
      bytesPerPixel += channel.channel().type == Imf::HALF ? 2 : 4;
    const auto checkWindow = [&](const char* window, const Imath::Box2i& box) {
      const Size size = sizeOf(box);
      if (size.width < 1 || size.height < 1 || size.width > kMaxExrSide || size.height > kMaxExrSide ||
          size.width * size.height > kMaxExrPixels)
        fail(name + " " + window, std::to_string(size.width) + "x" + std::to_string(size.height) +
                                      " pixels; 1 to " + std::to_string(kMaxExrSide) +
                                      " per side and at most " + std::to_string(kMaxExrPixels) +
                                      " in all are read");
    };
    checkWindow("displayWindow", header.displayWindow());
    checkWindow("dataWindow", header.dataWindow());
    // OpenEXR holds a row of tiles, or a compressed block of at most 256 lines, of all channels.
    constexpr std::int64_t kMaxTileSide = 4096, kMaxBlockBytes = 1LL << 30;
    const Size data = sizeOf(header.dataWindow());
    std::int64_t columns = data.width, lines = std::min<std::int64_t>(data.height, 256);
    if (header.hasTileDescription()) {
      const std::int64_t tileWidth = header.tileDescription().xSize,
                         tileHeight = header.tileDescription().ySize;
      if (tileWidth > kMaxTileSide || tileHeight > kMaxTileSide)
        fail(name, "tiles of " + std::to_string(tileWidth) + "x" + std::to_string(tileHeight) +
                       " pixels; at most " + std::to_string(kMaxTileSide) + " per side are read");
      columns = std::max(columns, tileWidth);
      lines = tileHeight;
    }
    if (columns * lines * bytesPerPixel > kMaxBlockBytes)
      fail(name, "the channels need " + std::to_string(columns * lines * bytesPerPixel) +
                     " bytes at once, more than " + std::to_string(kMaxBlockBytes));
  }

  Imath::Box2i box(int part, ExrWindow window) const {
    checkReadable(part);
    return window == ExrWindow::Data ? file->header(part).dataWindow() : file->header(part).displayWindow();
  }
};

ExrFile::ExrFile(const std::filesystem::path& path, const std::string& field)
    : impl_(std::make_unique<Impl>()) {
  impl_->path = path;
  if (!isExr(path, field)) impl_->fail(field, "not an OpenEXR file");
  checkHeader(path);
  impl_->guarded([&] { impl_->file = std::make_unique<Imf::MultiPartInputFile>(path.string().c_str()); });
}

ExrFile::~ExrFile() = default;
ExrFile::ExrFile(ExrFile&&) noexcept = default;

int ExrFile::partCount() const { return impl_->file->parts(); }

std::vector<std::string> ExrFile::channels(int part) const {
  const Imf::ChannelList& list = impl_->file->header(part).channels();
  std::vector<std::string> names;
  for (auto channel = list.begin(); channel != list.end(); ++channel) names.emplace_back(channel.name());
  return names;
}

std::string ExrFile::channelFormat(int part, const std::string& channel) const {
  const Imf::Channel* found = impl_->file->header(part).channels().findChannel(channel);
  if (!found) impl_->fail("part " + std::to_string(part), "no channel \"" + channel + "\"");
  return formatName(found->type);
}

std::string ExrFile::lossyCompression(int part, const std::string& channel) const {
  const Imf::Compression compression = impl_->file->header(part).compression();
  const std::string format = channelFormat(part, channel);
  const std::string suffix = channel.substr(channel.rfind('.') + 1);
  // OpenEXR's technical introduction: DWA quantizes channels of these names, B44 half floats, and keeps all others.
  static const std::set<std::string> kColors = {"R", "G", "B", "Y", "RY", "BY", "r", "g", "b", "y", "ry", "by"};
  const bool isQuantized = format != "uint" && kColors.contains(suffix);
  switch (compression) {
    case Imf::DWAA_COMPRESSION:
      return isQuantized ? "DWAA" : "";
    case Imf::DWAB_COMPRESSION:
      return isQuantized ? "DWAB" : "";
    case Imf::B44_COMPRESSION:
    case Imf::B44A_COMPRESSION:
      return format == "half" ? "B44" : "";
    default:
      return "";
  }
}

std::optional<std::string> ExrFile::findText(const std::string& attribute) const {
  for (int part = 0; part < partCount(); ++part) {
    const auto* found = impl_->file->header(part).findTypedAttribute<Imf::StringAttribute>(attribute);
    if (found) return found->value();
  }
  return std::nullopt;
}

std::string ExrFile::partName(int part) const {
  const Imf::Header& header = impl_->file->header(part);
  return header.hasName() ? header.name() : std::string();
}

std::string ExrFile::viewOf(int part, const std::string& channel) const {
  const Imf::Header& header = impl_->file->header(part);
  if (header.hasView()) return header.view();
  return Imf::hasMultiView(header) ? Imf::viewFromChannelName(channel, Imf::multiView(header)) : "";
}

std::vector<std::string> ExrFile::unusedAttributes(int part) const {
  const Imf::Header& header = impl_->file->header(part);
  std::vector<std::string> sentences;
  if (const auto* points = header.findTypedAttribute<Imf::ChromaticitiesAttribute>("chromaticities"))
    if (std::string sentence = otherPrimaries(points->value()); !sentence.empty())
      sentences.push_back(std::move(sentence));
  for (const std::string name : {"colorInteropID", "oiio:ColorSpace"})
    if (const auto* space = header.findTypedAttribute<Imf::StringAttribute>(name);
        space && !keepsRec709(space->value()))
      sentences.push_back(name + ": its colors are \"" + space->value() + "\"" + kAdvice);
  return sentences;
}

std::array<int, 2> ExrFile::dataOrigin(int part) const {
  const Imath::Box2i box = impl_->box(part, ExrWindow::Data);
  return {box.min.x, box.min.y};
}

namespace {

// The attribute of the part `first`, or of the first other part that has it. get(header, attribute): an optional.
template <class Get>
auto findIn(const Imf::MultiPartInputFile& file, const std::string& attribute, int first, const Get& get) {
  auto found = get(file.header(first), attribute);
  for (int part = 0; part < file.parts() && !found; ++part) found = get(file.header(part), attribute);
  return found;
}

// OpenEXR multiplies row vectors from the left: its rows are the columns.
template <class M>
std::optional<std::array<double, 16>> columnsOf(const M* matrix) {
  if (!matrix) return std::nullopt;
  std::array<double, 16> result;
  for (int i = 0; i < 16; ++i) result[static_cast<std::size_t>(i)] = static_cast<double>(matrix->value()[i / 4][i % 4]);
  return result;
}

}  // namespace

std::optional<std::array<double, 16>> ExrFile::findMatrix(const std::string& attribute, int first) const {
  return findIn(*impl_->file, attribute, first, [](const Imf::Header& header, const std::string& name) {
    const auto single = columnsOf(header.findTypedAttribute<Imf::M44fAttribute>(name));
    return single ? single : columnsOf(header.findTypedAttribute<Imf::M44dAttribute>(name));
  });
}

std::optional<double> ExrFile::findNumber(const std::string& attribute, int first) const {
  return findIn(*impl_->file, attribute, first, [](const Imf::Header& header, const std::string& name) {
    const auto* found = header.findTypedAttribute<Imf::FloatAttribute>(name);
    return found ? std::optional(static_cast<double>(found->value())) : std::nullopt;
  });
}

std::optional<std::array<double, 2>> ExrFile::findPair(const std::string& attribute, int first) const {
  return findIn(*impl_->file, attribute, first, [](const Imf::Header& header, const std::string& name) {
    const auto* found = header.findTypedAttribute<Imf::V2fAttribute>(name);
    return found ? std::optional(std::array<double, 2>{double(found->value().x), double(found->value().y)}) : std::nullopt;
  });
}

int ExrFile::findPart(const std::vector<std::string>& channels, std::optional<int> part,
                      const std::string& field) const {
  const auto has = [&](int candidate, const std::string& channel) {
    return impl_->file->header(candidate).channels().findChannel(channel) != nullptr;
  };
  if (part) {
    if (*part < 0 || *part >= partCount())
      impl_->fail(field + ".part", std::to_string(*part) + "; the file has " + std::to_string(partCount()) +
                                       " part(s), counted from 0");
    for (const std::string& channel : channels)
      if (!has(*part, channel))
        impl_->fail(field, "no channel \"" + channel + "\" in part " + std::to_string(*part) +
                               "; it has: " + listed(this->channels(*part)));
    return *part;
  }
  std::vector<int> found;
  std::string missing = channels.front();
  for (int candidate = 0; candidate < partCount(); ++candidate) {
    const auto absent = std::find_if(channels.begin(), channels.end(),
                                     [&](const std::string& channel) { return !has(candidate, channel); });
    if (absent == channels.end())
      found.push_back(candidate);
    else
      missing = *absent;
  }
  if (found.empty()) {
    std::vector<std::string> all;
    for (int candidate = 0; candidate < partCount(); ++candidate)
      for (const std::string& channel : this->channels(candidate)) all.push_back(channel);
    impl_->fail(field, "no channel \"" + missing + "\"; the file has: " + listed(all));
  }
  if (found.size() > 1)
    impl_->fail(field, "channel \"" + channels.front() + "\" is in parts " + std::to_string(found[0]) +
                           " and " + std::to_string(found[1]) + "; name one with \"part\"");
  return found.front();
}

int ExrFile::width(int part, ExrWindow window) const {
  return static_cast<int>(sizeOf(impl_->box(part, window)).width);
}

int ExrFile::height(int part, ExrWindow window) const {
  return static_cast<int>(sizeOf(impl_->box(part, window)).height);
}

bool ExrFile::coversDisplay(int part) const {
  const Imath::Box2i& data = impl_->file->header(part).dataWindow();
  const Imath::Box2i& display = impl_->file->header(part).displayWindow();
  return data.intersects(display.min) && data.intersects(display.max);
}

void ExrFile::read(int part, ExrWindow window, const std::vector<ExrPlane>& planes) const {
  const Imf::Header& header = impl_->file->header(part);
  const Imath::Box2i data = impl_->box(part, ExrWindow::Data), wanted = impl_->box(part, window);

  std::set<std::string> names;  // two planes may want one channel
  for (const ExrPlane& plane : planes) {
    const Imf::Channel* channel = header.channels().findChannel(plane.channel);
    const std::string field = "part " + std::to_string(part) + " channel \"" + plane.channel + "\"";
    if (!channel) impl_->fail(field, "missing");
    if (channel->xSampling != 1 || channel->ySampling != 1)
      impl_->fail(field, "subsampled " + std::to_string(channel->xSampling) + "x" +
                             std::to_string(channel->ySampling) + "; only full-resolution channels are read");
    names.insert(plane.channel);
  }

  // Rows arrive in blocks and the images grow with them, so that a damaged file which promises a
  // large image fails before the memory for it is touched.
  constexpr int kBlockRows = 64;
  const std::int64_t dataWidth = sizeOf(data).width;
  std::map<std::string, std::vector<float>> blocks;
  impl_->guarded([&] {
    for (const std::string& name : names)
      blocks[name].resize(static_cast<std::size_t>(dataWidth) * kBlockRows);
    for (const ExrPlane& plane : planes) {
      Image& image = *plane.image;
      image.width = width(part, window);
      image.height = height(part, window);
      image.data.clear();
      image.data.reserve(image.pixels() * static_cast<std::size_t>(image.channels));
    }
    Imf::InputPart input(*impl_->file, part);
    const int left = std::max(data.min.x, wanted.min.x), right = std::min(data.max.x, wanted.max.x);
    for (std::int64_t start = wanted.min.y; start <= wanted.max.y; start += kBlockRows) {
      const int first = static_cast<int>(start);
      const int last = static_cast<int>(std::min<std::int64_t>(wanted.max.y, start + kBlockRows - 1));
      const int firstInData = std::max(first, data.min.y), lastInData = std::min(last, data.max.y);
      if (firstInData <= lastInData) {
        const Imath::Box2i rows({data.min.x, firstInData}, {data.max.x, lastInData});
        Imf::FrameBuffer frame;
        for (auto& [name, block] : blocks)
          frame.insert(name, Imf::Slice::Make(Imf::FLOAT, block.data(), rows));
        input.setFrameBuffer(frame);
        input.readPixels(firstInData, lastInData);
      }
      for (const ExrPlane& plane : planes) {
        Image& image = *plane.image;
        const auto height = static_cast<std::size_t>(last - wanted.min.y + 1);
        const auto components = static_cast<std::size_t>(image.channels);
        image.data.resize(height * static_cast<std::size_t>(image.width) * components, plane.outside);
        const std::vector<float>& block = blocks[plane.channel];
        for (int y = firstInData; y <= lastInData; ++y) {
          const float* row = block.data() + (y - firstInData) * dataWidth;
          for (int x = left; x <= right; ++x)
            image.at(x - wanted.min.x, y - wanted.min.y)[plane.component] =
                row[static_cast<std::int64_t>(x) - data.min.x];
        }
      }
    }
  });
}

bool isExr(const std::filesystem::path& path, const std::string& field) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) throw InputError(path.string(), field, "no such file");
  if (!std::filesystem::is_regular_file(status)) throw InputError(path.string(), field, "not a regular file");
  std::ifstream file(path, std::ios::binary);
  if (!file) throw InputError(path.string(), field, "cannot be opened");
  std::array<char, 4> bytes = {};
  file.read(bytes.data(), bytes.size());
  return file && std::equal(bytes.begin(), bytes.end(), kMagic.begin(),
                            [](char a, unsigned char b) { return static_cast<unsigned char>(a) == b; });
}

Image readExrImage(const std::filesystem::path& path, const std::string& layer) {
  const ExrFile file(path);
  // Candidates: a part and the prefix before R, G and B.
  std::vector<std::pair<int, std::string>> found;
  std::vector<std::string> all, layers;
  for (int part = 0; part < file.partCount(); ++part) {
    const std::vector<std::string> names = file.channels(part);
    all.insert(all.end(), names.begin(), names.end());
    const auto has = [&](const std::string& name) {
      return std::binary_search(names.begin(), names.end(), name);
    };
    for (const std::string& name : names) {
      if (name != "R" && !name.ends_with(".R")) continue;
      const std::string prefix = name.substr(0, name.size() - 1);
      if (!has(prefix + "G") || !has(prefix + "B")) continue;
      found.emplace_back(part, prefix);
      layers.push_back(name);
    }
  }
  if (found.empty())
    throw InputError(path.string(), "channels", "no R, G, B in any layer; the file has: " + listed(all));
  if (!layer.empty()) {
    std::erase_if(found, [&](const auto& f) {
      return f.second != layer + "." && !f.second.ends_with("." + layer + ".");
    });
    if (found.size() != 1)
      throw InputError(path.string(), "channels",
                       (found.empty() ? "no layer \"" : "several layers \"") + layer +
                           "\" has R, G, B; there are " + listed(layers));
  }
  auto chosen = std::find_if(found.begin(), found.end(), [](const auto& f) { return f.second.empty(); });
  if (chosen == found.end() && found.size() > 1)
    throw InputError(path.string(), "channels",
                     "several layers have R, G, B and none is unnamed: " + listed(layers));
  if (chosen == found.end()) chosen = found.begin();
  Image image;
  image.channels = 3;
  const std::string& prefix = chosen->second;
  file.read(chosen->first, ExrWindow::Display,
            {{prefix + "R", &image, 0, 0}, {prefix + "G", &image, 1, 0}, {prefix + "B", &image, 2, 0}});
  return image;
}

void writeExrParts(const std::filesystem::path& path, const std::vector<ExrPart>& parts) {
  std::vector<Imf::Header> headers;
  const Image& first = *parts.front().channels.front().image;
  const Imath::Box2i display({0, 0}, {first.width - 1, first.height - 1});  // OpenEXR: one for all parts
  for (const ExrPart& part : parts) {
    const Image& image = *part.channels.front().image;
    Imf::Header header(display, Imath::Box2i({0, 0}, {image.width - 1, image.height - 1}));
    header.setType(Imf::SCANLINEIMAGE);
    header.compression() = Imf::ZIP_COMPRESSION;
    if (parts.size() > 1) header.setName(part.name);
    for (const auto& [name, value] : part.attributes) header.insert(name, Imf::StringAttribute(value));
    for (const ExrChannel& channel : part.channels)
      header.channels().insert(channel.name, Imf::Channel(pixelType(channel.format)));
    headers.push_back(header);
  }
  try {
    // Our own stream: OpenEXR finishes the file in a destructor, which cannot say that the disk is full.
    std::ofstream bytes(path, std::ios::binary);
    if (!bytes) throw InputError(path.string(), "", "cannot be opened for writing");
    Imf::StdOFStream stream(bytes, path.string().c_str());
    writeParts(stream, path, parts, headers);
    if (!bytes.flush()) throw InputError(path.string(), "", "cannot be written: the disk may be full");
  } catch (const InputError&) {
    throw;
  } catch (const std::exception& error) {
    throw InputError(path.string(), "", std::string("cannot be written: ") + error.what());
  }
}

void writeExr(const std::filesystem::path& path, const Image& image, const std::vector<std::string>& channels,
              const std::map<std::string, std::string>& attributes) {
  ExrPart part;
  part.attributes = attributes;
  for (std::size_t i = 0; i < channels.size(); ++i)
    part.channels.push_back({channels[i], ExrFormat::Float, &image, static_cast<int>(i)});
  writeExrParts(path, {part});
}

}  // namespace pellucid::harness
