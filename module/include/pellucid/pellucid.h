/* Pellucid: screen-space translucency and subsurface diffusion as Vulkan compute dispatches.
 *
 * An engine needs this header alone. The header has a context of pipelines, a frame with lights and shadow maps, and three calls a
 * frame: pellucidBuildPlan, pellucidWriteConstants, pellucidRecordPlan. All other settings have defaults in the `options` of a
 * struct (pellucid_options.h). pellucid_material.h makes materials. Other headers are for further work:
 * - pellucid_plan.h: record a plan yourself. pellucid.h includes it, but most engines need not read it.
 * - pellucid_views.h: record several views at once.
 * - pellucid_thesis.h: options of Whelan 2009.
 *
 * C ABI, Vulkan headers only. The caller owns images, buffers and command buffers. The module creates pipelines and layouts, and
 * records commands. The module allocates no device memory, changes no image layout, submits nothing and waits for nothing.
 *
 * Conventions, unless a field says otherwise:
 * - matrices: 16 floats, column-major, column vectors (GLM and Vulkan memory order);
 * - clip space: Vulkan's, x right, y down, depth 0..1. The matrix says everything else: reversed or infinite depth, perspective
 *   or orthographic, handedness;
 * - lengths: scene units of `metersPerUnit` meters. Lengths of materials: mm;
 * - colors: linear, scene-referred, R, G, B;
 * - ranges: colors and intensities 0..1e15, other scene values -1e15..1e15;
 * - defaults: 0 where a comment says "0 (default)". pellucidInit* writes all defaults. Structs without such a function, as
 *   PellucidLight and PellucidShadowMap, start from zeros;
 * - errors: a function that returns PellucidResult can return the errors in its comment. Codes stand without PELLUCID_ERROR_.
 */
#ifndef PELLUCID_H
#define PELLUCID_H

#include "pellucid_base.h"
#include "pellucid_material.h"
#include "pellucid_options.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Version of the release. */
#define PELLUCID_VERSION "0.3.0"
/* Version of the headers. The library refuses headers of another version. */
#define PELLUCID_HEADER_VERSION 7u

/* ---- Context: the pipelines of one device ----------------------------------------------------- */

/* The pipelines and layouts of one device. */
typedef struct PellucidContext PellucidContext;

/* Description of a context. */
typedef struct PellucidContextDesc {
  /* PELLUCID_HEADER_VERSION, which pellucidInitContextDesc writes. This field and the next two keep their places in all versions. */
  uint32_t headerVersion;
  /* Optional. It is called with each error of the context and of recordings. */
  PellucidMessageFn message;
  /* First argument of `message`. */
  void* messageUser;
  /* VkApplicationInfo::apiVersion of the instance, at least VK_API_VERSION_1_1; default 1.1. */
  uint32_t apiVersion;
  /* Required. */
  VkInstance instance;
  /* Required. */
  VkPhysicalDevice physicalDevice;
  /* Required. The device has VK_KHR_push_descriptor or Vulkan 1.4's pushDescriptor enabled. Other devices need
   * options.descriptorPools. */
  VkDevice device;
  /* Required. The module gets all Vulkan functions from this function. */
  PFN_vkGetInstanceProcAddr getInstanceProcAddr;
  /* pellucidInitContextDesc writes the defaults. */
  PellucidContextOptions options;
} PellucidContextDesc;

/* Writes the defaults. */
PELLUCID_API void pellucidInitContextDesc(PellucidContextDesc* desc);

/* Checks the device's limits and makes the pipelines of options.uses. Any thread may use the context. On failure *context is NULL.
 * Errors: VERSION, INVALID_ARGUMENT, MISSING_FEATURE, OUT_OF_MEMORY, VULKAN. */
PELLUCID_API PellucidResult pellucidCreateContext(const PellucidContextDesc* desc, PellucidContext** context);

/* Destroys a context. The device must have finished all commands that the context recorded. NULL is allowed. */
PELLUCID_API void pellucidDestroyContext(PellucidContext* context);

/* ---- Materials: pellucid_material.h compiles them -------------------------------------------------- */

/* Makes the tables of a material whose fields the caller filled or changed: what shaders read of its profile and its T(d). The
 * call takes about 2 ms. `message` (optional) names field and value. On failure the tables do not change. Errors: INVALID_ARGUMENT. */
PELLUCID_API PellucidResult pellucidMakeMaterialTables(PellucidMaterial* material, PellucidMessageFn message, void* messageUser);

/* ---- Lights and shadow maps --------------------------------------------------------------------- */

