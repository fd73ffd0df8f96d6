// Plain float image: interleaved channels, row 0 at the top.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace pellucid::harness {

struct Image {
  int width = 0, height = 0, channels = 0;
  std::vector<float> data;

  Image() = default;
  Image(int w, int h, int c, float value = 0.0f)
      : width(w),
        height(h),
        channels(c),
        data(static_cast<std::size_t>(w) * static_cast<std::size_t>(h) * static_cast<std::size_t>(c), value) {
  }

  bool empty() const { return data.empty(); }
  std::size_t pixels() const { return static_cast<std::size_t>(width) * static_cast<std::size_t>(height); }
  float* at(int x, int y) { return data.data() + index(x, y); }
  const float* at(int x, int y) const { return data.data() + index(x, y); }

private:
  std::size_t index(int x, int y) const {
    return (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)) *
           static_cast<std::size_t>(channels);
  }
};

inline Image channel(const Image& image, int c) {
  Image result(image.width, image.height, 1);
  const auto stride = static_cast<std::size_t>(image.channels), first = static_cast<std::size_t>(c);
  for (std::size_t i = 0; i < image.pixels(); ++i) result.data[i] = image.data[i * stride + first];
  return result;
}

// The first three channels of an image of three or four.
inline Image rgb(const Image& image) {
  Image result(image.width, image.height, 3);
  const auto stride = static_cast<std::size_t>(image.channels);
  for (std::size_t i = 0; i < image.pixels(); ++i)
    std::copy_n(&image.data[i * stride], 3, &result.data[i * 3]);
  return result;
}

// The rect from (x, y) on, which lies inside the image.
inline Image cropped(const Image& image, int x, int y, int width, int height) {
  Image result(width, height, image.channels);
  for (int row = 0; row < height; ++row)
    std::copy_n(image.at(x, y + row), width * image.channels, result.at(0, row));
  return result;
}

}  // namespace pellucid::harness
