// `pellucid measure-dots` on bodies whose minimum dots are known, and its table through replay.
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <vector>

#include "cli_fixture.h"
#include "gltf_builder.h"

namespace {

using namespace pellucid::test;

class MeasureDots : public Cli {
protected:
  // The minimum dots of a run.
  std::vector<double> measure(const std::string& arguments) {
    expect(0, "measure-dots " + arguments + " -o " + path("table.json"), "wrote");
    std::ifstream file(path("table.json"));
    return nlohmann::json::parse(file).at("minimum-dots").get<std::vector<double>>();
  }

  void writePlate() const {
    // 20 x 20 x 2 mm, outward faces.
    const float x = 10, z = 1;
    std::vector<float> positions, normals;
    std::vector<std::uint16_t> indices;
    for (int axis = 0; axis < 3; ++axis)
      for (const float side : {-1.0f, 1.0f}) {
        const auto first = static_cast<std::uint16_t>(positions.size() / 3);
        for (const auto& [u, v] : {std::pair(-1.0f, -1.0f), {1.0f, -1.0f}, {1.0f, 1.0f}, {-1.0f, 1.0f}}) {
          float corner[3], normal[3] = {0, 0, 0};
          corner[axis] = side;
          corner[(axis + 1) % 3] = u * side;
          corner[(axis + 2) % 3] = v;
          normal[axis] = side;
          for (int i = 0; i < 3; ++i) {
            positions.push_back(corner[i] * (i == 2 ? z : x));
            normals.push_back(normal[i]);
          }
        }
        for (const int i : {0, 1, 2, 0, 2, 3}) indices.push_back(static_cast<std::uint16_t>(first + i));
      }
    GltfBuilder glb;
    const int p = glb.vectors(positions), n = glb.vectors(normals), i = glb.indices(indices);
    glb.json["meshes"] = {
        {{"primitives", {{{"attributes", {{"POSITION", p}, {"NORMAL", n}}}, {"indices", i}}}}}};
    glb.json["nodes"] = {{{"mesh", 0}}};
    std::ofstream(path("plate.glb"), std::ios::binary) << glb.glb();
  }
};

// A sphere so small that T is T(0) everywhere: the mean of max(-N.L, 0) over its disc is Lambert's phase
// function (sin b + (pi - b) cos b) / pi of its value at b = 0, b the angle from opposite the light.
TEST_F(MeasureDots, SphereIsAlikeAllAround) {
  const double threshold = 0.5;
  double b = 0;
  const auto phase = [&] { return (std::sin(b) + (std::numbers::pi - b) * std::cos(b)) / std::numbers::pi; };
  while (phase() > threshold) b += 1e-5;
  const std::string sphere =
      "--procedural sphere --scene-set radius=.001 --scene-set extent=.003 --size 32x32 --shadow-size 48 "
      "--steps 12 --threshold .5 ";
  const std::vector<double> dots = measure(sphere + "--entries 5 --face 0,1,1 --up 1,0,0");
  ASSERT_EQ(dots.size(), 5u);
  // 300 pixels, of which the limb's are in or out, steps of 7.5 degrees, and texels of a 48th of the sphere
  // over which light fades in at the terminator. Normals of neighboring depths turn late at 32 pixels.
  for (const double dot : dots) EXPECT_NEAR(dot, -std::cos(b), 0.08);
}

// A plate shows its lit face's other side from the first step past 90 degrees on, and nothing of light that
// comes along it: that would have to cross 20 mm.
TEST_F(MeasureDots, PlateOfAModel) {
  writePlate();
  const std::vector<double> dots = measure(
      path("plate.glb") + " --material *=skin1 --unit mm --entries 4 --steps 6 --size 24x24 --shadow-size 64");
  ASSERT_EQ(dots.size(), 4u);
  const double firstStep = -std::sin(std::numbers::pi / 12);
  for (const size_t face : {0u, 2u}) {
    EXPECT_LT(dots[face], 0);
    EXPECT_GT(dots[face], firstStep);
  }
  EXPECT_NEAR(dots[0], dots[2], 0.01);
  EXPECT_EQ(dots[1], -1);
  EXPECT_EQ(dots[3], -1);
}

// The file is what replay takes, alone or with other settings around it.
TEST_F(MeasureDots, TableIsReplayed) {
  const std::string capture = path("ear.exr"), table = path("table.json");
  expect(0, "capture --procedural ear --size 24x24 --shadow-size 32 -o " + capture, "");
  const std::string small = "--procedural ear --entries 4 --steps 4 --size 16x16 --shadow-size 32";
  const std::vector<double> dots = measure(small);
  std::string list, center;
  std::ifstream written(table);
  const nlohmann::json json = nlohmann::json::parse(written);
  for (const double x : json.at("center")) center.append(center.empty() ? "" : ",").append(std::to_string(x));
  for (const double dot : dots) list.append(list.empty() ? "" : ",").append(std::to_string(dot));
  expect(0, "replay " + capture + " --repeat 0 -o " + path("file.exr") + " --set @" + table, "wrote");
  expect(0,
         "replay " + capture + " --repeat 0 -o " + path("list.exr") +
             " --set angle=minimum-dot-azimuth --set center=" + center + " --set minimum-dots=" + list,
         "wrote");
  expect(0, "replay " + capture + " --repeat 0 -o " + path("plain.exr"), "wrote");
  expect(0, "compare " + path("file.exr") + " " + path("list.exr") + " --limit max=0", "");
  expect(1, "compare " + path("file.exr") + " " + path("plain.exr") + " --limit max=0", "limit");
}

TEST_F(MeasureDots, Refusals) {
  expect(2, "measure-dots --procedural ear --face 0,2,0", "\"0,2,0\" is along --up \"0,1,0\"");
  expect(2, "measure-dots --procedural ear --set rect=0,0,1,1", "are not of the light that comes through");
  expect(3, "measure-dots --procedural slab", "scene \"slab\": has no end");
  expect(3, "measure-dots " + path("missing.glb"), "missing.glb");
  expect(3, "replay x.exr --set @" + path("none.json"), "none.json: cannot be read");
  for (const auto& [text, sentence] : {std::pair("[1]", "s.json: is not an object of settings"),
                                       {"{\"angle\": ", "s.json: not valid JSON"},
                                       {"{\"colour\": 1}", "s.json: colour: is not a key of --set"},
                                       {"{\"face\": [0, \"x\", 0]}", "s.json: face[1]"}}) {
    std::ofstream(path("s.json")) << text;
    expect(3, "replay x.exr --set @" + path("s.json"), sentence);
  }
}

}  // namespace
