// Relative RMSE of the diffusion from brute force, of each quality at each radius (pixels within which 99.9 %
// of the energy lies) the worst of the scenes of docs/diffusion.md. Written by
// build/bin/pellucid_diffusion_error --table, which --check measures again.
#pragma once

namespace pellucid {

constexpr float kErrorRadii[] = {0.5, 2, 8, 32, 128};
constexpr float kWorstError[][5] = {
    {0.0002f, 0.0157f, 0.0621f, 0.0620f, 0.0859f},
    {0.0002f, 0.0065f, 0.0279f, 0.0483f, 0.0805f},
    {0.0002f, 0.0065f, 0.0279f, 0.0483f, 0.0805f},
    {0.0002f, 0.0065f, 0.0279f, 0.0483f, 0.0805f},
};

}  // namespace pellucid
