/* Options of the context, the frame and a shadow map. pellucid.h includes this header, and its reader may stop there:
 * pellucidInitContextDesc and pellucidInitFrame write the defaults. Options of a shadow map are 0 by default.
 */
#ifndef PELLUCID_OPTIONS_H
#define PELLUCID_OPTIONS_H

#include "pellucid_base.h"
#include "pellucid_material.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---- Context ----------------------------------------------------------------------------------- */

/* Uses that frames make of a context. A pipeline is made if all that it is for is asked for; recording refuses a plan that
 * needs another one. */
typedef enum PellucidUse {
  /* Lights that are not gathered from, and thin walls. */
  PELLUCID_USE_TRANSLUCENCY = 1 << 0,
  /* Gathered light. */
  PELLUCID_USE_GATHER = 1 << 1,
  /* Light that spreads under the surface. */
  PELLUCID_USE_DIFFUSION = 1 << 2,
  /* PellucidFrameOptions::reuse without a gather. */
  PELLUCID_USE_REUSE = 1 << 3,
  /* PellucidFrameOptions::debugView. */
  PELLUCID_USE_DEBUG_VIEWS = 1 << 4,
  /* Options that pipelines look for, unless the context's uses leave them out: materials with thinWalled, */
  PELLUCID_USE_THIN_WALLS = 1 << 5,
  /* PellucidFrameOptions::ambient, */
  PELLUCID_USE_AMBIENT = 1 << 6,
  /* thesis->angleModel other than NORMAL, and transmittance models but EXP2 and SINH_EXP. */
  PELLUCID_USE_THESIS = 1 << 7
} PellucidUse;

/* Calls job(data, i) for each i below count, on any threads and in any order, and returns when all have returned. */
typedef void (*PellucidParallelForFn)(void* user, uint32_t count, void (*job)(void* data, uint32_t index), void* data);

/* How the normal image holds a vector n. */
typedef enum PellucidNormalEncoding {
  /* n in RGB, -1..1: SNORM and float formats; (0, 0, 0): none at this pixel. */
  PELLUCID_NORMALS_SNORM = 0,
  /* (n + 1) / 2 in RGB, 0..1; (0, 0, 0), which is no unit vector: none. */
  PELLUCID_NORMALS_UNORM = 1,
  /* "oct" of Cigolle et al. 2014 in RG, -1..1: n / (|x| + |y| + |z|), whose half of z < 0 is folded over the corners. Cannot say
   * none. */
  PELLUCID_NORMALS_OCTAHEDRAL = 2,
  /* (oct + 1) / 2 in RG, 0..1. */
  PELLUCID_NORMALS_OCTAHEDRAL_UNORM = 3
} PellucidNormalEncoding;

typedef struct PellucidContextOptions {
  /* PellucidUse bits; 0 (default): all. */
  uint32_t uses;
  /* That of PellucidFrameOptions of all frames: R16G16B16A16_SFLOAT (default) or R32G32B32A32_SFLOAT. UNDEFINED: any, on a device with
   * shaderStorageImageWriteWithoutFormat enabled. */
  VkFormat outputFormat;
  /* PellucidNormalEncoding of all frames; default SNORM. A library built with PELLUCID_GBUFFER_DECODE decodes by itself. */
  uint32_t normalEncoding;
  /* Of all shadow images: 2D (default), or 2D_ARRAY, of which one view of all layers serves every map in them. Each frame then has a
   * shadow image, maps or not. */
  VkImageViewType shadowViewType;
  /* 1: frames may have light tables; 0 (default): none has. */
  uint32_t lightTables;
  /* 1: each frame brings a pool that its descriptors come from, for devices that cannot push them; 0 (default): they are pushed. */
  uint32_t descriptorPools;
  /* 1: creation makes no pipelines, and pellucidCreatePipelines makes those of a plan; 0 (default): creation makes all of `uses`. */
  uint32_t deferPipelines;
  /* Optional. */
  VkPipelineCache pipelineCache;
  /* Optional; host memory of Vulkan objects. */
  const VkAllocationCallbacks* allocator;
  /* Optional; lends threads to the creation of pipelines. The allocator's and the cache's functions are called on them. */
  PellucidParallelForFn parallelFor;
  void* parallelUser;
} PellucidContextOptions;

