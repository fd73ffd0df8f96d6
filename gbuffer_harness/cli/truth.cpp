// `pellucid truth`: a capture with its path-traced truth.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <span>
#include <string>
#include <type_traits>

#include "capture/material.h"
#include "capture/read.h"
#include "capture/write.h"
#include "cli/capture_options.h"
#include "cli/commands.h"
#include "cli/settings.h"
#include "common/compare.h"
#include "common/error.h"
#include "common/progress.h"
#include "common/whole_file.h"
#include "raster/bodies.h"
#include "raster/model.h"
#include "reference/path_tracer/emitters.h"
#include "reference/path_tracer/truth.h"
#include "scene/model.h"
#include "scene/render.h"
#include "scene/scene.h"

namespace pellucid::harness {

namespace {

// FNV-1a (Fowler, Noll & Vo) of the inputs, in order. Images that a device draws are left out, as their last
// bits depend on the device.
class SceneHash {
public:
  // Numbers, and ranges of numbers or of ranges.
  template <class... T>
  void add(const T&... values) {
    (addOne(values), ...);
  }
  void add(const Model& model);  // triangles and surfaces
  void add(const SceneParameters& parameters);
  void add(const reference::Emitters& emitters, const Capture& capture);  // of it size, camera, materials
  std::string text() const;                                               // 16 hexadecimal digits

private:
  template <class T>
  void addOne(const T& value) {
    if constexpr (std::is_enum_v<T>)
      addOne(static_cast<int>(value));
    else if constexpr (std::is_arithmetic_v<T>)
      for (const std::byte byte : std::as_bytes(std::span(&value, 1)))
        hash_ = (hash_ ^ static_cast<std::uint64_t>(byte)) * 0x100000001b3u;
    else
      for (const auto& item : value) addOne(item);
  }

