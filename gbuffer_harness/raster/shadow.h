// A light's shadow maps, drawn as an engine would.
#pragma once

#include <memory>
#include <vector>

#include "raster/draw.h"
#include "raster/framing.h"
#include "raster/passes.h"
#include "raster/raster.h"

namespace pellucid::harness {

// One map on the device.
struct DrawnMap {
  ShadowMap outline;  // without images
  ShadowImage image;  // for the irradiance
  std::shared_ptr<const RenderTarget> surface;
  std::shared_ptr<const RenderTarget> exit;    // null: the map has no exit depth and no casters
  std::shared_ptr<const RenderTarget> engine;  // whose depth buffer the map keeps; null: a depth of `surface`
};

// What the maps of a light of this model show.
std::vector<LightView> shadowViews(const ModelPoints& points, const Light& light, const ModelCamera& camera,
                                   const RasterOptions& options);

// Records the drawing of a light's maps. options.shadowSize > 0.
std::vector<DrawnMap> recordShadows(VkCommandBuffer commands, TargetPool& targets,
                                    const std::vector<LightView>& views, const UploadedModel& uploaded,
                                    const Light& light, const RasterOptions& options);

// The map with its images.
ShadowMap downloadMap(const DrawnMap& map, const RasterOptions& options);

// True where device images hold what downloadMap() returns.
bool areOnDevice(const RasterOptions& options);

// The images that these are, in the order of the frame's; null: the map has none.
struct DeviceMap {
  std::shared_ptr<GpuImage> depth, exit, casterMaterial;
};
DeviceMap deviceMap(const DrawnMap& map, const RasterOptions& options);

// Throws InputError for options that no map can be drawn with.
void checkShadowDrawing(const Model& model, const ModelCamera& camera, const RasterOptions& options);

// Gives all maps of the lights places in one image, or leaves each its own. size: of a map.
void placeShadowMaps(MapPlacement placement, int size, std::vector<Light>& lights);

}  // namespace pellucid::harness
