/* Pellucid: screen-space translucency and subsurface diffusion as Vulkan compute dispatches.
 *
 * The run-time API: frame, images, recording. C ABI, Vulkan headers only. The caller owns every Vulkan
 * object: the module creates pipelines and layouts, records vkCmd* calls into the caller's command
 * buffer, and never allocates device memory, transitions an image layout, submits or waits.
 * pellucid_plan.h, which this header includes at its end, has what a plan holds, for engines that record
 * plans themselves. pellucid_context.h makes pipelines, pellucid_light.h describes a light, pellucid_shadow_map.h its
 * shadow map. Not included: pellucid_material.h, the material compiler; pellucid_views.h, several views in one recording;
 * pellucid_statistics.h, what the device decided; pellucid_cells.h, cells with material that the caller found;
 * pellucid_thesis.h, options of Whelan 2009; pellucid_budget.h, a frame budget.
 *
 * Conventions, unless a field says otherwise:
 * - matrices: 16 floats, column-major, column vectors (GLM and Vulkan memory order);
 * - clip space: Vulkan, x right, y down, depth 0..1; any near/far order, perspective or
 *   orthographic, either handedness: everything is read from the matrix;
 * - lengths: scene units, `metersPerUnit` meters each; material coefficients in mm;
 * - colors: linear, scene-referred;
 * - a zero-initialized optional field is its default; pellucidInit* writes the other defaults;
 * - a struct with a `structSize` grows at its end from release to release. A struct of an older header may
 *   end before its first field marked "may be missing" or after any later one: fields that it lacks have
 *   their defaults. A newer header's may be longer, up to 4096 bytes, if all further bytes are 0. Structs
 *   without a `structSize` change with PELLUCID_HEADER_VERSION alone.
 */
#ifndef PELLUCID_H
#define PELLUCID_H

#include <stddef.h>
#include <stdint.h>
#include <vulkan/vulkan_core.h>

#include "pellucid_context.h"
#include "pellucid_light.h"
#include "pellucid_result.h"
#include "pellucid_shadow_map.h"

