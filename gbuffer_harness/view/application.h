// `pellucid view` itself: a window, or an image in its place, with picture and panel.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "view/source.h"
#include "view/state.h"

namespace pellucid::harness {

struct SceneToView {
  std::function<std::unique_ptr<Source>(Device&)> open;
  std::function<void(ViewState&)> start;  // changes the state that the source begins with
};

struct ApplicationOptions {
  std::string device;                      // part of the Vulkan device's name; empty: the fastest kind
  bool validation = false;                 // messages of the validation layers end it with a DeviceError
  bool window = true;                      // false: needs `frames`
  int width = 1280, height = 800;          // of the window, pixels
  int frames = 0;                          // of the screen, then it ends; 0: until the window is closed
  std::filesystem::path screenshot, save;  // written at the end; empty: none
  std::function<std::string(const ReplaySettings&)> settingsText;  // what --set @FILE reads
  SceneToView scene;
};

struct ApplicationReport {
  std::string device;              // its description
  int frames = 0;                  // of the screen that were drawn
  std::uint64_t recorded = 0;      // of the module
  std::vector<std::string> saved;  // files
};

// Throws DeviceError where there is no display or device, and what opening, rendering and saving throw.
ApplicationReport runApplication(const ApplicationOptions& options);

}  // namespace pellucid::harness
