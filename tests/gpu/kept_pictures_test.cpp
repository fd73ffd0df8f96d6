// Pictures of the demo's ear, made again: a change of a pixel is deliberate, and comes with the new picture.
#include <stb/stb_image.h>

#include <cstdlib>
#include <memory>

#include "cli_fixture.h"

namespace {

using namespace pellucid::test;

// The bytes of a picture.
struct Pixels {
  int width = 0, height = 0, channels = 0;
  std::unique_ptr<stbi_uc, void (*)(void*)> rgb{nullptr, stbi_image_free};  // null: no picture

  explicit Pixels(const std::string& file) {
    rgb.reset(stbi_load(file.c_str(), &width, &height, &channels, 3));
  }
};

class KeptPictures : public Cli {
protected:
  // `name`: of tests/gpu/pictures.
  void expectAgain(const std::string& options, const char* name) {
    const std::string picture = path(name);
    expect(0,
           "replay " + path("ear.exr") + " --repeat 0 -o " + path("out.exr") + " --triptych " + picture +
               options,
           "wrote");
    const Pixels made(picture), kept(std::string(PELLUCID_SOURCE_DIR "/tests/gpu/pictures/") + name);
    ASSERT_TRUE(made.rgb && kept.rgb) << name;
    ASSERT_EQ(made.width, kept.width);
    ASSERT_EQ(made.height, kept.height);
    // The pictures come from Mesa 22.3.6's llvmpipe, to the bit. Other compilers round otherwise: one step of
    // 255 after tone mapping.
    constexpr int kMost = 1;
    int worst = 0, at = 0;
    for (int i = 0; i < 3 * kept.width * kept.height; ++i)
      if (const int apart = std::abs(made.rgb.get()[i] - kept.rgb.get()[i]); apart > worst) {
        worst = apart;
        at = i / 3;
      }
    EXPECT_LE(worst, kMost) << name << " at " << at % kept.width << ", " << at / kept.width
                            << ": look at the new picture, and copy it there if the change is meant";
  }
};

TEST_F(KeptPictures, AreMadeAgain) {
  expect(0, "capture --procedural ear --size 128x128 --shadow-size 256 -o " + path("ear.exr"));
  expectAgain("", "gather.png");
  expectAgain(" --set gather=0", "thickness.png");
}

}  // namespace
