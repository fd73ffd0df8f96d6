// Relative RMSE of whole frames against path tracing, with 0, 8 and 16 samples a probe: the worst channel of
// the worst frame among the ear, the heads and the bunny of docs/accuracy.md, which is the ear.
// tests/gpu/shared_captures_test.cpp measures the ear's again; bench/bench_test.cpp holds the other frames
// against them.
#pragma once

namespace pellucid {

constexpr float kFrameError[] = {0.179f, 0.0605f, 0.0598f};

}  // namespace pellucid
