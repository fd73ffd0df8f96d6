// The command as a person runs it: exit codes, sentences, files.
#include "cli_fixture.h"

#include <algorithm>
#include <cstdio>

#include "capture/exr.h"
#include "capture/read.h"
#include "capture/write.h"
#include "metrics/flicker.h"

namespace {

namespace fs = std::filesystem;
using namespace pellucid::harness;
using namespace pellucid::test;

TEST_F(Cli, CaptureReplayComparePlan) {
  const std::string capture = path("slab.exr"), out = path("out.exr"), again = path("again.exr");
  expect(0, "capture --procedural slab --size 48x32 --shadow-size 64 -o " + capture);
  expect(0, "info " + capture, "shadow");
  expect(0, "plan " + capture, "\"dispatchCount\": 8");
  expect(0,
         "replay " + capture + " -o " + out + " --triptych " + path("t.png") +
             " --png --exposure 1",
         "median of 3 frames after a first one");
  for (const char* file : {"out.exr", "out.png", "t.png"}) EXPECT_GT(fs::file_size(path(file)), 100u) << file;
  // Without translucency the picture is another one, and compare says so with its own exit code.
  const Outcome once = run("replay " + capture + " -o " + again + " --set features=diffusion --repeat 0");
  EXPECT_EQ(once.code, 0) << once.text;
  EXPECT_NE(once.text.find("skipped: 1 x translucency"), std::string::npos) << once.text;
  EXPECT_EQ(once.text.find("time"), std::string::npos) << once.text;
  expect(1, "compare " + out + " " + again + " --mask " + capture + " --limit rel_rmse=0.001", "limit");
  expect(0, "replay " + capture + " --mode thesis --debug thickness --repeat 1 -o " + path("d.exr"),
         "median of 1 frame after");
  EXPECT_TRUE(fs::exists(path("d.png")));
}

// Of a frame of 3 x 3 blocks.
TEST_F(Cli, Statistics) {
  const std::string capture = path("ball.exr"), out = path("out.exr");
  expect(0, "capture --procedural sphere --set extent=9 --set radius=1 --size 192x192 --shadow-size 32 -o " +
                capture);
  expect(0, "replay " + capture + " --repeat 0 -o " + out, "blocks with material: 1 of 9");
}

// The settings of a file are those of the command line.
TEST_F(Cli, SettingsOfAFile) {
  const std::string capture = path("ear.exr"), replay = "replay " + capture + " --repeat 0 -o ";
  expect(0, "capture --procedural ear --size 24x24 --shadow-size 32 -o " + capture);
  std::ofstream(path("s.json"))
      << R"({"angle": "minimum-dot-azimuth", "face": [0, 0, 1], "center": [1, 2, 3], "minimum-dots": [-0.1, -0.6, -0.3]})";
  expect(0, replay + path("file.exr") + " --set @" + path("s.json"), "wrote");
  expect(0,
         replay + path("list.exr") +
             " --set angle=minimum-dot-azimuth --set center=1,2,3 --set minimum-dots=-.1,-.6,-.3",
         "wrote");
  expect(0, replay + path("plain.exr"), "wrote");
  expect(0, "compare " + path("file.exr") + " " + path("list.exr") + " --limit max=0", "");
  expect(1, "compare " + path("file.exr") + " " + path("plain.exr") + " --limit max=0", "limit");
  expect(3, "replay x.exr --set @" + path("none.json"), "none.json: cannot be read");
  for (const auto& [text, sentence] : {std::pair("[1]", "s.json: is not an object of settings"),
                                       {"{\"angle\": ", "s.json: not valid JSON"},
                                       {"{\"colour\": 1}", "s.json: colour: is not a key of --set"},
                                       {"{\"face\": [0, \"x\", 0]}", "s.json: face[1]"}}) {
    std::ofstream(path("s.json")) << text;
    expect(3, "replay x.exr --set @" + path("s.json"), sentence);
  }
}

TEST_F(Cli, BadInput) {
  expect(3, "replay " + path("missing.json"), "missing.json");
  std::ofstream(path("broken.json")) << "{ \"pellucid\": 1, ";
  expect(3, "info " + path("broken.json"), "broken.json");
  std::ofstream(path("extra.json")) << "{ \"pellucid\": 1, \"colour\": 3 }";
  expect(3, "plan " + path("extra.json"), "colour");
  ASSERT_EQ(run("capture --procedural plane --size 16x16 --shadow-size 16 -o " + path("plane.exr")).code, 0);
  expect(3, "replay " + path("plane.exr") + " --set rect=8,8,20,4",
         "renderRect is 8, 8 + 20 x 4, outside the 16 x 16 image");
  expect(4, "replay " + path("plane.exr") + " --device NoSuchDevice", "NoSuchDevice");
  expect(3, "capture --procedural nothing -o " + path("x.exr"), "no scene \"nothing\"; there are ear");
}

TEST_F(Cli, TurntableAndSequence) {
  const std::string in = path("in.###.exr"), out = path("out.#.exr"), replay = "replay " + in + " -o " + out;
  const std::string turn =
      "capture --procedural ear --size 24x24 --shadow-size 16 --turntable 4 --light-turntable 6 -o " + in;
  expect(0, turn);
  for (const char* file : {"in.001.exr", "in.002.exr", "in.003.exr", "in.004.exr"})
    EXPECT_TRUE(fs::exists(path(file))) << file;
  EXPECT_FALSE(fs::exists(path("in.005.exr")));
  // One frame of it by itself is the same file.
  fs::copy_file(path("in.003.exr"), path("kept.exr"));
  expect(0, turn + " --frames 3");
  EXPECT_EQ(bytes("in.003.exr"), bytes("kept.exr"));
  EXPECT_NE(bytes("in.001.exr"), bytes("kept.exr"));

  expect(0, replay + " --frames 2-3 --jobs 2", "2 written, 0 finished before, 0 failed");
  // A damaged frame is made again, finished ones are not; a missing one does not lose the others.
  fs::resize_file(path("out.2.exr"), fs::file_size(path("out.2.exr")) / 2);
  fs::copy_file(path("out.3.exr"), path("third.exr"));
  fs::remove(path("in.001.exr"));
  const Outcome some = run(replay + " --frames 1-300");
  EXPECT_EQ(some.code, 3);
  for (const std::string& said : {std::string("2 written, 1 finished before, 297 failed"),
                                  "failed: --frames 1,5-300\n  frames 1,5-300: " + in + " is not there"})
    EXPECT_NE(some.text.find(said), std::string::npos) << some.text;
  EXPECT_EQ(bytes("out.3.exr"), bytes("third.exr"));
  expect(0, "compare " + path("out.2.exr") + " " + path("out.3.exr"), "rel_rmse");
  for (const auto& entry : fs::directory_iterator(folder_))
    EXPECT_EQ(entry.path().string().find(".part-"), std::string::npos) << entry.path();
  // Other settings would change the look in the middle.
  expect(3, replay + " --frames 2 --mode thesis", "made with \"mode=physical\"");
  expect(0, replay + " --frames 2 --mode thesis --overwrite --png --exposure 1", "1 written");
  EXPECT_TRUE(fs::exists(path("out.2.png")));
}

// Frames with history follow each other, and are made as a whole; a gap is a cut.
TEST_F(Cli, SequenceWithHistory) {
  const std::string in = path("in.#.exr"), set = " --set reuse=accumulate -o ", out = path("out.#.exr");
  expect(0, "capture --procedural ear --size 32x32 --shadow-size 32 --turntable 90 --frames 1-4 -o " + in);
  const Capture first = readCapture(path("in.1.exr")), second = readCapture(path("in.2.exr"));
  const Image expected = Reprojection(first, second).motion();
  ASSERT_EQ(second.motion.data.size(), expected.data.size());
  double most = 0;
  for (std::size_t i = 0; i < expected.data.size(); ++i) {
    ASSERT_NEAR(second.motion.data[i], expected.data[i], 1e-6) << i;
    most = std::max(most, std::abs(double(expected.data[i])));
  }
  EXPECT_GT(most, 0.01);

  expect(0, "replay " + in + set + out, "4 written");
  expect(0, "replay " + path("in.1.exr") + " --repeat 0" + set + path("alone.1.exr"));
  expect(0, "replay " + path("in.2.exr") + " --repeat 0" + set + path("alone.2.exr"));
  EXPECT_EQ(readExrImage(path("out.1.exr")).data, readExrImage(path("alone.1.exr")).data);
  EXPECT_NE(readExrImage(path("out.2.exr")).data, readExrImage(path("alone.2.exr")).data);
  fs::remove(path("out.1.exr"));
  expect(3, "replay " + in + set + out,
         "out.2.exr: is there, but frames with reuse need the history of those before");
  expect(0, "replay " + in + " --overwrite --frames 2,4" + set + out, "2 written");
  expect(0, "replay " + path("in.4.exr") + " --repeat 0" + set + path("alone.4.exr"));
  EXPECT_EQ(readExrImage(path("out.4.exr")).data, readExrImage(path("alone.4.exr")).data);
  // A frame that is missing is a cut, too.
  fs::remove(path("in.3.exr"));
  EXPECT_EQ(run("replay " + in + " --overwrite --frames 2-4" + set + out).code, 3);
  EXPECT_EQ(readExrImage(path("out.4.exr")).data, readExrImage(path("alone.4.exr")).data);
}

TEST_F(Cli, FlickerOfPixelsByThemselves) {
  // What comes through a pixel is its own: moved, only the rounding of rays is left, at most one step of the
  // output's half floats, .001. Lights that turn change what comes through, and the limit says so.
  const Outcome outcome =
      run("flicker --procedural ear --size 48x40 --shadow-size 64 --pixels 1,-4 --set features=translucency "
          "--limit worst=0.01");
  EXPECT_EQ(outcome.code, 1) << outcome.text;
  EXPECT_NE(outcome.text.find("worst of R lights turned by 0.5 degrees is"), std::string::npos)
      << outcome.text;
  // A row of a change: its relative RMSE, its 99.9th percentile and the worst pixel, R G B each.
  const auto worstOf = [&](const std::string& change) {
    double e[9] = {};
    const std::size_t row = outcome.text.find("| " + change + " | ");
    if (row == std::string::npos ||
        std::sscanf(outcome.text.c_str() + row + change.size() + 5, "%lf %lf %lf | %lf %lf %lf | %lf %lf %lf", e, e + 1,
                    e + 2, e + 3, e + 4, e + 5, e + 6, e + 7, e + 8) != 9)
      ADD_FAILURE() << change << ": " << outcome.text;
    return std::minmax({e[6], e[7], e[8]});
  };
  EXPECT_LE(worstOf("moved by 1 pixel").second, 0.002);
  EXPECT_LE(worstOf("moved by -4 pixels").second, 0.002);
  EXPECT_GT(worstOf("lights turned by 0.5 degrees").first, 0.01);
  EXPECT_NE(outcome.text.find("spots, lights turned by 0.5 degrees: "), std::string::npos) << outcome.text;
}

// Nothing that a command reads is lost by what it writes.
TEST_F(Cli, InputsAreNotOverwritten) {
  const std::string one = path("s.0001.exr"), all = path("s.####.exr");
  expect(0, "capture --procedural ear --size 16x16 --shadow-size 16 -o " + one);
  const std::string before = bytes("s.0001.exr");
  expect(2, "replay " + one + " -o " + one, "is an input of this command");
  expect(2, "replay " + one + " --overwrite -o " + path("./s.0001.exr"), "is an input of this command");
  expect(3, "replay '" + all + "' -o '" + all + "'", "pellucid.settings: is missing: no result of this command");
  expect(3, "replay '" + all + "' --overwrite -o '" + all + "'", "is an input of this command");
  EXPECT_EQ(bytes("s.0001.exr"), before);
}

TEST_F(Cli, AFullDiskIsSaid) {
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "needs /dev/full";
  expect(3, "material skin1 > /dev/full");
}

// A replay says what `info` says.
TEST_F(Cli, ReplayWarnsOfWhatItSees) {
  expect(0, "capture --procedural ear --size 16x16 --shadow-size 16 -o " + path("c.exr"));
  Capture capture = readCapture(path("c.exr"));
  std::fill(capture.material.begin(), capture.material.end(), std::uint8_t{0});
  writeCapture(capture, path("none.exr"));
  expect(0, "replay " + path("none.exr") + " --repeat 0 -o " + path("o.exr"), "warning: no pixel has a material");
}

TEST_F(Cli, SequenceUsage) {
  expect(2, "replay in.####.exr", "a sequence: -o with #### is required");
  expect(3, "replay in.####.exr -o o.####.exr", "in.####.exr: no file has such a name");
  expect(3, "capture --procedural ear --material *=granite -o x.exr", "granite");
  for (const char* command : {"capture --procedural ear", "replay x.exr"})
    expect(2, std::string(command) + " -o x.png", "\"x.png\" is written as EXR");
  expect(3, "capture --procedural slab --turntable 3 -o " + path("x.#.exr"), "scene \"slab\": has no end");
}

TEST_F(Cli, Stress) {
  expect(2, "stress --only nothing", "\"nothing\" is not one of finite, not-negative");
  expect(0, "stress --frames 2 --seed 6 --pixels 256 --only finite", "seed 6, frames 0 to 1, ");
}

// `before` of a command for one driver alone.
std::string onDriver(const fs::path& icd) { return "export VK_DRIVER_FILES=" + icd.string() + ";"; }

TEST_F(Cli, GuardedStress) {
  const fs::path swiftShader = "/usr/lib/chromium/vk_swiftshader_icd.json";  // as ./run driver has it
  if (!fs::exists(swiftShader))
    GTEST_SKIP() << swiftShader << " is not there: ./run driver swiftshader installs it";
  const Outcome outcome =
      run("stress --guarded --frames 1 --seed 1 --pixels 256 --only finite", onDriver(swiftShader));
  EXPECT_EQ(outcome.code, 0) << outcome.text;
  for (const char* part : {"SwiftShader", "seed 1, frames 0 to 0"})
    EXPECT_NE(outcome.text.find(part), std::string::npos) << outcome.text;
}

// RADV for a card that is not there has no VK_EXT_external_memory_host.
TEST_F(Cli, GuardedStressNamesTheExtensionThatADeviceLacks) {
  const fs::path radv = "/usr/share/vulkan/icd.d/radeon_icd.x86_64.json";
  const std::string before = onDriver(radv) + "export RADV_FORCE_FAMILY=navi21;";
  if (!fs::exists(radv)) GTEST_SKIP() << radv << " is not there";
  const Outcome outcome = run("stress --guarded --frames 1", before);
  EXPECT_EQ(outcome.code, 4) << outcome.text;
  EXPECT_NE(outcome.text.find("VK_EXT_external_memory_host is missing"), std::string::npos) << outcome.text;
}

// A frame that found a fault, which is mended: without the fine filter a pixel at an edge counted less than
// 0.
TEST_F(Cli, StressFrameThatFoundAFaultHolds) {
  expect(0, "stress --seed 303 --first 26 --frames 1 --pixels 12000000 --only more-irradiance",
         "seed 303, frames 26 to 26, ");
}

}  // namespace
