// Registers, shared memory, code and waves of a context's pipelines, as a driver's compiler reports them.
// AMD's driver of Mesa compiles for cards that are not there (./run shader-stats).
#include <vulkan/vulkan.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "pellucid/pellucid.h"
#include "pellucid/pellucid_plan.h"

namespace {

using Json = nlohmann::ordered_json;

struct Options {
  std::vector<std::string> families;
  std::string json, compare;
};

void check(VkResult result, const char* call) {
  if (result != VK_SUCCESS)
    throw std::runtime_error(std::string(call) + " returned VkResult " + std::to_string(result));
}

// The statistics that tools/bench_tables.py takes, by the names of RADV.
struct Column {
  const char *key, *statistic;
};
constexpr Column kColumns[] = {{"vgprs", "VGPRs"},        {"spilledVgprs", "Spilled VGPRs"}, {"spilledSgprs", "Spilled SGPRs"},
                               {"ldsBytes", "LDS size"},  {"codeBytes", "Code size"},        {"waves", "Subgroups per SIMD"}};

// A device that compiles and need not run anything.
class Compiler {
public:
  Compiler() {
    VkApplicationInfo application{VK_STRUCTURE_TYPE_APPLICATION_INFO};
    application.apiVersion = VK_API_VERSION_1_1;
    VkInstanceCreateInfo info{VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO};
    info.pApplicationInfo = &application;
    check(vkCreateInstance(&info, nullptr, &instance), "vkCreateInstance");
    uint32_t count = 1;
    const VkResult found = vkEnumeratePhysicalDevices(instance, &count, &physical);
    if (count == 0 || (found != VK_SUCCESS && found != VK_INCOMPLETE))
      throw std::runtime_error(
          "the driver has no device; VK_DRIVER_FILES names the driver, RADV_FORCE_FAMILY a card of RADV");
    VkPhysicalDeviceProperties properties;
    vkGetPhysicalDeviceProperties(physical, &properties);
    name = properties.deviceName;
    const float priority = 1;
    const VkDeviceQueueCreateInfo queue{
        VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO, nullptr, 0, 0, 1, &priority};
    VkPhysicalDevicePipelineExecutablePropertiesFeaturesKHR executables{
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PIPELINE_EXECUTABLE_PROPERTIES_FEATURES_KHR, nullptr, VK_TRUE};
    const char* const extensions[] = {VK_KHR_PUSH_DESCRIPTOR_EXTENSION_NAME,
                                      VK_KHR_PIPELINE_EXECUTABLE_PROPERTIES_EXTENSION_NAME};
    VkDeviceCreateInfo device{VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO, &executables};
    device.queueCreateInfoCount = 1;
    device.pQueueCreateInfos = &queue;
    device.enabledExtensionCount = 2;
    device.ppEnabledExtensionNames = extensions;
    check(vkCreateDevice(physical, &device, nullptr, &handle), "vkCreateDevice");
  }
  ~Compiler() {
    if (handle) vkDestroyDevice(handle, nullptr);
    if (instance) vkDestroyInstance(instance, nullptr);
  }
  Compiler(const Compiler&) = delete;

