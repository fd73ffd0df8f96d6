// Memory that ends where access ends.
#include "common/guarded_memory.h"

#include <gtest/gtest.h>
#include <sys/mman.h>

#include <csignal>
#include <cstring>

namespace {

using pellucid::harness::GuardedMemory;
using pellucid::harness::kGuardExitCode;
using pellucid::harness::reportGuardFaults;

TEST(GuardedMemory, HoldsWholePages) {
  for (const std::size_t size : {std::size_t{1}, std::size_t{4096}, std::size_t{70000}}) {
    GuardedMemory memory(size, 65536);
    EXPECT_GE(memory.size(), size);
    EXPECT_EQ(memory.size() % 65536, 0u);
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(memory.data()) % 65536, 0u);
    std::memset(memory.data(), 0x5A, memory.size());
    EXPECT_EQ(static_cast<char*>(memory.data())[memory.size() - 1], 0x5A);
  }
}

// Reads one byte at an offset from the memory's first.
void readAt(std::ptrdiff_t offset) {
  GuardedMemory memory(4096, 4096);
  reportGuardFaults("frame 7");
  const volatile char* bytes = static_cast<const char*>(memory.data());
  const char value = bytes[offset];
  (void)value;
}

TEST(GuardedMemoryDeathTest, AccessBeyondEndsTheProcessBySentence) {
  testing::FLAGS_gtest_death_test_style = "threadsafe";
  const auto exits = testing::ExitedWithCode(kGuardExitCode);
  EXPECT_EXIT(readAt(4096), exits, "an access 0 bytes beyond memory that is guarded: frame 7");
  EXPECT_EXIT(readAt(4096 + 254 * 3520), exits, "an access 894080 bytes beyond memory");
  EXPECT_EXIT(readAt(-8), exits, "an access 8 bytes before memory that is guarded: frame 7");
}

TEST(GuardedMemoryDeathTest, OtherFaultsStayFaults) {
  testing::FLAGS_gtest_death_test_style = "threadsafe";
  EXPECT_EXIT(
      {
        reportGuardFaults("frame 7");
        // Not at null: sanitizers end such an access before it faults.
        void* closed = mmap(nullptr, 1, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
        *static_cast<volatile char*>(closed) = 1;
      },
      testing::KilledBySignal(SIGSEGV), "^$");
}

}  // namespace