#ifdef __cplusplus
extern "C" {
#endif

#define PELLUCID_VERSION "0.2.0" /* of the release */

/* Passed in PellucidContextDesc; the library refuses a header it does not know. */
#define PELLUCID_HEADER_VERSION 5u

/* ---- Materials ------------------------------------------------------------------------------- */

enum { PELLUCID_MAX_GAUSSIANS = 8 };

/* T(d): fraction of the flux entering one face of a slab of thickness d (mm) that leaves the other.
 * The parameters are PellucidMaterial::transmittance[channel], in the order given here. */
typedef enum PellucidTransmittanceModel {
  PELLUCID_TRANSMITTANCE_EXP2 = 0,     /* a1, k1, a2, k2: a1 e^{-k1 d} + a2 e^{-k2 d} */
  PELLUCID_TRANSMITTANCE_SINH_EXP = 1, /* a, kappa, z, b, c: a / sinh(kappa d + z) + b e^{-c d} */
  PELLUCID_TRANSMITTANCE_GAUSSIANS = 2, /* none: sum w_i e^{-d^2 / (2 v_i)} over the profile's own
                                           Gaussians (d'Eon 2007; R(sqrt(r^2+d^2)) integrated) */
  PELLUCID_TRANSMITTANCE_GAUSSIANS_AS_PRINTED = 3, /* none: e^{-d^2 / v_i}, as Whelan 2009 eq. 2.11
                                           prints it; twice the exponent that the integral gives */
  PELLUCID_TRANSMITTANCE_LINEAR = 4     /* dmax (mm, > 0): 1 - d/dmax, 0 beyond (Whelan 2009, 4.1) */
} PellucidTransmittanceModel;

/* Constants that the shaders evaluate. Filled by pellucidCompileMaterial (pellucid_material.h) from physical
 * coefficients or a preset, or by hand. Index order of arrays of 3: R, G, B. */
typedef struct PellucidMaterial {
  uint32_t structSize;        /* sizeof(PellucidMaterial); one size for all of a frame */
  uint32_t transmittanceModel; /* PellucidTransmittanceModel */
  float transmittance[3][5];  /* 1/mm for rates, 1 for amplitudes; see the model */
  float reflectance[3];       /* rho, semi-infinite diffuse reflectance, (0, 1] */
  uint32_t gaussianCount;     /* 1..PELLUCID_MAX_GAUSSIANS; 0: the material does not diffuse */
  float gaussianVariance[3][PELLUCID_MAX_GAUSSIANS]; /* mm^2, > 0, of one axis: w/(2 pi v) e^{-r^2/2v} */
  float gaussianWeight[3][PELLUCID_MAX_GAUSSIANS];   /* each channel sums to 1 */
  float radius[3];            /* mm; 99.9 % of the diffused energy lies within */
  /* ---- fields that may be missing ---- */
  float burleyDistance[3];    /* mm; d of Christensen & Burley 2015 eq. 3 that the Gaussians fit and the
                                 diffusion takes in their place; 0 (default): the Gaussians */
  uint32_t thinWalled;        /* 1: a sheet without thickness, like leaves and paper. Light that arrives at one face leaves
                                 by the other times wallTransmittance, and `transmittance` is not read. Shadow maps only
                                 say whether something else blocks the light. Not gathered. 0 (default): a solid */
  float wallTransmittance[3]; /* of the irradiance of the other face, [0, 1]; with `reflectance` at most 1 */
} PellucidMaterial;

/* Tables that recordings take from a material: its profile over the pyramid's levels, and what the gather knows of it. They
 * depend on the material alone, so that they are made with it, once, and not for each frame. Plain data. */
enum { PELLUCID_MATERIAL_TABLE_WORDS = 3440 };
typedef struct PellucidMaterialTables {
  uint32_t words[PELLUCID_MATERIAL_TABLE_WORDS]; /* not for callers */
} PellucidMaterialTables;

/* Writes the tables of a material, compiled or by hand. INVALID_ARGUMENT: a null pointer, or a material that
 * pellucidValidateFrame refuses. */
PELLUCID_API PellucidResult pellucidMakeMaterialTables(const PellucidMaterial* material, PellucidMaterialTables* tables);

/* ---- Frame ----------------------------------------------------------------------------------- */

/* An image the caller owns. The view must be 2D, one layer, one mip; the layout is the one the image
 * is in while the recorded commands run, GENERAL or a READ_ONLY one, and is never changed. A null view means "not given". */
typedef struct PellucidImage {
  VkImageView view;     /* or a null handle: not given */
  VkImageLayout layout; /* of the image while the commands run */
} PellucidImage;

/* Content of a depth image. */
typedef enum PellucidDepthEncoding {
  PELLUCID_DEPTH_DEVICE = 0,  /* the 0..1 value of the matrix that rendered it; of the camera: other values, NaN,
                                 and distances of 1e9 and more: nothing there */
  PELLUCID_DEPTH_VIEW_Z = 1,  /* positive planar distance in front of the eye, scene units; <= 0,
                                 >= 1e9, inf or NaN: nothing there */
  PELLUCID_DEPTH_DISTANCE = 2 /* distance from the light, scene units (shadow maps only) */
} PellucidDepthEncoding;

/* A fused dispatch binds 8 shadow images and takes 128 lights and 112 shadow maps; a frame with more gets several. Exit
 * depths and caster materials count; the images of one light must fit into one dispatch. Where those of all lights are
 * more than a plan's dispatches can bind, all exit depths and caster materials are left out, which a skip says. */
enum { PELLUCID_MAX_LIGHT_SHADOW_MAPS = 8, PELLUCID_MAX_TRANSIENTS = 8 };

/* Parts of a frame. */
typedef enum PellucidFeatureBits {
  PELLUCID_FEATURE_TRANSLUCENCY = 1u << 0, /* light that comes through */
  PELLUCID_FEATURE_DIFFUSION = 1u << 1     /* light that spreads under the surface */
} PellucidFeatureBits;

/* Source of the thickness of a light with a shadow map. Lights without one use the camera's depths. */
typedef enum PellucidThicknessSource {
  PELLUCID_THICKNESS_LIGHT = 0, /* distance along the light ray from the shadow map's surface */
  PELLUCID_THICKNESS_CAMERA = 1 /* back depth minus front depth; the shadow map only occludes */
} PellucidThicknessSource;

/* Frames may take the light that comes through from an earlier one. Irradiance and diffusion
 * are always the frame's own. One of the two: alternating would skip frames in which coherence asks for a refresh. */
typedef enum PellucidReuse {
  PELLUCID_REUSE_NONE = 0,
  PELLUCID_REUSE_ALTERNATE = 1, /* every second frame (Whelan 2009, 4.7.4) */
  PELLUCID_REUSE_COHERENCE = 2  /* until the cosine between the camera's axis and the direction to a light has
                                   changed by more than the threshold (Whelan 2009, 4.7.5) */
} PellucidReuse;

/* Write one intermediate into `output` instead of the result. Float values, alpha kept. */
typedef enum PellucidDebugView {
  PELLUCID_DEBUG_NONE = 0,
  PELLUCID_DEBUG_THICKNESS = 1,     /* mm: R camera-space chord, G light-space of the first light with a map that
                                       contains the pixel, B that of the first contributing light; -1: none */
  PELLUCID_DEBUG_TRANSMITTANCE = 2, /* transmitted / arriving, summed over lights; 0 where none */
  PELLUCID_DEBUG_OCCLUSION = 3,     /* fraction of the lights' back irradiance that the maps let by */
  PELLUCID_DEBUG_IRRADIANCE = 4     /* irradiance + transmitted/rho: what the diffusion reads */
} PellucidDebugView;

/* The fate of the output's pixels that have a material: */
typedef enum PellucidOutputMode {
  PELLUCID_OUTPUT_REPLACE = 0, /* they become the result */
  PELLUCID_OUTPUT_ADD = 1      /* the result is added to their color, which is specular light, say, and their alpha
                                  stays. The sum is clamped as a result is: 0..65504, and NaN counts as 0. The output is not the
                                  irradiance image, and its image has usage SAMPLED, too. Debug views replace. For renderers
                                  without a pass that composites; see docs/integration.md */
} PellucidOutputMode;

/* Who decides how many workgroups run: */
typedef enum PellucidIndirect {
  PELLUCID_INDIRECT_NONE = 0,    /* the plan: passes run over the whole rect */
  PELLUCID_INDIRECT_MATERIAL = 1 /* the GPU: the diffusion and the gather run where it finds material */
} PellucidIndirect;

/* Options of Whelan 2009, pellucid_thesis.h. */
typedef struct PellucidThesisOptions PellucidThesisOptions;

/* All that one recording reads and writes. */
typedef struct PellucidFrame {
  uint32_t structSize; /* sizeof(PellucidFrame), written by pellucidInitFrame */
  uint32_t features;   /* PellucidFeatureBits; default both */
  uint32_t imageExtent[2]; /* pixels of every screen-sized image */
  uint32_t renderRect[4];  /* x, y, width, height inside imageExtent, beyond which nothing is read or written; width
                              0: the whole image */
  float metersPerUnit;     /* default 1 */
  float clipFromView[16];  /* the projection that rendered the depths, jitter included */
  float viewFromWorld[16]; /* rigid; default identity; far from the origin, docs/integration.md */

  PellucidImage frontDepth; /* required; one float channel */
  PellucidImage backDepth;  /* nearest back face behind the front; without it no camera-space thickness, and in a gather thin
                               parts return as much light as thick ones */
  PellucidImage irradiance; /* required; E that arrives outside of the surface, not divided by pi, without the factor 1 - F of
                               a diffuse term, not multiplied by albedo; preExposure says what else the image holds */
  PellucidImage normal;     /* outward unit vectors, as PellucidContextDesc::normalEncoding says */
  PellucidImage albedo;     /* multiplied after scattering */
  PellucidImage material;   /* required; unsigned integer, 0 none, i: materials[i - 1]; see materialMask. A view's
                               component mapping brings another channel to R */
  PellucidImage output;     /* required; storage image of outputFormat; may be the irradiance image. Pixels of
                               material 0 are not written, and all others of the rect are; alpha is the irradiance's */
  PellucidImage transients[PELLUCID_MAX_TRANSIENTS]; /* as listed by pellucidGetImageNeeds */
  VkFormat outputFormat;    /* R16G16B16A16_SFLOAT (default), R32G32B32A32_SFLOAT or B10G11R11_UFLOAT_PACK32, which has no
                               alpha; see PellucidContextDesc::outputFormat. 32 bits keep alpha to the bit and colors up
                               to 65504: to 1e-6 without diffusion, to 2^-10 with it, which works in halves */
  uint32_t frontDepthEncoding, backDepthEncoding; /* PELLUCID_DEPTH_DEVICE (default) or VIEW_Z */
  uint32_t normalsInViewSpace; /* 0: world (default) */
  uint32_t materialCount;   /* 1..255 */
  const PellucidMaterial* materials; /* materialCount of them */
  uint32_t lightCount;      /* any number; 0: no translucency */
  const PellucidLight* lights; /* lightCount of them */
  uint32_t shadowMapCount;  /* any number */
  const PellucidShadowMap* shadowMaps; /* shadowMapCount of them */
  uint32_t shadowImageCount; /* any number */
  const PellucidImage* shadowImages; /* depth or one float channel, one view each of
                                        PellucidContextDesc::shadowViewType, of the depth aspect alone */
  /* ---- fields that may be missing ---- */
  uint32_t thicknessSource; /* PellucidThicknessSource */
  uint32_t debugView;       /* PellucidDebugView */
  const PellucidThesisOptions* thesis; /* NULL (default): none */
  uint32_t gatherSamples;   /* samples of the shadow map that each probe gathers light from, for lights with a map: a
                               multiple of 4, at most 64; default 8. More lower the noise of thin parts. 0: one light-space
                               thickness a pixel; so it is, as the plan's skips say, with a solid that is
                               not of EXP2 or SINH_EXP, thickness from the camera, a material mark bit, and thesis
                               options of one thickness a pixel */
  uint32_t reuse;           /* PellucidReuse. Kept light is looked up at the same pixel: pass no previous plan
                               after a cut, and expect a lag of the frames in between where things move.
                               Point and spot lights are seen from thesis->objectCenter */
  float coherenceThreshold; /* of COHERENCE, >= 0; default .005 */
  float frameLoad;          /* frame time / its budget, >= 0; above 1 it multiplies the threshold, so that frames
                               that are late refresh less often; 0: not known */
  PellucidImage history;    /* with reuse; the persistent one of pellucidGetImageNeeds, GENERAL, the same in all frames */
  float targetError;      /* > 0: in place of gatherSamples, the least of 0, 8 and 16 whose measured error, a relative RMSE,
                             stays below it: with lights that of the worst frame against path tracing, else that of the
                             diffusion from brute force at the frame's radii; 16 and a skip if none does; 0 (default): off */
  float nearestDistance;  /* planar distance of the nearest surface that diffuses, scene units, or less: it leaves out
                             levels for radii that are small in pixels; nearer surfaces are then diffused too little.
                             Orthographic cameras need none. 0 (default): not known, radii count as the largest */
  uint32_t gatherSpacing;   /* pixels a side of the cell that one probe gathers for: 1, 2 or 4; 0 (default): 4 in images of
                               more than 2^20 pixels, 2 in those of more than 2^19, else 1. Each step costs a quarter of the
                               one before; 4 needs pixels far below a mean free path */
  uint32_t separateOutput;  /* 1: the output shares no memory with the irradiance, of which diffusion without a fused
                               dispatch before it then needs no copy; 0 (default): it may be the same image */
  uint32_t indirectDispatches; /* PellucidIndirect; default MATERIAL: the constants' buffer has usage INDIRECT_BUFFER, too, unless
                                  NONE */
  uint32_t materialShift, materialMask; /* the index is (R of the material image & mask) >> shift, so that other bits may
                                           hold anything; shift 0..31, and the mask has the bits of all indices; mask 0
                                           (default): all bits. thesis->materialMarkBit is a bit of the shifted value */
  uint32_t outputMode;      /* PellucidOutputMode */
  float preExposure;        /* the irradiance image holds E times this, and so does the output; lights and ambient keep their
                               units. The product of 1 / pi for an image of E / pi, 1 - F at normal incidence for one whose
                               lights lose F, and the exposure. 1e-9..1e9; default 1. Light that is reused was stored by the
                               factor of its own frame: a change of the factor computes it anew */
  const float* ambient;     /* light from all around that comes through thin parts, or NULL (default): 9 x RGB coefficients of
                               radiance, -1e15..1e15, of the real orthonormal spherical harmonics of the world direction that
                               light comes from, in the order 1, y, z, x, xy, yz, 3 z^2 - 1, xz, x^2 - y^2. The irradiance
                               image has what lies on visible faces. Needs backDepth; nothing shadows hidden faces.
                               Not in the debug views of light */
  uint32_t lightTableCount; /* 0..PELLUCID_MAX_LIGHT_TABLES; above 0 only with PellucidContextDesc::lightTables */
  const PellucidLightTable* lightTables; /* lightTableCount of them, which lights may share */
  VkDescriptorPool descriptorPool; /* with PellucidContextDesc::descriptorPools: by pellucidCreateDescriptorPool. Recording resets
                                      it, so each recording that the device has not finished needs one of its own, as of
                                      constants slices. Else unused; default NULL */
  const PellucidMaterialTables* materialTables; /* materialCount of them, each of the material of its index; NULL (default):
                                                   made anew for each frame, which takes 20 us of CPU time a material */
} PellucidFrame;

/* ---- Plan ------------------------------------------------------------------------------------ */

/* The dispatches of a frame: a complete type of pellucid_plan.h, at most 4096 bytes. Read while constants are written and
 * commands are recorded, and by the next plan as `previous`. */
typedef struct PellucidPlan PellucidPlan;

/* One transient the caller creates: 2D, one mip, of this format and extent (for any render rect), usage SAMPLED |
 * STORAGE. It holds nothing between frames: it may alias memory not used during dispatches first..last. */
typedef struct PellucidImageNeed {
  VkFormat format;    /* of the image and its view */
  uint32_t extent[2]; /* pixels */
  uint32_t firstDispatch, lastDispatch; /* indices in plan.dispatches between which it is in use */
  uint64_t bytes;     /* of texels, without what the device adds */
  uint32_t persistent; /* 1: for frame.history and not a transient; keeps its content between frames */
} PellucidImageNeed;

/* ---- Planning: pure functions, no device, no allocation -------------------------------------- */

/* The defaults, written into a struct of that many bytes. */
PELLUCID_API void pellucidInitFrameSized(PellucidFrame* frame, size_t structSize);
/* The defaults. */
static inline void pellucidInitFrame(PellucidFrame* f) { pellucidInitFrameSized(f, sizeof *f); }

/* The transients of this frame in order, then with reuse the persistent image. Writes up to *count needs, sets
 * *count to the number there are; `needs` may be NULL. Views are not looked at: call it before creating them. */
PELLUCID_API PellucidResult pellucidGetImageNeeds(const PellucidFrame* frame, uint32_t* count, PellucidImageNeed* needs);

/* Bytes of a constants slice for any frame of at most so many materials, lights and shadow maps, whatever else it holds:
 * plan.constantsSize is never more. shadowMapCount: the sum over the lights, so that a map of two lights counts twice. No
 * frame, image or device is needed, so a ring of slices can be allocated first. */
PELLUCID_API VkDeviceSize pellucidGetConstantsSize(uint32_t materialCount, uint32_t lightCount, uint32_t shadowMapCount);

/* Checks every convention and the domains of all fields (docs/materials.md); calls `fn` for each finding. PELLUCID_OK
 * unless one is an error. PELLUCID_ERROR_CAPACITY exactly where pellucidBuildPlan returns it, too: more shadow images
 * than a plan can bind. */
PELLUCID_API PellucidResult pellucidValidateFrame(const PellucidFrame* frame, PellucidMessageFn fn, void* user);

/* Same frame and previous plan, same plan. `previous` is the last recorded frame's plan or NULL; history comes in here
 * and nowhere else; see PellucidReuse. The plan keeps no pointer to the frame. It depends
 * on which optional inputs have views, and on output and irradiance being one view: then a frame with nothing to do has
 * no dispatches. */
PELLUCID_API PellucidResult pellucidBuildPlan(const PellucidFrame* frame, const PellucidPlan* previous, PellucidPlan* plan);

/* ---- Recording ------------------------------------------------------------------------------- */

/* Host-visible, host-coherent memory for one recording, usage STORAGE_BUFFER | UNIFORM_BUFFER |
 * INDIRECT_BUFFER, the last unless frame.indirectDispatches is NONE: the device writes there what it decides, which holds until the
 * constants are written again. All passes read it, so it should be device-local, too, where there is such memory.
 * pellucidWriteConstants writes the slice at once, and the device reads it when the commands run. Each recording that the
 * device has not finished needs a slice of its own: a ring of as many as there are frames in flight. Neither this library
 * nor Vulkan's validation sees one that is written too early; the earlier frame then has the later one's camera and lights. */
typedef struct PellucidConstantsSlice {
  VkBuffer buffer;     /* of the caller */
  VkDeviceSize offset; /* multiple of 256, the largest alignment Vulkan lets a device ask for */
  VkDeviceSize size;   /* >= plan.constantsSize, which pellucidGetConstantsSize bounds */
  void* mapped;        /* address of `offset` */
} PellucidConstantsSlice;

/* Scopes of the barriers around a recording, on any queue of a family that computes. A semaphore between two submissions
 * takes the place of a barrier. */
enum {
  PELLUCID_STAGES = VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, /* that touch the caller's images */
  PELLUCID_READS = VK_ACCESS_SHADER_READ_BIT,             /* accesses to inputs, and to an output that is added to */
  PELLUCID_WRITES = VK_ACCESS_SHADER_WRITE_BIT            /* to the output. Transients and history: both */
};

/* Makes those pipelines that the plan dispatches and a context with desc.deferPipelines lacks, of those of desc.uses: for tools,
 * which render few frames. desc.pipelineCache and parallelFor must be alive still. No other thread uses the context at the
 * same time. On failure the message callback has the sentence, and pipelines made so far stay. */
PELLUCID_API PellucidResult pellucidCreatePipelines(PellucidContext* context, const PellucidPlan* plan);

/* Writes the constants of a plan, made from this frame, to the slice's `mapped`. The plan may then be recorded any number of
 * times. Image views are not looked at. `size`: bytes there. INVALID_ARGUMENT: a null pointer, a frame that
 * pellucidValidateFrame refuses, or a plan of another one; BUFFER_TOO_SMALL: size is below plan.constantsSize. */
PELLUCID_API PellucidResult pellucidWriteConstants(const PellucidPlan* plan, const PellucidFrame* frame, void* mapped,
                                                   size_t size);

/* Records every dispatch and the barriers between them. Before: what wrote the inputs is visible to
 * PELLUCID_STAGES / PELLUCID_READS, and the output and transients are free for PELLUCID_WRITES. After: `output` was written
 * by PELLUCID_STAGES / PELLUCID_WRITES. When the commands run, the slice holds what pellucidWriteConstants wrote.
 * Outside of render passes. Left changed: pipeline and sets of the compute bind point, and 16 bytes of push constants of all
 * bind points (docs/integration.md). Of `frame` alone the images and the descriptor pool are read, which may be others than
 * when the plan was made. Errors, of which the message names the field:
 * - INVALID_ARGUMENT: an image that the plan binds has no view; a pipeline or an option of PellucidContextDesc that the plan
 * needs is not the context's; a slice without a buffer or with an offset that is no multiple of 256;
 * - BUFFER_TOO_SMALL: constants->size is below plan.constantsSize.
 * Everything else, layouts among it, is pellucidValidateFrame's. */
PELLUCID_API PellucidResult pellucidRecordPlan(const PellucidContext* context, VkCommandBuffer commandBuffer,
                                               const PellucidPlan* plan, const PellucidFrame* frame,
                                               const PellucidConstantsSlice* constants);

#ifdef __cplusplus
}
#endif

#include "pellucid_plan.h"
#endif
