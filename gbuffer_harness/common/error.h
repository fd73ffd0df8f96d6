// The harness's exceptions, one per exit code of the command line.
#pragma once

#include <new>
#include <stdexcept>
#include <string>

namespace pellucid::harness {

// Bad input (exit code 3). The sentence names the file, the field and the value.
class InputError : public std::runtime_error {
public:
  InputError(const std::string& file, const std::string& field, const std::string& sentence)
      : std::runtime_error((file.empty() ? std::string() : file + ": ") +
                           (field.empty() ? std::string() : field + ": ") + sentence) {}
};

// Calls work(), which takes memory for what is in `file`; where there is none left, throws InputError.
template <class Work>
auto withinMemory(const std::string& file, const Work& work) {
  try {
    return work();
  } catch (const std::bad_alloc&) {
    throw InputError(file, "", "needs more memory than there is");
  }
}

// Wrong use of the command line (exit code 2).
class UsageError : public std::runtime_error {
public:
  using std::runtime_error::runtime_error;
};

// No usable Vulkan device, or a Vulkan call failed (exit code 4).
class DeviceError : public std::runtime_error {
public:
  using std::runtime_error::runtime_error;
};

}  // namespace pellucid::harness
