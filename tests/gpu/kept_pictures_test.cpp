// Pictures that the documents show, made again: a change of a pixel is deliberate, and comes with the new picture.
#include <stb/stb_image.h>

#include <cstdlib>
#include <memory>
#include <ostream>

#include "cli_fixture.h"

namespace {

using namespace pellucid::test;

struct Picture {
  const char *name, *options;
};

// GoogleTest would print the bytes.
void PrintTo(const Picture& value, std::ostream* out) { *out << value.name; }

struct Pixels {
  int width = 0, height = 0, channels = 0;
  std::unique_ptr<stbi_uc, void (*)(void*)> rgb{nullptr, stbi_image_free};

  explicit Pixels(const std::string& file) {
    rgb.reset(stbi_load(file.c_str(), &width, &height, &channels, 3));
  }
};

class KeptPictures : public Cli, public testing::WithParamInterface<Picture> {};

TEST_P(KeptPictures, AreMadeAgain) {
  const std::string capture = path("ear.exr"), picture = path("picture.png");
  expect(0, "capture --procedural ear --size 512x512 -o " + capture, "");
  expect(0,
         "replay " + capture + " --repeat 0 -o " + path("ear.out.exr") + " --triptych " + picture +
             GetParam().options,
         "wrote");
  const std::string name = std::string(PELLUCID_SOURCE_DIR "/docs/images/") + GetParam().name;
  const Pixels made(picture), kept(name);
  ASSERT_TRUE(made.rgb && kept.rgb) << name;
  ASSERT_EQ(made.width, kept.width);
  ASSERT_EQ(made.height, kept.height);
  // The pictures come from this device, Mesa 22.3.6's llvmpipe, to the bit. Other compilers round otherwise: one step of
  // 255 after tone mapping.
  constexpr int kMost = 1;
  int worst = 0, x = 0;
  const int values = 3 * kept.width * kept.height;
  for (int i = 0; i < values; ++i)
    if (const int apart = std::abs(made.rgb.get()[i] - kept.rgb.get()[i]); apart > worst) worst = apart, x = i;
  EXPECT_LE(worst, kMost) << name << " at " << x / 3 % kept.width << ", " << x / 3 / kept.width
                          << ": look at the new picture, and copy it there if the change is meant";
}

INSTANTIATE_TEST_SUITE_P(Docs, KeptPictures,
                         testing::Values(Picture{"demo.png", ""},
                                         Picture{"thickness.png", " --set quality=0"}),
                         [](const auto& test) { return test.index == 0 ? "Demo" : "Thickness"; });

}  // namespace
