#include "sections.h"

#include <cmath>
#include <cstdio>
#include <functional>
#include <iterator>
#include <map>
#include <numbers>
#include <numeric>
#include <optional>
#include <vector>

#include "baselines/whole_frames.h"
#include "bench_frame.h"
#include "capture/material.h"
#include "common/error.h"
#include "gltf/gltf.h"
#include "kCombine.h"
#include "kLinearize.h"
#include "kThickness.h"
#include "kTransmittance.h"
#include "kTransmittanceOfThickness.h"
#include "measure.h"
#include "names.h"
#include "raster/draw.h"
#include "raster/framing.h"
#include "raster/passes.h"
#include "raster/rasterizer.h"
#include "raster/shadow.h"
#include "scene/turn.h"
#include "scene/vector.h"
#include "shared/pellucid_shared.h"

namespace pellucid::bench {

using namespace harness;

namespace {

// The thesis turns the light faster than the head, and does not say how fast. In its table 5.1 a threshold of
// .005 leaves .59 of the cost of transmittance, and one of .01 .32: what a light does that turns once in 1000
// frames. The head turns once in 2500 here, so that both come round together.
constexpr int kFrames = 5000, kHeadTurns = 2, kLightTurns = 5;
constexpr int kTimed = 12, kTimedSoftware = 4;  // frames, evenly apart, whose passes are timed

// Microseconds of each pass in the frames that have the pass.
class Passes {
public:
  void add(const std::string& name, double microseconds) {
    if (times_[name].empty()) names_.push_back(name);
    times_[name].push_back(microseconds);
  }
  const std::vector<std::string>& names() const { return names_; }
  double mean(const std::string& name) const {
    const auto found = times_.find(name);
    if (found == times_.end()) throw DeviceError("no frame of the turntable has the pass \"" + name + "\"");
    return std::accumulate(found->second.begin(), found->second.end(), 0.0) /
           static_cast<double>(found->second.size());
  }

private:
  std::map<std::string, std::vector<double>> times_;
  std::vector<std::string> names_;  // in the order of the first frame
};

struct Row {
  const char* table;
  int run;  // 0: not of the thesis
  std::string name;
  double microseconds;
  double thesisFps;  // 0: none
};

Light lightAt(const Bounds& bounds) {
  Light light;
  light.type = PELLUCID_LIGHT_POINT;
  const double distance = 3 * bounds.radius;
  light.position = fromGlm(toGlm(bounds.center) + glm::dvec3(0, 0.2 * distance, distance));
  light.intensity = distance * distance;
  return light;
}

// The thesis's translucency; the materials have its T(d) already.
ReplaySettings translucencyAlone() {
  ReplaySettings settings = thesisSettings();
  settings.features = PELLUCID_FEATURE_TRANSLUCENCY;
  settings.transmittance = TransmittanceChoice::Material;
  return settings;
}

constexpr VkDescriptorType kUniform = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
constexpr VkDescriptorType kBuffer = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
constexpr VkDescriptorType kRead = VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE;
constexpr VkDescriptorType kWrite = VK_DESCRIPTOR_TYPE_STORAGE_IMAGE;

// Translucency of camera-space thickness as separate dispatches, the way the thesis (4.7.2) first has it. The
// frame: device depths, back depth, at most one shadow image, translucency alone with 1.
class Steps {
public:
  explicit Steps(const std::shared_ptr<const BenchFrame>& frame)
      : frame_(frame),
        linearize_(frame->device(), kLinearize, {kUniform, kRead, kWrite}),
        thickness_(frame->device(), kThickness, {kUniform, kRead, kRead, kWrite}),
        transmittance_(frame->device(), kTransmittanceOfThickness, transmittanceTypes()),
        both_(frame->device(), kTransmittance, transmittanceTypes()),
        addition_(frame->device(), kCombine, {kUniform, kRead, kRead, kWrite}),
        front_(frame->image(VK_FORMAT_R32_SFLOAT)),
        back_(frame->image(VK_FORMAT_R32_SFLOAT)),
        chord_(frame->image(VK_FORMAT_R32_SFLOAT)),
        transmitted_(frame->image()),
        result_(frame->image()) {}

