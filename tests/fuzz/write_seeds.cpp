// pellucid_fuzz_seeds TARGET FOLDER: writes the target's seeds as files 0, 1, ... for libFuzzer to begin
// with.
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>

#include "fuzz/targets.h"

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fprintf(stderr, "usage: pellucid_fuzz_seeds TARGET FOLDER\n");
    return 2;
  }
  try {
    const std::filesystem::path folder = argv[2];
    std::filesystem::create_directories(folder);
    int count = 0;
    pellucid::fuzz::forEachSeed(argv[1], [&](const std::string& bytes) {
      std::ofstream(folder / std::to_string(count++), std::ios::binary) << bytes;
    });
    std::printf("%s: %d seeds\n", argv[1], count);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
