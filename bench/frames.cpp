#include "sections.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <random>
#include <utility>

#include "baselines/whole_frames.h"
#include "bench_frame.h"
#include "capture/material.h"
#include "common/error.h"
#include "frame_errors.h"
#include "kFloor.h"
#include "measure.h"
#include "names.h"

namespace pellucid::bench {

using namespace harness;

namespace {

static_assert(kSamples[1] == kDefaultGatherSamples);

constexpr double kWrong = 0.5;  // relative RMSE of a diffusion that is not worth timing

// Microseconds.
template <class Call>
double hostTime(const Call& call) {
  const auto start = std::chrono::steady_clock::now();
  call();
  return std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - start).count();
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// The floor: microseconds of one pass over two depths, an irradiance and an output of this size, in the
// fastest of several workgroup shapes. The images hold noise, which no device compresses. Throws DeviceError
// when a pass wrote something else than its inputs say: a floor that skips work would be no floor.
double measureFloor(Device& device, int width, int height, int repeat) {
  struct Shape {
    uint32_t width, height, pixels;  // of a group in threads; pixels of each thread
  };
  constexpr Shape kShapes[] = {{8, 8, 1}, {16, 16, 1}, {32, 8, 1}, {8, 8, 2}, {16, 16, 2}, {32, 8, 2}};
  constexpr float kRounding = 4e-3f;  // of halves up to 4, twice: of the irradiance and of the sum
  constexpr VkDescriptorType kRead = VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE;
  std::mt19937 random(1);
  const auto noise = [&](int channels, float least, float most) {
    Image image(width, height, channels);
    for (float& value : image.data) value = least + (most - least) * static_cast<float>(random()) * 0x1p-32f;
    return image;
  };
  const Image near = noise(1, 0.5f, 0.6f), far = noise(1, 0.6f, 0.7f), light = noise(3, 0.0f, 2.0f);
  GpuImage front(device, width, height, VK_FORMAT_R32_SFLOAT),
      back(device, width, height, VK_FORMAT_R32_SFLOAT);
  GpuImage irradiance(device, width, height, VK_FORMAT_R16G16B16A16_SFLOAT);
  GpuImage result(device, width, height, VK_FORMAT_R16G16B16A16_SFLOAT);
  front.upload(near);
  back.upload(far);
  irradiance.upload(light);
  Image right = light;
  for (size_t i = 0; i < right.data.size(); ++i) right.data[i] += far.data[i / 3] - near.data[i / 3];
  double fastest = INFINITY;
  for (const Shape& s : kShapes) {
    const ComputePass pass(device, kFloor, {kRead, kRead, kRead, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE},
                           {s.width * s.pixels, s.height, {s.width, s.height, s.pixels}});
    result.clear();
    const Time time = measure(device, repeat, [&](VkCommandBuffer commandBuffer) {
      pass.record(commandBuffer, width, height, {front.use(), back.use(), irradiance.use(), result.use()});
    });
    fastest = std::min(fastest, time.median);
    const Image written = rgb(result.download());
    if (!std::equal(written.data.begin(), written.data.end(), right.data.begin(), right.data.end(),
                    [](float a, float b) { return std::abs(a - b) < kRounding; }))
      throw DeviceError("the floor pass wrote something else than its inputs say");
  }
  return fastest;
}

// One frame at one size.
class FrameBench {
public:
  FrameBench(Device& device, const Context& context, const FrameOptions& options, int repeat,
             const FrameSource& source, Report& report)
      : device_(device),
        context_(context),
        repeat_(repeat),
        capture_(source.make()),
        turned_(source.turned),
        materials_(compileMaterials(capture_)),
        truth_(diffusionTruth(capture_, materials_, options.errorPixels)),
        report_(report) {
    // Every frame would multiply by it once; the errors do.
    withoutAlbedo_ = capture_;
    withoutAlbedo_.albedo = {};
    inputs_ = std::make_shared<InputImages>(device, withoutAlbedo_, ReplaySettings());
    why_ = whyNotRendered(capture_, materials_);
    if (!why_.empty()) return;
    others_ = std::make_shared<BenchFrame>(device, context, withoutAlbedo_, materials_,
                                           transmittanceSettings(), inputs_, normalsOf(device, capture_));
    diffusionsOfOthers_ = baselines(others_);
  }

