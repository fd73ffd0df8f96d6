#include "thesis.h"

#include <cmath>
#include <cstdio>
#include <functional>
#include <numbers>
#include <vector>

#include "baselines/baselines.h"
#include "bench_frame.h"
#include "capture/material.h"
#include "common/error.h"
#include "gltf/gltf.h"
#include "measure.h"
#include "names.h"
#include "raster/draw.h"
#include "raster/framing.h"
#include "raster/passes.h"
#include "raster/rasterizer.h"
#include "raster/shadow.h"
#include "scene.h"
#include "scene/turn.h"
#include "scene/vector.h"
#include "shared/pellucid_shared.h"
#include "steps.h"
#include "turntable_shares.h"

namespace pellucid::bench {

using namespace harness;

namespace {

// The thesis turns the light faster than the head, and does not say how fast. In its table 5.1 a threshold of
// .005 leaves .59 of the cost of transmittance, and one of .01 .32: what a light does that turns once in 1000
// frames. The head turns once in 2500 here, so that both come round together.
constexpr int kFrames = 5000, kHeadTurns = 2, kLightTurns = 5;
constexpr int kTimed = 12, kTimedSoftware = 4;  // frames, evenly apart, whose passes are timed

// Mean microseconds of each pass; those of translucency average only the frames that have some.
struct Passes {
  double gbuffer = 0, shadow = 0, lighting = 0, diffusion = 0;
  double front = 0, back = 0, thickness = 0, transmittance = 0, both = 0, addition = 0;
  double backFace = 0;           // the back-face pass that computes what comes through
  double fused = 0;              // the module's one dispatch
  double module[3] = {0, 0, 0};  // its whole frames, by kSamples
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
  settings.normalFormat = VK_FORMAT_R8G8B8A8_SNORM;
  return settings;
}

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
    Passes mean;
    int withLight = 0;
    for (int i = 0; i < timed_; ++i) {
      setFrame(i * kFrames / timed_);
      addFrame(mean, withLight);
    }
    for (double* sum : {&mean.gbuffer, &mean.shadow, &mean.lighting, &mean.diffusion, &mean.front, &mean.back,
                        &mean.module[0], &mean.module[1], &mean.module[2]})
      *sum /= timed_;
    if (withLight == 0) throw DeviceError("no frame of the turntable has light that comes through");
    for (double* sum :
         {&mean.thickness, &mean.transmittance, &mean.both, &mean.addition, &mean.backFace, &mean.fused})
      *sum /= withLight;
    return mean;
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

  void addFrame(Passes& sum, int& withLight) {
    Capture capture = withMapsAlone(rasterizer_.draw(turned_, raster_)->capture());
    capture.albedo = {};
    const std::vector<PellucidMaterial> materials = compileMaterials(capture);
    const bool reversed = raster_.reversedZ;
    const DrawView view{capture.clipFromView, capture.viewFromWorld, reversed};
    TargetPool targets(device_);
    const FrontTarget front(targets, raster_);
    device_.run([&](VkCommandBuffer commands) { front.record(commands, rasterizer_.uploaded(), view); });
    sum.gbuffer +=
        draw(*front.target, view, {FragmentShader::Surface, VK_CULL_MODE_BACK_BIT, nearer(reversed), false});
    const RenderTarget depth(device_, raster_.width, raster_.height, depthColors(reversed),
                             farDepth(reversed));
    sum.front += draw(depth, view, {FragmentShader::Depth, VK_CULL_MODE_BACK_BIT, nearer(reversed), false});
    const EarlierPass behind{&front.depthNormal(), &front.albedoObject()};
    sum.back +=
        draw(depth, view, {FragmentShader::Depth, VK_CULL_MODE_FRONT_BIT, nearer(reversed), false}, behind);
    addLight(sum, view, front);

    ReplaySettings whole;
    whole.normalFormat = VK_FORMAT_R8G8B8A8_SNORM;
    const auto inputs = std::make_shared<InputImages>(device_, capture, whole);
    const auto frame = [&](const ReplaySettings& settings) {
      return std::make_shared<BenchFrame>(device_, context_, capture, materials, settings, inputs);
    };
    for (std::size_t i = 0; i < std::size(kSamples); ++i) {
      whole.translucency.gatherSamples = kSamples[i];
      sum.module[i] += time(moduleVariant(frame(whole), "").record);
    }
    const auto thesis = std::make_shared<BenchFrame>(device_, context_, capture, linear(materials),
                                                     translucencyAlone(), inputs);
    sum.diffusion += time(gaussianSum(thesis).record);
    if (!isNecessary()) return;
    ++withLight;
    addTranslucency(sum, thesis, view, front);
  }

  void addLight(Passes& sum, const DrawView& view, const FrontTarget& front) {
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
    sum.shadow += draw(map, lightView, {FragmentShader::Depth, VK_CULL_MODE_NONE, nearer(kReversed), false});
    const IrradiancePass pass(device_);
    GpuImage irradiance(device_, raster_.width, raster_.height, VK_FORMAT_R32G32B32A32_SFLOAT);
    irradiance.clear();
    const LitSurfaces surfaces{front.normalPlanar(), front.depthNormal(), irradiance, view};
    sum.lighting += time(
        [&](VkCommandBuffer commands) { pass.record(commands, surfaces, light, shadowsOf(drawn, raster_)); });
  }

