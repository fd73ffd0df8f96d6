// Translucency without a dispatch: the shader that draws the back faces computes the transmitted light.
#pragma once

#include "pellucid/pellucid_plan.h"
#include "raster/raster.h"

namespace pellucid::harness {

// Camera-space thickness, transmittance and lighting while rasterizing back faces (Whelan 2009, 6.2.4),
// with compute/lib included in a fragment shader. `capture` is what rasterize() made of the same model and
// options, `frame` and `plan` a replay of that capture with 1 and lights that fit one fused dispatch. Returns
// transmitted / rho, RGB: what the dispatch adds to the irradiance where the model is closed (an open one has
// no back depth in the capture, but is drawn here). Throws InputError for a frame that is not so, and
// DeviceError as rasterize() does.
Image rasterizeTransmitted(Device& device, const Model& model, const Capture& capture,
                           const PellucidFrame& frame, const PellucidPlan& plan,
                           const RasterOptions& options);

}  // namespace pellucid::harness
