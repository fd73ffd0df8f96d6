// `pellucid view` as a person runs it, with a window on a virtual display and without one.
#include <cstdlib>

#include "capture/exr.h"
#include "capture/read.h"
#include "cli_fixture.h"
#include "gltf_builder.h"
#include "gpu_fixture.h"

namespace {

using namespace pellucid::test;

const std::string kScene =
    "view --procedural sphere --size 64x48 --shadow-size 64 --validate --window-size 640x400 ";

class View : public Cli {
protected:
  // The saved capture, replayed with the saved settings, against what was on the screen.
  void expectReplays(const std::string& name) const {
    expect(0,
           "replay " + path(name + ".exr") + " --set @" + path(name + ".settings.json") + " --repeat 0 -o " +
               path("replayed.exr"),
           "wrote");
    EXPECT_TRUE(sameBits(readExrImage(path("replayed.exr")), readExrImage(path(name + ".pellucid.exr"))))
        << name;
  }
};

TEST_F(View, SavesWhatReplaysToTheSameBits) {
  expect(0, kScene + "--no-window --frames 3 --set gather=16 --set filter=.5,.7,.9 --save " + path("a.exr"),
         "3 frames of the screen, 1 of");
  expectReplays("a");
  EXPECT_EQ(bytes("a.png").substr(0, 4), "\x89PNG");
  expect(0,
         "view " + path("a.exr") + " --set @" + path("a.settings.json") +
             " --validate --no-window --window-size 320x200 --frames 1 --save " + path("c.exr"),
         "wrote");
  EXPECT_EQ(bytes("a.pellucid.exr"), bytes("c.pellucid.exr"));
}

// Its material has a name and no color.
TEST_F(View, SavesAModel) {
  std::ofstream(path("t.glb"), std::ios::binary)
      << GltfBuilder::triangle({0, 0, 0, 2, 0, 0, 0, 2, 0}, {{"name", "wax"}}).glb();
  expect(
      0,
      "view " + path("t.glb") + " --material wax=skin1 --light point:0,0,10:100 directional:0,0,-1:2" +
          " --size 32x32 --shadow-size 32 --validate --no-window --window-size 320x200 --frames 2 --save " +
          path("a.exr"),
      "wrote");
  expectReplays("a");
}

TEST_F(View, RefusesInASentence) {
  expect(3, "view " + path("none.glb") + " --no-window --frames 1", "none.glb");
  expect(2, kScene + "--no-window", "--no-window: needs --frames");
  expect(2, "view x.exr --unit cm --no-window --frames 1", "--unit: x.exr is a capture");
  expect(4, kScene + "--device nonesuch --no-window --frames 1", "nonesuch");
  const Outcome outcome = run(kScene + "--frames 1", "unset DISPLAY WAYLAND_DISPLAY; ");
  EXPECT_EQ(outcome.code, 4);
  EXPECT_NE(outcome.text.find("no window can be opened"), std::string::npos) << outcome.text;
}

TEST_F(View, WindowOfAVirtualDisplay) {
  if (std::system("command -v xvfb-run >/dev/null") != 0) GTEST_SKIP() << "xvfb-run is not installed";
  const Outcome outcome =
      run(kScene + "--frames 4 --save " + path("w.exr"), "exec xvfb-run -a -s '-screen 0 1600x1000x24' ");
  EXPECT_EQ(outcome.code, 0) << outcome.text;
  EXPECT_NE(outcome.text.find("4 frames of the screen, 1 of the module"), std::string::npos) << outcome.text;
  expectReplays("w");
}

}  // namespace
