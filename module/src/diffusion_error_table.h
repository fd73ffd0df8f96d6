// Relative RMSE of the diffusion from brute force, of each quality at each radius (pixels within which 99.9 %
// of the energy lies) the worst of the scenes of docs/diffusion.md. Written by
// build/bin/pellucid_diffusion_error --table, which --check measures again.
#pragma once

namespace pellucid {

constexpr float kErrorRadii[] = {0.5, 2, 8, 32, 128};
constexpr float kWorstError[][5] = {
    {0.0002f, 0.0157f, 0.0621f, 0.0619f, 0.0418f},
    {0.0002f, 0.0065f, 0.0224f, 0.0221f, 0.0387f},
    {0.0002f, 0.0065f, 0.0224f, 0.0221f, 0.0387f},
    {0.0002f, 0.0046f, 0.0071f, 0.0077f, 0.0122f},
};

}  // namespace pellucid