/* Types of lights, with the names and units of KHR_lights_punctual. */
typedef enum PellucidLightType {
  PELLUCID_LIGHT_DIRECTIONAL = 0,
  PELLUCID_LIGHT_POINT = 1,
  PELLUCID_LIGHT_SPOT = 2
} PellucidLightType;

/* A light. */
typedef struct PellucidLight {
  /* PellucidLightType. */
  uint32_t type;
  /* World space. Only point and spot lights have a position. */
  float position[3];
  /* World-space direction in which the light travels, of any length above 0. Directional and spot lights need it, and lights with an
   * angleTable. */
  float direction[3];
  /* Factor of the intensity for R, G, B, 0..1e15. */
  float color[3];
  /* 0..1e15. Directional light: the irradiance at normal incidence. Point and spot light: I, where E = I cos(theta)/r^2 is the irradiance
   * at the angle of incidence theta and the distance r in scene units. */
  float intensity;
  /* Scene units, 0..1e15. Point and spot lights have the factor max(0, 1 - (r / range)^4) at the distance r. 0 (default): no factor. */
  float range;
  /* Angles from a spot light's axis in radians, 0 <= inner < outer <= pi/2. The light is full inside of the inner angle and ends at the
   * outer angle. */
  float innerConeAngle, outerConeAngle;
  /* The light's range of frame.shadowMaps, at most PELLUCID_MAX_LIGHT_SHADOW_MAPS: 6 for a cube, n for n cascades. A receiver takes the
   * first map that contains it. 0 maps: nothing shadows the light. It enters the face that a pixel hides, and frame.backDepth gives the
   * thickness. */
  uint32_t firstShadowMap, shadowMapCount;
  /* Falloff of point and spot lights: indices into options.lightTables plus 1; 0 (default): no table. angleTable has factors by the angle
   * from `direction`. distanceTable has factors by distance. */
  uint32_t angleTable, distanceTable;
  /* The largest cosine between the directions to eye and light for which light comes through, -1..0; default 0. -1: no light comes
   * through. Only thesis->angleModel MINIMUM_DOT and thesis->prescaleAngle read it. */
  float minimumDot;
} PellucidLight;

/* Most shadow maps of a light. */
enum { PELLUCID_MAX_LIGHT_SHADOW_MAPS = 8 };

/* Content of a depth image. */
typedef enum PellucidDepthEncoding {
  /* Clip z / w of the matrix that rendered the depth, 0..1. A camera's depth image has no surface at values outside 0..1, at NaN, and at
   * 1e9 scene units or more. */
  PELLUCID_DEPTH_DEVICE = 0,
  /* Planar distance in front of the eye, scene units, above 0. Values <= 0, values >= 1e9 and NaN: no surface. */
  PELLUCID_DEPTH_VIEW_Z = 1,
  /* Distance from the light, scene units. Only shadow maps can have this encoding. */
  PELLUCID_DEPTH_DISTANCE = 2,
  /* Thickness of the body under the surface, mm, along the normal, as artists paint it. Negative values, values >= 1e9 and NaN: not known.
   * Only frame.backDepth can have this encoding. */
  PELLUCID_DEPTH_THICKNESS = 3
} PellucidDepthEncoding;

/* A light's shadow map as the engine drew it. Biases, atlas tiles and exit depth are in `options`. */
typedef struct PellucidShadowMap {
  /* Index into frame.shadowImages. */
  uint32_t image;
  /* Width and height in texels, 1..65536. */
  uint32_t extent[2];
  /* PellucidDepthEncoding; default DEVICE. */
  uint32_t encoding;
  /* The matrix that drew the map, invertible. Clip (-1, -1) is the outer corner of the map's first texel. Clip (1, 1) is the outer corner
   * of the last texel. */
  float clipFromWorld[16];
  /* Zeros give the defaults. */
  PellucidShadowMapOptions options;
} PellucidShadowMap;

/* ---- Frame --------------------------------------------------------------------------------------- */

/* Most transients of a frame. */
enum { PELLUCID_MAX_TRANSIENTS = 8 };

