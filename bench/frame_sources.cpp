#include "frame_sources.h"

#include <algorithm>
#include <iterator>
#include <memory>
#include <optional>

#include "capture/read.h"
#include "common/error.h"
#include "gltf/gltf.h"
#include "raster/raster.h"
#include "scene/scene.h"

namespace pellucid::bench {

using namespace harness;

namespace {

constexpr std::pair<int, int> kSizes[] = {{1280, 720}, {1920, 1080}, {2560, 1440}, {3840, 2160}};
constexpr std::pair<int, int> kSoftwareSizes[] = {{256, 144}};
constexpr int kShadowSize = 2048, kSoftwareShadowSize = 512;

const std::string kNothing = "nothing";

bool isSoftware(const Device& device) {
  return device.properties().deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU;
}

int shadowSizeOf(const Device& device, const FrameOptions& options) {
  return options.shadowSize.value_or(isSoftware(device) ? kSoftwareShadowSize : kShadowSize);
}

// Nothing is a portrait without its material.
std::string drawnAs(const std::string& name) { return name == kNothing ? "portrait" : name; }

// No material anywhere, which only the image says.
Capture withoutMaterial(Capture capture) {
  std::fill(capture.material.begin(), capture.material.end(), std::uint8_t{0});
  return capture;
}

Capture named(Capture capture, const std::string& name) {
  capture.name = name;
  return capture;
}

// What lies beside a capture's file, or null.
std::shared_ptr<const Capture> turnedOf(const std::filesystem::path& file, const Capture& capture) {
  std::filesystem::path path = file;
  path.replace_extension(".turned" + file.extension().string());
  if (!std::filesystem::exists(path)) return nullptr;
  auto turned = std::make_shared<const Capture>(readCapture(path));
  if (turned->width != capture.width || turned->height != capture.height)
    throw InputError(path.string(), "size", "is not that of " + file.string());
  if (turned->material != capture.material)
    throw InputError(path.string(), "material",
                     "is not that of " + file.string() + ": lights alone may turn");
  return turned;
}

// A file of the folder under a key and a rim light.
Model litModel(const std::filesystem::path& folder, const std::string& file) {
  Model model = loadGltf(folder / file, {0.052, {{"*", "skin1"}}}).model;
  Light key, rim;
  key.direction = {0.6, -0.4, -0.7};
  rim.direction = {0.5, -0.2, 0.85};
  key.intensity = rim.intensity = 2;
  model.lights = {key, rim};
  return model;
}

constexpr const char* kHead = "head_views.glb";

// Throws InputError where the file lacks the camera.
const ModelCamera& cameraOf(const Model& model, const std::string& name) {
  const auto found = std::find_if(model.cameras.begin(), model.cameras.end(),
                                  [&](const ModelCamera& c) { return c.name == name; });
  if (found == model.cameras.end()) throw InputError(model.name, "cameras", "there is no \"" + name + "\"");
  return *found;
}

// Frames that the harness's rasterizer draws.
class DrawnFrames {
public:
  DrawnFrames(Device& device, const std::filesystem::path& models, int shadowSize)
      : device_(device), models_(models), shadowSize_(shadowSize) {}

  // Throws InputError where the files lack the frame.
  void load(const std::string& name) { cameraOf(modelOf(name), name); }

  Capture make(const std::string& name, int width, int height) {
    const RasterOptions raster{.width = width, .height = height, .shadowSize = shadowSize_};
    const Model& model = modelOf(name);
    return rasterize(device_, model, cameraOf(model, name), raster).capture;
  }

private:
  const Model& modelOf(const std::string& name) {
    const std::string file = name == "crowd" ? "crowd.glb" : kHead;
    const auto [entry, isNew] = loaded_.try_emplace(file);
    if (isNew) entry->second = litModel(models_, file);
    return entry->second;
  }

  Device& device_;
  std::filesystem::path models_;
  int shadowSize_;
  std::map<std::string, Model> loaded_;
};

// The procedural scene "head".
class StandIns {
public:
  explicit StandIns(int shadowSize) : shadowSize_(shadowSize) {}

