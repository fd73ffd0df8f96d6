/* Options of the context, the frame and a shadow map. pellucid.h includes this header. All options have defaults.
 * pellucidInitContextDesc and pellucidInitFrame write these defaults. Options of a shadow map are 0 by default.
 */
#ifndef PELLUCID_OPTIONS_H
#define PELLUCID_OPTIONS_H

#include "pellucid_base.h"
#include "pellucid_material.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---- Context ----------------------------------------------------------------------------------- */

/* Features that the frames of a context use, as bits. The context makes only the pipelines whose features are all in `uses`. Recording
 * refuses a plan that needs another feature, and names the PellucidUse. */
typedef enum PellucidUse {
  /* Light with one thickness a pixel, and thin walls. Frames that only copy the irradiance need it, too. */
  PELLUCID_USE_TRANSLUCENCY = 1 << 0,
  /* Light that the gather finds. It needs DIFFUSION, too. */
  PELLUCID_USE_GATHER = 1 << 1,
  /* Light that spreads under the surface. */
  PELLUCID_USE_DIFFUSION = 1 << 2,
  /* PellucidFrameOptions::reuse without a gather. */
  PELLUCID_USE_REUSE = 1 << 3,
  /* PellucidFrameOptions::debugView. */
  PELLUCID_USE_DEBUG_VIEWS = 1 << 4,
  /* Materials with thinWalled 1. */
  PELLUCID_USE_THIN_WALLS = 1 << 5,
  /* PellucidFrameOptions::ambient and PellucidFrame::hiddenIrradiance. */
  PELLUCID_USE_AMBIENT = 1 << 6,
  /* Every thesis->angleModel but NORMAL, and every transmittance model but EXP2 and SINH_EXP. */
  PELLUCID_USE_THESIS = 1 << 7
} PellucidUse;

/* Calls job(data, i) for each i below count, on any threads and in any order. Returns after the last job. */
typedef void (*PellucidParallelForFn)(void* user, uint32_t count, void (*job)(void* data, uint32_t index), void* data);

/* Options of a context. */
typedef struct PellucidContextOptions {
  /* PellucidUse bits; 0 (default): all. */
  uint32_t uses;
  /* PellucidFrameOptions::outputFormat of all frames: R16G16B16A16_SFLOAT (default) or R32G32B32A32_SFLOAT. UNDEFINED: frames may have any
   * of their formats. The device then needs shaderStorageImageWriteWithoutFormat enabled. */
  VkFormat outputFormat;
  /* Type of all views of shadow images: 2D (default) or 2D_ARRAY. A 2D_ARRAY view has all layers and serves the maps of all layers. Each
   * frame then needs a shadow image, even without maps. */
  VkImageViewType shadowViewType;
  /* 1: frames may have light tables. 0 (default): no frame has light tables. */
  uint32_t lightTables;
  /* 1: descriptors come from PellucidFrameOptions::descriptorPool, for devices without push descriptors. 0 (default): recording pushes
   * descriptors. */
  uint32_t descriptorPools;
  /* Optional; the cache in which pipelines are looked up and stored. */
  VkPipelineCache pipelineCache;
  /* Optional; allocates the host memory of Vulkan objects. */
  const VkAllocationCallbacks* allocator;
  /* Optional; makes the pipelines on several threads, which use allocator and pipelineCache. NULL (default): the calling thread. */
  PellucidParallelForFn parallelFor;
  /* First argument of parallelFor. */
  void* parallelUser;
} PellucidContextOptions;

/* ---- Frame --------------------------------------------------------------------------------------- */

/* Parts of a frame, as bits. */
typedef enum PellucidFeatureBits {
  /* Light that comes through the body. */
  PELLUCID_FEATURE_TRANSLUCENCY = 1u << 0,
  /* Light that spreads under the surface. */
  PELLUCID_FEATURE_DIFFUSION = 1u << 1
} PellucidFeatureBits;

/* How a frame reuses light that came through in earlier frames. Irradiance and diffusion are always new. After a cut, pass no previous
 * plan. ALTERNATE and COHERENCE keep the light of a pixel: on moving surfaces, kept light lags behind. */
