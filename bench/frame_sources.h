// The frames that somebody renders: of files, drawn from models, or procedural stand-ins.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "capture/capture.h"
#include "common/device.h"
#include "options.h"
#include "raster/raster.h"

namespace pellucid::bench {

inline constexpr const char* kFrameNames[] = {"portrait", "closeup", "crowd", "far", "nothing"};

struct FrameSource {
  std::string name;
  std::function<harness::Capture()> make;  // seconds
  // The frame after its lights turned a little: of a capture NAME.exr that has NAME.turned.exr beside it.
  std::shared_ptr<const harness::Capture> turned = nullptr;
};

// The capture without exit depths and caster materials: few engines have them, and the other methods here
// bind no images for them.
harness::Capture withMapsAlone(harness::Capture capture);

// Captures of files come first, then every name at each size; only the former where there are some and
// neither models nor names are given. The device draws models. Throws InputError for what cannot be read.
std::vector<FrameSource> frameSources(harness::Device& device, const FrameOptions& options);

// A scan of a head under a key and a rim light, as its camera "portrait" sees it.
struct DrawnModel {
  harness::Model model;
  harness::ModelCamera camera;
  harness::RasterOptions raster;  // `size` pixels a side
};
// Throws InputError where FrameOptions::models lacks it.
DrawnModel portrait(harness::Device& device, const FrameOptions& options, int size);

}  // namespace pellucid::bench
