#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfMultiPartOutputFile.h>
#include <ImfOutputPart.h>
#include <ImfPartType.h>
#include <ImfStdIO.h>
#include <ImfStringAttribute.h>

#include <cmath>
#include <cstdint>
#include <limits>

#include "capture/exr.h"
#include "common/error.h"

namespace pellucid::harness {

namespace {

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