  std::uint64_t hash_ = 0xcbf29ce484222325u;
};

void SceneHash::add(const Model& model) {
  for (const Vertex& vertex : model.vertices) {
    add(vertex.position, vertex.normal, vertex.uv, vertex.color, vertex.mark);
    if (vertex.alpha != 1) add(vertex.alpha);
  }
  add(model.indices);
  for (const Part& part : model.parts) add(part.firstIndex, part.indexCount, part.object, part.surface);
  for (const Surface& surface : model.surfaces) {
    add(surface.baseColor, surface.addedColor, surface.texture, surface.alphaCutoff, surface.doubleSided,
        surface.material);
    if (surface.lobeMap < 0 && surface.lobes == SurfaceLobes::Together) continue;
    add(surface.lobeMap, surface.displaced, surface.backscatter, surface.lobes);
  }
  for (const Texture& texture : model.textures) add(texture.rgba);
  add(model.metersPerUnit);
}

void SceneHash::add(const SceneParameters& parameters) {
  add(parameters.name);
  for (const auto& [name, number] : parameters.options) add(name, number);
  add(parameters.seed);
}

void SceneHash::add(const reference::Emitters& emitters, const Capture& capture) {
  for (const Light& light : emitters.lights) {
    // All fields, so that a new one comes here. Errors of tables are of files; the geometry stands for shadow
    // maps.
    const auto& [type, position, direction, color, intensity, range, radius, innerConeAngle, outerConeAngle,
                 angleTable, distanceTable, angleTableError, distanceTableError, shadowMaps] = light;
    add(type, position, direction, color, intensity, range, radius, innerConeAngle, outerConeAngle);
    if (!angleTable.empty()) add(std::string("angleTable"), angleTable);
    if (!distanceTable.empty()) add(std::string("distanceTable"), distanceTable);
  }
  if (emitters.harmonics) add(*emitters.harmonics);
  if (emitters.environment) add(emitters.environment->up, emitters.environment->down);
  add(capture.width, capture.height, capture.clipFromView, capture.viewFromWorld);
  for (const MaterialSource& source : capture.materials) {
    if (const auto* wall = std::get_if<ThinWallMaterial>(&source)) {
      add(wall->reflectance, wall->transmittance);
      continue;
    }
    const CoefficientMaterial material = coefficientsOf(source, capture.name + ": materials");
    add(material.scattering, material.absorption, material.g, material.ior);
  }
}

std::string SceneHash::text() const {
  char text[17];
  std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(hash_));
  return text;
}

using Clock = std::chrono::steady_clock;

struct Options {
  CaptureOptions scene;
  std::string output, like;
  std::uint64_t samples = 64, seed = 1;
  double seconds = 0;
  int jobs = 0;
  bool overwrite = false;
};

// The scene, seen twice: as a G-buffer, and as what rays meet.
struct Scene {
  Capture capture;
  std::unique_ptr<SceneModel> solids;  // that the traced scene refers to
  std::unique_ptr<reference::TraceScene> traced;
  reference::Emitters emitters;
  std::string hash;  // of everything that the truth depends on, but for samples and seed
};

void requireClosed(const Model& model) {
  for (const OpenObject& open : openObjects(model)) {
    const std::string where = "object " + std::to_string(open.object) + " (\"" + open.surface + "\")";
    if (open.looseEdges > 0)
      throw InputError(model.name, where,
                       std::to_string(open.looseEdges) +
                           " edges are not shared by two faces turned the same way; no light can be walked "
                           "through it");
    throw InputError(model.name, where,
                     "has " + std::to_string(open.holes) + (open.holes == 1 ? " hole" : " holes") +
                         "; --fill-holes closes them");
  }
}

// So that the model's coordinates are those of a capture whose unit has this length.
void scaleTo(double metersPerUnit, Model& model) {
  const auto scale = static_cast<float>(model.metersPerUnit / metersPerUnit);
  for (Vertex& vertex : model.vertices)
    for (float& x : vertex.position) x *= scale;
  model.metersPerUnit = metersPerUnit;
}

// A file that names no medium is all of the capture's, whose pixels say which.
void makeTranslucent(Model& model, bool close) {
  if (std::any_of(model.surfaces.begin(), model.surfaces.end(),
                  [](const Surface& surface) { return surface.material != 0; }))
    return;
  for (Surface& surface : model.surfaces) surface.material = 1;
  if (close) warn({"--fill-holes: " + std::to_string(fillHoles(model)) + " holes filled"});
}

Scene modelScene(const Options& options, SceneHash& hash) {
  CaptureModel model = captureModel(options.scene);
  if (options.like.empty()) {
    say(model);
    requireTranslucent(model);
  } else {
    makeTranslucent(model.model, options.scene.fillHoles);
  }
  requireClosed(model.model);
  for (const Surface& surface : model.model.surfaces) {
    if (surface.alphaCutoff > 0)
      warn({"surface \"" + surface.name + "\": the truth knows nothing of alpha and has no holes there"});
    if (surface.material != 0 && surface.normalMap >= 0)
      warn({"surface \"" + surface.name +
            "\": the truth's light falls on interpolated normals, the "
            "capture's on the normal map"});
  }
  if (std::any_of(model.model.vertices.begin(), model.model.vertices.end(),
                  [](const Vertex& vertex) { return vertex.mark < 0.5f; }))
    warn({"the truth's light enters where _TRANSLUCENT says that the surface is none, too"});
  Scene scene;
  if (!options.like.empty()) {
    scene.capture = readCapture(options.like);
    // The capture's bodies may have one number.
    if (scene.capture.materials.size() < model.model.materials.size() + model.model.bodies.size())
      joinBodies(model.model);
    scaleTo(scene.capture.metersPerUnit, model.model);
    hash.add(model.model);
    scene.traced = reference::makeMeshScene(model.model);
    return scene;
  }
  hash.add(model.model);
  Device device({options.scene.device, false});
  RasterResult result = rasterize(device, model.model, model.camera, model.raster);
  warn(result.warnings);
  scene.capture = std::move(result.capture);
  scene.traced = reference::makeMeshScene(model.model);
  return scene;
}

Scene proceduralScene(const Options& options, SceneHash& hash) {
  const SceneParameters parameters = procedural(options.scene);
  Scene scene;
  scene.solids = std::make_unique<SceneModel>(sceneModel(parameters));
  setIor(scene.solids->materials, options.scene);
  hash.add(parameters);
  scene.capture = options.like.empty() ? renderCapture(*scene.solids, parameters) : readCapture(options.like);
  if (scene.solids->materials.size() > scene.capture.materials.size())
    throw InputError(
        options.like, "materials",
        "has fewer than the " + std::to_string(scene.solids->materials.size()) + " of the scene");
  if (scene.capture.metersPerUnit != 0.001)
    throw InputError(options.like, "metersPerUnit", "is not 0.001: a procedural scene is in millimeters");
  scene.emitters.paint = scene.solids->paint;
  scene.traced = reference::makeSolidScene(*scene.solids);
  return scene;
}

// Light from all around of the capture that --like names, which its replay has.
void takeEnvironment(const std::string& like, Scene& scene) {
  const Capture& capture = scene.capture;
  const std::optional<Environment>& given = scene.emitters.environment;
  if (given && capture.environment) {
    const Harmonics harmonics = given->harmonics();
    for (std::size_t i = 0; i < harmonics.size(); ++i)
      for (std::size_t c = 0; c < 3; ++c)
        if (const double own = (*capture.environment)[i][c];
            std::abs(own - harmonics[i][c]) > 1e-4 * (1 + std::abs(own)))
          throw InputError(like, "environment", "is not that of --environment; leave the option out");
  }
  if (!given && capture.environment) scene.emitters.harmonics = capture.environment;
  if (!given && !capture.environment && !capture.hiddenIrradiance.empty())
    throw InputError(
        like, "hiddenIrradiance",
        "is of light that no ray finds: name the light by \"environment\", or leave the buffer out");
}

Scene makeScene(const Command& command, const Options& options) {
  SceneHash hash;
  Scene scene =
      isProcedural(command, options.scene) ? proceduralScene(options, hash) : modelScene(options, hash);
  scene.emitters.environment = environment(options.scene);
  if (options.like.empty())
    addTracedLight(scene.capture, *scene.traced, scene.emitters.environment);
  else
    takeEnvironment(options.like, scene);
  scene.emitters.lights = scene.capture.lights;
  for (Light& light : scene.emitters.lights) light.shadowMaps.clear();
  hash.add(scene.emitters, scene.capture);
  if (!options.like.empty())
    hash.add(scene.capture.material, scene.capture.hiddenIrradiance.data, scene.capture.albedo.data);
  scene.hash = hash.text();
  return scene;
}

// The samples in the file already; nothing when it is not there.
reference::TruthSums earlier(const Options& options, const Scene& scene) {
  if (options.overwrite || !std::filesystem::exists(options.output)) return {};
  const Capture old = readCapture(options.output);
  const auto refuse = [&](const std::string& why) {
    throw InputError(options.output, "truth", why + "; --overwrite begins anew");
  };
  if (!old.truth || old.truth->scene.empty() || old.truth->standardError.empty())
    refuse("the file has none that this command made");
  if (old.truth->scene != scene.hash) refuse("was made of another scene or with other options");
  if (old.truth->seed != options.seed)
    refuse("was made with --truth-seed " + std::to_string(old.truth->seed) + ", not " +
           std::to_string(options.seed));
  return reference::sumsOf(*old.truth);
}

std::string noiseText(const Truth& truth, const std::vector<std::uint8_t>& mask, int box) {
  char text[96];
  const std::vector<double> noise = relativeNoise(truth.image, truth.standardError, mask, box);
  if (noise.empty()) return "no block wholly of surface";
  std::snprintf(text, sizeof text, "%.2f %.2f %.2f %%", 100 * noise[0], 100 * noise[1], 100 * noise[2]);
  return text;
}

// Traces until `samples` more are there or the time is over, and writes the file now and then: what is
// killed goes on from there.
class Run {
public:
  Run(const Options& options, Scene& scene, reference::TruthSums sums)
      : options_(options), scene_(scene), sums_(std::move(sums)), begin_(Clock::now()), written_(begin_) {}

