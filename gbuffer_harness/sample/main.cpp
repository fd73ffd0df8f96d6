// A small deferred renderer with Pellucid in it, in a window or without one.
#include <GLFW/glfw3.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <numbers>

#include "capture/write.h"
#include "common/error.h"
#include "common/png.h"
#include "sample/renderer.h"
#include "window/window.h"

using namespace pellucid::sample;

namespace {

struct Options {
  std::string output, capture, device;
  int frames = 0, width = 640, height = 640, mapTexels = 1024;
  double turn = 0, cell = 1.5;
  bool headless = false, validate = false;
  Settings settings;
};

struct Switch {
  const char* name;
  int key;
  bool Settings::*on;
};
constexpr Switch kSwitches[] = {{"pellucid", 'P', &Settings::pellucid},
                                {"sun", '1', &Settings::sun},
                                {"spots", '2', &Settings::spots},
                                {"point", '3', &Settings::point},
                                {"ambient", '4', &Settings::ambient},
                                {"specular", 'S', &Settings::specular},
                                {"taa", 'T', &Settings::taa}};

void addOptions(CLI::App& app, Options& o) {
  Settings& s = o.settings;
  const auto number = [&](const char* name, auto& value, auto low, auto high, const char* what) {
    app.add_option(name, value, what)->check(CLI::Range(low, high))->capture_default_str();
  };
  app.add_option("-o", o.output, "PNG of the last frame");
  app.add_option("--capture", o.capture, "EXR with manifest of the last frame, for pellucid replay");
  app.add_option("--device", o.device, "part of the Vulkan device's name; default: the fastest kind");
  app.add_option("--turn", o.turn, "degrees that the camera goes round by each frame");
  app.add_flag("--headless,--no-window", o.headless, "draws without a display");
  app.add_flag("--validate", o.validate, "with the Vulkan validation layers, whose messages are an error");
  number("--frames", o.frames, 0, 1000000, "0: until the window is closed, without one 8");
  number("--width", o.width, 1, 8192, "pixels");
  number("--height", o.height, 1, 8192, "pixels");
  number("--shadow-size", o.mapTexels, 16, 4096, "texels across a shadow map");
  number("--cell", o.cell, 1.0, 20.0, "mm between vertices of the head");
  number("--gather", s.gatherSamples, 0, 64, "samples of Pellucid's gather, a multiple of 4; 0: no gather");
  number("--scale", s.scale, 0.1, 1.0, "rendered pixels per pixel of the picture along each side");
  number("--exposure", s.exposure, 1e-6, 1e6, "factor");
  number("--bias", s.biasConstant, 0.0, 1000.0, "constant depth bias of the shadow maps");
  number("--slope-bias", s.biasSlope, 0.0, 1000.0, "slope factor of the same");
  const auto queue = [&s](const std::string& name) { s.ownQueue = name == "compute"; };
  app.add_option_function<std::string>("--queue", queue,
                                       "of Pellucid: graphics (default), or compute, its own")
      ->check(CLI::IsMember({"graphics", "compute"}));
  app.add_flag("--cull-fronts", s.cullFronts, "the spots' shadow maps hold back faces");
  app.add_flag("--fronts", s.fronts, "with --cull-fronts: further maps of front faces, which Pellucid reads");
  for (const Switch& option : kSwitches)
    app.add_flag(std::string("--") + option.name + ",!--no-" + option.name, s.*option.on, "on by default");
  std::map<std::string, Mistake> mistakes;
  for (std::size_t i = 0; i < kMistakes.size(); ++i) mistakes[kMistakes[i]] = static_cast<Mistake>(i);
  app.add_option("--mistake", s.mistake, "gets one thing wrong")
      ->transform(CLI::CheckedTransformer(mistakes));
}

// Keys that were pressed since the frame before switch; keys that are held move.
void handleKeys(GLFWwindow* window, Settings& settings, ViewCamera& camera) {
  static std::map<int, bool> before;
  const auto held = [&](int key) { return glfwGetKey(window, key) == GLFW_PRESS; };
  const auto pressed = [&](int key) { return held(key) && !std::exchange(before[key], true); };
  for (auto& [key, was] : before) was = was && held(key);
  for (const Switch& option : kSwitches)
    if (pressed(option.key)) settings.*option.on = !(settings.*option.on);
  if (pressed('F')) settings.cullFronts = !settings.cullFronts;
  if (pressed('R')) settings.scale = settings.scale > 0.5 ? settings.scale - 0.25 : 1;
  const auto step = [&](int less, int more) { return 0.03 * (held(more) - held(less)); };
  orbit(camera, step(GLFW_KEY_LEFT, GLFW_KEY_RIGHT), step(GLFW_KEY_DOWN, GLFW_KEY_UP));
  zoom(camera, 1 + step(GLFW_KEY_PAGE_UP, GLFW_KEY_PAGE_DOWN));
}

void run(Options o) {
  Scene scene = headScene(o.cell, o.mapTexels);
  DeviceOptions wanted{o.device, o.validate};
  wanted.computeQueue = o.settings.ownQueue;
  wanted.pushes = true;  // frames in flight have no pools of their own
  std::optional<Desktop> desktop;
  if (!o.headless) desktop.emplace().require(wanted);
  Device device(wanted);
  Renderer renderer(device, scene,
                    {static_cast<std::uint32_t>(o.width), static_cast<std::uint32_t>(o.height)},
                    static_cast<std::uint32_t>(o.mapTexels));
  std::optional<Window> window;
  if (desktop) window.emplace(*desktop, device, "Pellucid sample: P switches Pellucid", o.width, o.height);
  if (o.headless && o.frames == 0) o.frames = 8;
  int frames = 0;
  for (; (o.frames == 0 || frames < o.frames) && !(window && window->shouldClose()); ++frames) {
    if (window) {
      window->events(false);
      handleKeys(window->handle(), o.settings, scene.camera);
      int width = 0, height = 0;
      window->size(width, height);
      if (width > 0 && height > 0 && (width != o.width || height != o.height))
        renderer.resize({static_cast<std::uint32_t>(o.width = width),
                         static_cast<std::uint32_t>(o.height = height)});
    }
    orbit(scene.camera, o.turn * std::numbers::pi / 180, 0);
    fitRange(scene.camera, scene.bounds.center, scene.bounds.radius);
    renderer.draw(o.settings, scene.camera);
    if (window) window->present(renderer.picture(), o.width, o.height);
  }
  if (!o.output.empty()) savePicture(o.output, renderer.picture().download());
  if (!o.capture.empty()) writeCapture(renderer.capture(), o.capture);
  const std::vector<std::string> messages = device.validationMessages();
  if (!messages.empty()) throw DeviceError("validation: " + messages.front());
  std::printf("%s\n%d frames\n", device.description().c_str(), frames);
  if (o.settings.ownQueue && device.computeQueue() == device.queue())
    std::printf("the device has one queue: Pellucid had submissions of its own on it\n");
  else if (o.settings.ownQueue)
    std::printf("Pellucid ran on a queue of family %u, drawing on one of family %u\n", device.computeFamily(),
                device.queueFamily());
  for (const std::string& file : {o.output, o.capture})
    if (!file.empty()) std::printf("wrote %s\n", file.c_str());
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("A deferred renderer with Pellucid in it.", "pellucid_sample");
  app.footer(
      "Keys: P Pellucid, 1 sun, 2 spots, 3 point, 4 ambient, S specular, T antialiasing, F culled fronts, "
      "R resolution, arrows and page keys: camera.\nExit codes: 0 ok, 2 usage, 3 bad input, 4 no usable "
      "device.");
  Options options;
  addOptions(app, options);
  try {
    app.parse(argc, argv);
    run(options);
    return 0;
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "pellucid_sample: %s\n", error.what());
    if (dynamic_cast<const UsageError*>(&error)) return 2;
    return dynamic_cast<const DeviceError*>(&error) ? 4 : 3;
  }
}
