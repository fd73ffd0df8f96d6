// Memory that ends where access ends: what shaders read beyond it stops the process, with a sentence.
#pragma once

#include <cstddef>
#include <cstdint>

namespace pellucid::harness {

// Whole pages of the host between pages without access.
class GuardedMemory {
public:
  // At least `size` bytes, a multiple of `alignment`, which is a power of two. Throws std::bad_alloc.
  GuardedMemory(std::size_t size, std::size_t alignment);
  ~GuardedMemory();
  GuardedMemory(const GuardedMemory&) = delete;
  GuardedMemory& operator=(const GuardedMemory&) = delete;

  void* data() const { return data_; }
  std::size_t size() const { return size_; }

  // Bytes without access on each side: an index of 16 bits into the largest struct of a constants slice stays
  // in there.
  static constexpr std::size_t kGuard = std::size_t{1} << 30;

private:
  void* reserved_ = nullptr;
  void* data_ = nullptr;
  std::size_t size_ = 0, reservedSize_ = 0, slot_ = 0;
};

// From now on, an access to a guard ends the process with this exit code after a line on stderr that says how
// far off it was, and `text`: what ran, of at most 511 characters. Other faults stay what they were.
inline constexpr int kGuardExitCode = 1;
void reportGuardFaults(const char* text);

}  // namespace pellucid::harness
