// A window of the desktop that shows images of the harness's device.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "common/device.h"
#include "common/gpu_image.h"
#include "common/owned.h"

struct GLFWwindow;

namespace pellucid::harness {

// GLFW while it is in scope. Throws DeviceError, which says what is missing, where there is no display or no
// Vulkan loader.
class Desktop {
public:
  Desktop();
  ~Desktop();
  Desktop(const Desktop&) = delete;
  Desktop& operator=(const Desktop&) = delete;

  // Fills in what a device needs that presents to windows.
  void require(DeviceOptions& options) const;
};

class Window {
public:
  // Throws DeviceError where the window or its swapchain cannot be made.
  Window(const Desktop& desktop, Device& device, const std::string& title, int width, int height);
  ~Window();
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;

  GLFWwindow* handle() const { return window_; }
  bool shouldClose() const;
  // Pixels; 0 x 0 while it is minimized.
  void size(int& width, int& height) const;
  // Handles what happened; `wait`: until something did, which costs nothing.
  void events(bool wait) const;

  // Shows a RGBA8 image in the layout GENERAL, of any size. Returns false where the window had no room for it
  // just then, as while it is resized or minimized: draw again.
  bool present(const GpuImage& image, int width, int height);

private:
  void createSwapchain();
  void destroySwapchain();
  void copy(VkCommandBuffer commandBuffer, const GpuImage& image, int width, int height, VkImage to) const;

  Device& device_;
  GLFWwindow* window_ = nullptr;
  VkSurfaceKHR surface_ = VK_NULL_HANDLE;
  VkSwapchainKHR swapchain_ = VK_NULL_HANDLE;
  VkExtent2D extent_{};
  std::vector<VkImage> images_;
  Owned<VkFence, vkDestroyFence> acquired_;
};

}  // namespace pellucid::harness
