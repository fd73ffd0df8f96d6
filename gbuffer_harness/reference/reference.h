// Float64 ground truth of the whole pass, written from the equations alone: it shares no code with
// the module or its shaders.
#pragma once

#include <cstdint>
#include <vector>

#include "capture/capture.h"
#include "common/translucency_settings.h"
#include "reference/diffusion.h"

namespace pellucid::harness::reference {

// Mirrors the settings of PellucidFrame.
struct Settings {
  std::uint32_t features = PELLUCID_FEATURE_TRANSLUCENCY | PELLUCID_FEATURE_DIFFUSION;
  TranslucencySettings translucency;
  bool ambient = false;  // light from all around comes through thin parts
  PellucidDebugView debugView = PELLUCID_DEBUG_NONE;
  // One value per pixel: the output is computed where it is not 0, and 0 elsewhere. Empty: everywhere.
  std::vector<std::uint8_t> wanted;
};

struct Result {
  Image image;  // RGB, see compute()
};

// The output of the pass, albedo * diffused(E + transmitted / rho), or the debug view; computed in
// double, rounded to float at the end. `materials` belong to the capture's in order. Pixels of
// material 0, which the pass leaves alone, are 0. Colors that are NaN, infinite or negative count as 0.
// Light is not gathered: a pixel takes one thickness, whatever gatherSamples asks for. A material pixel
// without front depth only gets its albedo. Debug views have the layouts of PellucidDebugView, TRANSMITTANCE
// and OCCLUSION per channel: transmitted / unoccluded and unoccluded / arriving irradiance, 0 where the
// divisor is 0. Throws InputError naming the capture, field and value.
Result compute(const Capture& capture, const std::vector<PellucidMaterial>& materials,
               const Settings& settings);

}  // namespace pellucid::harness::reference