  VkInstance instance = VK_NULL_HANDLE;
  VkPhysicalDevice physical = VK_NULL_HANDLE;
  VkDevice handle = VK_NULL_HANDLE;
  std::string name;
};

// The pipelines that the module makes, in the order of their indices. Functions of Vulkan have no user data.
std::vector<VkPipeline> made;

VkResult VKAPI_CALL createPipelines(VkDevice device, VkPipelineCache cache, uint32_t count,
                                    const VkComputePipelineCreateInfo* infos,
                                    const VkAllocationCallbacks* allocator, VkPipeline* pipelines) {
  std::vector<VkComputePipelineCreateInfo> captured(infos, infos + count);
  for (VkComputePipelineCreateInfo& info : captured)
    info.flags |= VK_PIPELINE_CREATE_CAPTURE_STATISTICS_BIT_KHR;
  const VkResult result =
      vkCreateComputePipelines(device, cache, count, captured.data(), allocator, pipelines);
  if (result == VK_SUCCESS) made.insert(made.end(), pipelines, pipelines + count);
  return result;
}

PFN_vkVoidFunction VKAPI_CALL deviceFunction(VkDevice device, const char* name) {
  if (std::strcmp(name, "vkCreateComputePipelines") == 0)
    return reinterpret_cast<PFN_vkVoidFunction>(createPipelines);
  return vkGetDeviceProcAddr(device, name);
}

PFN_vkVoidFunction VKAPI_CALL instanceFunction(VkInstance instance, const char* name) {
  if (std::strcmp(name, "vkGetDeviceProcAddr") == 0)
    return reinterpret_cast<PFN_vkVoidFunction>(deviceFunction);
  return vkGetInstanceProcAddr(instance, name);
}

Json statisticsOf(const Compiler& compiler, VkPipeline pipeline) {
  const auto get = reinterpret_cast<PFN_vkGetPipelineExecutableStatisticsKHR>(
      vkGetDeviceProcAddr(compiler.handle, "vkGetPipelineExecutableStatisticsKHR"));
  const VkPipelineExecutableInfoKHR info{VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_INFO_KHR, nullptr, pipeline,
                                         0};
  uint32_t count = 0;
  check(get(compiler.handle, &info, &count, nullptr), "vkGetPipelineExecutableStatisticsKHR");
  std::vector<VkPipelineExecutableStatisticKHR> all(count,
                                                    {VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_STATISTIC_KHR});
  check(get(compiler.handle, &info, &count, all.data()), "vkGetPipelineExecutableStatisticsKHR");
  Json row;
  for (const Column& column : kColumns) {
    for (const VkPipelineExecutableStatisticKHR& s : all)
      if (std::strcmp(s.name, column.statistic) == 0) row[column.key] = s.value.u64;
    if (!row.contains(column.key))
      throw std::runtime_error(compiler.name + " reports no \"" + column.statistic + "\"");
  }
  return row;
}

// Of all pipelines of a context with the defaults.
Json measure(std::string& name) {
  const Compiler compiler;
  name = compiler.name;
  PellucidContextDesc desc;
  pellucidInitContextDesc(&desc);
  desc.instance = compiler.instance;
  desc.physicalDevice = compiler.physical;
  desc.device = compiler.handle;
  desc.getInstanceProcAddr = instanceFunction;
  std::string sentence;
  desc.messageUser = &sentence;
  desc.message = [](void* user, PellucidSeverity, const char* field, const char* message) {
    *static_cast<std::string*>(user) += std::string(field) + " " + message;
  };
  made.clear();
  PellucidContext* context = nullptr;
  if (pellucidCreateContext(&desc, &context) != PELLUCID_OK) throw std::runtime_error(sentence);
  Json pipelines;
  for (uint32_t i = 0; i < made.size(); ++i)
    pipelines[pellucidPipelineName(i)] = statisticsOf(compiler, made[i]);
  pellucidDestroyContext(context);
  return pipelines;
}

Json measureAll(const Options& options) {
  Json all;
  for (const std::string& family : options.families) {
    ::setenv("RADV_FORCE_FAMILY", family.c_str(), 1);
    std::string name;
    Json pipelines = measure(name);
    all["families"][family] = {{"device", name}, {"pipelines", std::move(pipelines)}};
  }
  return all;
}

Json read(const std::string& path) {
  std::ifstream file(path);
  if (!file) throw std::runtime_error(path + " cannot be read");
  try {
    return Json::parse(file);
  } catch (const Json::exception& e) {
    throw std::runtime_error(path + ": " + e.what());
  }
}

// The pipelines that a wave less runs of than in `kept`, one line each.
std::string lostWaves(const Json& now, const Json& kept) {
  std::string lost;
  for (const auto& [family, was] : kept.at("families").items())
    for (const auto& [pipeline, row] : was.at("pipelines").items()) {
      const auto found = now.at("families").find(family);
      if (found == now.at("families").end() || !found->at("pipelines").contains(pipeline)) {
        lost += family + ", " + pipeline + ": not measured now; --json writes a new file to keep\n";
        continue;
      }
      const uint64_t before = row.at("waves"), waves = found->at("pipelines").at(pipeline).at("waves");
      if (waves < before)
        lost += family + ", " + pipeline + ": " + std::to_string(waves) + " waves a SIMD, " +
                std::to_string(before) + " before\n";
    }
  return lost;
}

int run(const Options& options) {
  const Json all = measureAll(options);
  if (options.compare.empty() && options.json.empty()) std::printf("%s\n", all.dump(1).c_str());
  if (!options.json.empty()) {
    std::ofstream file(options.json);
    file << all.dump(1) << "\n";
    if (!file.flush()) throw std::runtime_error(options.json + " cannot be written");
  }
  if (options.compare.empty()) return 0;
  const std::string lost = lostWaves(all, read(options.compare));
  std::fputs(lost.c_str(), stderr);
  return lost.empty() ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App app("Registers, code and waves of all pipelines, as a driver's compiler reports them",
               "pellucid_shader_stats");
  app.add_option("--family", options.families, "cards of RADV to compile for, one or more")
      ->default_val(std::vector<std::string>{"navi21", "navi10", "vega20", "polaris10"});
  app.add_option("--json", options.json, "file for the results; default: standard output, but for --compare");
  app.add_option("--compare", options.compare,
                 "results that were kept: exit code 1 where a pipeline has fewer waves than there");
  CLI11_PARSE(app, argc, argv);
  try {
    return run(options);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "pellucid_shader_stats: %s\n", e.what());
    return 3;
  }
}
