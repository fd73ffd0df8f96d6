// The bytes of a picture.
#pragma once

#include <stb/stb_image.h>

#include <memory>
#include <string>

namespace pellucid::test {

struct Pixels {
  int width = 0, height = 0, channels = 0;
  std::unique_ptr<stbi_uc, void (*)(void*)> rgb{nullptr, stbi_image_free};  // null: no picture

  explicit Pixels(const std::string& file) {
    rgb.reset(stbi_load(file.c_str(), &width, &height, &channels, 3));
  }
};

}  // namespace pellucid::test
