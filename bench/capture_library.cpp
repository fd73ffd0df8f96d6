// pellucid_bench_captures.so
#include "capture/read.h"
#include "frame_files.h"

extern "C" {
void pellucidBenchReadCapture(const std::filesystem::path& file, pellucid::harness::Capture& capture) {
  capture = pellucid::harness::readCapture(file);
}
}

static_assert(std::is_same_v<decltype(pellucidBenchReadCapture), pellucid::bench::ReadCaptureFile>);
