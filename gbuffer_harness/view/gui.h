// Dear ImGui on the harness's device, with a window or without.
#pragma once

#include "common/device.h"
#include "common/owned.h"
#include "raster/render_target.h"

struct GLFWwindow;

namespace pellucid::harness {

class Gui {
public:
  // Draws into targets like `target`. `window`: whose input it takes; null: none.
  Gui(Device& device, const RenderTarget& target, GLFWwindow* window);
  ~Gui();
  Gui(const Gui&) = delete;
  Gui& operator=(const Gui&) = delete;

  // The input of the window; then callers may change ImGui's IO before ImGui::NewFrame(). width, height:
  // pixels.
  void poll(int width, int height);
  void record(VkCommandBuffer commandBuffer) const;  // what ImGui::Render() made, within the target's pass

private:
  Device& device_;
  GLFWwindow* window_;
  Owned<VkDescriptorPool, vkDestroyDescriptorPool> pool_;
};

}  // namespace pellucid::harness
