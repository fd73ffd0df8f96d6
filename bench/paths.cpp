#include <algorithm>
#include <cstdio>
#include <functional>
#include <memory>

#include "baselines/whole_frames.h"
#include "bench_frame.h"
#include "capture/material.h"
#include "common/compare.h"
#include "measure.h"
#include "metrics/flicker.h"
#include "metrics/moved_capture.h"
#include "names.h"
#include "raster/camera_path.h"
#include "raster/raster.h"
#include "sections.h"

namespace pellucid::bench {

using namespace harness;

namespace {

constexpr int kPathSize = 512, kPathFrames = 24;  // as docs/accuracy.md has them
constexpr int kPixels[] = {1, 5};                 // of moves of the whole frame
constexpr int kStill = 16;                        // frames before a move
constexpr const char* kPublished[] = {"Jimenez 2010 + 2015, 11 taps", "HDRP, 20 samples"};

// Frames in their order in, images out.
struct Method {
  std::string name;
  std::function<Image(const Capture&)> run;
};

class PathBench {
public:
  PathBench(Device& device, const Context& context, const DrawnModel& drawn, Report& report)
      : device_(device),
        context_(context),
        drawn_(drawn),
        report_(report),
        still_(draw(drawn.camera, drawn.model.lights)),
        materials_(compileMaterials(still_)) {}

  void moved() {
    const Mask mask = comparisonMask(still_.material, still_.irradiance, Subset::All);
    const int rim = *std::max_element(std::begin(kPixels), std::end(kPixels));
    for (const int k : kPixels) {
      const Capture before = movedCapture(still_, 0, 0, rim);
      Capture after = movedCapture(still_, k, 0, rim);
      after.motion = Reprojection(before, after).motion();
      const std::string name = "moved by " + std::to_string(k) + (k == 1 ? " pixel" : " pixels");
      report_.note(name);
      for (const Method& method : methods()) {
        Image first;
        for (int i = 0; i < kStill; ++i) first = method.run(before);  // until a history has converged
        add(name, method.name, {compareShifted(first, method.run(after), mask, k, 0)});
      }
    }
  }

  void follow(const std::string& name) {
    report_.note("path " + name);
    const CameraPath path(name, drawn_.model, drawn_.camera);
    std::vector<Method> all = methods();
    all.push_back({"irradiance", [](const Capture& capture) { return capture.irradiance; }});
    std::vector<std::vector<Flicker>> steps(all.size());
    PathFlicker flicker;
    for (int frame = 0; frame < kPathFrames; ++frame) {
      const CameraPath::Pose pose = path.at(frame);
      const std::vector<Flicker> step =
          flicker.next(draw(pose.camera, pose.lights), pose.switches, [&](const Capture& capture) {
            std::vector<Image> images;
            for (const Method& method : all) images.push_back(method.run(capture));
            return images;
          });
      for (std::size_t i = 0; i < step.size(); ++i) steps[i].push_back(step[i]);
    }
    for (std::size_t i = 0; i < all.size(); ++i) add("path " + name, all[i].name, steps[i]);
  }

private:
  Capture draw(const ModelCamera& camera, const std::vector<Light>& lights) const {
    Model model = drawn_.model;
    model.lights = lights;
    Capture capture = withMapsAlone(rasterize(device_, model, camera, drawn_.raster).capture);
    capture.albedo = {};  // the published passes here write no albedo
    return capture;
  }

  Method ours(const std::string& name, const std::function<void(ReplaySettings&)>& change) {
    ReplaySettings settings;
    settings.translucency.gatherSamples = kDefaultGatherSamples;
    settings.anchor = visibleMiddle(still_);
    change(settings);
    const auto sequence = std::make_shared<ReplaySequence>(device_);
    return {"Pellucid, " + name, [=, this](const Capture& capture) {
              return rgb(sequence->run(capture, materials_, settings).output);
            }};
  }