/* Input and output of one recording. */
typedef struct PellucidFrame {
  /* Width and height in pixels of every screen-sized image, 1..65536. In frames that
   * diffuse, the rect with 8 pixels around touches at most 65535 blocks of 64 x 64 pixels. */
  uint32_t imageExtent[2];
  /* Meters of a scene unit, 1e-6 (micrometers) to 1e3 (kilometers); default 1. */
  float metersPerUnit;
  /* The projection that rendered the depths, with its jitter. */
  float clipFromView[16];
  /* The camera's view matrix: a rotation and a translation; default identity. docs/integration.md, "Far from the origin". */
  float viewFromWorld[16];
  /* Factor of the irradiance E in `irradiance` and `output`, 1e-9..1e9; default 1. Lights do not have the factor. preExposure is
   * the product of three factors:
   * - 1 / pi if the image holds E / pi;
   * - 1 - F if lighting subtracts the Fresnel reflection F, taken at normal incidence;
   * - the exposure. */
  float preExposure;

  /* Required; a depth format or one float channel, in options.frontDepthEncoding: the surface that the camera sees. The surface's normal
   * follows from these depths. Shading normals are no input, because normal maps turn them away from the surface. */
  PellucidImage frontDepth;
  /* Optional; as frontDepth, in options.backDepthEncoding: the nearest back face behind the front depth, or the body's thickness. Without
   * it no light has the camera-space thickness, and thin parts return as much light as thick parts. */
  PellucidImage backDepth;
  /* Optional; three float channels, in the units of `irradiance`: the irradiance of the hidden face from all around, as light probes
   * have it. The part T(d) comes through. The image replaces options.ambient for hidden faces, and needs backDepth. docs/integration.md,
   * "Ambient light". */
  PellucidImage hiddenIrradiance;
  /* Required; three float channels: the irradiance E of the visible surface times preExposure, without albedo and specular light. */
  PellucidImage irradiance;
  /* Optional; three channels, 0..1: factor of the light after scattering. Without it the factor is 1. */
  PellucidImage albedo;
  /* Required; unsigned integer. 0: no material. i: materials[i - 1]. */
  PellucidImage material;
  /* Required by reuse ACCUMULATE; two float channels, without jitter. Times options.motionScale, the vector is the surface's place in
   * this frame minus the place in the earlier frame. Its unit is the image's width and height. */
  PellucidImage motion;
  /* Required; a storage image, which may be `irradiance`. It gets E after scattering, times preExposure and albedo, in place of a diffuse
   * term. Results are 0..65504. Alpha is copied from `irradiance`. Pixels of material 0 are not written. If `output` and
   * `irradiance` have one view, they are one image in layout GENERAL. If they have two views, the views share no memory. Without a view,
   * the output counts as the irradiance image. plan.inPlaceDispatches says whether a dispatch samples and stores one image. */
  PellucidImage output;
  /* The scratch images that pellucidGetImageNeeds lists, in its order, in layout GENERAL. */
  PellucidImage transients[PELLUCID_MAX_TRANSIENTS];

  /* materialCount materials. */
  const PellucidMaterial* materials;
  /* 1..255. */
  uint32_t materialCount;
  /* Any number of lights. */
  uint32_t lightCount;
  /* lightCount lights. */
  const PellucidLight* lights;
  /* shadowMapCount maps of all lights. */
  const PellucidShadowMap* shadowMaps;
  /* Any number of maps. */
  uint32_t shadowMapCount;
  /* Any number of images, as far as a plan can bind them. */
  uint32_t shadowImageCount;
  /* shadowImageCount images with depth or one float channel. A view has the depth aspect alone. */
  const PellucidImage* shadowImages;
  /* pellucidInitFrame writes the defaults. */
  PellucidFrameOptions options;
} PellucidFrame;

/* Writes the defaults. */
PELLUCID_API void pellucidInitFrame(PellucidFrame* frame);

/* Checks every convention and the range of each field (docs/materials.md). Calls `fn` (optional) with each warning and error. Warnings
 * alone return PELLUCID_OK. Only this function and recording refuse null views. This function alone checks layouts. Any handles can stand
 * for views, with layout GENERAL. Errors: INVALID_ARGUMENT; CAPACITY for more shadow images than a plan can bind. */
PELLUCID_API PellucidResult pellucidValidateFrame(const PellucidFrame* frame, PellucidMessageFn fn, void* user);

/* An image that the caller creates: 2D, one mip, usage SAMPLED | STORAGE. A transient holds nothing between frames. Its memory may serve
 * other uses outside of the dispatches firstDispatch to lastDispatch. */
typedef struct PellucidImageNeed {
  /* Format of the image. */
  VkFormat format;
  /* Width and height in pixels. */
  uint32_t extent[2];
  /* Indices into plan.dispatches: the first and the last dispatch between whose barriers the image is used. With reuse, they cover the plans
   * of both kinds of frames. */
  uint32_t firstDispatch, lastDispatch;
  /* Bytes of all texels. The device may need more. */
  uint64_t bytes;
  /* 0: a transient. 1: options.history, an image that keeps its content between frames. */
  uint32_t persistent;
} PellucidImageNeed;

