#include "context_creation.h"

#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <ctime>
#include <fstream>
#include <iterator>
#include <map>
#include <random>
#include <sstream>

#include "common/error.h"
#include "replay/replay.h"

namespace pellucid::bench {

using namespace harness;

namespace {

struct Cost {
  double wall, cpu;  // microseconds
};

using Environment = std::map<std::string, std::string>;

// NVIDIA's and Mesa's.
const Environment kWithoutCache = {{"__GL_SHADER_DISK_CACHE", "0"}, {"MESA_SHADER_CACHE_DISABLE", "true"}};

Environment cacheIn(const std::filesystem::path& folder) {
  return {{"__GL_SHADER_DISK_CACHE", "1"},
          {"__GL_SHADER_DISK_CACHE_PATH", folder},
          {"MESA_SHADER_CACHE_DISABLE", "false"},
          {"MESA_SHADER_CACHE_DIR", folder}};
}

// Gone with what is in it.
class TemporaryFolder {
public:
  TemporaryFolder()
      : path_(std::filesystem::temp_directory_path() /
              ("pellucid_bench-" + std::to_string(getpid()) + "-" + std::to_string(std::random_device{}()))) {
    std::filesystem::create_directories(path_);
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }

private:
  std::filesystem::path path_;
};

std::vector<char*> pointers(std::vector<std::string>& texts) {
  std::vector<char*> result;
  for (std::string& text : texts) result.push_back(text.data());
  result.push_back(nullptr);
  return result;
}

// This program's process with these arguments and variables; what it printed.
std::string output(std::vector<std::string> arguments, const Environment& variables) {
  std::vector<std::string> environment;
  for (char** entry = environ; *entry; ++entry) {
    const std::string text = *entry;
    if (variables.count(text.substr(0, text.find('='))) == 0) environment.push_back(text);
  }
  for (const auto& [name, value] : variables) environment.push_back(name + "=" + value);
  const std::string self = std::filesystem::read_symlink("/proc/self/exe");
  arguments.insert(arguments.begin(), self);

  int ends[2];
  if (pipe(ends) != 0) throw DeviceError("no pipe to a process that creates a context");
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, ends[1], STDOUT_FILENO);
  posix_spawn_file_actions_addclose(&actions, ends[0]);
  pid_t process;
  const int failure = posix_spawn(&process, self.c_str(), &actions, nullptr, pointers(arguments).data(),
                                  pointers(environment).data());
  posix_spawn_file_actions_destroy(&actions);
  close(ends[1]);
  std::string text;
  char buffer[256];
  for (ssize_t n; failure == 0 && (n = read(ends[0], buffer, sizeof buffer)) > 0;)
    text.append(buffer, static_cast<size_t>(n));
  close(ends[0]);
  int status = 0;
  if (failure != 0 || waitpid(process, &status, 0) != process || status != 0)
    throw DeviceError("a process that creates a context failed: " + self);
  return text;
}

Cost createdBy(std::vector<std::string> arguments, const std::string& device, const Environment& variables) {
  arguments.push_back("--create-context");
  if (!device.empty()) arguments.insert(arguments.end(), {"--device", device});
  std::istringstream text(output(arguments, variables));
  Cost cost{};
  if (!(text >> cost.wall >> cost.cpu))
    throw DeviceError("a process that creates a context did not say its time");
  return cost;
}

void add(Report& report, const std::string& name, std::vector<Cost> costs) {
  std::sort(costs.begin(), costs.end(), [](const Cost& a, const Cost& b) { return a.wall < b.wall; });
  const auto at = [&](double share) {
    return costs[static_cast<size_t>(share * static_cast<double>(costs.size() - 1) + 0.5)];
  };
  report.add({name, 0, 0, 0, {}, {{"cpu_us", at(0.5).cpu}, {"processes", costs.size()}}},
             {at(0.5).wall, at(0.1).wall, at(0.9).wall});
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
    const Context context(
        device,
        [&](PellucidContextDesc& desc) {
          desc.options.pipelineCache = cache;
          desc.options.uses = options.uses;
        },
        Compile::AtCreation);
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
  createdBy({}, device, cacheIn(folder.path()));
  add(report, "driver cache", several({}, cacheIn(folder.path())));
  const std::string file = folder.path() / "pipelines";
  createdBy({"--save-cache", file}, device, kWithoutCache);
  add(report, "saved VkPipelineCache", several({"--load-cache", file}, kWithoutCache));
}

}  // namespace pellucid::bench
