// From a file that nobody described to a picture, in two commands.
#include <nlohmann/json.hpp>

#include "cli_fixture.h"

namespace {

using namespace pellucid::test;

class InitCommand : public Cli {
protected:
  void SetUp() override {
    Cli::SetUp();
    ASSERT_EQ(run("capture --procedural sphere --size 32x24 --shadow-size 16 -o " + path("s.exr")).code, 0);
  }
};

TEST_F(InitCommand, WritesAManifestThatReplays) {
  const std::string manifest = path("c.json");
  const Outcome made =
      run("init " + path("s.exr") + " --fov 20 --unit mm --light directional:0,0,1:3 -o " + manifest);
  ASSERT_EQ(made.code, 0) << made.text;
  for (const char* line :
       {"frontDepth: s.exr front.Z, viewZ", "backDepth: s.exr back.Z, viewZ",
        "irradiance: s.exr irradiance.R,irradiance.G,irradiance.B", "the projection is that of --fov",
        "missing most: camera: unknown: where the camera is"})
    EXPECT_NE(made.text.find(line), std::string::npos) << line << "\n" << made.text;
  EXPECT_NE(made.text.find("next: pellucid replay " + manifest), std::string::npos) << made.text;
  expect(0, "replay " + manifest + " --repeat 0 --png -o " + path("o.exr"), "wrote");
  EXPECT_GT(std::filesystem::file_size(path("o.png")), 100u);
  const auto json = nlohmann::json::parse(bytes("c.json"));
  EXPECT_EQ(json["metersPerUnit"], 0.001);
  EXPECT_EQ(json["lights"][0]["intensity"], 3);
  EXPECT_EQ(json["buffers"]["frontDepth"]["file"], "s.exr") << "relative to the manifest";
  EXPECT_TRUE(json.contains("// camera"));
}

// Engines' normals follow normal maps, and would turn surfaces away from their depths.
TEST_F(InitCommand, ABufferOfNormalsChangesNoBit) {
  ASSERT_EQ(
      run("init " + path("s.exr") + " --fov 20 --unit mm --light directional:0,0,1:3 -o " + path("c.json"))
          .code,
      0);
  const std::string replay = "replay " + path("c.json") + " --repeat 0 -o " + path("o.exr");
  expect(0, replay, "wrote");
  const std::string without = bytes("o.exr");
  auto json = nlohmann::json::parse(bytes("c.json"));
  json["buffers"]["normal"] = {{"constant", {0.6, 0, 0.8}}, {"space", "view"}};
  std::ofstream(path("c.json")) << json.dump();
  expect(0, replay, "wrote");
  EXPECT_EQ(bytes("o.exr"), without);
}

// Without a flag, the depth of the background says which plane has 1.
TEST_F(InitCommand, AnAbsentFlagIsAGuess) {
  for (const char* way : {"--reversed-z", "--forward-z"}) {
    ASSERT_EQ(run("capture --procedural sphere --size 32x24 --depth device " + std::string(way) + " -o " + path("d.exr")).code, 0);
    const auto manifest = [&](const std::string& flag) {
      EXPECT_EQ(run("init " + path("d.exr") + " --fov 20 --near 10 --overwrite " + flag + " -o " + path("d.json")).code, 0);
      return bytes("d.json");
    };
    const std::string guessed = manifest("");
    EXPECT_FALSE(guessed.empty());
    EXPECT_EQ(guessed, manifest(way));
    EXPECT_NE(manifest("--reversed-z"), manifest("--forward-z"));
  }
}

// A scene's own default is forward, and perspective.
TEST_F(InitCommand, AnAbsentFlagOfACaptureIsTheScenesDefault) {
  const auto captured = [&](const std::string& flags) {
    EXPECT_EQ(
        run("capture --procedural sphere --size 32x24 --depth device " + flags + " -o " + path("f.exr")).code,
        0);
    return bytes("f.exr");
  };
  const std::string absent = captured("");
  EXPECT_EQ(absent, captured("--forward-z --projection perspective"));
  EXPECT_NE(absent, captured("--reversed-z"));
  EXPECT_NE(absent, captured("--projection orthographic"));
}

// Renders take hours, and people edit manifests.
TEST_F(InitCommand, FilesThatAreThereAreKept) {
  const std::string init = "init " + path("s.exr") + " --fov 20 -o ", input = bytes("s.exr");
  std::filesystem::create_hard_link(path("s.exr"), path("h.exr"));
  std::filesystem::create_directory(path("d"));
  for (const std::string& same : {path("s.exr"), path("h.exr"), path("d") + "/../s.exr"})
    expect(2, init + same + " --overwrite", "-o " + same + ": is an input of this command");
  EXPECT_EQ(bytes("s.exr"), input);
  std::ofstream(path("c.json")) << "edited";
  expect(2, init + path("c.json"), "-o " + path("c.json") + ": is there; --overwrite replaces it");
  EXPECT_EQ(bytes("c.json"), "edited");
  expect(0, init + path("c.json") + " --overwrite", "wrote");
}

TEST_F(InitCommand, NamesWhatItNeeds) {
  const std::string init = "init " + path("s.exr") + " -o " + path("c.json");
  expect(2, init, "--fov: is needed");
  expect(2, init + " --fov 20 --albedo Nothing", "albedo: there is no \"Nothing\"");
  expect(2, init + " --fov 20 --light sun", "--light: \"sun\" is not directional");
  expect(3, "init " + path("none.exr") + " --fov 20", "none.exr");
  EXPECT_FALSE(std::filesystem::exists(path("c.json")));
}

}  // namespace