  // Planar distances, which a raster pass draws otherwise.
  void linearize(VkCommandBuffer commandBuffer) const {
    dispatch(commandBuffer, linearize_, {frame_->images().frontDepth, front_->use()});
    dispatch(commandBuffer, linearize_, {frame_->images().backDepth, back_->use()});
  }
  void thickness(VkCommandBuffer commandBuffer) const {
    dispatch(commandBuffer, thickness_, {front_->use(), back_->use(), chord_->use()});
  }
  void transmittance(VkCommandBuffer commandBuffer) const {
    transmit(commandBuffer, transmittance_, *chord_);
  }
  // Thickness and transmittance in one.
  void both(VkCommandBuffer commandBuffer) const { transmit(commandBuffer, both_, *back_); }
  void addition(VkCommandBuffer commandBuffer) const {
    dispatch(commandBuffer, addition_, {frame_->images().irradiance, transmitted_->use(), result_->use()});
  }

  using Step = void (Steps::*)(VkCommandBuffer) const;
  Image outputOf(const std::vector<Step>& steps) const {
    transmitted_->clear();
    frame_->device().run([&](VkCommandBuffer commandBuffer) {
      for (const Step step : steps) {
        (this->*step)(commandBuffer);
        computeBarrier(commandBuffer);
      }
    });
    return rgb(result_->download());
  }

private:
  static std::vector<VkDescriptorType> transmittanceTypes() {
    return {kUniform, kBuffer, kBuffer, kBuffer, kRead, kRead, kRead, kRead, kWrite};
  }
  void transmit(VkCommandBuffer commandBuffer, const ComputePass& pass, const GpuImage& chordOrBack) const {
    const PellucidFrame& f = frame_->images();
    dispatch(commandBuffer, pass,
             {frame_->planned(PELLUCID_BINDING_LIGHTS), frame_->planned(PELLUCID_BINDING_SHADOWS),
              frame_->planned(PELLUCID_BINDING_MATERIALS), front_->use(), chordOrBack.use(), f.material,
              frame_->planned(PELLUCID_BINDING_SHADOW_IMAGES), transmitted_->use()});
  }
  void dispatch(VkCommandBuffer commandBuffer, const ComputePass& pass,
                std::vector<Resource> resources) const {
    resources.insert(resources.begin(), frame_->planned(PELLUCID_BINDING_FRAME));
    pass.record(commandBuffer, frame_->width(), frame_->height(), resources,
                {frame_->run().plan().activeLights});
  }

  std::shared_ptr<const BenchFrame> frame_;
  ComputePass linearize_, thickness_, transmittance_, both_, addition_;
  std::shared_ptr<GpuImage> front_, back_, chord_, transmitted_, result_;
};

class ThesisBench {
public:
  ThesisBench(Device& device, const Context& context, const FrameOptions& options, int repeat)
      : device_(device),
        context_(context),
        repeat_(repeat),
        model_(loadGltf(options.models / "head_views.glb", {0.052, {{"*", "skin1"}}}).model),
        points_(pointsOf(model_)),
        light_(lightAt(points_.bounds)),
        rasterizer_(device, model_) {
    const bool software = device.properties().deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU;
    const auto [width, height] = options.sizes.empty()
                                     ? (software ? std::pair(256, 144) : std::pair(1280, 720))
                                     : options.sizes.front();
    raster_.width = width;
    raster_.height = height;
    raster_.shadowSize = options.shadowSize.value_or(software ? 256 : 1024);
    raster_.pointMaps = PointMaps::One;
    timed_ = software ? kTimedSoftware : kTimed;
    std::vector<double> turns;
    for (int i = 0; i < 36; ++i) turns.push_back(2 * std::numbers::pi * i / 36);
    camera_ = frameModel(model_, {0, 0, 1}, 0.5, static_cast<double>(width) / height, false, turns);
  }

