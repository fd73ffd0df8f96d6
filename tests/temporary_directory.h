// A directory of a test's own.
#pragma once

#include <filesystem>
#include <random>
#include <string>
#include <system_error>

namespace pellucid::harness {

// Goes away with the test.
class TemporaryDirectory {
public:
  TemporaryDirectory() {
    static int count = 0;
    const auto base = std::filesystem::temp_directory_path();
    do {
      path_ =
          base / ("pellucid_test_" + std::to_string(std::random_device{}()) + "_" + std::to_string(count++));
    } while (!std::filesystem::create_directory(path_));
  }
  ~TemporaryDirectory() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TemporaryDirectory(const TemporaryDirectory&) = delete;
  TemporaryDirectory& operator=(const TemporaryDirectory&) = delete;

  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
  operator const std::filesystem::path&() const { return path_; }

private:
  std::filesystem::path path_;
};

}  // namespace pellucid::harness
