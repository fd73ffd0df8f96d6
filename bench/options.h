// What the command line asks for.
#pragma once

#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace pellucid::bench {

struct FrameOptions {
  std::vector<std::string> captures;       // files
  std::filesystem::path models;            // folder of head_views.glb and crowd.glb; empty: stand-ins
  std::vector<std::pair<int, int>> sizes;  // of the made ones; empty: by the kind of device
  std::vector<std::string> names;          // of the made ones; empty: all
  std::optional<int> shadowSize;           // texels a side; absent: by the kind of device
  int errorPixels = 4096;                  // at most, that brute force is computed at
};

struct Options {
  std::string device, json;
  std::optional<int> repeat;  // absent: 7, or 3 on a software device
  std::set<std::string> tables = {"frames", "context"};
  FrameOptions frames;
  // Options of the processes that the section context starts.
  bool createContext = false;
  std::uint32_t uses = 0;  // of that context; PellucidContextDesc::uses
  std::filesystem::path loadCache, saveCache;
};

// The exit status where the command line ends the program, else -1.
int readOptions(int argc, char** argv, Options& options);

}  // namespace pellucid::bench
