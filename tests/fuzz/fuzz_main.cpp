// libFuzzer's entry points of one target. A first run in an empty folder starts from the seeds that
// pellucid_fuzz_seeds writes there.
#include <cstdio>
#include <cstdlib>

#include "fuzz/targets.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  try {
    pellucid::fuzz::PELLUCID_FUZZ_FUNCTION({data, size});
  } catch (const pellucid::fuzz::BrokenPromise& promise) {
    std::fprintf(stderr, "broken promise: %s\n", promise.what());
    std::abort();
  }
  return 0;
}