typedef enum PellucidReuse {
  /* Each frame computes the light. */
  PELLUCID_REUSE_NONE = 0,
  /* Every second frame computes the light (Whelan 2009, 4.7.4). */
  PELLUCID_REUSE_ALTERNATE = 1,
  /* A frame computes the light if a cosine has changed by more than coherenceThreshold (Whelan 2009, 4.7.5). It is the cosine between
   * the camera's axis and the direction to a light. The direction to point and spot lights is from thesis->objectCenter. */
  PELLUCID_REUSE_COHERENCE = 2,
  /* Gathered light alone: each frame takes other samples and averages its probes with the earlier frame's probes, at the place that
   * frame.motion gives. Noise falls to a quarter. Changes of light arrive within a few frames. */
  PELLUCID_REUSE_ACCUMULATE = 4
} PellucidReuse;

/* A debug view: an intermediate result in place of the output, in floats. Alpha is the irradiance's. */
typedef enum PellucidDebugView {
  /* The result. */
  PELLUCID_DEBUG_NONE = 0,
  /* Thickness in mm; -1: none, which B10G11R11_UFLOAT_PACK32 stores as 0. R: camera-space thickness. G: light-space thickness of the first light whose map contains the pixel. B:
   * thickness of the first light that contributes. */
  PELLUCID_DEBUG_THICKNESS = 1,
  /* Light that comes through, divided by the light that arrives at hidden faces, both summed over lights; 0: no light arrives. */
  PELLUCID_DEBUG_TRANSMITTANCE = 2,
  /* The part of the lights' hidden irradiance that shadow maps do not block, 0..1. */
  PELLUCID_DEBUG_OCCLUSION = 3,
  /* Input of the diffusion: irradiance + light that comes through / rho. */
  PELLUCID_DEBUG_IRRADIANCE = 4
} PellucidDebugView;

/* Entries of a light table, and most light tables of a frame. */
enum { PELLUCID_LIGHT_TABLE_ENTRIES = 64, PELLUCID_MAX_LIGHT_TABLES = 16 };

/* Light table: factors of a light's intensity, linear between entries.
 * - By angle: entry i is the factor at the angle pi i / 63 from light.direction, which a point light then needs, too. For an IES
 *   profile of equal values all around, divide the candela by the largest candela, which is the intensity. A spot keeps its cone.
 * - By distance: entry i is the factor of 1 / r^2 at r = range i / 63, with range > 0. These factors replace 1 - (r / range)^4. An
 *   engine's falloff f(r) has the entries r^2 f(r), divided by the largest entry. The intensity is multiplied by this entry. */
typedef struct PellucidLightTable {
  /* 0..1, stored as half floats. */
  float factor[PELLUCID_LIGHT_TABLE_ENTRIES];
} PellucidLightTable;

/* Options of Whelan 2009. pellucid_thesis.h has the fields. */
typedef struct PellucidThesisOptions PellucidThesisOptions;

