// A small deferred renderer with Pellucid in it, in a window or without one.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <optional>

#include "capture/write.h"
#include "common/png.h"
#include "sample/renderer.h"
#ifdef PELLUCID_SAMPLE_HAS_WINDOW
#include <GLFW/glfw3.h>

#include "view/window.h"
#endif

using namespace pellucid::sample;

namespace {

struct Options {
  std::string file, output, capture, device;
  std::vector<std::string> materials, off;
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

std::map<std::string, std::string> presets(const std::vector<std::string>& given) {
  std::map<std::string, std::string> result;
  for (const std::string& option : given) {
    const std::size_t equals = option.find('=');
    if (equals == std::string::npos || equals == 0)
      throw UsageError("--material: \"" + option + "\" is not NAME=PRESET");
    result[option.substr(0, equals)] = option.substr(equals + 1);
  }
  return result;
}

void addOptions(CLI::App& app, Options& o) {
  Settings& s = o.settings;
  app.add_option("scene", o.file, "glTF file (.glb, .gltf); default: a procedural head")
      ->check(CLI::ExistingFile);
  app.add_option("--material", o.materials, "NAME=PRESET of a file's material, *=PRESET of all others");
  app.add_flag("--headless,--no-window", o.headless, "draws --frames frames without a display");
  app.add_option("--frames", o.frames, "after which it ends; default: when the window is closed, headless 8")
      ->check(CLI::Range(1, 1000000));
  app.add_option("-o", o.output, "PNG of the last frame");
  app.add_option("--capture", o.capture, "EXR with manifest of the last frame, for pellucid replay");
  app.add_option("--width", o.width, "pixels")->check(CLI::Range(1, 8192))->capture_default_str();
  app.add_option("--height", o.height, "pixels")->check(CLI::Range(1, 8192))->capture_default_str();
  app.add_option("--shadow-size", o.mapTexels, "texels across a shadow map")
      ->check(CLI::Range(16, 4096))
      ->capture_default_str();
  app.add_option("--turn", o.turn, "degrees that the camera goes round by each frame");
  app.add_option("--cell", o.cell, "mm between vertices of the procedural head")
      ->check(CLI::Range(1.0, 20.0))
      ->capture_default_str();
  for (const Switch& option : kSwitches)
    app.add_flag(std::string("--") + option.name + ",!--no-" + option.name, s.*option.on, "on by default");
  app.add_option("--quality", s.quality, "of Pellucid")->check(CLI::Range(0, 2))->capture_default_str();
  app.add_option("--scale", s.scale, "rendered pixels per pixel of the picture")
      ->check(CLI::Range(0.1, 1.0))
      ->capture_default_str();
  app.add_option("--exposure", s.exposure, "factor")->check(CLI::PositiveNumber)->capture_default_str();
  app.add_flag("--cull-fronts", s.cullFronts, "the spots' shadow maps hold back faces");
  app.add_option("--bias", s.biasConstant, "constant depth bias of the spots' shadow maps")
      ->check(CLI::Range(0.0, 1000.0));
  app.add_option("--slope-bias", s.biasSlope, "slope factor of their depth bias")
      ->check(CLI::Range(0.0, 1000.0));
  std::map<std::string, Mistake> mistakes;
  for (std::size_t i = 0; i < kMistakeNames.size(); ++i) mistakes[kMistakeNames[i]] = static_cast<Mistake>(i);
  app.add_option("--mistake", s.mistake, "an integration that gets this wrong")
      ->transform(CLI::CheckedTransformer(mistakes))
      ->option_text("NAME");
  app.add_option("--device", o.device, "part of the Vulkan device's name; default: the fastest kind");
  app.add_flag("--validate", o.validate, "with the Vulkan validation layers, whose messages are an error");
}

#ifdef PELLUCID_SAMPLE_HAS_WINDOW
// A press since the call before.
bool pressed(GLFWwindow* window, int key) {
  static std::map<int, bool> held;
  const bool now = glfwGetKey(window, key) == GLFW_PRESS, before = std::exchange(held[key], now);
  return now && !before;
}

void handleKeys(GLFWwindow* window, Settings& settings, ViewCamera& camera) {
  for (const Switch& option : kSwitches)
    if (pressed(window, option.key)) settings.*option.on = !(settings.*option.on);
  if (pressed(window, 'F')) settings.cullFronts = !settings.cullFronts;
  if (pressed(window, 'R')) settings.scale = settings.scale > 0.5 ? settings.scale - 0.25 : 1;
  const auto held = [&](int key) { return glfwGetKey(window, key) == GLFW_PRESS ? 0.03 : 0.0; };
  orbit(camera, held(GLFW_KEY_RIGHT) - held(GLFW_KEY_LEFT), held(GLFW_KEY_UP) - held(GLFW_KEY_DOWN));
  zoom(camera, 1 + held(GLFW_KEY_PAGE_DOWN) - held(GLFW_KEY_PAGE_UP));
}
#endif

void run(Options o) {
  Scene scene =
      o.file.empty() ? headScene(o.cell, o.mapTexels) : fileScene(o.file, presets(o.materials), o.mapTexels);
  for (const std::string& note : scene.notes) std::fprintf(stderr, "%s\n", note.c_str());
  DeviceOptions wanted{o.device, o.validate};
#ifdef PELLUCID_SAMPLE_HAS_WINDOW
  std::optional<Desktop> desktop;
  if (!o.headless) desktop.emplace().require(wanted);
#else
  if (!o.headless)
    throw UsageError("this build has no window, as libglfw3-dev was missing; --headless needs none");
#endif
  Device device(wanted);
  std::printf("%s\n", device.description().c_str());
  Renderer renderer(device, scene,
                    {static_cast<std::uint32_t>(o.width), static_cast<std::uint32_t>(o.height)},
                    static_cast<std::uint32_t>(o.mapTexels));
#ifdef PELLUCID_SAMPLE_HAS_WINDOW
  std::optional<Window> window;
  if (desktop) window.emplace(*desktop, device, "Pellucid sample: P switches it", o.width, o.height);
#endif
  if (o.headless && o.frames == 0) o.frames = 8;
  int frames = 0;
  for (; o.frames == 0 || frames < o.frames; ++frames) {
#ifdef PELLUCID_SAMPLE_HAS_WINDOW
    if (window) {
      window->events(false);
      if (window->shouldClose()) break;
      handleKeys(window->handle(), o.settings, scene.camera);
    }
#endif
    orbit(scene.camera, o.turn * 3.14159265 / 180, 0);
    fitRange(scene.camera, scene.bounds.center, scene.bounds.radius);
    renderer.draw(o.settings, scene.camera);
#ifdef PELLUCID_SAMPLE_HAS_WINDOW
    if (window) window->present(renderer.picture(), o.width, o.height);
#endif
  }
  std::printf("%d frames\n", frames);
  if (!o.capture.empty()) writeCapture(renderer.capture(), o.capture);
  if (!o.output.empty()) {
    const Image picture = renderer.picture().download();
    std::vector<std::uint8_t> rgb;
    for (std::size_t i = 0; i < picture.data.size(); ++i)
      if (i % 4 != 3) rgb.push_back(static_cast<std::uint8_t>(std::lround(255 * picture.data[i])));
    writePng(o.output, o.width, o.height, rgb);
  }
  for (const std::string& file : {o.capture, o.output})
    if (!file.empty()) std::printf("wrote %s\n", file.c_str());
  const std::vector<std::string> messages = device.validationMessages();
  if (!messages.empty()) throw DeviceError("validation: " + messages.front());
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app(
      "A deferred renderer with Pellucid in it. Keys: P Pellucid, 1 sun, 2 spots, 3 point, 4 ambient, S "
      "specular, T antialiasing, F culled fronts, R resolution, arrows and page keys camera.",
      "pellucid_sample");
  app.footer("Exit codes: 0 ok, 2 usage, 3 bad input, 4 no usable device.");
  Options options;
  addOptions(app, options);
  enum { kUsage = 2, kBadInput, kNoDevice };
  const auto fail = [](int code, const std::exception& e) {
    std::fprintf(stderr, "pellucid_sample: %s\n", e.what());
    return code;
  };
  try {
    app.parse(argc, argv);
    run(options);
    return 0;
  } catch (const CLI::ParseError& e) {
    return app.exit(e) == 0 ? 0 : kUsage;
  } catch (const UsageError& e) {
    return fail(kUsage, e);
  } catch (const DeviceError& e) {
    return fail(kNoDevice, e);
  } catch (const std::exception& e) {
    return fail(kBadInput, e);
  }
}