  std::string size() const { return std::to_string(capture_.width) + "x" + std::to_string(capture_.height); }
  const Capture& capture() const { return capture_; }

  // Rows of everything.
  void run(double floor) {
    head(floor);
    // Downloads leave the device idle: errors first, then times without a gap.
    measureErrors();
    wholeFramesOfModule();
    parts();
    if (why_.empty())
      wholeFramesOfOthers();
    else
      report_.note("  others are left out: " + why_);
  }

private:
  std::shared_ptr<const BenchFrame> frame(const ReplaySettings& settings) const {
    return std::make_shared<BenchFrame>(device_, context_, withoutAlbedo_, materials_, settings, inputs_);
  }
  static ReplaySettings alone(PellucidFeatureBits feature) {
    ReplaySettings s;
    s.features = feature;
    return s;
  }

  void head(double floor) {
    const size_t covered =
        capture_.material.size() -
        static_cast<size_t>(std::count(capture_.material.begin(), capture_.material.end(), 0));
    const double share = static_cast<double>(covered) / static_cast<double>(capture_.material.size());
    char text[160];
    std::snprintf(text, sizeof text, "%s, %s, %.3f covered, floor %.1f us", capture_.name.c_str(),
                  size().c_str(), share, floor);
    report_.section(text, "frames");
    if (!truth_.pixels.empty())
      report_.note("  error: of the diffusion, from brute force at " + std::to_string(truth_.pixels.size()) +
                   " pixels");
    report_.record({{"frame", capture_.name},
                    {"size", size()},
                    {"kind", "frame"},
                    {"name", "frame"},
                    {"covered", share},
                    {"lights", capture_.lights.size()},
                    {"error_pixels", truth_.pixels.size()},
                    {"floor_us", floor}});
  }

  void measureErrors() {
    const auto add = [&](const Variant& v) {
      if (truth_.pixels.empty()) return;
      errors_[v.name] = diffusionErrors(outputOf(device_, v), truth_);
      if (!(rootMeanSquare(errors_[v.name]) < kWrong))
        throw DeviceError(v.name + " does not diffuse " + capture_.name);
    };
    add(moduleVariant(frame(alone(PELLUCID_FEATURE_DIFFUSION)), kModule));
    for (const Variant& v : diffusionsOfOthers_) add(v);
  }

  void row(const std::string& kind, const Variant& v, const std::string& diffusion) {
    add(kind, v, measure(device_, repeat_, v.record), diffusion);
  }

  // `diffusion`: the variant whose error the row has; empty: none. Whole images are compared with the
  // capture's truth.
  void add(const std::string& kind, const Variant& v, const Time& time, const std::string& diffusion,
           nlohmann::json more = nlohmann::json::object()) {
    more.update({{"frame", capture_.name}, {"size", size()}, {"kind", kind}});
    std::optional<double> error;
    if (const auto found = errors_.find(diffusion); found != errors_.end()) {
      error = rootMeanSquare(found->second);
      more["relative_rmse_rgb"] = found->second;
    }
    if (kind == "whole" && capture_.truth) more.update(errorFields(outputOf(device_, v), capture_));
    report_.add({v.name, v.dispatches, v.barriers, v.transientBytes, error, more}, time);
  }

  nlohmann::json hostTimes(const BenchFrame& f, std::vector<double> recordings) const {
    constexpr int kCalls = 101;
    const auto plan = std::make_unique<PellucidPlan>();
    std::vector<double> plans, constants;
    for (int i = 0; i < kCalls; ++i) {
      plans.push_back(hostTime([&] { pellucidBuildPlan(&f.images(), nullptr, plan.get()); }));
      constants.push_back(hostTime([&] { f.writeConstants(); }));
    }
    return {{"cpu_plan_us", median(std::move(plans))},
            {"cpu_constants_us", median(std::move(constants))},
            {"cpu_record_us", median(std::move(recordings))}};
  }