  std::string title() const {
    return "tables of Whelan 2009: " + std::to_string(model_.indices.size() / 3) + " triangles, " +
           std::to_string(raster_.width) + "x" + std::to_string(raster_.height) +
           ", a point light, shadow map of " + std::to_string(raster_.shadowSize);
  }

  TurntableShares shares() {
    std::vector<TurntableFrame> frames;
    for (int k = 0; k < kFrames; ++k) {
      setFrame(k);
      frames.push_back({cosine(), isNecessary()});
    }
    return turntableShares(frames);
  }

  Passes passes() {
    Passes passes;
    for (int i = 0; i < timed_; ++i) {
      setFrame(i * kFrames / timed_);
      addFrame(passes);
    }
    return passes;
  }

private:
  // The head turns before a camera that stands still, which is a camera and a light that turn back.
  void setFrame(int k) {
    const double head = 2 * std::numbers::pi * kHeadTurns * k / kFrames;
    const double light = 2 * std::numbers::pi * kLightTurns * k / kFrames;
    turned_ = camera_;
    turned_.viewFromWorld = turnedView(camera_.viewFromWorld, points_.bounds.center, -head);
    model_.lights = {turnedLight(light_, points_.bounds.center, light - head)};
  }

  // Between the directions from the head to the eye and to the light.
  double cosine() const {
    const glm::dmat4 world = glm::inverse(toGlm(turned_.viewFromWorld));
    return glm::dot(glm::dvec3(world[2]),
                    glm::normalize(toGlm(model_.lights[0].position) - toGlm(points_.bounds.center)));
  }
  // The thesis's test, at the angle where its curves begin. The module's own asks whether light could come
  // through at any pixel, which a light beside the head always could.
  bool isNecessary() const { return cosine() < 0; }

  static std::vector<PellucidMaterial> linear(const std::vector<PellucidMaterial>& materials) {
    return withTransmittance(materials, TransmittanceChoice::Linear);
  }

  double time(const std::function<void(VkCommandBuffer)>& record) const {
    return measure(device_, repeat_, record).median;
  }
  double draw(const RenderTarget& target, const DrawView& view, const PipelineState& state,
              const EarlierPass& earlier = {}) const {
    const VkCullModeFlags doubleSided = state.cull & VK_CULL_MODE_FRONT_BIT;
    return time([&](VkCommandBuffer commandBuffer) {
      rasterizer_.uploaded().record(commandBuffer, target, view, state, doubleSided, earlier);
    });
  }

  void addFrame(Passes& passes) {
    Capture capture = withMapsAlone(rasterizer_.draw(turned_, raster_)->capture());
    capture.albedo = {};
    const std::vector<PellucidMaterial> materials = compileMaterials(capture);
    const bool reversed = raster_.reversedZ;
    const DrawView view{capture.clipFromView, capture.viewFromWorld, reversed};
    TargetPool targets(device_);
    const FrontTarget front(targets, raster_);
    device_.run([&](VkCommandBuffer commands) { front.record(commands, rasterizer_.uploaded(), view); });
    passes.add("G-buffer", draw(*front.target, view,
                                {FragmentShader::Surface, VK_CULL_MODE_BACK_BIT, nearer(reversed), false}));
    const RenderTarget depth(device_, raster_.width, raster_.height, depthColors(reversed),
                             farDepth(reversed));
    passes.add("front depth",
               draw(depth, view, {FragmentShader::Depth, VK_CULL_MODE_BACK_BIT, nearer(reversed), false}));
    const EarlierPass behind{&front.depthNormal(), &front.albedoObject()};
    passes.add(
        "back depth",
        draw(depth, view, {FragmentShader::Depth, VK_CULL_MODE_FRONT_BIT, nearer(reversed), false}, behind));
    addLight(passes, view, front);

    ReplaySettings whole;
    const auto inputs = std::make_shared<InputImages>(device_, capture, whole);
    const auto frame = [&](const ReplaySettings& settings) {
      return std::make_shared<BenchFrame>(device_, context_, capture, materials, settings, inputs);
    };
    for (std::size_t i = 0; i < std::size(kSamples); ++i) {
      whole.translucency.gatherSamples = kSamples[i];
      passes.add(nameOf(kSamples[i]), time(moduleVariant(frame(whole), "").record));
    }
    const auto thesis = std::make_shared<BenchFrame>(device_, context_, capture, linear(materials),
                                                     translucencyAlone(), inputs);
    passes.add("six Gaussians", time(gaussianSum(thesis).record));
    if (isNecessary()) addTranslucency(passes, thesis, view, front);
  }

