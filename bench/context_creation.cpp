#include "sections.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "common/error.h"
#include "replay/replay.h"

namespace pellucid::bench {

using namespace harness;

namespace {

struct Cost {
  double wall, cpu;  // microseconds
};

using Environment = std::vector<std::string>;

// NVIDIA's and Mesa's.
const Environment kWithoutCache = {"__GL_SHADER_DISK_CACHE=0", "MESA_SHADER_CACHE_DISABLE=true"};

Environment cacheIn(const std::string& folder) {
  return {"__GL_SHADER_DISK_CACHE=1", "__GL_SHADER_DISK_CACHE_PATH=" + folder,
          "MESA_SHADER_CACHE_DISABLE=false", "MESA_SHADER_CACHE_DIR=" + folder};
}

// Gone with what is in it.
struct TemporaryFolder {
  std::string path = (std::filesystem::temp_directory_path() / "pellucid_bench-XXXXXX").string();
  TemporaryFolder() {
    if (!mkdtemp(path.data())) throw InputError(path, "", "cannot be made");
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path, ignored);
  }
};

// Adds a word to a command of the shell.
void addWord(std::string& command, const std::string& word) {
  command += " '";
  for (const char c : word) {
    if (c == '\'') command += "'\\'";  // ends the quotes, and begins them again
    command += c;
  }
  command += "'";
}

// The output of a process of this program with these arguments and variables.
Cost createdBy(std::vector<std::string> arguments, const std::string& device, const Environment& variables) {
  arguments.push_back("--create-context");
  if (!device.empty()) arguments.insert(arguments.end(), {"--device", device});
  std::string command = "env";
  for (const std::string& variable : variables) addWord(command, variable);
  addWord(command, std::filesystem::read_symlink("/proc/self/exe"));
  for (const std::string& argument : arguments) addWord(command, argument);
  std::FILE* const pipe = popen(command.c_str(), "r");
  Cost cost{};
  const bool said = pipe && std::fscanf(pipe, "%lf %lf", &cost.wall, &cost.cpu) == 2;
  if (!pipe || pclose(pipe) != 0 || !said)
    throw DeviceError("a process that creates a context failed: " + command);
  return cost;
}

void add(Report& report, const std::string& name, const std::vector<Cost>& costs) {
  std::vector<double> walls, cpus;
  for (const Cost& cost : costs) {
    walls.push_back(cost.wall);
    cpus.push_back(cost.cpu);
  }
  report.add({name, 0, 0, 0, {}, {{"cpu_us", percentiles(cpus).median}, {"processes", costs.size()}}},
             percentiles(walls));
}

VkPipelineCache loadCache(const Device& device, const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  const std::vector<char> data{std::istreambuf_iterator<char>(file), {}};
  if (!path.empty() && data.empty()) throw InputError(path.string(), "", "is no saved pipeline cache");
  VkPipelineCacheCreateInfo info{VK_STRUCTURE_TYPE_PIPELINE_CACHE_CREATE_INFO};
  info.initialDataSize = data.size();
  info.pInitialData = data.data();
  VkPipelineCache cache;
  check(vkCreatePipelineCache(device.handle(), &info, nullptr, &cache), "vkCreatePipelineCache");
  return cache;
}

void saveCache(const Device& device, VkPipelineCache cache, const std::filesystem::path& path) {
  size_t size = 0;
  check(vkGetPipelineCacheData(device.handle(), cache, &size, nullptr), "vkGetPipelineCacheData");
  std::vector<char> data(size);
  check(vkGetPipelineCacheData(device.handle(), cache, &size, data.data()), "vkGetPipelineCacheData");
  std::ofstream file(path, std::ios::binary);
  file.write(data.data(), static_cast<std::streamsize>(size));
  if (!file.flush()) throw InputError(path.string(), "", "cannot be written");
}

}  // namespace

int createContext(const Options& options) {
  Device device({options.device, false});
  const bool cached = !options.loadCache.empty() || !options.saveCache.empty();
  const VkPipelineCache cache = cached ? loadCache(device, options.loadCache) : VK_NULL_HANDLE;
  const auto start = std::chrono::steady_clock::now();
  const std::clock_t cpuStart = std::clock();  // of all threads
  {
    const Context context(device, [&](PellucidContextDesc& desc) {
      desc.options.pipelineCache = cache;
      desc.options.uses = options.uses;
    });
    const double cpu = 1e6 * static_cast<double>(std::clock() - cpuStart) / CLOCKS_PER_SEC;
    const double wall =
        std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - start).count();
    std::printf("%.1f %.1f\n", wall, cpu);
  }
  if (!options.saveCache.empty()) saveCache(device, cache, options.saveCache);
  vkDestroyPipelineCache(device.handle(), cache, nullptr);
  return 0;
}

void measureContextCreation(const std::string& device, int repeat, Report& report) {
  report.section("context creation");
  report.setFloor(0);
  const TemporaryFolder folder;
  const auto several = [&](const std::vector<std::string>& arguments, const Environment& variables) {
    std::vector<Cost> costs;
    for (int i = 0; i < std::min(repeat, 3); ++i) costs.push_back(createdBy(arguments, device, variables));
    return costs;
  };
  add(report, "no driver cache", {createdBy({}, device, kWithoutCache)});
  constexpr std::uint32_t kDefaultFrame = PELLUCID_USE_GATHER | PELLUCID_USE_DIFFUSION;
  add(report, "no driver cache, uses of a default frame whose lights have maps",
      {createdBy({"--uses", std::to_string(kDefaultFrame)}, device, kWithoutCache)});
  createdBy({}, device, cacheIn(folder.path));
  add(report, "driver cache", several({}, cacheIn(folder.path)));
  const std::string file = folder.path + "/pipelines";
  createdBy({"--save-cache", file}, device, kWithoutCache);
  add(report, "saved VkPipelineCache", several({"--load-cache", file}, kWithoutCache));
}

}  // namespace pellucid::bench
