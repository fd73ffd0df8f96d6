/* Pellucid: screen-space translucency and subsurface diffusion as Vulkan compute dispatches.
 *
 * This header is what an engine needs to ship: a context of pipelines, a frame with its lights and shadow maps, and
 * three calls a frame: pellucidBuildPlan, pellucidWriteConstants, pellucidRecordPlan. Everything else has a default in the
 * `options` of a struct (pellucid_options.h). pellucid_material.h makes materials. Further headers are included by those who
 * need them: pellucid_plan.h (recording a plan yourself), pellucid_views.h (several views at once), pellucid_statistics.h
 * (what the device decided), pellucid_thesis.h (options of Whelan 2009).
 *
 * C ABI, Vulkan headers only. The caller owns every Vulkan object: the module creates pipelines and layouts and records
 * commands. It allocates no device memory, changes no image layout, submits nothing and waits for nothing.
 *
 * Conventions, unless a field says otherwise:
 * - matrices: 16 floats, column-major, column vectors (GLM and Vulkan memory order);
 * - clip space: Vulkan, x right, y down, depth 0..1; near and far in any order, infinite, perspective or orthographic,
 *   either handedness: everything is read from the matrix;
 * - lengths: scene units of `metersPerUnit` meters; of materials mm;
 * - colors: linear, scene-referred, R, G, B;
 * - a zero-initialized optional field has its default; pellucidInit* writes the other defaults;
 * - a struct with a `structSize` ends with its options and may grow there: fields that a caller's older struct lacks have their
 *   defaults, and a newer one's further bytes, up to 4096 in all, must be 0.
 */
#ifndef PELLUCID_H
#define PELLUCID_H

#include "pellucid_base.h"
#include "pellucid_material.h"
#include "pellucid_options.h"

