// Sections on planes, where every pixel may be covered: the module's frames, and diffusions of others.
#include "plane.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <vector>

#include "bench_frame.h"
#include "common/compare.h"
#include "common/error.h"
#include "diffusions.h"
#include "floor.h"
#include "pellucid/pellucid_material.h"
#include "reference/reference.h"
#include "scene.h"
#include "scene/scene.h"

namespace pellucid::bench {

using namespace harness;

namespace {

using namespace harness;

// The default number of samples on an ear against all texels in float64, where it is unlit: relative RMSE of
// 4x4 averages, worst channel.
double gatherError(const Site& site) {
  Capture capture = makeScene({.name = "ear", .width = 128, .height = 128, .shadowSize = 384});
  capture.albedo = {};
  capture.lights.resize(1);
  // The scene measures transmitted light alone. Lit surfaces also return gathered light, so their pixels do
  // not count.
  const std::vector<std::uint8_t> unlit = comparisonMask(capture.material, capture.irradiance, Subset::Unlit);
  std::fill(capture.irradiance.data.begin(), capture.irradiance.data.end(), 0.0f);
  ReplaySettings settings;
  settings.translucency.gatherSamples = kDefaultGatherSamples;
  reference::Settings all;
  all.features = settings.features;
  all.translucency = settings.translucency;
  constexpr int kBox = 4;
  all.wanted = spreadPixels(capture, site.errorPixels, kBox);
  for (size_t i = 0; i < unlit.size(); ++i) all.wanted[i] &= unlit[i];
  const std::vector<PellucidMaterial> materials(capture.materials.size(), site.material);
  const Image truth = reference::compute(capture, materials, all).image;
  const Image image = site.run(moduleVariant(site.frame(capture, settings), ""));
  double worst = 0;
  for (const ChannelDifference& channel : compareImages(image, truth, all.wanted, kBox).channels)
    worst = std::max(worst, channel.relativeRmse);
  return worst;
}

struct Bench {
  const PlaneOptions& options;
  const Site& site;
  int repeat;
  Report& report;

  std::shared_ptr<const BenchFrame> frame(const Capture& capture, const ReplaySettings& settings) const {
    return site.frame(capture, settings);
  }
  Capture fullSlab() const { return slab(options.size.first, options.size.second, 1, site.pixel); }
  Image run(const Variant& variant) const { return site.run(variant); }
  Time time(const std::function<void(VkCommandBuffer)>& record) const {
    return measure(site.device, repeat, record);
  }
  Time row(const Variant& v, std::optional<double> error) const {
    const Time t = time(v.record);
    report.add({v.name, v.dispatches, v.barriers, v.bytesPerPixel, error}, t);
    return t;
  }
};

// The fused dispatch on the slab, where the answer is closed: its T at its thickness.
void requireRightAnswer(const Bench& bench) {
  ReplaySettings settings;
  settings.features = PELLUCID_FEATURE_TRANSLUCENCY;
  settings.outputFormat = VK_FORMAT_R32G32B32A32_SFLOAT;
  const Capture c = slab(64, 48, 1, 0.1);
  const Image out = bench.run(moduleVariant(bench.frame(c, settings), ""));
  const double thickness = slabThickness(c);
  const double expected = static_cast<double>(c.irradiance.data[0]) +
                          pellucidEvaluateTransmittance(&bench.site.material, 0, thickness) /
                              static_cast<double>(bench.site.material.reflectance[0]);
  if (!(std::abs(static_cast<double>(out.data[0]) - expected) < 1e-4))
    throw DeviceError("the fused dispatch gives " + std::to_string(out.data[0]) + " and not " +
                      std::to_string(expected));
}

void modulePlans(const Bench& bench) {
  const auto [width, height] = bench.options.size;
  const auto rows = [&](const std::string& title, const Capture& capture) {
    bench.report.section(title);
    bench.row(moduleVariant(bench.frame(capture, {}), "whole frame"), {});
  };
  for (const double coverage : bench.options.coverage) {
    char title[64];
    std::snprintf(title, sizeof title, "module, %g %% covered", coverage);
    rows(title, slab(width, height, coverage / 100, bench.site.pixel));
  }
  rows("module, radii not known", inPerspective(bench.fullSlab()));
}

// The fused dispatch alone.
void fusedDispatch(const Bench& bench) {
  bench.report.section("fused dispatch");
  ReplaySettings settings;
  settings.features = PELLUCID_FEATURE_TRANSLUCENCY;
  bench.row(moduleVariant(bench.frame(bench.fullSlab(), settings), "1 lights, 1 maps"), {});
}

// What the gather adds to a frame, in place of the fused dispatch: over a frame without it that is otherwise
// the same.
void gathered(const Bench& bench) {
  const auto added = [&](const std::string& name, const Capture& capture, std::optional<double> error) {
    ReplaySettings gather;
    gather.translucency.gatherSamples = kDefaultGatherSamples;
    const Variant without = moduleVariant(bench.frame(capture, {}), ""),
                  with = moduleVariant(bench.frame(capture, gather), "");
    const Time a = bench.time(without.record), b = bench.time(with.record);
    bench.report.add(
        {name, int64_t{with.dispatches} - without.dispatches, int64_t{with.barriers} - without.barriers,
         with.bytesPerPixel - without.bytesPerPixel, error},
        {b.median - a.median, b.low - a.high, b.high - a.low});
  };
  bench.report.section("gather, added to the frame; error: from all texels");
  added("8 samples", bench.fullSlab(), gatherError(bench.site));
  added("8 samples, nothing transmitted", litFromTheFront(bench.fullSlab()), {});
}

std::vector<TimedError> diffusion(const Bench& bench) {
  bench.report.section("diffusion; error: from brute force");
  const std::vector<double> errors = diffusionErrors(bench.site);
  std::vector<TimedError> points;
  const std::vector<Variant> timed = diffusions(bench.site, bench.fullSlab());
  for (size_t i = 0; i < timed.size(); ++i)
    points.push_back({timed[i].name, errors[i], bench.row(timed[i], errors[i]).median});
  return points;
}

}  // namespace

PlanePlots measurePlanes(const Site& site, const std::set<std::string>& tables, const PlaneOptions& options,
                         int repeat, Report& report) {
  const auto [width, height] = options.size;
  const std::vector<Floor> floors = measureFloors(site.device, slab(width, height, 1, site.pixel), repeat);
  report.setFloor(floors.front().time.median);
  const Bench b{options, site, repeat, report};
  requireRightAnswer(b);
  report.section("floor");
  for (const Floor& floor : floors) report.add({floor.shape, 1, 0, 24, {}}, floor.time);
  const auto wanted = [&](const char* name) { return tables.count(name) > 0; };
  PlanePlots plots;
  plots.floor = floors.front().time.median;
  if (wanted("module")) modulePlans(b);
  if (wanted("fused")) fusedDispatch(b);
  if (wanted("gather")) gathered(b);
  if (wanted("diffusion")) plots.diffusion = {timeAgainstError(site.device.description(), diffusion(b))};
  return plots;
}

}  // namespace pellucid::bench
