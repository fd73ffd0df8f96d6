#include "view/gui.h"

#include <imgui.h>
// After imgui.h, which its backends leave to others.
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_vulkan.h>

#include "common/error.h"

namespace pellucid::harness {

Gui::Gui(Device& device, const RenderTarget& target, GLFWwindow* window)
    : device_(device), window_(window), pool_(device) {
  // The backend's font is its one descriptor set.
  const VkDescriptorPoolSize size{VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 1};
  VkDescriptorPoolCreateInfo pool{VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO};
  pool.flags = VK_DESCRIPTOR_POOL_CREATE_FREE_DESCRIPTOR_SET_BIT;
  pool.maxSets = pool.poolSizeCount = 1;
  pool.pPoolSizes = &size;
  check(vkCreateDescriptorPool(device.handle(), &pool, nullptr, pool_.receive()), "vkCreateDescriptorPool");

  IMGUI_CHECKVERSION();
  ImGui::CreateContext();
  ImGui::StyleColorsDark();
  ImGui::GetStyle().WindowRounding = 0;
  ImGuiIO& io = ImGui::GetIO();
  io.IniFilename = nullptr;  // windows are where the application puts them
  if (window) ImGui_ImplGlfw_InitForVulkan(window, true);
  ImGui_ImplVulkan_InitInfo info{};
  info.Instance = device.instance();
  info.PhysicalDevice = device.physicalDevice();
  info.Device = device.handle();
  info.QueueFamily = device.queueFamily();
  info.Queue = device.queue();
  info.DescriptorPool = pool_;
  info.MinImageCount = info.ImageCount = 2;
  info.MSAASamples = VK_SAMPLE_COUNT_1_BIT;
  info.CheckVkResultFn = [](VkResult result) { check(result, "Dear ImGui"); };
  ImGui_ImplVulkan_Init(&info, target.pass().renderPass());
  device.run([](VkCommandBuffer commandBuffer) { ImGui_ImplVulkan_CreateFontsTexture(commandBuffer); });
  ImGui_ImplVulkan_DestroyFontUploadObjects();
}

Gui::~Gui() {
  vkDeviceWaitIdle(device_.handle());
  ImGui_ImplVulkan_Shutdown();
  if (window_) ImGui_ImplGlfw_Shutdown();
  ImGui::DestroyContext();
}

void Gui::poll(int width, int height) {
  ImGui_ImplVulkan_NewFrame();
  ImGuiIO& io = ImGui::GetIO();
  if (window_) {
    ImGui_ImplGlfw_NewFrame();
    // The screen is in pixels, of which some desktops have more than one a unit of the window.
    const float scale = io.DisplaySize.x > 0 ? static_cast<float>(width) / io.DisplaySize.x : 1;
    if (ImGui::IsMousePosValid()) io.MousePos = {io.MousePos.x * scale, io.MousePos.y * scale};
    io.DisplayFramebufferScale = {1, 1};
  } else {
    io.DeltaTime = 1.0f / 60;  // the same in every run
  }
  io.DisplaySize = {static_cast<float>(width), static_cast<float>(height)};
}

void Gui::record(VkCommandBuffer commandBuffer) const {
  ImGui_ImplVulkan_RenderDrawData(ImGui::GetDrawData(), commandBuffer);
}

}  // namespace pellucid::harness