/* ---- Frame --------------------------------------------------------------------------------------- */

/* Parts of a frame. */
typedef enum PellucidFeatureBits {
  /* Light that comes through. */
  PELLUCID_FEATURE_TRANSLUCENCY = 1u << 0,
  /* Light that spreads under the surface. */
  PELLUCID_FEATURE_DIFFUSION = 1u << 1
} PellucidFeatureBits;

/* Frames that use the light that came through in earlier ones. Irradiance and diffusion are always the frame's own. Pass no previous
 * plan after a cut. ALTERNATE and COHERENCE look kept light up at the same pixel: moving surfaces lag by the frames in between. */
typedef enum PellucidReuse {
  PELLUCID_REUSE_NONE = 0,
  /* Every second frame (Whelan 2009, 4.7.4). */
  PELLUCID_REUSE_ALTERNATE = 1,
  /* Until the cosine between the camera's axis and the direction to a light has changed by more than the threshold (Whelan 2009,
   * 4.7.5). Point and spot lights are seen from thesis->objectCenter. */
  PELLUCID_REUSE_COHERENCE = 2,
  /* Probes are averaged over frames, each with the place that frame.motion says it had, and take other samples in each frame. Noise
   * falls to a quarter, and light that changes arrives within frames. Only of gathered light. */
  PELLUCID_REUSE_ACCUMULATE = 4
} PellucidReuse;

/* An intermediate that `output` gets in place of the result. Float values; alpha is kept. */
typedef enum PellucidDebugView {
  PELLUCID_DEBUG_NONE = 0,
  /* mm: R camera-space chord, G light-space of the first light with a map that contains the pixel, B that of the first contributing
   * light; -1: none. */
  PELLUCID_DEBUG_THICKNESS = 1,
  /* Transmitted / arriving, summed over lights; 0 where none. */
  PELLUCID_DEBUG_TRANSMITTANCE = 2,
  /* Fraction of the lights' back irradiance that the maps let by. */
  PELLUCID_DEBUG_OCCLUSION = 3,
  /* Irradiance + transmitted / rho, which the diffusion reads. */
  PELLUCID_DEBUG_IRRADIANCE = 4
} PellucidDebugView;

enum { PELLUCID_LIGHT_TABLE_ENTRIES = 64, PELLUCID_MAX_LIGHT_TABLES = 16 };

/* A light's own falloff, linear between entries.
 * By angle: entry i is the factor at i / 63 pi from `direction`, which point lights then have, too. An IES profile that is the same
 * all around is one, over its most candela, which are the intensity. A spot keeps its cone.
 * By distance: entry i is the factor of 1 / r^2 at i / 63 range, in place of the range's window; range > 0. An engine's falloff
 * f(r) has entries r^2 f(r) over their maximum. */
typedef struct PellucidLightTable {
  /* [0, 1], kept as halves; light.intensity has the scale. */
  float factor[PELLUCID_LIGHT_TABLE_ENTRIES];
} PellucidLightTable;

enum { PELLUCID_MATERIAL_TABLE_WORDS = 3712 };

/* Tables of a material, made once with it: its profile over the pyramid's levels, and numbers of the gather. Plain data. */
typedef struct PellucidMaterialTables {
  /* Not for callers. */
  uint32_t words[PELLUCID_MATERIAL_TABLE_WORDS];
} PellucidMaterialTables;

/* Writes the tables of a material, compiled or by hand. INVALID_ARGUMENT: a null pointer, or a material that pellucidValidateFrame
 * refuses. */
PELLUCID_API PellucidResult pellucidMakeMaterialTables(const PellucidMaterial* material, PellucidMaterialTables* tables);

/* Options of Whelan 2009, pellucid_thesis.h. */
typedef struct PellucidThesisOptions PellucidThesisOptions;