  void addLight(Passes& passes, const DrawView& view, const FrontTarget& front) {
    const Light& light = model_.lights[0];
    TargetPool targets(device_);
    std::vector<DrawnMap> drawn;
    device_.run([&](VkCommandBuffer commands) {
      drawn =
          recordShadows(commands, targets, frameLight(points_, light, raster_.pointMaps, raster_.shadowSize),
                        rasterizer_.uploaded(), light, raster_);
    });
    if (drawn.size() != 1) throw DeviceError("the point light has no single shadow map");
    constexpr bool kReversed = true;
    const DrawView lightView{drawn[0].image.clipFromView, drawn[0].image.viewFromWorld, kReversed};
    const RenderTarget map(device_, raster_.shadowSize, raster_.shadowSize, depthColors(kReversed),
                           farDepth(kReversed));
    passes.add("shadow map",
               draw(map, lightView, {FragmentShader::Depth, VK_CULL_MODE_NONE, nearer(kReversed), false}));
    const IrradiancePass pass(device_);
    GpuImage irradiance(device_, raster_.width, raster_.height, VK_FORMAT_R32G32B32A32_SFLOAT);
    irradiance.clear();
    const LitSurfaces surfaces{front.normalPlanar(), front.depthNormal(), irradiance, view};
    passes.add("lighting", time([&](VkCommandBuffer commands) {
                 pass.record(commands, surfaces, light, shadowsOf(drawn, raster_));
               }));
  }

  void addTranslucency(Passes& passes, const std::shared_ptr<const BenchFrame>& frame, const DrawView& view,
                       const FrontTarget& front) {
    const Steps steps(frame);
    const Variant module = moduleVariant(frame, "");
    const Image right = outputOf(device_, module);
    requireAgreement(right, steps.outputOf({&Steps::linearize, &Steps::both, &Steps::addition}));
    requireAgreement(right, steps.outputOf({&Steps::linearize, &Steps::thickness, &Steps::transmittance,
                                            &Steps::addition}));
    const auto timeOf = [&](Steps::Step step) {
      return time([&](VkCommandBuffer commandBuffer) { (steps.*step)(commandBuffer); });
    };
    passes.add("thickness", timeOf(&Steps::thickness));
    passes.add("transmittance", timeOf(&Steps::transmittance));
    passes.add("both in one", timeOf(&Steps::both));
    passes.add("addition", timeOf(&Steps::addition));
    passes.add("Pellucid's one dispatch", time(module.record));
    const bool keepGreater = view.reversedDepth;
    const RenderTarget target(device_, raster_.width, raster_.height,
                              {{VK_FORMAT_R32G32B32A32_SFLOAT, clearTo(0)}}, farDepth(keepGreater));
    const auto constants = std::get<VkDescriptorBufferInfo>(frame->planned(PELLUCID_BINDING_FRAME)).buffer;
    const PlannedInputs planned{frame->run().plan(), frame->images(), constants};
    passes.add(
        "back-face pass",
        draw(target, view, {FragmentShader::Transmit, VK_CULL_MODE_FRONT_BIT, nearer(keepGreater), false},
             {&front.depthNormal(), &front.albedoObject(), &planned}));
  }

