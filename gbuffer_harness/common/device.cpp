#include "common/device.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <optional>

#include "common/error.h"
#include "common/guarded_memory.h"
#include "common/parse.h"

namespace pellucid::harness {
namespace {

constexpr const char* kValidationLayer = "VK_LAYER_KHRONOS_validation";

bool hasLayer(const char* name) {
  uint32_t count = 0;
  vkEnumerateInstanceLayerProperties(&count, nullptr);
  std::vector<VkLayerProperties> layers(count);
  vkEnumerateInstanceLayerProperties(&count, layers.data());
  return std::any_of(layers.begin(), layers.end(),
                     [&](const auto& l) { return !std::strcmp(l.layerName, name); });
}

bool hasExtension(VkPhysicalDevice device, const char* name) {
  uint32_t count = 0;
  vkEnumerateDeviceExtensionProperties(device, nullptr, &count, nullptr);
  std::vector<VkExtensionProperties> extensions(count);
  vkEnumerateDeviceExtensionProperties(device, nullptr, &count, extensions.data());
  return std::any_of(extensions.begin(), extensions.end(),
                     [&](const auto& e) { return !std::strcmp(e.extensionName, name); });
}

struct QueueFamily {
  uint32_t index;
  bool canDraw;
};

std::vector<VkQueueFamilyProperties> familiesOf(VkPhysicalDevice device) {
  uint32_t count = 0;
  vkGetPhysicalDeviceQueueFamilyProperties(device, &count, nullptr);
  std::vector<VkQueueFamilyProperties> families(count);
  vkGetPhysicalDeviceQueueFamilyProperties(device, &count, families.data());
  return families;
}

// A family that computes and that `accepts` takes, if possible one that draws too.
std::optional<QueueFamily> findFamily(VkPhysicalDevice device,
                                      const std::function<bool(uint32_t family)>& accepts) {
  const std::vector<VkQueueFamilyProperties> families = familiesOf(device);
  std::optional<QueueFamily> best;
  for (uint32_t i = 0; i < families.size(); ++i) {
    if (!(families[i].queueFlags & VK_QUEUE_COMPUTE_BIT) || families[i].timestampValidBits == 0 ||
        !accepts(i))
      continue;
    const bool canDraw = families[i].queueFlags & VK_QUEUE_GRAPHICS_BIT;
    if (!best || (canDraw && !best->canDraw)) best = {i, canDraw};
  }
  return best;
}

// The family of a second queue that computes: if possible another one, if possible one that does not draw.
uint32_t secondFamily(const std::vector<VkQueueFamilyProperties>& families, uint32_t first) {
  uint32_t best = first;
  for (uint32_t i = 0; i < families.size(); ++i) {
    if (i == first || !(families[i].queueFlags & VK_QUEUE_COMPUTE_BIT)) continue;
    if (best == first || !(families[i].queueFlags & VK_QUEUE_GRAPHICS_BIT)) best = i;
  }
  return best;
}

int speed(VkPhysicalDeviceType type) {
  switch (type) {
    case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU:
      return 4;
    case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU:
      return 3;
    case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU:
      return 2;
    case VK_PHYSICAL_DEVICE_TYPE_CPU:
      return 1;
    default:
      return 0;
  }
}

}  // namespace

void check(VkResult result, const char* call) {
  if (result == VK_ERROR_DEVICE_LOST)
    throw DeviceError(std::string(call) + ": the driver lost the device, which a hang or a reset does");
  if (result != VK_SUCCESS)
    throw DeviceError(std::string(call) + " returned VkResult " + std::to_string(result));
}

Device::Device(const DeviceOptions& options) {
  // The destructor does not run when a constructor throws.
  try {
    createInstance(options);
    chooseDevice(options);
    createDevice(options);
  } catch (...) {
    release();
    throw;
  }
}

Device::~Device() { release(); }

void Device::release() {
  if (device_) {
    vkDeviceWaitIdle(device_);
    kept_.clear();
    for (VkDescriptorPool pool : setPools_) vkDestroyDescriptorPool(device_, pool, nullptr);
    vkDestroyCommandPool(device_, pool_, nullptr);
    vkDestroyDevice(device_, nullptr);
  }
  if (messenger_) {
    const auto destroy = reinterpret_cast<PFN_vkDestroyDebugUtilsMessengerEXT>(
        vkGetInstanceProcAddr(instance_, "vkDestroyDebugUtilsMessengerEXT"));
    destroy(instance_, messenger_, nullptr);
  }
  if (instance_) vkDestroyInstance(instance_, nullptr);
}

void Device::createInstance(const DeviceOptions& options) {
  VkApplicationInfo application{VK_STRUCTURE_TYPE_APPLICATION_INFO};
  application.pApplicationName = "pellucid";
  application.apiVersion = VK_API_VERSION_1_1;
  VkInstanceCreateInfo info{VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO};
  info.pApplicationInfo = &application;

  VkDebugUtilsMessengerCreateInfoEXT messenger{VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT};
  messenger.messageSeverity =
      VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
  messenger.messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT;
  messenger.pfnUserCallback = &Device::onMessage;
  messenger.pUserData = this;
  const VkValidationFeatureEnableEXT synchronization =
      VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT;
  VkValidationFeaturesEXT features{VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT};
  features.enabledValidationFeatureCount = 1;
  features.pEnabledValidationFeatures = &synchronization;
  std::vector<const char*> extensions = options.instanceExtensions;
  if (options.validation) {
    if (!hasLayer(kValidationLayer)) throw DeviceError("the Vulkan validation layers are not installed");
    info.enabledLayerCount = 1;
    info.ppEnabledLayerNames = &kValidationLayer;
    extensions.push_back(VK_EXT_DEBUG_UTILS_EXTENSION_NAME);
    info.pNext = &features;
    features.pNext = &messenger;
  }
  info.enabledExtensionCount = static_cast<uint32_t>(extensions.size());
  info.ppEnabledExtensionNames = extensions.data();
  check(vkCreateInstance(&info, nullptr, &instance_), "vkCreateInstance");
  if (!options.validation) return;
  const auto create = reinterpret_cast<PFN_vkCreateDebugUtilsMessengerEXT>(
      vkGetInstanceProcAddr(instance_, "vkCreateDebugUtilsMessengerEXT"));
  check(create(instance_, &messenger, nullptr, &messenger_), "vkCreateDebugUtilsMessengerEXT");
}

void Device::chooseDevice(const DeviceOptions& options) {
  const std::string& name = options.name;
  uint32_t count = 0;
  check(vkEnumeratePhysicalDevices(instance_, &count, nullptr), "vkEnumeratePhysicalDevices");
  std::vector<VkPhysicalDevice> devices(count);
  if (count > 0)
    check(vkEnumeratePhysicalDevices(instance_, &count, devices.data()), "vkEnumeratePhysicalDevices");

  std::string seen;
  int best = -1;
  for (VkPhysicalDevice candidate : devices) {
    VkPhysicalDeviceProperties properties;
    vkGetPhysicalDeviceProperties(candidate, &properties);
    const std::optional<QueueFamily> family = findFamily(candidate, [&](uint32_t i) {
      return !options.presents || options.presents(instance_, candidate, i);
    });
    std::string why;
    if (properties.apiVersion < VK_API_VERSION_1_1)
      why = "Vulkan 1.1 is missing";
    else if (options.pushes && !hasExtension(candidate, VK_KHR_PUSH_DESCRIPTOR_EXTENSION_NAME))
      why = "VK_KHR_push_descriptor is missing";
    else if (options.guarded && !hasExtension(candidate, VK_EXT_EXTERNAL_MEMORY_HOST_EXTENSION_NAME))
      why = "VK_EXT_external_memory_host is missing";
    else if (options.presents && !hasExtension(candidate, VK_KHR_SWAPCHAIN_EXTENSION_NAME))
      why = "VK_KHR_swapchain is missing";
    else if (!family)
      why = options.presents ? "no compute queue with timestamps presents to the window"
                             : "no compute queue with timestamps";
    seen += "\n  " + std::string(properties.deviceName) + (why.empty() ? "" : " (" + why + ")");
    if (!why.empty() || lower(properties.deviceName).find(lower(name)) == std::string::npos) continue;
    if (speed(properties.deviceType) <= best) continue;
    best = speed(properties.deviceType);
    physicalDevice_ = candidate;
    properties_ = properties;
    families_[0] = families_[1] = family->index;
    canDraw_ = family->canDraw;
  }
  if (!physicalDevice_)
    throw DeviceError(devices.empty()
                          ? "no Vulkan device; install a driver (Debian: mesa-vulkan-drivers)"
                          : "no usable Vulkan device" +
                                (name.empty() ? std::string() : " whose name contains \"" + name + "\"") +
                                "; there are:" + seen);
}

void Device::createDevice(const DeviceOptions& options) {
  VkPhysicalDeviceDriverProperties driver{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES};
  VkPhysicalDeviceProperties2 properties{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2};
  // Core in 1.2; an older device would ignore the struct and leave the strings empty.
  if (properties_.apiVersion >= VK_API_VERSION_1_2) properties.pNext = &driver;
  vkGetPhysicalDeviceProperties2(physicalDevice_, &properties);
  driver_ = std::string(driver.driverName) + " " + driver.driverInfo;

  const std::vector<VkQueueFamilyProperties> families = familiesOf(physicalDevice_);
  if (options.computeQueue) families_[1] = secondFamily(families, families_[0]);
  const bool apart = families_[1] != families_[0];
  const uint32_t second = options.computeQueue && !apart && families[families_[0]].queueCount > 1 ? 1 : 0;
  const float priorities[] = {1, 1};
  VkDeviceQueueCreateInfo queues[2] = {};
  for (int i = 0; i < 2; ++i)
    queues[i] = {
        VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO, nullptr, 0, families_[i], 1 + second, priorities};
  std::vector<const char*> extensions;
  pushes_ = hasExtension(physicalDevice_, VK_KHR_PUSH_DESCRIPTOR_EXTENSION_NAME);
  if (pushes_) extensions.push_back(VK_KHR_PUSH_DESCRIPTOR_EXTENSION_NAME);
  guarded_ = options.guarded;
  if (guarded_) extensions.push_back(VK_EXT_EXTERNAL_MEMORY_HOST_EXTENSION_NAME);
  if (options.presents) extensions.push_back(VK_KHR_SWAPCHAIN_EXTENSION_NAME);
  VkPhysicalDeviceFeatures available, features{};
  vkGetPhysicalDeviceFeatures(physicalDevice_, &available);
  features.shaderStorageImageWriteWithoutFormat = available.shaderStorageImageWriteWithoutFormat;
  features.shaderStorageImageMultisample = available.shaderStorageImageMultisample;
  writesWithoutFormat_ = features.shaderStorageImageWriteWithoutFormat;
  VkDeviceCreateInfo info{VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO};
  info.queueCreateInfoCount = apart ? 2 : 1;
  info.pQueueCreateInfos = queues;
  info.enabledExtensionCount = static_cast<uint32_t>(extensions.size());
  info.ppEnabledExtensionNames = extensions.data();
  info.pEnabledFeatures = &features;
  check(vkCreateDevice(physicalDevice_, &info, nullptr, &device_), "vkCreateDevice");
  vkGetDeviceQueue(device_, families_[0], 0, &queue_);
  vkGetDeviceQueue(device_, families_[1], second, &computeQueue_);
  VkCommandPoolCreateInfo pool{VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO};
  pool.flags = VK_COMMAND_POOL_CREATE_TRANSIENT_BIT;
  pool.queueFamilyIndex = families_[0];
  check(vkCreateCommandPool(device_, &pool, nullptr, &pool_), "vkCreateCommandPool");
}

std::string Device::description() const {
  return std::string(properties_.deviceName) + (driver_.size() > 1 ? ", " + driver_ : std::string());
}

void Device::run(const std::function<void(VkCommandBuffer)>& record) {
  VkCommandBufferAllocateInfo allocate{VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO};
  allocate.commandPool = pool_;
  allocate.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
  allocate.commandBufferCount = 1;
  VkCommandBuffer commandBuffer;
  check(vkAllocateCommandBuffers(device_, &allocate, &commandBuffer), "vkAllocateCommandBuffers");
  VkCommandBufferBeginInfo begin{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
  begin.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
  VkFence fence = VK_NULL_HANDLE;
  const auto release = [&] {
    vkDestroyFence(device_, fence, nullptr);
    vkFreeCommandBuffers(device_, pool_, 1, &commandBuffer);
    for (VkDescriptorPool pool : setPools_) vkResetDescriptorPool(device_, pool, 0);
  };
  try {
    check(vkBeginCommandBuffer(commandBuffer, &begin), "vkBeginCommandBuffer");
    record(commandBuffer);
    // A fence alone does not show the host what the device wrote.
    const VkMemoryBarrier toHost{VK_STRUCTURE_TYPE_MEMORY_BARRIER, nullptr, VK_ACCESS_MEMORY_WRITE_BIT,
                                 VK_ACCESS_HOST_READ_BIT};
    vkCmdPipelineBarrier(commandBuffer, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, VK_PIPELINE_STAGE_HOST_BIT, 0, 1,
                         &toHost, 0, nullptr, 0, nullptr);
    check(vkEndCommandBuffer(commandBuffer), "vkEndCommandBuffer");
    VkFenceCreateInfo fenceInfo{VK_STRUCTURE_TYPE_FENCE_CREATE_INFO};
    check(vkCreateFence(device_, &fenceInfo, nullptr, &fence), "vkCreateFence");
    VkSubmitInfo submit{VK_STRUCTURE_TYPE_SUBMIT_INFO};
    submit.commandBufferCount = 1;
    submit.pCommandBuffers = &commandBuffer;
    check(vkQueueSubmit(queue_, 1, &submit, fence), "vkQueueSubmit");
    check(vkWaitForFences(device_, 1, &fence, VK_TRUE, UINT64_MAX), "vkWaitForFences");
  } catch (...) {
    release();
    throw;
  }
  release();
}

VkDescriptorSet Device::setForRun(VkDescriptorSetLayout layout) {
  constexpr uint32_t kSets = 64, kOfEachType = 16 * kSets;
  VkDescriptorSetAllocateInfo allocate{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO};
  allocate.descriptorSetCount = 1;
  allocate.pSetLayouts = &layout;
  VkDescriptorSet set = VK_NULL_HANDLE;
  for (VkDescriptorPool pool : setPools_) {
    allocate.descriptorPool = pool;
    if (vkAllocateDescriptorSets(device_, &allocate, &set) == VK_SUCCESS) return set;
  }
  VkDescriptorPoolSize sizes[] = {{VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, kOfEachType},
                                  {VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, kOfEachType},
                                  {VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, kOfEachType},
                                  {VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, kOfEachType},
                                  {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, kOfEachType}};
  VkDescriptorPoolCreateInfo info{VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO};
  info.maxSets = kSets;
  info.poolSizeCount = static_cast<uint32_t>(std::size(sizes));
  info.pPoolSizes = sizes;
  check(vkCreateDescriptorPool(device_, &info, nullptr, &allocate.descriptorPool), "vkCreateDescriptorPool");
  setPools_.push_back(allocate.descriptorPool);
  check(vkAllocateDescriptorSets(device_, &allocate, &set), "vkAllocateDescriptorSets");
  return set;
}

uint32_t Device::memoryType(uint32_t typeBits, VkMemoryPropertyFlags flags,
                            VkMemoryPropertyFlags preferred) const {
  VkPhysicalDeviceMemoryProperties memory;
  vkGetPhysicalDeviceMemoryProperties(physicalDevice_, &memory);
  for (const VkMemoryPropertyFlags wanted : {flags | preferred, flags})
    for (uint32_t i = 0; i < memory.memoryTypeCount; ++i)
      if (typeBits & (1u << i) && (memory.memoryTypes[i].propertyFlags & wanted) == wanted) return i;
  throw DeviceError("the device has no memory type with VkMemoryPropertyFlags " + std::to_string(flags));
}

std::vector<std::string> Device::validationMessages() const {
  const std::lock_guard lock(messagesMutex_);
  return messages_;
}

VkBool32 Device::onMessage(VkDebugUtilsMessageSeverityFlagBitsEXT, VkDebugUtilsMessageTypeFlagsEXT,
                           const VkDebugUtilsMessengerCallbackDataEXT* data, void* user) {
  auto* self = static_cast<Device*>(user);
  const std::lock_guard lock(self->messagesMutex_);
  self->messages_.emplace_back(data->pMessage);
  return VK_FALSE;
}

HostBuffer::HostBuffer(const Device& device, VkDeviceSize size, VkBufferUsageFlags usage)
    : device_(device), size_(size) {
  const bool guarded = device.guarded() && usage & VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
  const VkExternalMemoryBufferCreateInfo external{VK_STRUCTURE_TYPE_EXTERNAL_MEMORY_BUFFER_CREATE_INFO,
                                                  nullptr,
                                                  VK_EXTERNAL_MEMORY_HANDLE_TYPE_HOST_ALLOCATION_BIT_EXT};
  VkBufferCreateInfo info{VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO};
  if (guarded) info.pNext = &external;
  info.size = size;
  info.usage = usage;
  device.share(info);
  check(vkCreateBuffer(device.handle(), &info, nullptr, &buffer_), "vkCreateBuffer");
  if (guarded)
    import();
  else
    allocate(usage);
}

void HostBuffer::allocate(VkBufferUsageFlags usage) {
  VkMemoryRequirements needs;
  vkGetBufferMemoryRequirements(device_.handle(), buffer_, &needs);
  VkMemoryAllocateInfo allocate{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO};
  allocate.allocationSize = needs.size;
  // Data that shaders and draws read lies beside them: across a bus each group would wait for it anew. The
  // host reads from memory without a cache word by word.
  constexpr VkBufferUsageFlags kRead = VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT |
                                       VK_BUFFER_USAGE_STORAGE_BUFFER_BIT |
                                       VK_BUFFER_USAGE_VERTEX_BUFFER_BIT | VK_BUFFER_USAGE_INDEX_BUFFER_BIT;
  const auto allocateIn = [&](VkMemoryPropertyFlags preferred) {
    allocate.memoryTypeIndex = device_.memoryType(
        needs.memoryTypeBits, VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT,
        preferred);
    return vkAllocateMemory(device_.handle(), &allocate, nullptr, &memory_);
  };
  VkResult result = allocateIn(usage & kRead ? VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT
                               : usage & VK_BUFFER_USAGE_TRANSFER_DST_BIT ? VK_MEMORY_PROPERTY_HOST_CACHED_BIT
                                                                          : 0);
  // Some devices show the host no more than 256 MB of their memory.
  if (result == VK_ERROR_OUT_OF_DEVICE_MEMORY) result = allocateIn(0);
  check(result, "vkAllocateMemory");
  check(vkBindBufferMemory(device_.handle(), buffer_, memory_, 0), "vkBindBufferMemory");
  check(vkMapMemory(device_.handle(), memory_, 0, VK_WHOLE_SIZE, 0, &mapped_), "vkMapMemory");
}

void HostBuffer::import() {
  constexpr auto kType = VK_EXTERNAL_MEMORY_HANDLE_TYPE_HOST_ALLOCATION_BIT_EXT;
  VkPhysicalDeviceExternalMemoryHostPropertiesEXT host{
      VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_EXTERNAL_MEMORY_HOST_PROPERTIES_EXT};
  VkPhysicalDeviceProperties2 properties{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, &host, {}};
  vkGetPhysicalDeviceProperties2(device_.physicalDevice(), &properties);
  VkMemoryRequirements needs;
  vkGetBufferMemoryRequirements(device_.handle(), buffer_, &needs);
  pages_ = std::make_unique<GuardedMemory>(static_cast<size_t>(needs.size),
                                           static_cast<size_t>(host.minImportedHostPointerAlignment));
  const auto getPointer = reinterpret_cast<PFN_vkGetMemoryHostPointerPropertiesEXT>(
      vkGetDeviceProcAddr(device_.handle(), "vkGetMemoryHostPointerPropertiesEXT"));
  VkMemoryHostPointerPropertiesEXT pointer{VK_STRUCTURE_TYPE_MEMORY_HOST_POINTER_PROPERTIES_EXT};
  check(getPointer(device_.handle(), kType, pages_->data(), &pointer), "vkGetMemoryHostPointerPropertiesEXT");
  const VkImportMemoryHostPointerInfoEXT import{VK_STRUCTURE_TYPE_IMPORT_MEMORY_HOST_POINTER_INFO_EXT,
                                                nullptr, kType, pages_->data()};
  VkMemoryAllocateInfo allocate{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO, &import};
  allocate.allocationSize = pages_->size();
  allocate.memoryTypeIndex =
      device_.memoryType(needs.memoryTypeBits & pointer.memoryTypeBits,
                         VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT);
  check(vkAllocateMemory(device_.handle(), &allocate, nullptr, &memory_), "vkAllocateMemory");
  const VkDeviceSize offset = (pages_->size() - needs.size) / needs.alignment * needs.alignment;
  check(vkBindBufferMemory(device_.handle(), buffer_, memory_, offset), "vkBindBufferMemory");
  mapped_ = static_cast<char*>(pages_->data()) + offset;
}

HostBuffer::~HostBuffer() {
  vkDestroyBuffer(device_.handle(), buffer_, nullptr);
  vkFreeMemory(device_.handle(), memory_, nullptr);
}

Timestamps::Timestamps(const Device& device, uint32_t count) : device_(device), count_(count) {
  VkQueryPoolCreateInfo info{VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO};
  info.queryType = VK_QUERY_TYPE_TIMESTAMP;
  info.queryCount = count;
  check(vkCreateQueryPool(device.handle(), &info, nullptr, &pool_), "vkCreateQueryPool");
}

Timestamps::~Timestamps() { vkDestroyQueryPool(device_.handle(), pool_, nullptr); }

void Timestamps::reset(VkCommandBuffer commandBuffer) const {
  vkCmdResetQueryPool(commandBuffer, pool_, 0, count_);
}

void Timestamps::mark(VkCommandBuffer commandBuffer, uint32_t index) const {
  vkCmdWriteTimestamp(commandBuffer, VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT, pool_, index);
}

std::vector<double> Timestamps::intervals() const {
  std::vector<uint64_t> ticks(count_);
  check(
      vkGetQueryPoolResults(device_.handle(), pool_, 0, count_, ticks.size() * sizeof(uint64_t), ticks.data(),
                            sizeof(uint64_t), VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT),
      "vkGetQueryPoolResults");
  std::vector<double> result;
  for (uint32_t i = 1; i < count_; ++i)
    result.push_back(static_cast<double>(ticks[i] - ticks[i - 1]) *
                     static_cast<double>(device_.properties().limits.timestampPeriod) * 1e-3);
  return result;
}

}  // namespace pellucid::harness