typedef struct PellucidFrameOptions {
  /* PellucidFeatureBits; default both. */
  uint32_t features;
  /* x, y, width, height inside imageExtent, beyond which nothing is read or written; width 0 (default): the whole image. */
  uint32_t renderRect[4];

  /* ---- inputs and output ---- */

  /* PELLUCID_DEPTH_DEVICE (default) or VIEW_Z. */
  uint32_t frontDepthEncoding, backDepthEncoding;
  /* 1: normals are of view space; 0 (default): world. */
  uint32_t normalsInViewSpace;
  /* The index is (R of the material image & mask) >> shift, so that other bits may hold anything. Shift 0..31; mask 0 (default): all
   * bits, else those of all indices. */
  uint32_t materialShift, materialMask;
  /* R16G16B16A16_SFLOAT (default), R32G32B32A32_SFLOAT, or B10G11R11_UFLOAT_PACK32, which has no alpha; see
   * PellucidContextOptions::outputFormat. 32 bits keep colors up to 65504: to 1e-6 without diffusion, to 2^-10 with it. */
  VkFormat outputFormat;
  /* 1: the result is added to the output's color, which is specular light, say, and alpha stays. The sum is clamped to 0..65504, and NaN
   * counts as 0. The output is not the irradiance image, and has usage SAMPLED, too. Debug views replace. 0 (default): the output
   * becomes the result. For renderers without a pass that composites; docs/integration.md. */
  uint32_t addToOutput;
  /* 1: the output shares no memory with the irradiance, of which diffusion without lights then needs no copy; 0 (default): it may. */
  uint32_t separateOutput;

  /* ---- the gather: light of maps that comes through ---- */

  /* Samples of the shadow map by each probe, a multiple of 4, at most 64; default 8. More lower the noise of thin parts. 0: one
   * light-space thickness a pixel, which frames also get, as skips say, with a solid not of EXP2 or SINH_EXP, with cameraThickness, a
   * material mark bit, or thesis options of one thickness a pixel. */
  uint32_t gatherSamples;
  /* Pixels a side of a probe's cell: 1, 2 or 4. 0 (default): 4 in images of more than 2^20 pixels, 2 of more than 2^19, else 1. Each
   * step costs a quarter of the one before; 4 needs pixels far below a mean free path. */
  uint32_t gatherSpacing;
  /* Planar distance of the nearest surface that diffuses, or less, scene units. It leaves out levels for radii that are small in
   * pixels; nearer surfaces are then diffused too little. 0 (default): not known. Orthographic cameras need none. */
  float nearestDistance;
  /* 1: thickness is back depth minus front depth, and shadow maps only occlude; 0 (default): along the light ray from the map's
   * surface. Lights without a map always take the camera's. */
  uint32_t cameraThickness;

  /* ---- other light ---- */

  /* Light from all around that comes through thin parts, or NULL (default): 9 x RGB coefficients of radiance without
   * preExposure, -1e15..1e15, of the real orthonormal spherical harmonics of the world direction that light comes from, in the order 1, y, z, x, xy, yz, 3 z^2 - 1,
   * xz, x^2 - y^2. The irradiance image has the light of visible faces. Needs backDepth. Nothing shadows hidden faces, unless
   * frame.hiddenIrradiance has their light. */
  const float* ambient;
  /* Lights may share them. 0..PELLUCID_MAX_LIGHT_TABLES, above 0 only with PellucidContextOptions::lightTables. */
  uint32_t lightTableCount;
  const PellucidLightTable* lightTables;

  /* ---- recording ---- */

  /* 1 (default): the GPU runs groups where it finds material, and the slice's buffer has usage INDIRECT_BUFFER; 0: over the whole
   * rect. */
  uint32_t indirectDispatches;
  /* materialCount of them, each of the material of its index; NULL (default): made anew for each frame, which takes 20 us of CPU
   * time a material. */
  const PellucidMaterialTables* materialTables;
  /* With PellucidContextOptions::descriptorPools, by pellucidCreateDescriptorPool. Recording resets it: each recording that the device
   * has not finished needs a pool of its own, as of constants slices. */
  VkDescriptorPool descriptorPool;

  /* ---- reuse, debug views, thesis ---- */

  /* PellucidReuse. */
  uint32_t reuse;
  /* Of COHERENCE, 0..2; default .005. Multiply it by frame time / budget where that is above 1, as Whelan 2009, 4.7.5 does. */
  float coherenceThreshold;
  /* With reuse: the persistent image of pellucidGetImageNeeds, GENERAL, the same in all frames. */
  PellucidImage history;
  /* PellucidDebugView. */
  uint32_t debugView;
  /* NULL (default): none. */
  const PellucidThesisOptions* thesis;

  /* ---- motion ---- */

  /* World-space point x, y, z with w 1 on the body that the camera looks at. Cells, patterns of samples and texels of the pyramid
   * follow the point's pixel, so that noise moves with the body and not over it. Transients then grow by up to 127 pixels a side. Not
   * with reuse ALTERNATE or COHERENCE. w 0 (default): they stay with the screen, as they do while the point is behind the camera. */
  float anchor[4];
  /* Of what frame.motion holds to parts of the image's width and height, -1e6..1e6; default 1, 1. For pixels: 1 over the extent. */
  float motionScale[2];
} PellucidFrameOptions;

