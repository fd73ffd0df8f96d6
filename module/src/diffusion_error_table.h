// Relative RMSE of the diffusion from brute force, of each quality at each radius (pixels within which 99.9 %
// of the energy lies) the worst of the scenes of docs/diffusion.md. Written by
// build/bin/pellucid_diffusion_error --table, which --check measures again.
#pragma once

namespace pellucid {

constexpr float kErrorRadii[] = {0.5, 2, 8, 32, 128};
constexpr float kWorstError[][5] = {
    {0.0002f, 0.0157f, 0.0791f, 0.1039f, 0.0744f},
    {0.0002f, 0.0064f, 0.0237f, 0.0364f, 0.0396f},
    {0.0002f, 0.0069f, 0.0095f, 0.0086f, 0.0089f},
    {0.0002f, 0.0011f, 0.0012f, 0.0015f, 0.0018f},
};

}  // namespace pellucid