  void trace(const reference::TruthTracer& tracer) {
    const std::uint64_t first = sums_.samples;
    const bool timed = options_.seconds > 0;
    const auto rows = static_cast<std::uint64_t>(scene_.capture.height);
    Progress progress("tracing",
                      timed ? static_cast<std::uint64_t>(1000 * options_.seconds) : rows * options_.samples);
    std::uint64_t millisecondsShown = 0;
    while (timed ? seconds(begin_) < options_.seconds || sums_.samples == first
                 : sums_.samples - first < options_.samples) {
      const std::uint64_t left = options_.samples - (sums_.samples - first);
      const std::uint64_t count = timed ? kPass : std::min(kPass, left);
      tracer.trace(sums_, count, options_.seed, options_.jobs, [&] {
        if (!timed) progress.advance(count);
      });
      if (timed) {
        const auto now = static_cast<std::uint64_t>(1000 * seconds(begin_));
        progress.advance(now - millisecondsShown);
        millisecondsShown = now;
      }
      progress.note(noiseText(reference::truthOf(sums_), scene_.capture.material, 8) + " noise of 8x8");
      if (seconds(written_) > kWriteEvery) write();
    }
    write();
  }

  const reference::TruthSums& sums() const { return sums_; }
  double seconds() const { return seconds(begin_); }

private:
  static constexpr std::uint64_t kPass = 8;  // samples between looks at the clock
  static constexpr double kWriteEvery = 60;  // seconds