  static void requireAgreement(const Image& module, const Image& steps) {
    constexpr double kTolerance = 5e-3;  // halves, and chords that are stored in between
    double difference = 0, size = 0;
    for (std::size_t i = 0; i < module.data.size(); ++i) {
      const double value = module.data[i];
      if (value == 0) continue;  // pixels without a material are the steps' alone
      difference += std::pow(static_cast<double>(steps.data[i]) - value, 2);
      size += value * value;
    }
    if (!(difference <= kTolerance * kTolerance * size))
      throw DeviceError("the separate steps differ from the module's dispatch by " +
                        std::to_string(std::sqrt(difference / size)));
  }

  Device& device_;
  const Context& context_;
  int repeat_;
  Model model_;
  ModelPoints points_;
  Light light_;
  Rasterizer rasterizer_;
  RasterOptions raster_;
  int timed_ = 0;
  ModelCamera camera_, turned_;
};

std::vector<Row> rowsOf(const Passes& p, const TurntableShares& s) {
  const double lit = p.mean("G-buffer") + p.mean("shadow map") + p.mean("lighting");
  const double diffused = lit + p.mean("six Gaussians"), front = p.mean("front depth"),
               back = p.mean("back depth");
  const double depths = front + back, thickness = p.mean("thickness"), both = p.mean("both in one");
  const double all = depths + thickness + p.mean("transmittance");
  const double combined = depths + both, alternate = depths / 2 + both, add = p.mean("addition");
  return {
      {"5.1", 1, "baseline: shadow map, diffuse lighting", lit, 540},
      {"5.1", 2, "1 + six Gaussians (Jimenez 2009)", diffused, 304},
      {"5.1", 3, "2 + transmittance", diffused + all + add, 217},
      {"5.1", 4, "3, when necessary", diffused + s.necessary * (all + add), 248},
      {"5.1", 5, "3 + coherence .005", diffused + s.coherent[0] * all + add, 246},
      {"5.1", 6, "3 + coherence .01", diffused + s.coherent[1] * all + add, 269},
      {"5.1", 7, "4 + coherence .005", diffused + s.both[0] * all + s.necessary * add, 266},
      {"5.1", 8, "4 + coherence .01", diffused + s.both[1] * all + s.necessary * add, 282},
      {"5.2", 1, "all of transmittance", diffused + all + add, 222},
      {"5.2", 2, "1 less the transmittance shader", diffused + depths + thickness, 239},
      {"5.2", 3, "2 less the thickness shader", diffused + depths, 258},
      {"5.2", 4, "3 less back depth", diffused + front, 278},
      {"5.2", 5, "3 less all depths", diffused, 304},
      {"5.3", 1, "baseline", lit, 540},
      {"5.3", 2, "1 + six Gaussians (Jimenez 2009)", diffused, 304},
      {"5.3", 3, "2 + transmittance", diffused + all + add, 217},
      {"5.3", 4, "3, thickness and transmittance in one", diffused + combined + add, 239},
      {"5.3", 5, "4 + depth maps on alternate frames", diffused + alternate + add, 261},
      {"5.3", 6, "4 + coherence .005", diffused + s.coherent[0] * combined + add, 265},
      {"5.3", 7, "all", diffused + s.both[0] * alternate + s.necessary * add, 296},
      {"more", 0, "2 + transmittance in the back-face pass", diffused + p.mean("back-face pass") + add, 0},
      {"more", 0, "2 + back depth, one dispatch of Pellucid",
       diffused + back + p.mean("Pellucid's one dispatch"), 0},
      {"more", 0, "1 + " + nameOf(kSamples[0]), lit + p.mean(nameOf(kSamples[0])), 0},
      {"more", 0, "1 + " + nameOf(kSamples[1]), lit + p.mean(nameOf(kSamples[1])), 0},
      {"more", 0, "1 + " + nameOf(kSamples[2]), lit + p.mean(nameOf(kSamples[2])), 0},
  };
}

void print(const std::vector<Row>& rows, Report& report) {
  constexpr double kThesisDiffused = 304;
  const double diffused = rows[1].microseconds;
  char text[160];
  std::snprintf(text, sizeof text, "%-5s %-42s %9s %9s %9s %9s %9s", "table", "row", "us", "fps", "effect",
                "thesis", "effect");
  report.note(text);
  for (const Row& row : rows) {
    const double effect = row.microseconds / diffused - 1;
    std::snprintf(text, sizeof text, "%-5s %-42s %9.1f %9.0f %+8.1f%%", row.table,
                  ((row.run > 0 ? std::to_string(row.run) + " " : "") + row.name).c_str(), row.microseconds,
                  1e6 / row.microseconds, 100 * effect);
    std::string line = text;
    nlohmann::json json = {{"table", row.table},
                           {"run", row.run},
                           {"name", row.name},
                           {"us", row.microseconds},
                           {"effect", effect}};
    if (row.thesisFps > 0) {
      const double theirs = kThesisDiffused / row.thesisFps - 1;
      std::snprintf(text, sizeof text, " %9.0f %+8.1f%%", row.thesisFps, 100 * theirs);
      line += text;
      json["thesis_fps"] = row.thesisFps;
      json["thesis_effect"] = theirs;
    }
    report.note(line);
    report.record(json);
  }
}

}  // namespace

TurntableShares turntableShares(const std::vector<TurntableFrame>& frames) {
  TurntableShares shares;
  const double one = 1.0 / static_cast<double>(frames.size());
  for (const TurntableFrame& frame : frames) shares.necessary += frame.necessary ? one : 0;
  for (std::size_t i = 0; i < std::size(kCoherence); ++i) {
    // Frames without light that comes through keep nothing, so that the first one after them is computed.
    std::optional<double> kept, keptOfBoth;
    for (const TurntableFrame& frame : frames) {
      if (!kept || std::abs(frame.cosine - *kept) > kCoherence[i]) {
        shares.coherent[i] += one;
        kept = frame.cosine;
      }
      if (!frame.necessary) keptOfBoth.reset();
      if (frame.necessary && (!keptOfBoth || std::abs(frame.cosine - *keptOfBoth) > kCoherence[i])) {
        shares.both[i] += one;
        keptOfBoth = frame.cosine;
      }
    }
  }
  return shares;
}

void measureThesis(Device& device, const Context& context, const FrameOptions& options, int repeat,
                   Report& report) {
  if (options.models.empty())
    throw InputError("", "--tables thesis", "draws a model: --models FOLDER is required");
  ThesisBench bench(device, context, options, repeat);
  report.section(bench.title(), "thesis");
  const TurntableShares shares = bench.shares();
  char text[200];
  std::snprintf(
      text, sizeof text,
      "  of %d frames: %.3f with light that comes through; coherence .005 computes %.3f, .01 %.3f; with both "
      "%.3f and %.3f",
      kFrames, shares.necessary, shares.coherent[0], shares.coherent[1], shares.both[0], shares.both[1]);
  report.note(text);
  const Passes passes = bench.passes();
  for (const std::string& name : passes.names()) {
    const double microseconds = passes.mean(name);
    std::snprintf(text, sizeof text, "  %-34s %9.1f", name.c_str(), microseconds);
    report.note(text);
    report.record({{"table", "passes"}, {"name", name}, {"us", microseconds}});
  }
  print(rowsOf(passes, shares), report);
}

}  // namespace pellucid::bench