/* Lists the transients of this frame in order, then with reuse the persistent image. The images serve every render rect. Writes at most
 * *count needs, and sets *count to the number of all. `needs` may be NULL. Transients need no views yet. Optional inputs count as given
 * if they have views; all other views may be null. `output` and `irradiance` have the plan's views, because frames in place may need one
 * transient more. Any handles can stand for views. Errors: INVALID_ARGUMENT; CAPACITY, if needs are written. */
PELLUCID_API PellucidResult pellucidGetImageNeeds(const PellucidFrame* frame, uint32_t* count, PellucidImageNeed* needs);

/* ---- Plan and recording -------------------------------------------------------------------------- */

/* The dispatches of a frame: plain data of at most 4096 bytes. pellucid_plan.h has the fields. */
typedef struct PellucidPlan PellucidPlan;

/* Plans a frame. The function is pure: the same frame and previous plan give the same plan, without a device or allocation. The plan
 * keeps no pointer to the frame. Views may be null, and any handles can stand for views. Optional images count as given if they have views,
 * and an output without a view as in place. `previous`: the plan of the last recorded frame, for options.reuse alone, or NULL. `previous` and
 * `plan` may be one object. On failure the plan is empty. Errors: INVALID_ARGUMENT; CAPACITY for more dispatches than a plan holds. */
PELLUCID_API PellucidResult pellucidBuildPlan(const PellucidFrame* frame, const PellucidPlan* previous, PellucidPlan* plan);

/* The most bytes that a slice needs for these numbers of materials, lights and shadow maps, a multiple of 256. A map of two lights counts
 * twice. */
PELLUCID_API VkDeviceSize pellucidGetConstantsSize(uint32_t materialCount, uint32_t lightCount, uint32_t shadowMapCount);

/* The constants of one recording: host-visible, host-coherent memory, device-local if such memory exists. The device also writes into
 * the slice. Each recording that the device has not finished needs its own slice, so a ring has one slice for each frame in flight.
 * No check notices a slice that is overwritten too early. */
typedef struct PellucidConstantsSlice {
  /* Usage STORAGE_BUFFER | UNIFORM_BUFFER | INDIRECT_BUFFER. */
  VkBuffer buffer;
  /* Bytes, a multiple of 256. */
  VkDeviceSize offset;
  /* Bytes, at least plan.constantsSize. */
  VkDeviceSize size;
  /* Host address of the byte at `offset`. */
  void* mapped;
} PellucidConstantsSlice;

/* Writes the constants of a plan into `size` bytes at `mapped`. The plan was made from this frame. Views may be null if they were null for
 * the plan. Errors: INVALID_ARGUMENT for a null pointer, a frame that pellucidBuildPlan refuses, or a plan of another frame;
 * BUFFER_TOO_SMALL, if `size` is below plan->constantsSize. */
PELLUCID_API PellucidResult pellucidWriteConstants(const PellucidPlan* plan, const PellucidFrame* frame, void* mapped, size_t size);

/* Stages and accesses of the barriers around a recording. Any queue family with COMPUTE may run a recording. */
enum {
  PELLUCID_STAGES = VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT,
  PELLUCID_READS = VK_ACCESS_SHADER_READ_BIT,
  PELLUCID_WRITES = VK_ACCESS_SHADER_WRITE_BIT
};

/* Records the dispatches of a plan and the barriers between them, outside of render passes.
 * - Before: the inputs are visible to PELLUCID_STAGES / PELLUCID_READS. Output and transients are free for PELLUCID_WRITES.
 * - After: PELLUCID_STAGES / PELLUCID_WRITES have written `output`.
 * - State: recording changes pipeline and sets of the compute bind point, and 16 bytes of push constants.
 * - Frame: recording reads only images and descriptor pool of `frame`. Both may differ from those of pellucidBuildPlan. A plan of two
 *   views of output and irradiance refuses one view.
 * - Errors: INVALID_ARGUMENT for an image without a view, a plan that needs a use that the context lacks, or a bad slice;
 *   BUFFER_TOO_SMALL; OUT_OF_MEMORY and VULKAN of the descriptor pool. */
PELLUCID_API PellucidResult pellucidRecordPlan(const PellucidContext* context, VkCommandBuffer commandBuffer,
                                               const PellucidPlan* plan, const PellucidFrame* frame,
                                               const PellucidConstantsSlice* constants);

#ifdef __cplusplus
}
#endif

#include "pellucid_plan.h"
#endif
