#include "common/png.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>

#include "common/error.h"
#include "common/srgb.h"
#include "common/whole_file.h"

#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wmissing-field-initializers"
#pragma GCC diagnostic ignored "-Wconversion"
#include <stb/stb_image_write.h>
#pragma GCC diagnostic pop

namespace pellucid::harness {

void writePng(const std::filesystem::path& path, int width, int height,
              const std::vector<std::uint8_t>& rgb) {
  std::ofstream file(path, std::ios::binary);
  const auto append = [](void* to, void* bytes, int size) {
    static_cast<std::ofstream*>(to)->write(static_cast<const char*>(bytes), size);
  };
  if (!file || !stbi_write_png_to_func(append, &file, width, height, 3, rgb.data(), width * 3) ||
      !file.flush())
    throw InputError(path.string(), "", "the PNG cannot be written");
}

void savePicture(const std::filesystem::path& png, const Image& screen) {
  std::vector<std::uint8_t> bytes(screen.pixels() * 3);
  for (std::size_t i = 0; i < bytes.size(); ++i)
    bytes[i] = static_cast<std::uint8_t>(std::lround(screen.data[i / 3 * 4 + i % 3] * 255));
  writeWhole(png, [&](const auto& file) { writePng(file, screen.width, screen.height, bytes); });
}

std::vector<std::uint8_t> toSrgb(const Image& image, float exposure) {
  constexpr std::array<std::uint8_t, 3> kMagenta = {255, 0, 255};
  std::vector<std::uint8_t> rgb(image.pixels() * 3);
  const int used = std::min(image.channels, 3);
  for (std::size_t i = 0; i < image.pixels(); ++i) {
    const float* pixel = image.data.data() + i * static_cast<std::size_t>(image.channels);
    const bool finite = std::all_of(pixel, pixel + used, [](float value) { return std::isfinite(value); });
    std::array<float, 3> color;
    for (int c = 0; c < 3; ++c) color[static_cast<std::size_t>(c)] = pixel[std::min(c, used - 1)] * exposure;
    for (std::size_t c = 0; c < 3; ++c) rgb[i * 3 + c] = finite ? srgbOf(double(color[c])) : kMagenta[c];
  }
  return rgb;
}

float autoExposure(const Image& image) {
  std::vector<float> lit;
  for (float v : image.data)
    if (v > 0 && v < 1e30f) lit.push_back(v);
  if (lit.empty()) return 1;
  const auto nth = lit.begin() + static_cast<std::ptrdiff_t>(static_cast<double>(lit.size() - 1) * 0.99);
  std::nth_element(lit.begin(), nth, lit.end());
  return 0.8f / *nth;
}

Image contactSheet(const std::vector<const Image*>& images, int columns, int gap) {
  const Image& first = *images.front();
  const int count = static_cast<int>(images.size());
  columns = std::min(columns, count);
  const int rows = (count + columns - 1) / columns;
  Image sheet(columns * (first.width + gap) - gap, rows * (first.height + gap) - gap, first.channels);
  const auto row = static_cast<std::size_t>(first.width) * static_cast<std::size_t>(first.channels);
  for (int i = 0; i < count; ++i)
    for (int y = 0; y < first.height; ++y)
      std::copy_n(images[static_cast<std::size_t>(i)]->at(0, y), row,
                  sheet.at(i % columns * (first.width + gap), i / columns * (first.height + gap) + y));
  return sheet;
}

}  // namespace pellucid::harness
