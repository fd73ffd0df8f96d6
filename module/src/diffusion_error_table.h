// Relative RMSE of the diffusion from brute force, of each quality at each radius (pixels within which 99.9 %
// of the energy lies) the worst of the scenes of docs/diffusion.md. Written by
// build/bin/pellucid_diffusion_error --table, which --check measures again.
#pragma once

namespace pellucid {

constexpr float kErrorRadii[] = {0.5, 2, 8, 32, 128};
constexpr float kWorstError[][5] = {
    {0.0002f, 0.0157f, 0.0806f, 0.1045f, 0.0739f},
    {0.0002f, 0.0064f, 0.0238f, 0.0366f, 0.0402f},
    {0.0002f, 0.0064f, 0.0238f, 0.0366f, 0.0402f},
    {0.0002f, 0.0057f, 0.0071f, 0.0078f, 0.0118f},
};

}  // namespace pellucid
