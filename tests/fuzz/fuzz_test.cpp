// Every seed of every fuzz target: the code under test accepts it or says what is wrong, without a crash, a
// hang or memory by the gigabyte. `./run fuzz` goes on from there.
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <ctime>
#include <fstream>
#include <ostream>

#include "fuzz/targets.h"

namespace pellucid::fuzz {

// GoogleTest would print the bytes.
void PrintTo(const Target& target, std::ostream* out) { *out << target.name; }

namespace {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kLimitsMemory = false;  // sanitizers reserve terabytes
#else
constexpr bool kLimitsMemory = true;
#endif

// While it lives the process may take half a gigabyte more than it has; beyond, new throws bad_alloc.
class MemoryLimit {
public:
  MemoryLimit() {
    getrlimit(RLIMIT_AS, &before_);
    if (!kLimitsMemory) return;
    std::size_t pages = 0;
    std::ifstream("/proc/self/statm") >> pages;
    rlimit limit = before_;
    limit.rlim_cur = pages * 4096 + (rlim_t{512} << 20);
    setrlimit(RLIMIT_AS, &limit);
  }
  ~MemoryLimit() { setrlimit(RLIMIT_AS, &before_); }
  MemoryLimit(const MemoryLimit&) = delete;
  MemoryLimit& operator=(const MemoryLimit&) = delete;

private:
  rlimit before_;
};

class Seeds : public testing::TestWithParam<Target> {};

TEST_P(Seeds, AreAcceptedOrRefusedWithASentence) {
  int count = 0, accepted = 0;
  const MemoryLimit limit;
  forEachSeed(GetParam().name, [&](const std::string& bytes) {
    SCOPED_TRACE(count);
    const std::clock_t start = std::clock();  // of the process: other work of the machine does not count
    bool isAccepted = false;
    EXPECT_NO_THROW(isAccepted =
                        GetParam().run({reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size()}));
    // A sound input takes some milliseconds, but the first one compiles the materials of random frames.
    EXPECT_LT(std::clock() - start, (count == 0 ? 60 : 5) * CLOCKS_PER_SEC);
    EXPECT_TRUE(isAccepted || count > 0) << "the first is sound";
    ++count;
    accepted += isAccepted;
  });
  RecordProperty("accepted", accepted);
  // Some damage does no harm, and most does.
  EXPECT_GT(accepted, count / 200);
  EXPECT_LT(accepted, count * 9 / 10);
}

INSTANTIATE_TEST_SUITE_P(Targets, Seeds, testing::ValuesIn(kTargets),
                         [](const auto& test) { return std::string(test.param.name); });

}  // namespace
}  // namespace pellucid::fuzz