/* ---- Shadow map ------------------------------------------------------------------------------------ */

/* docs/integration.md, "Shadow maps as engines draw them", says which option an engine's habit asks for. All but a matrix that is
 * read default to 0. */
typedef struct PellucidShadowMapOptions {
  /* Texels, 0..65535: the map's first texel in the image, an atlas. offset + extent <= 65536. Nothing beyond is read. */
  uint32_t offset[2];
  /* Array layer, 0..65535; above 0 only with PellucidContextOptions::shadowViewType 2D_ARRAY. */
  uint32_t layer;
  /* 1: the map holds the faces by which light leaves, drawn with front faces culled. Its light has the camera's thickness, is not gathered,
   * and needs frame.backDepth; receivers beyond the stored face are in shadow. All maps of a light hold the same faces. */
  uint32_t backFaces;
  /* The light's rigid view matrix: right-handed, -z forward. Required for VIEW_Z, and for DISTANCE of directional lights. Not read
   * for DEVICE, nor for DISTANCE of point and spot lights. */
  float viewFromWorld[16];

  /* How far stored depths lie from the surface; subtracted before a depth is used. Biases have the sign with which they were added, so
   * that those of reversed depths are negative. */
  /* In units of the stored depth, -1e15..1e15. VIEW_Z and DISTANCE: scene units. DEVICE: the constant factor of vkCmdSetDepthBias
   * times 2^-16 for D16, 2^-24 for D24, and 2^(e - 23) for D32, where 2^e <= the triangle's largest depth: 2^-24 from .5 on. */
  float depthBiasConstant;
  /* Slope factor of vkCmdSetDepthBias, -1e6..1e6: times the larger of the stored depth's changes per texel along x and y, taken
   * from the nearer of the neighbors. */
  float depthBiasSlope;
  /* Scene units along the light's ray, 0..1e15, by which the stored surface lies farther from the light: moved vertices, or an offset
   * by the shader that wrote depth. */
  float offsetLength;
  /* Smallest difference of stored depths, 0..1e15, for which tolerances allow: 1/65535 for D16, 2^-24 for D24; 0: as fine as floats. */
  float depthStep;

  /* Images of what lies behind the stored surface, with the map's offset, extent and layer: indices into frame.shadowImages plus 1;
   * 0: not given. Without them everything between that surface and the receiver counts as the receiver's medium, air included. A
   * dispatch binds 8 shadow images, and those of one light must fit into one; where those of all lights exceed a plan's
   * dispatches, all exit depths and caster materials are left out, as a skip says. */
  /* Depth of the nearest back face behind the stored surface, in the map's encoding and matrices, without biases. Receivers beyond it
   * are in shadow. Nothing there, or NaN: the medium goes on. Not read with cameraThickness or backFaces. */
  uint32_t exitImage;
  /* One float channel: material of the stored surface, numbered as in frame.material without the mark bit; 0: opaque. Light enters
   * receivers of that material only. */
  uint32_t casterMaterialImage;
  /* The number is round(value * scale), 0..65536; 0: 255, for R8_UNORM; 1 for formats that hold the number itself. */
  float casterMaterialScale;
} PellucidShadowMapOptions;

#ifdef __cplusplus
}
#endif
#endif
