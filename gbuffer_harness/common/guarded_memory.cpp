#include "common/guarded_memory.h"

#include <signal.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdio>
#include <cstring>
#include <new>

namespace pellucid::harness {
namespace {

// What the handler of a signal may read: no allocation, no locks.
struct Guarded {
  std::atomic<std::uintptr_t> data{0};  // 0: free
  std::atomic<std::size_t> size{0};
};
std::array<Guarded, 256> guarded;
char running[512];

std::size_t takeSlot(std::uintptr_t data, std::size_t size) {
  for (std::size_t i = 0; i < guarded.size(); ++i) {
    std::uintptr_t none = 0;
    if (!guarded[i].data.compare_exchange_strong(none, data)) continue;
    guarded[i].size = size;
    return i;
  }
  throw std::bad_alloc();
}

void onFault(int signal, siginfo_t* info, void*) {
  const auto at = reinterpret_cast<std::uintptr_t>(info->si_addr);
  for (const Guarded& g : guarded) {
    const std::uintptr_t data = g.data;
    const std::size_t size = g.size;
    if (data == 0 || at < data - GuardedMemory::kGuard || at >= data + size + GuardedMemory::kGuard) continue;
    // snprintf of integers takes no locks in practice, and the process is over anyway.
    char line[640];
    const bool before = at < data;
    std::snprintf(line, sizeof line, "an access %llu bytes %s memory that is guarded: %s\n",
                  static_cast<unsigned long long>(before ? data - at : at - data - size),
                  before ? "before" : "beyond", running);
    const auto written = ::write(STDERR_FILENO, line, std::strlen(line));
    _exit(written < 0 ? kGuardExitCode + 1 : kGuardExitCode);
  }
  // Another fault: the same instruction meets it again, without this handler.
  ::signal(signal, SIG_DFL);
}

}  // namespace

GuardedMemory::GuardedMemory(std::size_t size, std::size_t alignment) {
  const std::size_t page = std::max(alignment, static_cast<std::size_t>(sysconf(_SC_PAGESIZE)));
  size_ = (size + page - 1) / page * page;
  // Room to align the pages within what is reserved.
  const std::size_t all = 2 * kGuard + size_ + page;
  reserved_ = mmap(nullptr, all, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (reserved_ == MAP_FAILED) throw std::bad_alloc();
  const auto first = (reinterpret_cast<std::uintptr_t>(reserved_) + kGuard + page - 1) / page * page;
  data_ = reinterpret_cast<void*>(first);
  if (mprotect(data_, size_, PROT_READ | PROT_WRITE) != 0) {
    munmap(reserved_, all);
    throw std::bad_alloc();
  }
  reservedSize_ = all;
  slot_ = takeSlot(first, size_);
}

GuardedMemory::~GuardedMemory() {
  guarded[slot_].data = 0;
  munmap(reserved_, reservedSize_);
}

void reportGuardFaults(const char* text) {
  std::snprintf(running, sizeof running, "%s", text);
  struct sigaction action {};
  action.sa_sigaction = onFault;
  action.sa_flags = SA_SIGINFO;
  sigaction(SIGSEGV, &action, nullptr);
  sigaction(SIGBUS, &action, nullptr);
}

}  // namespace pellucid::harness