  static double seconds(Clock::time_point since) {
    return std::chrono::duration<double>(Clock::now() - since).count();
  }
  void write() {
    Truth truth = reference::truthOf(sums_);
    truth.seed = options_.seed;
    truth.scene = scene_.hash;
    scene_.capture.truth = std::move(truth);
    writeWhole(options_.output,
               [&](const auto& file) { writeCapture(scene_.capture, file, ColorFormat::Float); });
    written_ = Clock::now();
  }

  const Options& options_;
  Scene& scene_;
  reference::TruthSums sums_;
  Clock::time_point begin_, written_;
};

// Refuses options that a capture given by --like answers itself.
void refuseScene(const Command& command) {
  for (const char* name :
       {"--size", "--camera", "--view", "--fov", "--projection", "--light", "--ior", "--shadow-size",
        "--shadow-depth", "--jitter", "--depth", "--back", "--point-maps", "--infinite-far"})
    if (command.isGiven(name))
      throw UsageError(std::string(name) +
                       ": --like takes camera, size, lights and materials of the capture");
}

void truth(const Command& command, const Options& options) {
  if (options.output.empty()) throw UsageError("truth: -o is required");
  requireExr("-o", options.output);
  const std::filesystem::path folder = std::filesystem::absolute(options.output).parent_path();
  if (!std::filesystem::is_directory(folder))
    throw InputError(options.output, "", "cannot be written: there is no folder " + folder.string());
  if (!options.like.empty()) refuseScene(command);
  Scene scene = makeScene(command, options);
  const std::vector<reference::TraceMedium> media =
      reference::traceMedia(scene.capture.materials, scene.capture.name);
  reference::TruthSums sums = earlier(options, scene);
  const std::uint64_t before = sums.samples;
  const reference::VisibleSurface surface = reference::visibleSurface(scene.capture, *scene.traced);
  const auto pixels = static_cast<std::size_t>(std::count_if(surface.points.begin(), surface.points.end(),
                                                             [](const auto& p) { return p.has_value(); }));
  if (surface.missed > pixels)
    throw InputError(scene.capture.name, "camera",
                     "only " + std::to_string(pixels) + " of the " + std::to_string(pixels + surface.missed) +
                         " pixels with a material show the scene that is traced; is --unit right?");
  if (pixels == 0)
    throw InputError(scene.capture.name, "material", "no pixel has one: there is nothing to trace");
  if (surface.missed > 0)
    warn({std::to_string(surface.missed) + " pixels show a surface that no ray met; their truth is 0"});
  Run run(options, scene, std::move(sums));
  run.trace(reference::TruthTracer(scene.capture, surface, *scene.traced, media, scene.emitters));
  const std::uint64_t added = run.sums().samples - before;
  std::printf("%s: %zu pixels, %llu samples each, %.0f paths a second\n", options.output.c_str(), pixels,
              static_cast<unsigned long long>(run.sums().samples),
              static_cast<double>(added) * static_cast<double>(pixels) / run.seconds());
  for (const int box : {1, 4, 8})
    std::printf("noise of %dx%d averages, R G B: %s\n", box, box,
                noiseText(*scene.capture.truth, scene.capture.material, box).c_str());
}

}  // namespace

void addTruthCommand(const Command& app) {
  const auto options = std::make_shared<Options>();
  const Command command =
      app.subcommand("truth", "Path-trace a scene and write a capture that has this truth and its noise");
  command.option("-o,--output", options->output, "EXR to write; a file that is there gets more samples");
  const auto samples = command.option("--spp", options->samples, "samples to add to each pixel")
                           .range(2, 1 << 24);  // one sample says nothing of its noise
  command.option("--seconds", options->seconds, "add samples for this many seconds instead of --spp")
      .range(0.001, 1e7)
      .excludes(samples);
  command.option("--like", options->like,
                 "capture of this model or scene, made anywhere, whose camera, G-buffer, lights and "
                 "materials the output gets");
  command.option("--truth-seed", options->seed, "seed of the paths' random numbers");
  command.option("--jobs", options->jobs, "threads, on which the result does not depend; 0: all")
      .range(0, 4096);
  command.flag("--overwrite", options->overwrite, "begin anew where the output file is there");
  addCaptureOptions(command, options->scene);
  command.run([options, command] { truth(command, *options); });
}

}  // namespace pellucid::harness
