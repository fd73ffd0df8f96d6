// A model through the rasterizer: the G-buffer an engine would hand to Pellucid.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "common/device.h"
#include "raster/framing.h"
#include "raster/model.h"

namespace pellucid::harness {

enum class BackFace {
  Nearest,  // of those behind the front: the thickness of the first layer
  Farthest  // the thickness of everything, hollows included
};

enum class MapCull { None, Back, Front };

enum class MapPlacement {
  Separate,  // an image for each map
  Atlas,     // tiles of one image
  Array      // layers of one image
};

// How the maps that a capture keeps are drawn, as engines do. The irradiance's own maps stay plain unless
// `filter` says that it reads the same ones.
struct ShadowDrawing {
  MapCull cull = MapCull::None;
  // Factors of vkCmdSetDepthBias that move away from the light, -1e3..1e3: the harness's depths are reversed,
  // so that both are drawn, and kept in the capture, with the other sign.
  double depthBiasConstant = 0, depthBiasSlope = 0;
  int bits = 32;  // of the depth buffer: 16, 24 or 32, a float
  // Texels, 0..100. Vertices move inward along their normals by this times 1 - cosine to the light, as by the
  // normal bias of Unity. On a sphere the surface moves along the ray by this on average, which is the map's
  // offsetLength. Directional lights only.
  double normalOffset = 0;
  // Maps of a directional light that follow the camera, 0..6; 0: one around the model.
  int cascades = 0;
  // Texels across of percentage-closer filtering, odd, at most 15: the irradiance compares with the maps as
  // they are drawn, at this many taps along each axis, each weighted among its four texels. 0: irradiance of
  // plain maps.
  int filter = 0;
  MapPlacement placement = MapPlacement::Separate;
};

struct RasterOptions {
  int width = 512, height = 512;                                // pixels, 1..8192
  bool reversedZ = true;                                        // device depth 1 at the near plane
  bool infiniteFar = false;                                     // perspective cameras only
  PellucidDepthEncoding depthEncoding = PELLUCID_DEPTH_DEVICE;  // DEVICE or VIEW_Z
  std::array<double, 2> jitter = {0, 0};  // pixels right and down, -1..1, by which the picture moves
  BackFace backFace = BackFace::Nearest;
  int shadowSize = 1024;  // texels across a shadow map, 0..8192; 0: no shadow maps and no shadows
  PellucidDepthEncoding shadowEncoding = PELLUCID_DEPTH_DEVICE;
  PointMaps pointMaps = PointMaps::Auto;
  // Part of the model's triangles, (0, 1], in back depth and in the shadow maps that the capture keeps
  // (Whelan 2009, 4.7.3). Front depth, irradiance and its own shadows have all triangles.
  double simplify = 1;
  ShadowDrawing shadow;  // other than plain in DEVICE encoding alone; placement in any
};

struct RasterResult {
  // With front depth, back depth unless every pixel is open, irradiance, albedo and material;
  // materials and lights as the model's, with the shadow maps of frameLight(). A light that has a radius
  // gets its map, of its center, and brings no irradiance: shadow maps draw no soft shadows.
  Capture capture;
  // Pixels of a material through which the front's object is not closed: an open or single-sided mesh, or
  // a hole. They have no back depth.
  std::size_t openPixels = 0;
  // Factor in the irradiance, RGB, 0 where nothing is; empty: no surface has its lobes apart.
  Image reflectedShare;
  std::vector<std::string> warnings;  // sentences for a person
};

// Draws `model` as `camera` sees it. Coverage is one sample at each pixel's center. Same device and same
// input, same bits. Throws InputError naming the field for a size or combination that is out of range, and
// DeviceError when the device cannot draw.
RasterResult rasterize(Device& device, const Model& model, const ModelCamera& camera,
                       const RasterOptions& options);

}  // namespace pellucid::harness