  void addTranslucency(Passes& sum, const std::shared_ptr<const BenchFrame>& frame, const DrawView& view,
                       const FrontTarget& front) {
    requireAgreement(frame);
    const TranslucencySteps steps = translucencySteps(frame);
    sum.thickness += time(steps.thickness);
    sum.transmittance += time(steps.transmittance);
    sum.both += time(steps.both);
    sum.addition += time(steps.addition);
    sum.fused += time(moduleVariant(frame, "").record);
    const bool keepGreater = view.reversedDepth;
    const RenderTarget target(device_, raster_.width, raster_.height,
                              {{VK_FORMAT_R32G32B32A32_SFLOAT, clearTo(0)}}, farDepth(keepGreater));
    const auto constants = std::get<VkDescriptorBufferInfo>(frame->planned(PELLUCID_BINDING_FRAME)).buffer;
    const PlannedInputs planned{frame->run().plan(), frame->images(), constants};
    sum.backFace +=
        draw(target, view, {FragmentShader::Transmit, VK_CULL_MODE_FRONT_BIT, nearer(keepGreater), false},
             {&front.depthNormal(), &front.albedoObject(), &planned});
  }

  // The timed variants compute the same: the steps are held against the module's dispatch.
  void requireAgreement(const std::shared_ptr<const BenchFrame>& frame) const {
    constexpr double kTolerance = 5e-3;  // halves, and chords that are stored in between
    std::vector<Image> images;
    for (const Variant& variant : translucencyVariants(frame)) {
      device_.run(variant.record);
      images.push_back(variant.output());
    }
    const Image& module = images.back();
    for (std::size_t k = 0; k + 1 < images.size(); ++k) {
      double difference = 0, size = 0;
      for (std::size_t i = 0; i < module.data.size(); ++i) {
        const double value = module.data[i];
        // Pixels without a material are the steps' alone.
        if (value == 0) continue;
        difference += std::pow(static_cast<double>(images[k].data[i]) - value, 2);
        size += value * value;
      }
      if (!(difference <= kTolerance * kTolerance * size))
        throw DeviceError("the separate steps differ from the module's dispatch by " +
                          std::to_string(std::sqrt(difference / size)));
    }
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
  const double lit = p.gbuffer + p.shadow + p.lighting, diffused = lit + p.diffusion;
  const double depths = p.front + p.back, all = depths + p.thickness + p.transmittance;
  const double combined = depths + p.both, alternate = depths / 2 + p.both, add = p.addition;
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
      {"5.2", 2, "1 less the transmittance shader", diffused + depths + p.thickness, 239},
      {"5.2", 3, "2 less the thickness shader", diffused + depths, 258},
      {"5.2", 4, "3 less back depth", diffused + p.front, 278},
      {"5.2", 5, "3 less all depths", diffused, 304},
      {"5.3", 1, "baseline", lit, 540},
      {"5.3", 2, "1 + six Gaussians (Jimenez 2009)", diffused, 304},
      {"5.3", 3, "2 + transmittance", diffused + all + add, 217},
      {"5.3", 4, "3, thickness and transmittance in one", diffused + combined + add, 239},
      {"5.3", 5, "4 + depth maps on alternate frames", diffused + alternate + add, 261},
      {"5.3", 6, "4 + coherence .005", diffused + s.coherent[0] * combined + add, 265},
      {"5.3", 7, "all", diffused + s.both[0] * alternate + s.necessary * add, 296},
      {"more", 0, "2 + transmittance in the back-face pass", diffused + p.backFace + add, 0},
      {"more", 0, "2 + back depth, one dispatch of Pellucid", diffused + p.back + p.fused, 0},
      {"more", 0, "1 + " + nameOf(kSamples[0]), lit + p.module[0], 0},
      {"more", 0, "1 + " + nameOf(kSamples[1]), lit + p.module[1], 0},
      {"more", 0, "1 + " + nameOf(kSamples[2]), lit + p.module[2], 0},
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
  const std::pair<const char*, double> parts[] = {
      {"G-buffer", passes.gbuffer},        {"shadow map", passes.shadow},
      {"lighting", passes.lighting},       {"six Gaussians", passes.diffusion},
      {"front depth", passes.front},       {"back depth", passes.back},
      {"thickness", passes.thickness},     {"transmittance", passes.transmittance},
      {"both in one", passes.both},        {"addition", passes.addition},
      {"back-face pass", passes.backFace}, {"Pellucid's one dispatch", passes.fused}};
  for (const auto& [name, microseconds] : parts) {
    std::snprintf(text, sizeof text, "  %-34s %9.1f", name, microseconds);
    report.note(text);
    report.record({{"table", "passes"}, {"name", name}, {"us", microseconds}});
  }
  print(rowsOf(passes, shares), report);
}

}  // namespace pellucid::bench
