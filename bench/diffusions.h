// The module's diffusion and the published ones: how far each is from brute force, and the plot of that
// against time.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "baselines/baselines.h"
#include "capture/capture.h"
#include "common/plot.h"

namespace pellucid::bench {

// Where frames run, and what of.
struct Site {
  harness::Device& device;
  const harness::Context& context;
  PellucidMaterial material;
  double pixel;                                       // mm
  int errorPixels = std::numeric_limits<int>::max();  // of a scene, at most, that brute force is computed at

  std::shared_ptr<const BenchFrame> frame(const harness::Capture& capture,
                                          harness::ReplaySettings settings) const;
  harness::Image run(const Variant& variant) const;
};

// Root mean square over the channels of the relative RMSE of `image`, where there is a material. Throws
// DeviceError beyond `limit`: a wrong pass is not worth timing. `pixels`: one value per pixel, which counts
// where it is not 0; empty: all.
double requireNear(const Variant& v, const harness::Image& image, const harness::Image& truth,
                   const harness::Capture& capture, double limit,
                   const std::vector<std::uint8_t>& pixels = {});

// The module's, and then the baselines.
std::vector<Variant> diffusions(const Site& site, const harness::Capture& capture);

// Of these: against the float64 reference, the largest of the scenes'.
std::vector<double> diffusionErrors(const Site& site);

struct TimedError {
  std::string name;
  double error, time;  // relative RMSE; microseconds
};

// A family of variants is a color: what stands before the comma of its members' names. `from`: what errors
// are from.
harness::Plot timeAgainstError(const std::string& title, const std::vector<TimedError>& points,
                               const std::string& from = "brute force");

}  // namespace pellucid::bench
