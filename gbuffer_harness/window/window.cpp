#define GLFW_INCLUDE_VULKAN
#include "window/window.h"

#include <GLFW/glfw3.h>

#include <algorithm>
#include <array>

#include "common/error.h"

namespace pellucid::harness {

namespace {

std::string lastError() {
  const char* description = nullptr;
  glfwGetError(&description);
  return description ? description : "GLFW gives no reason";
}

template <class T, class Function, class... Arguments>
std::vector<T> listed(const Function& function, Arguments... arguments) {
  std::uint32_t count = 0;
  check(function(arguments..., &count, nullptr), "vkGet*");
  std::vector<T> all(count);
  if (count > 0) check(function(arguments..., &count, all.data()), "vkGet*");
  return all;
}

// Chooses 8 bits without a curve of its own, because the copied image is sRGB already.
VkSurfaceFormatKHR chooseFormat(const std::vector<VkSurfaceFormatKHR>& formats) {
  for (const VkFormat wanted : {VK_FORMAT_B8G8R8A8_UNORM, VK_FORMAT_R8G8B8A8_UNORM})
    for (const VkSurfaceFormatKHR& format : formats)
      if (format.format == wanted && format.colorSpace == VK_COLOR_SPACE_SRGB_NONLINEAR_KHR) return format;
  throw DeviceError("the window has no format of 8 bits a channel without an sRGB curve of its own");
}

VkImageMemoryBarrier transition(VkImage image, VkImageLayout from, VkImageLayout to) {
  VkImageMemoryBarrier barrier{VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER};
  barrier.srcAccessMask = from == VK_IMAGE_LAYOUT_UNDEFINED ? 0 : VK_ACCESS_TRANSFER_WRITE_BIT;
  barrier.dstAccessMask = from == VK_IMAGE_LAYOUT_UNDEFINED ? VK_ACCESS_TRANSFER_WRITE_BIT : 0;
  barrier.oldLayout = from;
  barrier.newLayout = to;
  barrier.srcQueueFamilyIndex = barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
  barrier.image = image;
  barrier.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
  return barrier;
}

void record(VkCommandBuffer commandBuffer, const VkImageMemoryBarrier& barrier) {
  vkCmdPipelineBarrier(commandBuffer, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_PIPELINE_STAGE_TRANSFER_BIT, 0, 0,
                       nullptr, 0, nullptr, 1, &barrier);
}

}  // namespace

Desktop::Desktop() {
  if (!glfwInit())
    throw DeviceError("no window can be opened: " + lastError() + "; --no-window draws without a display");
  if (glfwVulkanSupported()) return;
  const std::string reason = lastError();
  glfwTerminate();
  throw DeviceError("no window can show what Vulkan draws: " + reason);
}

Desktop::~Desktop() { glfwTerminate(); }

void Desktop::require(DeviceOptions& options) const {
  std::uint32_t count = 0;
  const char** const names = glfwGetRequiredInstanceExtensions(&count);
  if (!names) throw DeviceError("no window can show what Vulkan draws: " + lastError());
  options.instanceExtensions.assign(names, names + count);
  options.pushes = true;  // what is drawn is not waited for
  options.presents = [](VkInstance instance, VkPhysicalDevice device, std::uint32_t family) {
    return glfwGetPhysicalDevicePresentationSupport(instance, device, family) == GLFW_TRUE;
  };
}

Window::Window(const Desktop&, Device& device, const std::string& title, int width, int height)
    : device_(device), acquired_(device) {
  glfwWindowHint(GLFW_CLIENT_API, GLFW_NO_API);
  window_ = glfwCreateWindow(width, height, title.c_str(), nullptr, nullptr);
  if (!window_) throw DeviceError("the window cannot be opened: " + lastError());
  try {
    check(glfwCreateWindowSurface(device.instance(), window_, nullptr, &surface_), "glfwCreateWindowSurface");
    VkBool32 presents = VK_FALSE;
    check(vkGetPhysicalDeviceSurfaceSupportKHR(device.physicalDevice(), device.queueFamily(), surface_,
                                               &presents),
          "vkGetPhysicalDeviceSurfaceSupportKHR");
    if (!presents) throw DeviceError(device.description() + " cannot present to the window");
    const VkFenceCreateInfo fence{VK_STRUCTURE_TYPE_FENCE_CREATE_INFO};
    check(vkCreateFence(device.handle(), &fence, nullptr, acquired_.receive()), "vkCreateFence");
    createSwapchain();
  } catch (...) {
    destroySwapchain();
    vkDestroySurfaceKHR(device.instance(), surface_, nullptr);
    glfwDestroyWindow(window_);
    throw;
  }
}

Window::~Window() {
  vkDeviceWaitIdle(device_.handle());
  destroySwapchain();
  vkDestroySurfaceKHR(device_.instance(), surface_, nullptr);
  glfwDestroyWindow(window_);
}

bool Window::shouldClose() const { return glfwWindowShouldClose(window_); }

void Window::size(int& width, int& height) const {
  glfwGetFramebufferSize(window_, &width, &height);
  if (glfwGetWindowAttrib(window_, GLFW_ICONIFIED)) width = height = 0;
}

void Window::events(bool wait) const {
  if (wait)
    glfwWaitEvents();
  else
    glfwPollEvents();
}

void Window::createSwapchain() {
  const VkPhysicalDevice physical = device_.physicalDevice();
  VkSurfaceCapabilitiesKHR can;
  check(vkGetPhysicalDeviceSurfaceCapabilitiesKHR(physical, surface_, &can),
        "vkGetPhysicalDeviceSurfaceCapabilitiesKHR");
  int width = 0, height = 0;
  size(width, height);
  extent_ = can.currentExtent;
  if (extent_.width == UINT32_MAX) {  // the swapchain decides
    extent_.width =
        std::clamp(static_cast<std::uint32_t>(width), can.minImageExtent.width, can.maxImageExtent.width);
    extent_.height =
        std::clamp(static_cast<std::uint32_t>(height), can.minImageExtent.height, can.maxImageExtent.height);
  }
  if (width == 0 || height == 0 || extent_.width == 0 || extent_.height == 0) {
    extent_ = {0, 0};
    return;
  }
  if (!(can.supportedUsageFlags & VK_IMAGE_USAGE_TRANSFER_DST_BIT))
    throw DeviceError(device_.description() + " cannot copy images to the window");
  const VkSurfaceFormatKHR format =
      chooseFormat(listed<VkSurfaceFormatKHR>(vkGetPhysicalDeviceSurfaceFormatsKHR, physical, surface_));
  VkSwapchainCreateInfoKHR info{VK_STRUCTURE_TYPE_SWAPCHAIN_CREATE_INFO_KHR};
  info.surface = surface_;
  info.minImageCount = std::max(can.minImageCount, 2u);
  if (can.maxImageCount > 0) info.minImageCount = std::min(info.minImageCount, can.maxImageCount);
  info.imageFormat = format.format;
  info.imageColorSpace = format.colorSpace;
  info.imageExtent = extent_;
  info.imageArrayLayers = 1;
  info.imageUsage = VK_IMAGE_USAGE_TRANSFER_DST_BIT;
  info.preTransform = can.currentTransform;
  info.compositeAlpha = can.supportedCompositeAlpha & VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR
                            ? VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR
                            : VK_COMPOSITE_ALPHA_INHERIT_BIT_KHR;
  info.presentMode = VK_PRESENT_MODE_FIFO_KHR;  // every device has it
  info.clipped = VK_TRUE;
  check(vkCreateSwapchainKHR(device_.handle(), &info, nullptr, &swapchain_), "vkCreateSwapchainKHR");
  images_ = listed<VkImage>(vkGetSwapchainImagesKHR, device_.handle(), swapchain_);
}

void Window::destroySwapchain() {
  if (swapchain_) vkDestroySwapchainKHR(device_.handle(), swapchain_, nullptr);
  swapchain_ = VK_NULL_HANDLE;
  images_.clear();
}

void Window::copy(VkCommandBuffer commandBuffer, const GpuImage& image, int width, int height,
                  VkImage to) const {
  record(commandBuffer, transition(to, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL));
  VkImageBlit region{};
  region.srcSubresource = region.dstSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
  region.srcOffsets[1] = {width, height, 1};
  region.dstOffsets[1] = {static_cast<std::int32_t>(extent_.width), static_cast<std::int32_t>(extent_.height),
                          1};
  vkCmdBlitImage(commandBuffer, image.handle(), VK_IMAGE_LAYOUT_GENERAL, to,
                 VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region, VK_FILTER_NEAREST);
  record(commandBuffer,
         transition(to, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, VK_IMAGE_LAYOUT_PRESENT_SRC_KHR));
}

bool Window::present(const GpuImage& image, int width, int height) {
  if (!swapchain_) createSwapchain();
  if (!swapchain_) return false;  // minimized
  std::uint32_t index = 0;
  const VkResult acquired =
      vkAcquireNextImageKHR(device_.handle(), swapchain_, UINT64_MAX, VK_NULL_HANDLE, acquired_, &index);
  if (acquired == VK_ERROR_OUT_OF_DATE_KHR) {
    destroySwapchain();
    return false;
  }
  if (acquired != VK_SUBOPTIMAL_KHR) check(acquired, "vkAcquireNextImageKHR");
  const VkFence fence = acquired_;
  check(vkWaitForFences(device_.handle(), 1, &fence, VK_TRUE, UINT64_MAX), "vkWaitForFences");
  check(vkResetFences(device_.handle(), 1, &fence), "vkResetFences");
  // run() waits, so that presenting needs no semaphore.
  device_.run(
      [&](VkCommandBuffer commandBuffer) { copy(commandBuffer, image, width, height, images_[index]); });
  VkPresentInfoKHR info{VK_STRUCTURE_TYPE_PRESENT_INFO_KHR};
  info.swapchainCount = 1;
  info.pSwapchains = &swapchain_;
  info.pImageIndices = &index;
  const VkResult presented = vkQueuePresentKHR(device_.queue(), &info);
  int pixelsWide = 0, pixelsHigh = 0;
  size(pixelsWide, pixelsHigh);
  const bool fits = static_cast<std::uint32_t>(pixelsWide) == extent_.width &&
                    static_cast<std::uint32_t>(pixelsHigh) == extent_.height;
  if (presented == VK_SUCCESS || (presented == VK_SUBOPTIMAL_KHR && fits)) return true;
  if (presented != VK_SUBOPTIMAL_KHR && presented != VK_ERROR_OUT_OF_DATE_KHR)
    check(presented, "vkQueuePresentKHR");
  check(vkQueueWaitIdle(device_.queue()), "vkQueueWaitIdle");
  destroySwapchain();  // made anew in the window's size by the next call
  return false;
}

}  // namespace pellucid::harness