/* Options of a frame. */
typedef struct PellucidFrameOptions {
  /* PellucidFeatureBits; default both. */
  uint32_t features;
  /* x, y, width, height in pixels, inside imageExtent. No pixel outside is read or written. Width 0 (default): the whole image. */
  uint32_t renderRect[4];

  /* ---- inputs and output ---- */

  /* PELLUCID_DEPTH_DEVICE (default) or VIEW_Z. */
  uint32_t frontDepthEncoding;
  /* PELLUCID_DEPTH_DEVICE (default), VIEW_Z or THICKNESS. */
  uint32_t backDepthEncoding;
  /* The material index is (value & materialMask) >> materialShift. Other bits of the value are ignored. Shift: 0..31; default 0. Mask 0
   * (default): all bits. Any other mask must contain the bits of every index. */
  uint32_t materialShift, materialMask;
  /* R16G16B16A16_SFLOAT (default), R32G32B32A32_SFLOAT, or B10G11R11_UFLOAT_PACK32 without alpha. The format must fit
   * PellucidContextOptions::outputFormat. Relative error of 32 bits: 1e-6 without diffusion, 2^-10 with diffusion.
   * Relative error of B10G11R11: 2^-7 in red and green, 2^-6 in blue. */
  VkFormat outputFormat;
  /* 0 (default): the result replaces the output. 1: the result is added to the output's color, for renderers that do not composite in a
   * later pass (docs/integration.md). The sum is clamped to 0..65504, NaN counts as 0, and alpha stays. The output then has usage
   * SAMPLED, too, and is not the irradiance image. Debug views still replace the output. The last dispatch samples and stores the output
   * (plan.inPlaceDispatches). */
  uint32_t addToOutput;

  /* ---- the gather: light of maps that comes through ---- */

  /* Samples of the shadow map by each probe, a multiple of 4 up to 64; default 8. More samples lower the noise of thin parts. 0: one
   * light-space thickness a pixel. Some frames cannot be gathered, as plan.skips says. Causes are a solid of another model than EXP2 or
   * SINH_EXP, cameraThickness 1, and four options of thesis: angleModel, constantViewDirection, maximumThickness and
   * materialMarkBit. */
  uint32_t gatherSamples;
  /* Pixels a side of a probe's cell: 1, 2 or 4. 0 (default): 4 in images of more than 2^20 pixels, 2 in images of more than 2^19
   * pixels, else 1. Probes of 2 cost a quarter of probes of 1, and probes of 4 a quarter of probes of 2. 4 needs pixels far smaller than a
   * diffusion length. */
  uint32_t gatherSpacing;
  /* 1: light of all lights enters the face that a pixel hides, frame.backDepth gives the thickness, and shadow maps only occlude. 0
   * (default): lights with a map of front faces have the light-space thickness. Lights without such a map are always as with 1. With
   * backDepthEncoding THICKNESS, a frame that has shadow maps refuses 1, because a thickness does not tell where the hidden face lies. */
  uint32_t cameraThickness;

  /* ---- other light ---- */

  /* Light from all around that comes through thin parts: 9 x RGB coefficients of radiance without preExposure, -1e15..1e15. NULL (default):
   * no light. Basis: real orthonormal spherical harmonics of the world direction from which light comes. Order: 1, y, z, x, xy, yz,
   * 3 z^2 - 1, xz, x^2 - y^2. The irradiance image has this light of visible faces. Needs backDepth. Nothing shadows hidden faces,
   * unless frame.hiddenIrradiance has their light. */
  const float* ambient;
  /* 0..PELLUCID_MAX_LIGHT_TABLES; default 0. Above 0 only with PellucidContextOptions::lightTables 1. */
  uint32_t lightTableCount;
  /* lightTableCount tables. Lights may share a table. */
  const PellucidLightTable* lightTables;

  /* ---- recording ---- */

  /* 1 (default): passes run in blocks where the GPU finds material. The slice's buffer then has usage INDIRECT_BUFFER. 0: passes run over
   * the whole rect. */
  uint32_t indirectDispatches;
  /* Required with PellucidContextOptions::descriptorPools 1; pellucidCreateDescriptorPool makes it. Recording resets the pool. Each
   * recording that the device has not finished needs its own pool. */
  VkDescriptorPool descriptorPool;

  /* ---- reuse, debug views, thesis ---- */

  /* PellucidReuse; default NONE. With ALTERNATE and COHERENCE, dispatches may sample and store `history` (plan.inPlaceDispatches). */
  uint32_t reuse;
  /* Change of the cosine that COHERENCE tolerates, 0..2; default .005. Whelan 2009, 4.7.5, multiplies the threshold by frame time / budget
   * if this quotient is above 1. */
  float coherenceThreshold;
  /* Required by reuse: the persistent image of pellucidGetImageNeeds, in layout GENERAL, the same image in all frames. Any content at
   * first: frames without a previous plan, and after another size, rect, anchor.w or change between ACCUMULATE and other reuse, read
   * nothing of it. */
  PellucidImage history;
  /* PellucidDebugView; default NONE. */
  uint32_t debugView;
  /* NULL (default): no options of Whelan 2009. */
  const PellucidThesisOptions* thesis;

  /* ---- motion ---- */

  /* World-space point x, y, z on the body that the camera looks at, with w = 1. Cells, patterns of samples and texels of the pyramid
   * follow the point's pixel. Noise then moves with the body. Transients grow by up to 127 pixels a side. Reuse ALTERNATE and COHERENCE
   * refuse an anchor. w = 0 (default), or a point behind the camera: cells, patterns and texels stay with the screen. */
  float anchor[4];
  /* Factors that turn frame.motion into parts of the image's width and height, -1e6..1e6; default 1, 1. Motion in pixels: 1 / width,
   * 1 / height. */
  float motionScale[2];
} PellucidFrameOptions;