  Method published(const std::string& name) {
    return {name, [=, this](const Capture& capture) {
              const auto frame =
                  std::make_shared<BenchFrame>(device_, context_, capture, materials_,
                                               transmittanceSettings(), nullptr, normalsOf(device_, capture));
              const std::vector<WholeFrame> all = fastestWholeFrames(frame);
              const auto found = std::find_if(all.begin(), all.end(),
                                              [&](const WholeFrame& w) { return w.variant.name == name; });
              device_.run(found->variant.record);
              return found->variant.output();
            }};
  }

  // With histories that are empty.
  std::vector<Method> methods() {
    std::vector<Method> all = {
        ours("no anchor", [](ReplaySettings& s) { s.anchor = {}; }), ours("anchor", [](ReplaySettings&) {}),
        ours("accumulated", [](ReplaySettings& s) { s.reuse = PELLUCID_REUSE_ACCUMULATE; }),
        ours("no gather", [](ReplaySettings& s) { s.translucency.gatherSamples = 0; }),
        ours("64 samples", [](ReplaySettings& s) { s.translucency.gatherSamples = 64; })};
    for (const char* name : kPublished) all.push_back(published(name));
    return all;
  }

  void add(const std::string& change, const std::string& method, const std::vector<Flicker>& steps) {
    const Flicker all = flickerOf(steps);
    const auto &rmse = all.relativeRmse, &p999 = all.p999;
    char text[120];
    std::snprintf(text, sizeof text, "  %-34s %.4f %.4f %.4f  %.3f %.3f %.3f", method.c_str(), rmse[0],
                  rmse[1], rmse[2], p999[0], p999[1], p999[2]);
    report_.note(text);
    report_.record(
        {{"kind", "path"}, {"change", change}, {"name", method}, {"flicker_rgb", rmse}, {"p999_rgb", p999}});
  }

  Device& device_;
  const Context& context_;
  const DrawnModel& drawn_;
  Report& report_;
  Capture still_;
  std::vector<PellucidMaterial> materials_;
};

// A frame that goes on with the history of the one before, which is the same frame, beside one without a
// history.
void timeAccumulation(Device& device, const Context& context, const FrameSource& source, int repeat,
                      Report& report) {
  Capture capture = source.make();
  capture.albedo = {};
  capture.motion = Image(capture.width, capture.height, 2);
  const std::vector<PellucidMaterial> materials = compileMaterials(capture);
  const std::string frame =
      source.name + ", " + std::to_string(capture.width) + "x" + std::to_string(capture.height);
  ReplaySettings settings;
  settings.translucency.gatherSamples = kDefaultGatherSamples;
  settings.anchor = visibleMiddle(capture);
  for (const bool accumulates : {false, true}) {
    settings.reuse = accumulates ? PELLUCID_REUSE_ACCUMULATE : PELLUCID_REUSE_NONE;
    const FrameRun first(device, context, capture, materials, settings);
    device.run([&](VkCommandBuffer commandBuffer) { first.record(commandBuffer); });
    const FrameRun next(device, context, capture, materials, settings, &first);
    const Time time =
        measure(device, repeat, [&](VkCommandBuffer commandBuffer) { next.record(commandBuffer); });
    report.add({frame + (accumulates ? ", accumulated" : ", anchor"),
                next.plan().dispatchCount,
                next.plan().barrierCount,
                0,
                {},
                {{"kind", "accumulation"},
                 {"accumulates", accumulates},
                 {"frame", source.name},
                 {"size", std::to_string(capture.width) + "x" + std::to_string(capture.height)}}},
               time);
  }
}

}  // namespace

void measurePaths(Device& device, const Context& context, const FrameOptions& options, int repeat,
                  Report& report) {
  report.section("along paths: RMSE R G B, 99.9 % R G B", "paths");
  const DrawnModel drawn = portrait(device, options, kPathSize);
  PathBench bench(device, context, drawn, report);
  bench.moved();
  for (const char* name : kPaths) bench.follow(name);
  report.section("times of accumulation", "paths");
  for (const FrameSource& source : frameSources(device, options))
    if (source.name != "nothing") timeAccumulation(device, context, source, repeat, report);
}

}  // namespace pellucid::bench
