// A light's shadow maps, drawn as an engine would.
#pragma once

#include <memory>
#include <vector>

#include "raster/draw.h"
#include "raster/irradiance.h"
#include "raster/raster.h"

namespace pellucid::harness {

struct DrawnShadows {
  std::vector<ShadowMap> maps;      // for the capture
  std::vector<ShadowImage> images;  // for the irradiance, of the targets
  std::vector<std::unique_ptr<RenderTarget>> targets;
};

// options.shadowSize > 0.
DrawnShadows drawShadows(Device& device, const Model& model, const UploadedModel& uploaded,
                         const Light& light, const RasterOptions& options);

// Throws InputError for options that no map can be drawn with.
void checkShadowDrawing(const Model& model, const RasterOptions& options);

// Gives all maps of the lights places in one image, or leaves each its own.
void placeShadowMaps(MapPlacement placement, std::vector<Light>& lights);

}  // namespace pellucid::harness