/* ---- Shadow map ------------------------------------------------------------------------------------ */

/* Options of a shadow map, 0 by default. VIEW_Z and DISTANCE maps need viewFromWorld. docs/integration.md, "Shadow maps as engines
 * draw them", has the options by the way an engine draws its maps. */
typedef struct PellucidShadowMapOptions {
  /* x, y of the map's first texel in an atlas, 0..65535, with offset + extent <= 65536. No texel outside of the map's tile is read. */
  uint32_t offset[2];
  /* Layer of the shadow image, 0..65535; above 0 only with PellucidContextOptions::shadowViewType 2D_ARRAY. */
  uint32_t layer;
  /* 1: the map holds back faces, drawn with front faces culled. The light then enters the face that a pixel hides, needs
   * frame.backDepth, and is not gathered. Receivers beyond the stored face are in shadow. All maps of a light must have the same value. 0 (default): front
   * faces. */
  uint32_t backFaces;
  /* The light's view matrix: a rotation and a translation, right-handed, -z forward. VIEW_Z and DISTANCE need a valid matrix. DEVICE does
   * not read it. */
  float viewFromWorld[16];

  /* ---- biases. Passes subtract them from stored depths. Signs are those of vkCmdSetDepthBias: negative for reversed depths ---- */

  /* In units of the stored depth, -1e15..1e15. VIEW_Z and DISTANCE: scene units. DEVICE: the constant factor of vkCmdSetDepthBias
   * times 2^-16 for D16, 2^-24 for D24, or 2^(e - 23) for D32. 2^e is the largest power of two up to the triangle's largest depth. For
   * depths from .5 to 1 the factor is 2^-24. */
  float depthBiasConstant;
  /* Slope factor of vkCmdSetDepthBias, -1e6..1e6. Passes multiply it by the change of stored depth per texel, the larger of x and y. Each
   * change is to the neighbor whose depth differs least. */
  float depthBiasSlope;
  /* Distance along the light ray, in scene units, 0..1e15, by which the stored surface lies farther from the light than the body. Causes
   * are moved vertices, or an offset in the shader that writes depth. */
  float offsetLength;
  /* Smallest difference of stored depths, 0..1e15, to which tolerances are adapted: 1/65535 for D16, 2^-24 for D24. 0 (default): float
   * precision. */
  float depthStep;

  /* ---- further images of the map, with its offset, extent and layer. Without them all matter and air between the stored surface and the
   * receiver counts as the receiver's medium. A dispatch binds 8 shadow images, and the images of one light must fit into one dispatch.
   * If a plan cannot bind the images of all lights, it leaves out all exit depths and caster materials, and plan.skips says so. ---- */

  /* Index into frame.shadowImages plus 1; 0 (default): no image. Exit depth: the depth of the nearest back face behind the stored surface,
   * in the map's encoding and matrices, without biases. Receivers beyond the exit depth are in shadow. An empty texel or NaN: the medium
   * does not end. Not read with cameraThickness or backFaces. */
  uint32_t exitImage;
  /* Index into frame.shadowImages plus 1; 0 (default): no image. Caster material: the material index of the stored surface in one float
   * channel, without thesis->materialMarkBit; 0: opaque. Light reaches receivers of the same index only. */
  uint32_t casterMaterialImage;
  /* Factor of the caster material, 0..65536: the index is round(value * scale). 0 (default): 255, for R8_UNORM. Use 1 for formats that
   * hold the index itself. */
  float casterMaterialScale;
} PellucidShadowMapOptions;

#ifdef __cplusplus
}
#endif
#endif
