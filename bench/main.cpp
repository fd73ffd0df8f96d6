// pellucid_bench: GPU times of the module's plans as multiples of the bandwidth floor of the same run.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>
#include <random>

#include "commit.h"
#include "common/error.h"
#include "floor.h"
#include "measure.h"
#include "replay/replay.h"

namespace {

using namespace pellucid::harness;
using namespace pellucid::bench;

struct Options {
  std::string device, json;
  std::pair<int, int> size = {1280, 720};
  int repeat = 30;
};

// Burley's slab and six Gaussians of d'Eon et al. 2007's skin: the bench times arithmetic, and any
// material has the same.
PellucidMaterial material() {
  PellucidMaterial m{};
  m.structSize = sizeof m;
  m.gaussianCount = 6;
  const float variance[6] = {0.0064f, 0.0484f, 0.187f, 0.567f, 1.99f, 7.41f};
  const float weight[3][6] = {{0.233f, 0.100f, 0.118f, 0.113f, 0.358f, 0.078f},
                              {0.455f, 0.336f, 0.198f, 0.007f, 0.004f, 0},
                              {0.649f, 0.344f, 0, 0.007f, 0, 0}};
  for (int c = 0; c < 3; ++c) {
    const float k = static_cast<float>(c + 1);
    const float t[5] = {0.25f, k, 0.75f, k / 3, 0};
    std::copy(t, t + 5, m.transmittance[c]);
    m.reflectance[c] = 0.5f;
    m.radius[c] = 3.7f * std::sqrt(variance[5]);
    std::copy(variance, variance + 6, m.gaussianVariance[c]);
    std::copy(weight[c], weight[c] + 6, m.gaussianWeight[c]);
  }
  return m;
}

// A 2 mm slab, noise in the irradiance, one directional light from behind with a 1024^2 shadow map; the
// upper `coverage` of the image has the material. A pixel is `pixel` mm wide.
Capture slab(int width, int height, double coverage, double pixel) {
  Capture c;
  c.name = "slab";
  c.width = width;
  c.height = height;
  c.metersPerUnit = 0.001;
  c.clipFromView[0] = 2 / (pixel * width);
  c.clipFromView[5] = -2 / (pixel * height);
  c.clipFromView[10] = -1.0 / 100;
  c.frontDepth.image = Image(width, height, 1, 50);
  c.backDepth.image = Image(width, height, 1, 52);
  c.normal = Image(width, height, 3);
  c.irradiance = Image(width, height, 3);
  std::mt19937 random(1);  // zeros would run faster than real data
  for (size_t i = 0; i < c.irradiance.data.size(); ++i) {
    c.irradiance.data[i] = static_cast<float>(random() % 1024) / 512;
    c.normal.data[i] = i % 3 == 2 ? 1.0f : 0.0f;
  }
  c.material.assign(c.irradiance.pixels(), 0);
  std::fill_n(c.material.begin(),
              static_cast<std::ptrdiff_t>(coverage * static_cast<double>(c.material.size())),
              std::uint8_t{1});
  c.materials.resize(1);
  Light light;
  light.direction = {0, 0, 1};
  light.shadowMap.emplace();
  light.shadowMap->clipFromWorld = {
      2 / (pixel * width), 0, 0, 0, 0, 2 / (pixel * height), 0, 0, 0, 0, 0.01, 0, 0, 0, 1, 1};
  light.shadowMap->depth.encoding = PELLUCID_DEPTH_DEVICE;
  light.shadowMap->depth.image = Image(1024, 1024, 1, 0.48f);
  c.lights = {light};
  return c;
}

// Of `lights` copies of the slab's light the first `mapped` keep their shadow map.
Capture litBy(Capture c, int lights, int mapped) {
  c.lights.assign(static_cast<size_t>(lights), c.lights[0]);
  for (int i = mapped; i < lights; ++i) c.lights[static_cast<size_t>(i)].shadowMap.reset();
  return c;
}

// The answer of a bench frame's fused dispatch, where it is known in closed form.
void requireRightAnswer(Device& device, const Context& context) {
  ReplaySettings settings;
  settings.features = PELLUCID_FEATURE_TRANSLUCENCY;
  settings.outputFormat = VK_FORMAT_R32G32B32A32_SFLOAT;
  const Capture c = slab(64, 48, 1, 0.1);
  FrameRun run(device, context, c, {material()}, settings);
  device.run([&](VkCommandBuffer commandBuffer) { run.record(commandBuffer); });
  const Image out = run.output();
  const float expected = c.irradiance.data[0] + 2 * (0.25f * std::exp(-2.0f) + 0.75f * std::exp(-2.0f / 3));
  if (!(std::abs(out.data[0] - expected) < 1e-4f))
    throw DeviceError("the fused dispatch gives " + std::to_string(out.data[0]) + " and not " +
                      std::to_string(expected));
}

void bench(const Options& options) {
  const auto [width, height] = options.size;
  Device device({options.device, false});
  const Context context(device);
  requireRightAnswer(device, context);
  const FloorPass floor(device, width, height);
  const Time floorTime = measure(device, options.repeat, [&](VkCommandBuffer c) { floor.record(c); });
  if (!floor.isRight()) throw DeviceError("the floor pass wrote something else than its inputs say");

  nlohmann::json results = {{"device", device.description()},
                            {"commit", PELLUCID_COMMIT},
                            {"width", width},
                            {"height", height},
                            {"repeat", options.repeat},
                            {"floor_us", floorTime.median},
                            {"results", nlohmann::json::array()}};
  std::FILE* table = options.json == "-" ? stderr : stdout;
  std::fprintf(table, "%s, commit %s, %d x %d, median of %d\n%-34s %9s %9s %9s %8s %11s\n",
               device.description().c_str(), PELLUCID_COMMIT, width, height, options.repeat, "", "us", "10 %",
               "90 %", "x floor", "bytes/pixel");
  const auto row = [&](const std::string& name, const Time& time, double bytes) {
    std::fprintf(table, "%-34s %9.1f %9.1f %9.1f %8.2f %11.1f\n", name.c_str(), time.median, time.low,
                 time.high, time.median / floorTime.median, bytes);
    results["results"].push_back({{"name", name},
                                  {"us", time.median},
                                  {"p10_us", time.low},
                                  {"p90_us", time.high},
                                  {"floor_ratio", time.median / floorTime.median},
                                  {"modeled_bytes_per_pixel", bytes}});
  };
  row("floor", floorTime, 24);
  for (const double coverage : {1.0, 0.25, 0.0}) {
    const Capture capture = slab(width, height, coverage, 0.1);
    const std::string suffix = ", " + std::to_string(static_cast<int>(coverage * 100)) + " % covered";
    const FrameRun run(device, context, capture, {material()}, {});
    double total = 0;
    const double pixels = static_cast<double>(width) * height;
    for (uint32_t i = 0; i < run.plan().dispatchCount; ++i) {
      const double bytes = static_cast<double>(run.plan().dispatches[i].modeledBytes) / pixels;
      total += bytes;
      row(run.plan().dispatches[i].name + suffix,
          measure(device, options.repeat, [&](VkCommandBuffer c) { run.record(c, i); }), bytes);
    }
    row("whole frame" + suffix, measure(device, options.repeat, [&](VkCommandBuffer c) { run.record(c); }),
        total);
  }
  // The fused dispatch by lights, and by how many of them have a shadow map.
  for (const int lights : {1, 8, 64})
    for (const int mapped : {0, 1, 4}) {
      if (mapped > lights) continue;
      const FrameRun run(device, context, litBy(slab(width, height, 1, 0.1), lights, mapped), {material()},
                         {});
      const double bytes = static_cast<double>(run.plan().dispatches[0].modeledBytes);
      row("translucency, " + std::to_string(lights) + " lights, " + std::to_string(mapped) + " maps",
          measure(device, options.repeat, [&](VkCommandBuffer c) { run.record(c, 0); }),
          bytes / (static_cast<double>(width) * height));
    }
  if (options.json == "-")
    std::printf("%s\n", results.dump(1).c_str());
  else if (!options.json.empty())
    std::ofstream(options.json) << results.dump(1) << "\n";
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App app("GPU times of Pellucid's dispatches as multiples of the bandwidth floor.", "pellucid_bench");
  app.add_option("--device", options.device, "part of the Vulkan device's name");
  app.add_option("--size", options.size, "WIDTHxHEIGHT")->delimiter('x')->capture_default_str();
  app.add_option("--repeat", options.repeat, "counted runs of each")
      ->check(CLI::Range(1, 10000))
      ->capture_default_str();
  app.add_option("--json", options.json, "file to write, - for standard output");
  CLI11_PARSE(app, argc, argv);
  try {
    bench(options);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "pellucid_bench: %s\n", e.what());
    return dynamic_cast<const DeviceError*>(&e) ? 4 : 3;
  }
}
