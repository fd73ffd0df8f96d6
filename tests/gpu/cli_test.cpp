// The command as a person runs it: exit codes, sentences, files.
#include "cli_fixture.h"

namespace {

namespace fs = std::filesystem;
using namespace pellucid::test;

TEST_F(Cli, CaptureReplayComparePlan) {
  const std::string capture = path("slab.exr"), out = path("out.exr"), again = path("again.exr");
  expect(0, "capture --procedural slab --size 48x32 --shadow-size 64 -o " + capture, "");
  expect(0, "info " + capture, "shadow");
  expect(0, "plan " + capture, "\"dispatchCount\": 9");
  expect(0, "replay " + capture + " -o " + out + " --triptych " + path("t.png") + " --png", "upsample");
  const std::string linear = bytes("t.png");
  const std::string mapped = "replay " + capture + " --repeat 0 -o " + out + " --exposure 1 ";
  expect(0, mapped + "--triptych " + path("t.png") + " --tonemap agx", "wrote");
  const std::string agx = bytes("t.png");
  expect(0, mapped + "--triptych " + path("t.png") + " --tonemap aces", "wrote");
  EXPECT_NE(agx, bytes("t.png"));
  EXPECT_NE(agx, linear);
  expect(2, mapped + "--tonemap agx", "--png or --triptych");
  expect(2, mapped + "--tonemap agx --debug thickness", "a debug view holds data");
  expect(2, mapped + "--png --tonemap velvia", "--tonemap");
  expect(0, "replay " + capture + " -o " + again + " --repeat 0", "wrote");
  expect(0, "compare " + out + " " + again + " --mask " + capture + " --limit max=0", "rel_rmse");
  for (const char* file : {"out.exr", "out.png", "t.png"}) EXPECT_GT(fs::file_size(path(file)), 100u) << file;
  // Without translucency the picture is another one, and compare says so with its own exit code.
  const Outcome once = run("replay " + capture + " -o " + again + " --set features=diffusion --repeat 0");
  EXPECT_EQ(once.code, 0) << once.text;
  EXPECT_NE(once.text.find("skipped: 1 x translucency"), std::string::npos) << once.text;
  EXPECT_EQ(once.text.find("time"), std::string::npos) << once.text;
  expect(1, "compare " + out + " " + again + " --mask " + capture + " --limit rel_rmse=0.001", "limit");
  expect(0, "replay " + capture + " --debug thickness -o " + path("d.exr"),
         "median of 3 frames after a first one");
  EXPECT_TRUE(fs::exists(path("d.png")));
  expect(0, "replay " + capture + " --mode thesis --repeat 1 -o " + again, "median of 1 frame after");
}

// A table, and a picture of 6 x 4 blocks; the EXR holds the result.
TEST_F(Cli, Statistics) {
  const std::string capture = path("ear.exr"), out = path("out.exr"), plain = path("plain.exr");
  ASSERT_EQ(run("capture --procedural ear --size 384x256 --shadow-size 32 -o " + capture).code, 0);
  const Outcome outcome = run("replay " + capture + " --repeat 0 --stats --debug blocks -o " + out);
  EXPECT_EQ(outcome.code, 0) << outcome.text;
  int blocks = 0, most = 0;
  const std::size_t line = outcome.text.find("blocks with material");
  ASSERT_NE(line, std::string::npos) << outcome.text;
  ASSERT_EQ(std::sscanf(&outcome.text[line], "blocks with material %d %d", &blocks, &most), 2) << outcome.text;
  EXPECT_EQ(most, 24);
  EXPECT_LT(blocks, most);
  EXPECT_TRUE(fs::exists(path("out.png")));
  const Outcome without = run("replay " + capture + " --repeat 0 -o " + plain);
  EXPECT_EQ(without.text.find("blocks with material"), std::string::npos) << without.text;
  expect(0, "compare " + out + " " + plain + " --mask " + capture + " --limit max=0", "rel_rmse");
}

TEST_F(Cli, Sheet) {
  const std::string turn = " --frames 2,12 ";
  expect(0,
         "capture --procedural ear --size 24x16 --shadow-size 32 --turntable 12 --orbit" + turn + "-o " +
             path("ear.##.exr"),
         "");
  expect(0, "replay " + path("ear.##.exr") + turn + "--set filter=.55,.29,.28 -o " + path("view.##.exr"),
         "2 frames: 2 written");
  const std::string views = path("view.02.exr") + " " + path("view.12.exr");
  expect(0,
         "sheet " + views + " " + path("view.02.exr") + " --columns 2 --tonemap agx -o " + path("sheet.png"),
         "3 images");
  EXPECT_GT(fs::file_size(path("sheet.png")), 100u);
  expect(0, "sheet " + views + " --label one --label two --exposure 1,0.5 -o " + path("sheet.png"),
         "2 images");
  expect(
      0,
      "sheet " + path("ear.02.exr@albedo") + " " + path("ear.02.exr@irradiance") + " -o " + path("sheet.png"),
      "2 images");
  expect(3, "sheet " + path("view.02.exr@velvia") + " -o " + path("sheet.png"), "velvia");
  expect(2, "sheet " + views + " --exposure 1,2,3 -o " + path("sheet.png"), "--exposure: 3 are given for 2");
  expect(2, "sheet " + views + " --label one -o " + path("sheet.png"), "--label: 1 are given for");
  expect(1, "compare " + views + " --limit rel_rmse=0.1", "limit");  // another view is another picture
  ASSERT_EQ(run("capture --procedural plane --size 16x16 --shadow-size 16 -o " + path("small.exr")).code, 0);
  ASSERT_EQ(run("replay " + path("small.exr") + " --repeat 0 -o " + path("small_out.exr")).code, 0);
  expect(3, "sheet " + views + " " + path("small_out.exr") + " -o " + path("sheet.png"),
         "small_out.exr: is 16 x 16");
}

TEST_F(Cli, SheetOfSweeps) {
  const std::string capture = path("ear.exr"), sheet = path("sheet.png");
  ASSERT_EQ(run("capture --procedural ear --size 96x64 --shadow-size 32 -o " + capture).code, 0);
  expect(0, "sheet " + capture + " --sweep gather=0,8 --sweep material=skin1,marble --exposure 1 -o " + sheet,
         "4 images");
  // Two rows of two, with gaps of 4: 196 x 132.
  const std::string png = bytes("sheet.png");
  EXPECT_EQ(png.substr(16, 8), std::string("\0\0\0\xC4\0\0\0\x84", 8));
  expect(2, "sheet " + capture + " " + capture + " --sweep gather=0 -o " + sheet,
         "--sweep: takes one capture");
  expect(2, "sheet " + capture + " --sweep color=red -o " + sheet, "unknown key \"color\"");
  expect(3, "sheet " + capture + " --sweep material=jade -o " + sheet, "jade");
}

TEST_F(Cli, UsageErrors) {
  expect(2, "", "subcommand");
  expect(2, "replay", "capture");
  expect(2, "replay x.exr --set colour=red", "unknown key \"colour\"");
  expect(2, "replay x.exr --debug soul", "\"soul\" is not one of");
  expect(2, "replay x.exr --mode magic", "\"magic\" is not one of");
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
  expect(3, "replay " + path("plane.exr") + " --repeat 0 -o " + path("no/such/folder/o.exr"),
         "no/such/folder");
  expect(3, "capture --procedural nothing -o " + path("x.exr"), "no scene \"nothing\"; there are ear");
  expect(3, "evaluate " + path("plane.exr"), "truth");
}

TEST_F(Cli, NoDevice) {
  ASSERT_EQ(run("capture --procedural plane --size 16x16 --shadow-size 16 -o " + path("plane.exr")).code, 0);
  expect(4, "replay " + path("plane.exr") + " --device NoSuchDevice", "NoSuchDevice");
}

TEST_F(Cli, TurntableAndSequence) {
  const std::string in = path("in.###.exr"), out = path("out.#.exr");
  expect(0,
         "capture --procedural ear --size 24x24 --shadow-size 16 --turntable 4 --light-turntable 6 -o " + in,
         "");
  for (const char* file : {"in.001.exr", "in.002.exr", "in.003.exr", "in.004.exr"})
    EXPECT_TRUE(fs::exists(path(file))) << file;
  EXPECT_FALSE(fs::exists(path("in.005.exr")));
  // One frame of it by itself is the same file.
  fs::copy_file(path("in.003.exr"), path("kept.exr"));
  expect(0,
         "capture --procedural ear --size 24x24 --shadow-size 16 --turntable 4 --light-turntable 6 --frames "
         "3 -o " +
             in,
         "");
  EXPECT_EQ(bytes("in.003.exr"), bytes("kept.exr"));
  EXPECT_NE(bytes("in.001.exr"), bytes("kept.exr"));

  expect(0, "replay " + in + " -o " + out + " --frames 2-3 --jobs 2",
         "2 written, 0 finished before, 0 failed");
  // A damaged frame is made again, finished ones are not; a missing one does not lose the others.
  fs::resize_file(path("out.2.exr"), fs::file_size(path("out.2.exr")) / 2);
  fs::copy_file(path("out.3.exr"), path("third.exr"));
  fs::remove(path("in.001.exr"));
  expect(3, "replay " + in + " -o " + out + " --frames 1-4", "2 written, 1 finished before, 1 failed");
  expect(3, "replay " + in + " -o " + out + " --frames 1,4",
         "failed: --frames 1\n  frames 1: " + in + " is not there");
  expect(3, "replay " + in + " -o " + out + " --frames 1-300",
         "failed: --frames 1,5-300\n  frames 1,5-300: " + in + " is not there");
  expect(0, "replay " + in + " -o " + out, "0 written, 3 finished before, 0 failed");
  EXPECT_EQ(bytes("out.3.exr"), bytes("third.exr"));
  expect(0, "compare " + path("out.2.exr") + " " + path("out.3.exr"), "rel_rmse");
  for (const auto& entry : fs::directory_iterator(folder_))
    EXPECT_EQ(entry.path().string().find(".part-"), std::string::npos) << entry.path();
  // Other settings would change the look in the middle.
  expect(3, "replay " + in + " -o " + out + " --frames 2 --mode thesis", "made with \"mode=physical\"");
  expect(0, "replay " + in + " -o " + out + " --frames 2 --mode thesis --overwrite --png --exposure 1",
         "1 written");
  EXPECT_TRUE(fs::exists(path("out.2.png")));
}

TEST_F(Cli, SequenceUsage) {
  expect(2, "replay in.####.exr", "a sequence: -o with #### is required");
  expect(3, "replay in.####.exr -o o.####.exr", "in.####.exr: no file has such a name");
  expect(2, "replay in.#.exr -o o.exr --frames 1-2", "\"o.exr\" is not a file name with one run of #");
  expect(2, "replay in.#.exr -o o.#.exr --frames 2-1", "\"2-1\" ends before it begins");
  expect(2, "replay in.#.exr -o o.#.exr --frames 1-2 --png", "--exposure");
  expect(2, "replay in.#.exr -o o.#.exr --frames 1-2 --triptych t.png", "--triptych");
  expect(2, "replay in.#.exr -o o.#.exr --frames 1-2 --repeat 2",
         "--repeat times one capture, not a sequence");
  expect(2, "capture --procedural ear --turntable 3 -o x.exr", "one run of #");
  expect(2, "capture --procedural ear --orbit -o x.exr", "--orbit: needs --turntable");
  expect(2, "capture --procedural ear --point-maps 6 -o x.exr", "--point-maps: needs a model");
  expect(2, "capture --procedural ear --material skin=marble -o x.exr", "have no names");
  expect(3, "capture --procedural ear --material *=granite -o x.exr", "granite");
  expect(2, "capture x.glb --seed 3 -o x.exr", "--seed: needs --procedural");
  for (const char* command : {"capture --procedural ear", "replay x.exr"})
    expect(2, std::string(command) + " -o x.png", "\"x.png\" is written as EXR");
  expect(3, "capture --procedural slab --turntable 3 -o " + path("x.#.exr"), "scene \"slab\": has no end");
}

TEST_F(Cli, Stress) {
  expect(2, "stress --only nothing", "\"nothing\" is not one of finite, not-negative");
  expect(2, "stress --frames 2 --seconds 2", "excludes");
  expect(0, "stress --frames 2 --seed 6 --pixels 256 --only finite", "seed 6, frames 0 to 1, ");
}

// `before` of a command for one driver alone.
std::string onDriver(const fs::path& icd) { return "export VK_DRIVER_FILES=" + icd.string() + ";"; }

TEST_F(Cli, GuardedStress) {
  const fs::path swiftShader = "/usr/lib/chromium/vk_swiftshader_icd.json";  // as ./run driver has it
  if (!fs::exists(swiftShader))
    GTEST_SKIP() << swiftShader << " is not there: ./run driver swiftshader installs it";
  const Outcome outcome =
      run("stress --guarded --frames 2 --seed 1 --pixels 1024 --only finite", onDriver(swiftShader));
  EXPECT_EQ(outcome.code, 0) << outcome.text;
  for (const char* part : {"SwiftShader", "seed 1, frames 0 to 1"})
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

// Frames that found faults which are mended: without the fine filter a pixel at an edge counted less than 0.
TEST_F(Cli, StressFramesThatFoundFaultsHold) {
  expect(0, "stress --seed 303 --first 26 --frames 1 --pixels 12000000 --only more-irradiance",
         "seed 303, frames 26 to 26, ");
}

}  // namespace