  Capture make(const std::string& name, int width, int height) {
    const double view = static_cast<double>(std::find(std::begin(kFrameNames), std::end(kFrameNames), name) -
                                            std::begin(kFrameNames));
    SceneParameters p{.name = "head",
                      .width = width,
                      .height = height,
                      .options = {{"view", view}},
                      .reversedZ = true,
                      .depthEncoding = PELLUCID_DEPTH_DEVICE,
                      .shadowEncoding = PELLUCID_DEPTH_DEVICE};
    // Every view of one head has the same shadow maps, at any size, and casting them takes longer than the
    // image.
    std::vector<Light>& lights = lights_[name == "crowd"];
    p.shadowSize = lights.empty() ? shadowSize_ : 0;
    Capture capture = makeScene(p);
    if (lights.empty()) lights = capture.lights;
    capture.lights = lights;
    return capture;
  }

private:
  int shadowSize_;
  std::vector<Light> lights_[2];  // of one head; of a crowd
};

}  // namespace

Capture withMapsAlone(Capture capture) {
  for (Light& light : capture.lights)
    for (ShadowMap& map : light.shadowMaps) {
      map.exitDepth = {};
      map.casterMaterial.clear();
    }
  return capture;
}

std::vector<FrameSource> frameSources(Device& device, const FrameOptions& options) {
  std::vector<FrameSource> sources;
  for (const std::string& file : options.captures) {
    const std::filesystem::path path = std::filesystem::absolute(file);
    const std::string name =
        path.extension() == ".json" ? path.parent_path().filename().string() : path.stem().string();
    // Read at once: what is wrong with a file shows before a run of minutes.
    const auto capture = std::make_shared<const Capture>(named(readCapture(path), name));
    sources.push_back({name, [=] { return *capture; }, turnedOf(path, *capture)});
  }
  if (!options.captures.empty() && options.models.empty() && options.names.empty()) return sources;

  std::vector<std::pair<int, int>> sizes = options.sizes;
  const bool software = isSoftware(device);
  if (sizes.empty() && software) sizes.assign(std::begin(kSoftwareSizes), std::end(kSoftwareSizes));
  if (sizes.empty()) sizes.assign(std::begin(kSizes), std::end(kSizes));
  const int shadowSize = shadowSizeOf(device, options);
  std::vector<std::string> names;
  for (const std::string name : kFrameNames)
    if (options.names.empty() || std::count(options.names.begin(), options.names.end(), name) > 0)
      names.push_back(name);

  std::function<Capture(const std::string&, int, int)> made;
  if (options.models.empty()) {
    made = [all = std::make_shared<StandIns>(shadowSize)](const auto& name, int w, int h) {
      return all->make(name, w, h);
    };
  } else {
    const auto all = std::make_shared<DrawnFrames>(device, options.models, shadowSize);
    for (const std::string& name : names) all->load(drawnAs(name));
    made = [all](const auto& name, int w, int h) { return all->make(name, w, h); };
  }
  for (const auto& [width, height] : sizes)
    for (const std::string& name : names)
      sources.push_back({name,
                         [=, w = width, h = height] {
                           const Capture capture = withMapsAlone(made(drawnAs(name), w, h));
                           return named(name == kNothing ? withoutMaterial(capture) : capture, name);
                         },
                         nullptr});
  return sources;
}

DrawnModel portrait(Device& device, const FrameOptions& options, int size) {
  if (options.models.empty())
    throw InputError("--models", "", std::string("the table paths needs a folder of ") + kHead);
  DrawnModel drawn{litModel(options.models, kHead), {}, {}};
  drawn.camera = cameraOf(drawn.model, "portrait");
  drawn.raster.width = drawn.raster.height = size;
  drawn.raster.shadowSize = shadowSizeOf(device, options);
  return drawn;
}

}  // namespace pellucid::bench
