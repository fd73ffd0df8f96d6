// A Vulkan device with its queues: what an engine already has before it meets Pellucid.
#pragma once

#include <vulkan/vulkan.h>

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <typeindex>
#include <vector>

namespace pellucid::harness {

class GuardedMemory;

// Throws DeviceError naming the call unless `result` is VK_SUCCESS.
void check(VkResult result, const char* call);

struct DeviceOptions {
  std::string name;         // part of the device's name, any case; empty: the fastest kind there is
  bool validation = false;  // core and synchronization validation; messages are collected
  // A window system's instance extensions, and a test that a queue family presents to the window system. With
  // `presents` the device has VK_KHR_swapchain; without, the device shows nothing.
  std::vector<const char*> instanceExtensions = {};
  std::function<bool(VkInstance, VkPhysicalDevice, uint32_t family)> presents = {};
  bool computeQueue = false;  // a second queue, if possible of a family that does not draw
  bool pushes = false;        // the device must push descriptors
  bool guarded = false;       // HostBuffers end at memory without access (common/guarded_memory.h)
};

// Bytes of images that went between host and device.
struct Transfers {
  std::uint64_t uploaded = 0, downloaded = 0;
};

class Device {
public:
  // Throws DeviceError that lists the devices there are.
  explicit Device(const DeviceOptions& options = {});
  ~Device();
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;

  VkInstance instance() const { return instance_; }
  VkPhysicalDevice physicalDevice() const { return physicalDevice_; }
  VkDevice handle() const { return device_; }
  uint32_t queueFamily() const { return families_[0]; }
  VkQueue queue() const { return queue_; }
  // The second queue; the first one where none was asked for or the device has no other.
  VkQueue computeQueue() const { return computeQueue_; }
  uint32_t computeFamily() const { return families_[1]; }
  // Images and buffers belong to the families of both queues.
  template <class CreateInfo>
  void share(CreateInfo& info) const {
    if (families_[0] == families_[1]) return;
    info.sharingMode = VK_SHARING_MODE_CONCURRENT;
    info.queueFamilyIndexCount = 2;
    info.pQueueFamilyIndices = families_;
  }
  const VkPhysicalDeviceProperties& properties() const { return properties_; }
  std::string description() const;           // "name, driver and version"
  bool canDraw() const { return canDraw_; }  // the queue does graphics besides compute
  // Storage images need no format in shaders.
  bool writesWithoutFormat() const { return writesWithoutFormat_; }

  bool pushes() const { return pushes_; }  // has VK_KHR_push_descriptor
  bool guarded() const { return guarded_; }

  // A set for commands of run(), which frees it at its end: for devices that do not push descriptors.
  VkDescriptorSet setForRun(VkDescriptorSetLayout layout);

  // Records with `record`, submits and waits; then the host sees all that was written.
  void run(const std::function<void(VkCommandBuffer)>& record);

  // The one T(*this) of the device, made when first asked for and destroyed with the device: pipelines, which
  // outlive what draws with them. One thread at a time.
  template <class T>
  T& kept() {
    std::shared_ptr<void>& slot = kept_[typeid(T)];
    if (!slot) slot = std::make_shared<T>(*this);
    return *std::static_pointer_cast<T>(slot);
  }

  uint32_t memoryType(uint32_t typeBits, VkMemoryPropertyFlags flags,
                      VkMemoryPropertyFlags preferred = 0) const;

  // So far.
  const Transfers& transfers() const { return transfers_; }
  void countTransfer(std::uint64_t uploaded, std::uint64_t downloaded) {
    transfers_.uploaded += uploaded;
    transfers_.downloaded += downloaded;
  }

  // The warnings and errors of the validation layers so far.
  std::vector<std::string> validationMessages() const;

private:
  void createInstance(const DeviceOptions& options);
  void chooseDevice(const DeviceOptions& options);
  void createDevice(const DeviceOptions& options);
  void release();
  static VKAPI_ATTR VkBool32 VKAPI_CALL onMessage(VkDebugUtilsMessageSeverityFlagBitsEXT,
                                                  VkDebugUtilsMessageTypeFlagsEXT,
                                                  const VkDebugUtilsMessengerCallbackDataEXT*, void*);

  VkInstance instance_ = VK_NULL_HANDLE;
  VkDebugUtilsMessengerEXT messenger_ = VK_NULL_HANDLE;
  VkPhysicalDevice physicalDevice_ = VK_NULL_HANDLE;
  VkPhysicalDeviceProperties properties_{};
  std::string driver_;
  uint32_t families_[2] = {0, 0};  // of the queues
  bool canDraw_ = false, writesWithoutFormat_ = false, pushes_ = false, guarded_ = false;
  VkDevice device_ = VK_NULL_HANDLE;
  VkQueue queue_ = VK_NULL_HANDLE, computeQueue_ = VK_NULL_HANDLE;
  VkCommandPool pool_ = VK_NULL_HANDLE;
  std::vector<VkDescriptorPool> setPools_;  // of setForRun
  Transfers transfers_;
  std::map<std::type_index, std::shared_ptr<void>> kept_;
  mutable std::mutex messagesMutex_;
  std::vector<std::string> messages_;
};

// Host-visible, coherent, mapped memory. Data that shaders and draws read is device-local, and data that the
// device writes for the host is cached, where there is such memory. On guarded devices buffers that shaders
// read lie in pages of the host that end where the buffer does.
class HostBuffer {
public:
  HostBuffer(const Device& device, VkDeviceSize size, VkBufferUsageFlags usage);
  ~HostBuffer();
  HostBuffer(const HostBuffer&) = delete;
  HostBuffer& operator=(const HostBuffer&) = delete;

  VkBuffer handle() const { return buffer_; }
  VkDeviceSize size() const { return size_; }
  void* mapped() const { return mapped_; }

private:
  void allocate(VkBufferUsageFlags usage);
  void import();

  const Device& device_;
  VkDeviceSize size_;
  std::unique_ptr<GuardedMemory> pages_;  // null: the driver's memory
  VkBuffer buffer_ = VK_NULL_HANDLE;
  VkDeviceMemory memory_ = VK_NULL_HANDLE;
  void* mapped_ = nullptr;
};

// GPU timestamps around what is recorded between mark() calls.
class Timestamps {
public:
  Timestamps(const Device& device, uint32_t count);
  ~Timestamps();
  Timestamps(const Timestamps&) = delete;
  Timestamps& operator=(const Timestamps&) = delete;

  void reset(VkCommandBuffer commandBuffer) const;
  void mark(VkCommandBuffer commandBuffer, uint32_t index) const;
  // Microseconds between consecutive marks.
  std::vector<double> intervals() const;

private:
  const Device& device_;
  uint32_t count_;
  VkQueryPool pool_ = VK_NULL_HANDLE;
};

}  // namespace pellucid::harness