  void dispatches(const BenchFrame& f, const std::string& whole) {
    const PellucidPlan& plan = f.run().plan();
    if (plan.dispatchCount == 0) return;
    const std::vector<Time> times =
        measureParts(device_, repeat_, plan.dispatchCount,
                     [&](VkCommandBuffer commandBuffer, uint32_t i) { f.run().record(commandBuffer, i); });
    for (uint32_t i = 0; i < plan.dispatchCount; ++i) {
      const PellucidDispatch& d = plan.dispatches[i];
      report_.add({"  " + std::to_string(i) + " " + d.name,
                   1,
                   d.barrierBefore,
                   0,
                   {},
                   {{"frame", capture_.name}, {"size", size()}, {"kind", "dispatch"}, {"of", whole}}},
                  times[i]);
    }
  }

  nlohmann::json flickerOf(const Variant& still, const ReplaySettings& settings) const {
    Capture linear = *turned_;
    linear.albedo = {};
    const Variant turned = moduleVariant(
        std::make_shared<BenchFrame>(device_, context_, linear, materials_, settings), still.name);
    const Image before = outputOf(device_, still);
    return flickerFields(before, outputOf(device_, turned), capture_, *turned_);
  }

  void wholeFrame(uint32_t samples) {
    ReplaySettings whole;
    whole.translucency.gatherSamples = samples;
    const auto f = frame(whole);
    const Variant v = moduleVariant(f, nameOf(samples));
    std::vector<double> recordings;
    const Time time = measure(device_, repeat_, [&](VkCommandBuffer commandBuffer) {
      recordings.push_back(hostTime([&] { v.record(commandBuffer); }));
    });
    const nlohmann::json host = hostTimes(*f, std::move(recordings));
    nlohmann::json more = host;
    if (turned_) more.update(flickerOf(v, whole));
    add("whole", v, time, kModule, more);
    char text[160];
    std::snprintf(text, sizeof text, "    CPU: plan %.1f us, constants %.1f us, record %.1f us",
                  host["cpu_plan_us"].get<double>(), host["cpu_constants_us"].get<double>(),
                  host["cpu_record_us"].get<double>());
    report_.note(text);
    dispatches(*f, v.name);
  }

  void wholeFramesOfModule() {
    for (const uint32_t samples : kSamples) wholeFrame(samples);
  }

  // Translucency and diffusion alone.
  void parts() {
    report_.note("  translucency alone");
    row("translucency", moduleVariant(frame(alone(PELLUCID_FEATURE_TRANSLUCENCY)), kModule), "");
    if (why_.empty()) {
      row("translucency", gaussianTransmittance(others_).variant, "");
      row("translucency", burleyTransmittance(others_).variant, "");
    }
    report_.note("  diffusion alone");
    row("diffusion", moduleVariant(frame(alone(PELLUCID_FEATURE_DIFFUSION)), kModule), kModule);
    for (const Variant& v : diffusionsOfOthers_) row("diffusion", v, v.name);
  }

  void wholeFramesOfOthers() {
    report_.note("  whole frames of others");
    for (const WholeFrame& w : wholeFrames(others_)) row("whole", w.variant, w.diffusion);
  }

  Device& device_;
  const Context& context_;
  int repeat_;
  Capture capture_, withoutAlbedo_;
  std::shared_ptr<const Capture> turned_;  // null: nothing is known of turned lights
  std::vector<PellucidMaterial> materials_;
  DiffusionTruth truth_;
  Report& report_;
  std::shared_ptr<const InputImages> inputs_;
  std::string why_;
  std::shared_ptr<const BenchFrame> others_;
  std::vector<Variant> diffusionsOfOthers_;
  std::map<std::string, ChannelErrors> errors_;  // of diffusions, by name
};

}  // namespace

void measureFrames(Device& device, const Context& context, const std::vector<FrameSource>& sources,
                   const FrameOptions& options, int repeat, Report& report) {
  requireRightTransmittance(device, context, compileMaterial(PresetMaterial{"skin1"}, "skin1"));
  std::map<std::string, double> floors;  // by size
  for (const FrameSource& source : sources) {
    FrameBench bench(device, context, options, repeat, source, report);
    const auto [floor, isNew] = floors.try_emplace(bench.size());
    if (isNew) floor->second = measureFloor(device, bench.capture().width, bench.capture().height, repeat);
    report.setFloor(floor->second);
    bench.run(floor->second);
  }
}

}  // namespace pellucid::bench
