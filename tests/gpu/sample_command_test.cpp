// `pellucid_sample` as a person runs it.
#include <cstdlib>

#include "capture/read.h"
#include "cli_fixture.h"

namespace {

using namespace pellucid::test;

const std::string kSmall = "--frames 2 --width 40 --height 32 --shadow-size 32 --cell 20 --validate ";

using SampleCommand = Cli;

TEST_F(SampleCommand, DrawsAndCapturesTheProceduralHead) {
  expect(0, kSmall + "--headless --turn 5 -o " + path("a.png") + " --capture " + path("a.exr"),
         "2 frames\nwrote");
  EXPECT_EQ(bytes("a.png").substr(0, 4), "\x89PNG");
  const pellucid::harness::Capture capture = pellucid::harness::readCapture(path("a.exr"));
  EXPECT_EQ(capture.width, 40);
  EXPECT_EQ(capture.lights.size(), 5u);
  EXPECT_TRUE(capture.truth.has_value());
  // D16 with the bias of engines, of reversed depths.
  for (const pellucid::harness::Light& light : capture.lights) {
    EXPECT_FALSE(light.shadowMaps.empty());
    for (const pellucid::harness::ShadowMap& map : light.shadowMaps) {
      EXPECT_NEAR(map.depthStep, 1.0 / 65535, 1e-9);
      EXPECT_NEAR(map.depthBiasConstant, -4.0 / 65535, 1e-9);
      EXPECT_EQ(map.depthBiasSlope, -3);
    }
  }
}

TEST_F(SampleCommand, NamesWhatIsWrong) {
  expect(2, "--scale 2 --headless", "--scale");
  expect(2, "--queue copy --headless", "--queue: copy not in");
  expect(2, "--mistake typo --headless", "--mistake");
  expect(4, "--device nothing-like-it --cell 20 --headless", "nothing-like-it");
}

TEST_F(SampleCommand, WindowOfAVirtualDisplay) {
  if (std::system("command -v xvfb-run >/dev/null") != 0) GTEST_SKIP() << "xvfb-run is not installed";
  const Outcome outcome = run(kSmall, "exec xvfb-run -a -s '-screen 0 320x200x24' ");
  EXPECT_EQ(outcome.code, 0) << outcome.text;
  EXPECT_NE(outcome.text.find("2 frames"), std::string::npos) << outcome.text;
}

}  // namespace