#ifdef __cplusplus
extern "C" {
#endif

#define PELLUCID_VERSION "0.3.0"   /* of the release */
#define PELLUCID_HEADER_VERSION 6u /* the library refuses a header of another version */

/* ---- Context: the pipelines of one device ----------------------------------------------------- */

typedef struct PellucidContext PellucidContext;

typedef struct PellucidContextDesc {
  /* sizeof(PellucidContextDesc) and PELLUCID_HEADER_VERSION, by pellucidInitContextDesc. */
  uint32_t structSize, headerVersion;
  /* VkApplicationInfo::apiVersion in use, >= VK_API_VERSION_1_1; default 1.1. */
  uint32_t apiVersion;
  VkInstance instance;
  VkPhysicalDevice physicalDevice;
  /* With VK_KHR_push_descriptor enabled, or pushDescriptor of Vulkan 1.4, or else options.descriptorPools. */
  VkDevice device;
  /* All Vulkan functions come from here. */
  PFN_vkGetInstanceProcAddr getInstanceProcAddr;
  /* Called with each error of a context or recording; optional. */
  PellucidMessageFn message;
  void* messageUser;
  PellucidContextOptions options;
} PellucidContextDesc;

PELLUCID_API void pellucidInitContextDescSized(PellucidContextDesc* desc, size_t structSize);
/* Writes the defaults. */
static inline void pellucidInitContextDesc(PellucidContextDesc* d) { pellucidInitContextDescSized(d, sizeof *d); }

/* Checks the device's limits and makes pipelines. Any thread may use the context. On failure *context is NULL. Errors: VERSION,
 * INVALID_ARGUMENT, MISSING_FEATURE, OUT_OF_MEMORY, VULKAN. */
PELLUCID_API PellucidResult pellucidCreateContext(const PellucidContextDesc* desc, PellucidContext** context);

/* The device must have finished with commands recorded through the context. NULL is allowed. */
PELLUCID_API void pellucidDestroyContext(PellucidContext* context);

/* ---- Lights and shadow maps --------------------------------------------------------------------- */

/* Types, names and units are those of KHR_lights_punctual. */
typedef enum PellucidLightType {
  PELLUCID_LIGHT_DIRECTIONAL = 0,
  PELLUCID_LIGHT_POINT = 1,
  PELLUCID_LIGHT_SPOT = 2
} PellucidLightType;

typedef struct PellucidLight {
  /* PellucidLightType. */
  uint32_t type;
  /* World; of point and spot lights. */
  float position[3];
  /* World, in which light travels, any length > 0; of directional and spot lights. */
  float direction[3];
  /* >= 0. */
  float color[3];
  /* Irradiance at normal incidence of a directional light; else I of E = I cos/r^2, with r in scene units. >= 0. */
  float intensity;
  /* Of point and spot lights, scene units: the light has the factor max(0, 1 - (r / range)^4); 0 (default): none. */
  float range;
  /* Radians from the axis of a spot, 0 <= inner < outer <= pi/2. */
  float innerConeAngle, outerConeAngle;
  /* Of frame.shadowMaps, at most PELLUCID_MAX_LIGHT_SHADOW_MAPS: 6 for a cube, n for cascades. The first map that contains a
   * receiver is used. 0 maps: nothing shadows the light, and thickness is the camera's. */
  uint32_t firstShadowMap, shadowMapCount;
  /* Own falloff of point and spot lights: indices into options.lightTables plus 1, of the factor by the angle from `direction`
   * and of the factor by distance. 0 (default): none. */
  uint32_t angleTable, distanceTable;
} PellucidLight;

enum { PELLUCID_MAX_LIGHT_SHADOW_MAPS = 8 };

/* Content of a depth image. */
typedef enum PellucidDepthEncoding {
  /* The 0..1 value of the matrix that rendered it. Camera depths hold no surface beyond 0..1, at NaN, and 1e9 or more away. */
  PELLUCID_DEPTH_DEVICE = 0,
  /* Positive planar distance in front of the eye, scene units; <= 0, >= 1e9, infinity and NaN hold nothing. */
  PELLUCID_DEPTH_VIEW_Z = 1,
  /* Distance from the light, scene units; of shadow maps only. */
  PELLUCID_DEPTH_DISTANCE = 2
} PellucidDepthEncoding;

/* A light's shadow map as the engine drew it; its options hold biases, atlas tiles and exit depth. */
typedef struct PellucidShadowMap {
  uint32_t image;     /* index into frame.shadowImages */
  uint32_t extent[2]; /* texels, 1..65536 */
  uint32_t encoding;  /* PellucidDepthEncoding */
  /* Clip (-1, -1) is the outer corner of the map's first texel, and (1, 1) that of its last. */
  float clipFromWorld[16];
  PellucidShadowMapOptions options;
} PellucidShadowMap;

/* ---- Frame --------------------------------------------------------------------------------------- */

enum { PELLUCID_MAX_TRANSIENTS = 8 };

/* All that one recording reads and writes. */
typedef struct PellucidFrame {
  /* sizeof(PellucidFrame), by pellucidInitFrame. */
  uint32_t structSize;
  /* Pixels of every screen-sized image, 1..65536. */
  uint32_t imageExtent[2];
  /* Default 1. */
  float metersPerUnit;
  /* The projection that rendered the depths, jitter included. */
  float clipFromView[16];
  /* Rigid; default identity. docs/integration.md, "Far from the origin". */
  float viewFromWorld[16];
  /* The irradiance image holds E times this, and so does the output; lights keep their units. 1e-9..1e9; default 1. It is the product
   * of 1 / pi for an image of E / pi, 1 - F at normal incidence for one whose lights lose F, and the exposure. */
  float preExposure;

  /* Required; one float channel. */
  PellucidImage frontDepth;
  /* Nearest back face behind the front. Without it no thickness is the camera's, and thin parts return as much light as thick ones. */
  PellucidImage backDepth;
  /* E from all around that arrives where backDepth lies, which nothing else tells: of light probes, say, in the units of `irradiance`.
   * T of it comes through, in place of options.ambient's. docs/integration.md, "Ambient light". */
  PellucidImage hiddenIrradiance;
  /* Required. E that arrives outside of the surface, times preExposure, which has 1 / pi or 1 - F if the image has them. Without albedo. */
  PellucidImage irradiance;
  /* Outward unit vectors, as PellucidContextOptions::normalEncoding says. */
  PellucidImage normal;
  /* Multiplies the light after scattering. Without it the output is that of a white surface. */
  PellucidImage albedo;
  /* Required; unsigned integer: 0 none, i: materials[i - 1]. */
  PellucidImage material;
  /* Of reuse ACCUMULATE, which requires it; two float channels: the surface's place in the image less its place in the earlier frame,
   * in parts of width and height, times options.motionScale. Without jitter. */
  PellucidImage motion;
  /* Required; storage image, which may be the irradiance's. It takes the place of a diffuse term: the irradiance after scattering, times
   * preExposure and albedo. Pixels of material 0 are not written; alpha is the irradiance's. */
  PellucidImage output;
  /* As pellucidGetImageNeeds lists them. */
  PellucidImage transients[PELLUCID_MAX_TRANSIENTS];

  const PellucidMaterial* materials;
  uint32_t materialCount; /* 1..255 */
  /* Any number. */
  uint32_t lightCount;
  const PellucidLight* lights;
  const PellucidShadowMap* shadowMaps;
  uint32_t shadowMapCount;
  /* Depth or one float channel: views of the depth aspect alone. */
  uint32_t shadowImageCount;
  const PellucidImage* shadowImages;
  PellucidFrameOptions options;
} PellucidFrame;

PELLUCID_API void pellucidInitFrameSized(PellucidFrame* frame, size_t structSize);
/* Writes the defaults. */
static inline void pellucidInitFrame(PellucidFrame* f) { pellucidInitFrameSized(f, sizeof *f); }

/* Checks every convention and the domains of all fields (docs/materials.md), and calls `fn` for each finding. PELLUCID_OK unless one
 * is an error. CAPACITY: more shadow images than a plan can bind. */
PELLUCID_API PellucidResult pellucidValidateFrame(const PellucidFrame* frame, PellucidMessageFn fn, void* user);

/* A transient that the caller creates: 2D, one mip, usage SAMPLED | STORAGE. It holds nothing between frames, so that it may share
 * memory with whatever is not used during those dispatches. */
typedef struct PellucidImageNeed {
  VkFormat format;
  uint32_t extent[2];
  /* In plan.dispatches between which the image is in use. */
  uint32_t firstDispatch, lastDispatch;
  uint64_t bytes; /* of texels, without what the device adds */
  /* 1: for options.history in place of a transient; keeps its content between frames. */
  uint32_t persistent;
} PellucidImageNeed;

/* The transients of this frame in order, for any render rect, then with reuse the persistent image. Writes up to *count needs and sets
 * *count to the number there are; `needs` may be NULL. Views are not looked at, so that the call precedes their creation. */
PELLUCID_API PellucidResult pellucidGetImageNeeds(const PellucidFrame* frame, uint32_t* count, PellucidImageNeed* needs);

/* ---- Plan and recording -------------------------------------------------------------------------- */

/* The dispatches of a frame: plain data of at most 4096 bytes, complete in pellucid_plan.h. */
typedef struct PellucidPlan PellucidPlan;

/* Pure: same frame and previous plan, same plan; no device, no allocation. The plan keeps no pointer to the frame, and depends on
 * which optional images have views. `previous`: the last recorded frame's plan, for options.reuse alone, or NULL. */
PELLUCID_API PellucidResult pellucidBuildPlan(const PellucidFrame* frame, const PellucidPlan* previous, PellucidPlan* plan);

/* Bytes that a slice needs at most for so many materials, lights and shadow maps. A map of two lights counts twice. */
PELLUCID_API VkDeviceSize pellucidGetConstantsSize(uint32_t materialCount, uint32_t lightCount, uint32_t shadowMapCount);

/* Host-visible, host-coherent memory for one recording, usage STORAGE_BUFFER | UNIFORM_BUFFER | INDIRECT_BUFFER; device-local, too,
 * where there is such memory. The device also writes there. Each recording that the device has not finished needs a slice of its
 * own: a ring of as many as there are frames in flight. Nothing notices a slice that is written too early. */
typedef struct PellucidConstantsSlice {
  VkBuffer buffer;
  /* A multiple of 256. */
  VkDeviceSize offset;
  /* >= plan.constantsSize. */
  VkDeviceSize size;
  /* Address of `offset`. */
  void* mapped;
} PellucidConstantsSlice;

/* Writes the constants of a plan, made from this frame, to `size` bytes at `mapped`; image views are not looked at. Errors:
 * INVALID_ARGUMENT for a null pointer, a frame that pellucidValidateFrame refuses, or a plan of another frame; BUFFER_TOO_SMALL. */
PELLUCID_API PellucidResult pellucidWriteConstants(const PellucidPlan* plan, const PellucidFrame* frame, void* mapped, size_t size);

/* Scopes of the barriers around a recording, on any queue of a family that computes. */
enum {
  PELLUCID_STAGES = VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT,
  PELLUCID_READS = VK_ACCESS_SHADER_READ_BIT,
  PELLUCID_WRITES = VK_ACCESS_SHADER_WRITE_BIT
};

/* Records every dispatch and the barriers between them, outside of render passes. Before: the inputs are visible to PELLUCID_STAGES /
 * PELLUCID_READS, and the output and transients are free for PELLUCID_WRITES. After: `output` was written by PELLUCID_STAGES /
 * PELLUCID_WRITES. Left changed: pipeline and sets of the compute bind point, and 16 bytes of push constants. Of `frame` only images
 * and the descriptor pool are read, which may be others than when the plan was made. Errors: INVALID_ARGUMENT for an image
 * without a view, a plan that needs what the context leaves out, or a bad slice; BUFFER_TOO_SMALL. */
PELLUCID_API PellucidResult pellucidRecordPlan(const PellucidContext* context, VkCommandBuffer commandBuffer,
                                               const PellucidPlan* plan, const PellucidFrame* frame,
                                               const PellucidConstantsSlice* constants);

#ifdef __cplusplus
}
#endif

#include "pellucid_plan.h"
#endif
