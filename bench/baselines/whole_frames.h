// Whole frames as others render them: their light through thin parts, then their diffusion. Own
// implementations.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "baselines/baselines.h"
#include "capture/capture.h"

namespace pellucid::bench {

// Irradiance with the light that comes through, one pass over all lights with a shadow map.
struct TransmittancePass {
  Variant variant;
  Source image;  // what the pass writes; irradiance where there is no material
};

// Settings whose frame both passes bind: the frame of `settings` has its lights, maps and normals in the
// plan's first dispatch.
harness::ReplaySettings transmittanceSettings();

// Jimenez et al. 2010: T(d) of six Gaussians.
TransmittancePass gaussianTransmittance(const std::shared_ptr<const BenchFrame>& frame);

// HDRP: T(d) of Burley's profile (Christensen & Burley 2015).
TransmittancePass burleyTransmittance(const std::shared_ptr<const BenchFrame>& frame);

// Why these passes cannot do a capture: they have one material, at most four shadow maps, and normals. Empty:
// they can.
std::string whyNotRendered(const harness::Capture& capture, const std::vector<PellucidMaterial>& materials);

// A whole frame, the name of its transmittance pass, and which of baselines(), by name, its diffusion is.
struct WholeFrame {
  Variant variant;
  std::string transmittance, diffusion;
};

// Jimenez et al. 2010 and 2015, the six Gaussians of 2009 in place of the latter, and HDRP's, in the sizes
// that are in use. `frame`: of transmittanceSettings().
std::vector<WholeFrame> wholeFrames(const std::shared_ptr<const BenchFrame>& frame);

// The transmittance passes against float64 evaluations of their equations on the CPU, on a slab, whose answer
// is closed, and on an ear under three lights; the whole frames against their diffusion of what these passes
// wrote. Throws DeviceError naming what differs.
void requireRightWholeFrames(harness::Device& device, const harness::Context& context,
                             const PellucidMaterial& material);

}  // namespace pellucid::bench
