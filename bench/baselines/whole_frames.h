// Whole frames as others render them: their light through thin parts, then their diffusion. Own
// implementations, each with the kernel that its paper derives for the frame's material.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "bench_frame.h"
#include "capture/capture.h"

namespace pellucid::bench {

// The image to diffuse: the frame's irradiance, or an image of rgba16f in its place.
using Source = std::shared_ptr<const harness::GpuImage>;

// d'Eon & Luebke 2007 / Jimenez et al. 2009: six Gaussians, two passes each.
Variant gaussianSum(const std::shared_ptr<const BenchFrame>& frame, const Source& source = nullptr);

// The diffusions that follow transmittance in wholeFrames(), of the frame's irradiance: six Gaussians, the
// pre-integrated separable kernel of Jimenez et al. 2015, and the disk of Golubev 2018.
std::vector<Variant> baselines(const std::shared_ptr<const BenchFrame>& frame);

// Irradiance with the light that comes through, one pass over all lights with a shadow map.
struct TransmittancePass {
  Variant variant;
  Source image;  // what the pass writes; irradiance where there is no material
};

// Settings whose frame both passes bind: the frame of `settings` has its lights and maps in the plan's first
// dispatch. The frame also has normals.
harness::ReplaySettings transmittanceSettings();

// Jimenez et al. 2010: T(d) of six Gaussians.
TransmittancePass gaussianTransmittance(const std::shared_ptr<const BenchFrame>& frame);

// HDRP: T(d) of Burley's profile (Christensen & Burley 2015).
TransmittancePass burleyTransmittance(const std::shared_ptr<const BenchFrame>& frame);

// Why these passes cannot do a capture: they have one material and at most four shadow maps. Empty: they can.
std::string whyNotRendered(const harness::Capture& capture, const std::vector<PellucidMaterial>& materials);

// A whole frame, and which of baselines(), by name, its diffusion is.
struct WholeFrame {
  Variant variant;
  std::string diffusion;
};

// Jimenez et al. 2010 and 2015, the six Gaussians of 2009 in place of the latter, and HDRP's, in the sizes
// that are in use. `frame`: of transmittanceSettings(), with normals.
std::vector<WholeFrame> wholeFrames(const std::shared_ptr<const BenchFrame>& frame);
// The fastest of Jimenez et al.'s and the fastest of HDRP's.
std::vector<WholeFrame> fastestWholeFrames(const std::shared_ptr<const BenchFrame>& frame);

// The transmittance passes against float64 evaluations of their equations on the CPU, on an ear under three
// lights. Throws DeviceError naming what differs.
void requireRightTransmittance(harness::Device& device, const harness::Context& context,
                               const PellucidMaterial& material);

}  // namespace pellucid::bench
