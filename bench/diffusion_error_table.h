// Relative RMSE of the diffusion from brute force at each radius (pixels within which 99.9 % of the energy
// lies), the worst of the scenes of docs/accuracy.md. Written by build/bin/pellucid_diffusion_error --table,
// which --check measures again.
#pragma once

namespace pellucid {

constexpr float kErrorRadii[] = {0.5, 2, 8, 32, 128};
constexpr float kWorstError[] = {0.0002f, 0.0091f, 0.0316f, 0.0415f, 0.0389f};

}  // namespace pellucid
