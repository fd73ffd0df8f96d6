/* Pellucid: screen-space translucency and subsurface diffusion as Vulkan compute dispatches.
 *
 * The whole run-time API. C ABI, Vulkan headers only. The caller owns every Vulkan object: the
 * module creates pipelines and layouts, records vkCmd* calls into the caller's command buffer, and
 * never allocates device memory, transitions an image layout, submits or waits.
 *
 * Conventions, unless a field says otherwise:
 * - matrices: 16 floats, column-major, column vectors (GLM and Vulkan memory order);
 * - clip space: Vulkan, x right, y down, depth 0..1; any near/far order, perspective or
 *   orthographic, either handedness: everything is read from the matrix;
 * - lengths: scene units, `metersPerUnit` meters each; material coefficients in mm;
 * - colors: linear, scene-referred;
 * - a zero-initialized optional field is its default; pellucidInit* writes the other defaults.
 */
#ifndef PELLUCID_H
#define PELLUCID_H

#include <stddef.h>
#include <stdint.h>
#include <vulkan/vulkan_core.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Passed in PellucidContextDesc; the library refuses a header it does not know. */
#define PELLUCID_HEADER_VERSION 3u

typedef int32_t PellucidResult;
enum {
  PELLUCID_OK = 0,
  PELLUCID_ERROR_INVALID_ARGUMENT = -1, /* a field is wrong; the message names it */
  PELLUCID_ERROR_VERSION = -2,          /* structSize or headerVersion unknown to this library */
  PELLUCID_ERROR_MISSING_FEATURE = -3,  /* the device lacks Vulkan 1.1, push descriptors or 24 KiB of
                                           shared memory a group */
  PELLUCID_ERROR_OUT_OF_MEMORY = -4,
  PELLUCID_ERROR_VULKAN = -5,        /* a Vulkan call failed; the message has the VkResult */
  PELLUCID_ERROR_CAPACITY = -6,      /* more dispatches or shadow images than a plan holds */
  PELLUCID_ERROR_BUFFER_TOO_SMALL = -7 /* constants slice or text buffer shorter than needed */
};

typedef enum PellucidSeverity {
  PELLUCID_SEVERITY_WARNING = 0,
  PELLUCID_SEVERITY_ERROR = 1
} PellucidSeverity;

/* `field` is the API field at fault ("lights[2].color"), `message` a UTF-8 sentence. Both are valid
 * during the call only. Called on the thread that made the API call. */
typedef void (*PellucidMessageFn)(void* user, PellucidSeverity severity, const char* field,
                                  const char* message);

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

/* What the shaders evaluate. Filled by pellucidCompileMaterial (pellucid_material.h) from physical
 * coefficients or a preset, or by hand. Index order of arrays of 3: R, G, B. */
typedef struct PellucidMaterial {
  uint32_t structSize;        /* sizeof(PellucidMaterial) */
  uint32_t transmittanceModel; /* PellucidTransmittanceModel */
  float transmittance[3][5];  /* 1/mm for rates, 1 for amplitudes; see the model */
  float reflectance[3];       /* rho, semi-infinite diffuse reflectance, (0, 1] */
  uint32_t gaussianCount;     /* 1..PELLUCID_MAX_GAUSSIANS; 0: the material does not diffuse */
  float gaussianVariance[3][PELLUCID_MAX_GAUSSIANS]; /* mm^2, > 0, of one axis: w/(2 pi v) e^{-r^2/2v} */
  float gaussianWeight[3][PELLUCID_MAX_GAUSSIANS];   /* each channel sums to 1 */
  float radius[3];            /* mm; 99.9 % of the diffused energy lies within */
  float burleyDistance[3];    /* mm; d of Christensen & Burley 2015 eq. 3 that the Gaussians fit and the diffusion
                                 takes in their place, or 0 */
} PellucidMaterial;

/* ---- Frame ----------------------------------------------------------------------------------- */

/* An image the caller owns. The view must be 2D, one layer, one mip; the layout is the one the image
 * is in while the recorded commands run, GENERAL or a READ_ONLY one, and is never changed. A null view means "not given". */
typedef struct PellucidImage {
  VkImageView view;
  VkImageLayout layout;
} PellucidImage;

typedef enum PellucidDepthEncoding {
  PELLUCID_DEPTH_DEVICE = 0,  /* the 0..1 value of the matrix that rendered it; of the camera: other values, NaN, and distances
                                 of 1e9 and more: nothing there */
  PELLUCID_DEPTH_VIEW_Z = 1,  /* positive planar distance in front of the eye, scene units; <= 0,
                                 >= 1e9, inf or NaN: nothing there */
  PELLUCID_DEPTH_DISTANCE = 2 /* distance from the light, scene units (shadow maps only) */
} PellucidDepthEncoding;

typedef enum PellucidLightType {
  PELLUCID_LIGHT_DIRECTIONAL = 0,
  PELLUCID_LIGHT_POINT = 1,
  PELLUCID_LIGHT_SPOT = 2
} PellucidLightType;

/* Names and units of KHR_lights_punctual. */
typedef struct PellucidLight {
  uint32_t type;        /* PellucidLightType */
  float position[3];    /* world; point and spot */
  float direction[3];   /* world, direction of travel; directional and spot; any length > 0 */
  float color[3];       /* linear, >= 0 */
  float intensity;      /* directional: irradiance at normal incidence; else E = intensity cos/r^2,
                           r in scene units */
  float range;          /* scene units; 0: unlimited (window of KHR_lights_punctual) */
  float innerConeAngle; /* radians from the axis; spot; < outerConeAngle */
  float outerConeAngle; /* radians, (0, pi/2]; spot */
  uint32_t firstShadowMap, shadowMapCount; /* into frame.shadowMaps, 0..PELLUCID_MAX_LIGHT_SHADOW_MAPS; the first that contains the
                                              receiver is used: 6 for a cube, n for cascades. 0 maps:
                                              unshadowed, thickness from the camera's depths */
} PellucidLight;

typedef struct PellucidShadowMap {
  uint32_t image;        /* index into frame.shadowImages */
  uint32_t extent[2];    /* texels */
  uint32_t encoding;     /* PellucidDepthEncoding */
  float clipFromWorld[16];
  float viewFromWorld[16]; /* right-handed, -z forward; not read for PELLUCID_DEPTH_DEVICE, nor for
                              DISTANCE of point and spot lights */
  float bias;            /* scene units of thickness; nearer than this counts as the receiver itself */

  /* Two optional images of the map's extent say what lies behind the stored surface. Without them everything
   * between that surface and the receiver counts as the receiver's medium, air behind an occluder included.
   * Both are indices into frame.shadowImages plus 1; 0 (default): not given. */
  uint32_t exitImage; /* depth, in the map's encoding and matrices, of the nearest back face behind the stored
                         surface. Receivers beyond it are in shadow. A texel that holds nothing, or NaN: no back
                         face is known, and the medium goes on. Not read by PELLUCID_THICKNESS_CAMERA */
  uint32_t casterMaterialImage; /* one float channel: material of the stored surface, numbered as in
                                   frame.material without the mark bit; 0: opaque. Light enters receivers of that
                                   material only */
  float casterMaterialScale; /* the number is round(value * scale); >= 0; 0 (default): 255, for R8_UNORM; 1 for
                                formats that hold the number itself */
} PellucidShadowMap;

/* A fused dispatch binds 8 shadow images and takes 128 lights and 128 shadow maps; a frame with more gets several.
 * Exit depths and caster materials count; the images of one light must fit into one dispatch. Where those of all lights
 * are more than the dispatches of a plan can bind, all exit depths and caster materials are left out, which a skip says. */
enum { PELLUCID_MAX_LIGHT_SHADOW_MAPS = 8, PELLUCID_MAX_TRANSIENTS = 4 };

typedef enum PellucidFeatureBits {
  PELLUCID_FEATURE_TRANSLUCENCY = 1u << 0,
  PELLUCID_FEATURE_DIFFUSION = 1u << 1
} PellucidFeatureBits;

/* Where the thickness of a light with a shadow map comes from. Lights without one always use the
 * camera's front and back depth. */
typedef enum PellucidThicknessSource {
  PELLUCID_THICKNESS_LIGHT = 0, /* distance along the light ray from the shadow map's surface */
  PELLUCID_THICKNESS_CAMERA = 1 /* back depth minus front depth; the shadow map only occludes */
} PellucidThicknessSource;

/* What stands for the cosine of the light on the hidden face. x is the cosine between the view ray and
 * the direction to the light: 1 when the light is straight behind. Every factor is clamped to 0..1. */
typedef enum PellucidAngleModel {
  PELLUCID_ANGLE_NORMAL = 0,         /* -N.L, the hidden face taken antiparallel to N; COSINE where
                                        there is no normal */
  PELLUCID_ANGLE_COSINE = 1,         /* x (Whelan 2009, 4.2) */
  PELLUCID_ANGLE_INVERSE_COSINE = 2, /* 1 - acos(x) 2/pi (Whelan 2009, 4.4) */
  PELLUCID_ANGLE_POLYNOMIAL = 3,     /* c0 + c1 x + c2 x^2 + c3 x^3 for x > 0, else 0: the form of the
                                        quadratic and cubic of Whelan 2009, eqs. 4.4 and 4.5 */
  PELLUCID_ANGLE_MINIMUM_DOT = 4,    /* (m + x) / (m + 1), m = minimumDot (Whelan 2009, eq. 4.6) */
  PELLUCID_ANGLE_MINIMUM_DOT_AZIMUTH = 5, /* m per light from minimumDotTable by the light's azimuth around
                                             the object (Whelan 2009, 4.6.2) */
  PELLUCID_ANGLE_MINIMUM_DOT_SPHERE = 6   /* the same by the direction on the sphere */
} PellucidAngleModel;

/* Which frames compute the light that comes through and which take that of an earlier one: the part of a
 * post-process that Whelan 2009 saves by not rendering the depth maps. Irradiance and diffusion are always
 * the frame's own. One of the two: alternating would skip frames in which coherence asks for a refresh. */
typedef enum PellucidReuse {
  PELLUCID_REUSE_NONE = 0,
  PELLUCID_REUSE_ALTERNATE = 1, /* every second frame (Whelan 2009, 4.7.4) */
  PELLUCID_REUSE_COHERENCE = 2  /* until the cosine between the camera's axis and the direction to a light has
                                   changed by more than the threshold (Whelan 2009, 4.7.5) */
} PellucidReuse;

/* Write one intermediate into `output` instead of the result. Float values, alpha kept. */
typedef enum PellucidDebugView {
  PELLUCID_DEBUG_NONE = 0,
  PELLUCID_DEBUG_THICKNESS = 1,     /* mm: R camera-space chord, G light-space of the first light with
                                       a map that contains the pixel, B the one used by the first
                                       contributing light; -1: none */
  PELLUCID_DEBUG_TRANSMITTANCE = 2, /* transmitted / arriving, summed over lights; 0 where none */
  PELLUCID_DEBUG_OCCLUSION = 3,     /* fraction of the lights' back irradiance that the maps let by */
  PELLUCID_DEBUG_IRRADIANCE = 4     /* irradiance + transmitted/rho: what the diffusion reads */
} PellucidDebugView;

/* PellucidFrame::gatherSamples: frame.quality chooses. */
#define PELLUCID_GATHER_BY_QUALITY 0xFFFFFFFFu

typedef struct PellucidFrame {
  uint32_t structSize; /* sizeof(PellucidFrame), written by pellucidInitFrame */
  uint32_t features;   /* PellucidFeatureBits; default both */
  uint32_t imageExtent[2]; /* pixels of every screen-sized image */
  uint32_t renderRect[4];  /* x, y, width, height inside imageExtent; width 0: the whole image.
                              Nothing outside is read or written */
  float metersPerUnit;     /* default 1 */
  float clipFromView[16];  /* the projection that rendered the depths, jitter included */
  float viewFromWorld[16]; /* rigid; default identity */

  PellucidImage frontDepth; /* required; one float channel */
  PellucidImage backDepth;  /* nearest back face behind the front; without it there is no camera-space
                               thickness */
  PellucidImage irradiance; /* required; E, not divided by pi, not multiplied by albedo */
  PellucidImage normal;     /* outward unit vectors, components -1..1 */
  PellucidImage albedo;     /* multiplied after scattering */
  PellucidImage material;   /* required; unsigned integer, 0 none, i: materials[i - 1] */
  PellucidImage output;     /* required; storage image of outputFormat; may be the irradiance image.
                               Pixels of material 0 are not written; alpha is the irradiance's */
  PellucidImage transients[PELLUCID_MAX_TRANSIENTS]; /* as listed by pellucidGetImageNeeds */
  VkFormat outputFormat;    /* R16G16B16A16_SFLOAT (default), R32G32B32A32_SFLOAT or B10G11R11_UFLOAT_PACK32, which has no
                               alpha; see PellucidContextDesc::outputFormat. 32 bits keep alpha to the bit and colors up to
                               65504: to 1e-6 without diffusion, to 2^-10 with it, which works in halves */
  uint32_t frontDepthEncoding, backDepthEncoding; /* PELLUCID_DEPTH_DEVICE (default) or VIEW_Z */
  uint32_t normalsInViewSpace; /* 0: world (default) */

  uint32_t materialCount;   /* 1..255 */
  const PellucidMaterial* materials;
  uint32_t lightCount;      /* any number; 0: no translucency */
  const PellucidLight* lights;
  uint32_t shadowMapCount;
  const PellucidShadowMap* shadowMaps;
  uint32_t shadowImageCount; /* any number */
  const PellucidImage* shadowImages; /* depth or one float channel, one 2D view each */

  uint32_t thicknessSource; /* PellucidThicknessSource */
  uint32_t debugView;       /* PellucidDebugView */

  uint32_t angleModel;      /* PellucidAngleModel */
  float anglePolynomial[4]; /* c0..c3 of POLYNOMIAL */
  float minimumDot;         /* of MINIMUM_DOT and prescaleAngle: the cosine between the directions to the eye
                               and to the light above which nothing comes through, [-1, 0]; -1: nothing ever does */
  uint32_t constantViewDirection; /* 1: one view ray for all pixels, the camera's axis (Whelan 2009) */
  uint32_t chordThickness;  /* 1: camera-space thickness is the chord itself, without the cosine
                               between N and the view ray */
  float maximumThickness;   /* mm; thicker parts let nothing through; 0: no limit */
  float transmittanceFilter[3]; /* multiplies T, [0, 1]; default 1 (Whelan 2009, 4.5: .55 .29 .28) */
  uint32_t gatherSamples;   /* points of the shadow map that each point of gatherSpacing gathers light from, for lights
                               with a map: a multiple of 4, at most 64; needs materials of EXP2 or SINH_EXP.
                               0: one light-space thickness. PELLUCID_GATHER_BY_QUALITY (default): 0, 8 or 16 at
                               quality 0, 1 or 2; 0, which the plan's skips say, with a material of another
                               model, thickness from the camera, another angleModel than NORMAL, and with
                               constantViewDirection, minimumDot or maximumThickness */

  /* Minimum dots by the direction from the object to a light, each [-1, 0]. AZIMUTH: minimumDotTableSize
   * entries, 1..360 (Whelan: 36), at equal angles about upAxis, the first where the face looks and the next
   * towards cross(upAxis, faceVector); linear in between, around the turn. SPHERE: size x size entries, size
   * 3..16, rows first: the octahedral map x = s / l, y = f / l of the direction (s along cross(upAxis,
   * faceVector), u up, f along the face; l = |s| + |u| + |f|), corners folded under for u < 0, both
   * coordinates -1 at the first entry and 1 at the last; bilinear. Entries that share a direction on the
   * border should agree. Looked up once a light. */
  uint32_t minimumDotTableSize;
  const float* minimumDotTable;
  float faceVector[3];   /* world, not along upAxis; default +z */
  float upAxis[3];       /* world; default +y */
  float objectCenter[3]; /* world; where point and spot lights are seen from */
  uint32_t materialMarkBit; /* a power of two above materialCount, or 0: pixels whose material value has the
                               bit get diffusion and no translucency; the rest of the value is the index */

  uint32_t reuse;           /* PellucidReuse. Kept light is looked up at the same pixel: pass no previous plan
                               after a cut, and expect a lag of the frames in between where things move */
  float coherenceThreshold; /* of COHERENCE, >= 0; default .005 */
  float frameLoad;          /* frame time / its budget, >= 0: the threshold is multiplied by it where it is
                               above 1, so that frames that are late refresh less often; 0: not known */
  PellucidImage history;    /* with reuse; the persistent one of pellucidGetImageNeeds, GENERAL. Of the same
                               image in all frames; its content is the module's */

  uint32_t prescaleAngle;   /* 1: COSINE, INVERSE_COSINE and POLYNOMIAL take (m + x) / (m + 1), m = minimumDot,
                               in place of x, so that they begin at the minimum dot and still reach their
                               value at 1 (our reading of Whelan 2009's pre-scaling); 0 (default): x itself */

  uint32_t quality;       /* of the frame. 0: one thickness a pixel, and no filter of each pixel's neighbors; 1
                             (default): gathered light, and that filter; 2: twice the samples, at twice the points
                             along each side. gatherSamples and gatherSpacing override it */
  float targetError;      /* > 0: in place of the diffusion's quality, the least one whose measured error stays below it: relative
                             RMSE from brute force, the worst of several scenes, at the radii that the frame has;
                             the best and a skip if none does; 0 (default): off */
  float nearestDistance;  /* planar distance of the nearest surface that diffuses, scene units, or less: radii in
                             pixels follow from it, and where they are small levels are left out; surfaces that are
                             nearer still are then diffused too little. Orthographic cameras need none.
                             0 (default): not known, and radii count as being as large as the pyramid holds */
  uint32_t gatherSpacing;   /* pixels a side that one point gathers for: 1, 2 or 4; 0 (default): 4 in images of more
                               than 2^20 pixels, 2 in those of more than 2^19, else 1, and half of that at quality 2.
                               Each step costs a quarter of the one before. 4 asks for pixels well below a mean free
                               path */
  uint32_t separateOutput;  /* 1: the output shares no memory with the irradiance, which diffusion without a fused
                               dispatch before it (a gather, or no light) then reads itself and not a copy; 0
                               (default): it may be the same image */
  uint32_t indirectDispatches; /* 1: the constants' buffer has usage INDIRECT_BUFFER, too: of a gather's dispatches
                               those that the GPU finds nothing to do for are then empty. 0 (default): all run */
} PellucidFrame;

/* ---- Plan ------------------------------------------------------------------------------------ */

/* Images and buffers a dispatch binds, as bits for pellucidGetRequiredInputs and as names in plans.
 * Transients are PELLUCID_RESOURCE_TRANSIENT0 + index, shadow images SHADOW0 + index. */
typedef enum PellucidResource {
  PELLUCID_RESOURCE_FRONT_DEPTH = 0,
  PELLUCID_RESOURCE_BACK_DEPTH = 1,
  PELLUCID_RESOURCE_IRRADIANCE = 2,
  PELLUCID_RESOURCE_NORMAL = 3,
  PELLUCID_RESOURCE_ALBEDO = 4,
  PELLUCID_RESOURCE_MATERIAL = 5,
  PELLUCID_RESOURCE_OUTPUT = 6,
  PELLUCID_RESOURCE_CONSTANTS = 7, /* a range of the constants slice */
  PELLUCID_RESOURCE_TRANSIENT0 = 8,
  PELLUCID_RESOURCE_HISTORY = 12,
  PELLUCID_RESOURCE_SHADOW0 = 16
} PellucidResource;

enum {
  PELLUCID_MAX_DISPATCHES = 32,
  PELLUCID_MAX_BINDINGS = 24,
  PELLUCID_MAX_SKIPS = 16,
  PELLUCID_PUSH_CONSTANT_BYTES = 16
};

typedef struct PellucidBinding {
  uint32_t binding;            /* of set 0, the push-descriptor set */
  VkDescriptorType type;
  uint32_t resource;           /* PellucidResource */
  uint32_t level;              /* mip or pyramid level; 0 for a plain image */
  VkDeviceSize offset, size;   /* bytes in the constants slice; buffers only */
} PellucidBinding;

typedef struct PellucidDispatch {
  const char* name;             /* static string */
  uint32_t pipeline;            /* index below pellucidGetPipelineCount(); pellucidPipelineName() reads it */
  uint32_t groups[3];           /* workgroups; the most there may be when indirect */
  uint32_t indirect;            /* 1: VkDispatchIndirectCommand at indirectOffset of indirectResource, which earlier
                                   dispatches decide */
  uint32_t indirectResource;
  VkDeviceSize indirectOffset;
  uint32_t barrierBefore;       /* 1: a compute-to-compute memory barrier precedes the dispatch */
  uint32_t barrierIndirect;     /* 1: DRAW_INDIRECT / INDIRECT_COMMAND_READ waits for that barrier, too */
  uint32_t pushConstants[PELLUCID_PUSH_CONSTANT_BYTES / 4];
  uint32_t bindingCount;
  PellucidBinding bindings[PELLUCID_MAX_BINDINGS];
  uint64_t modeledBytes;        /* least device-memory traffic: each image read once, written once */
} PellucidDispatch;

typedef struct PellucidSkip {
  const char* what;   /* static string */
  const char* reason; /* static string */
  uint32_t count;     /* how many (lights, say) */
} PellucidSkip;

enum { PELLUCID_MAX_COHERENT_LIGHTS = 16 };

/* What frame.history holds after the plan has run; how the next plan decides. */
typedef struct PellucidHistory {
  uint32_t valid; /* 0: nothing */
  uint32_t age;   /* frames since it was written */
  VkFormat format;
  uint32_t extent[2], rect[4];
  uint32_t lightCount; /* above PELLUCID_MAX_COHERENT_LIGHTS, COHERENCE refreshes every frame */
  float lightDots[PELLUCID_MAX_COHERENT_LIGHTS]; /* camera axis and direction to the light, when written */
  uint32_t gatherSpacing; /* of the points of a gather; 0: it holds the light of pixels */
} PellucidHistory;

/* Parts of a frame that a plan is made from. A plan keeps a hash of each, and recording refuses a frame whose parts
 * differ, by name. */
typedef enum PellucidFact {
  PELLUCID_FACT_SIZE = 0,          /* imageExtent, renderRect */
  PELLUCID_FACT_CAMERA = 1,        /* metersPerUnit, clipFromView, viewFromWorld */
  PELLUCID_FACT_IMAGES = 2,        /* which optional images are given */
  PELLUCID_FACT_SETTINGS = 3,      /* all fields of other kinds */
  PELLUCID_FACT_MATERIALS = 4,
  PELLUCID_FACT_LIGHTS = 5,
  PELLUCID_FACT_SHADOW_MAPS = 6,
  PELLUCID_FACT_SHADOW_IMAGES = 7, /* their number */
  PELLUCID_FACT_COUNT = 8
} PellucidFact;

typedef struct PellucidPlan {
  uint32_t dispatchCount, barrierCount;
  uint32_t skipCount;
  uint32_t activeLights;      /* lights that can contribute; the others are in skips */
  VkDeviceSize constantsSize; /* bytes RecordPlan writes into the constants slice */
  PellucidDispatch dispatches[PELLUCID_MAX_DISPATCHES];
  PellucidSkip skips[PELLUCID_MAX_SKIPS];
  PellucidHistory history;
  float largestRadius; /* pixels within which 99.9 % of the diffused energy lies, of the widest channel of all
                          materials at frame.nearestDistance; 0: not known, or nothing diffuses */
  uint32_t quality;    /* that the diffusion runs at: frame.quality, or what frame.targetError chose; 0 where
                          nothing diffuses */
  uint32_t facts[PELLUCID_FACT_COUNT]; /* hashes of what the frame held, by PellucidFact */
} PellucidPlan;

/* One transient the caller creates: 2D, one mip, of this format and extent, usage SAMPLED | STORAGE. It holds
 * nothing between frames, so it may alias any memory not used during dispatches first..last. The extents hold for
 * every render rect. */
typedef struct PellucidImageNeed {
  VkFormat format;
  uint32_t extent[2];
  uint32_t firstDispatch, lastDispatch;
  uint64_t bytes;
  uint32_t persistent; /* 1: for frame.history and not a transient; keeps its content between frames */
} PellucidImageNeed;

/* ---- Context --------------------------------------------------------------------------------- */

typedef struct PellucidContext PellucidContext;

/* What frames ask of a context. A pipeline is made if all that it is for is asked for, and recording refuses a plan
 * that needs one of the others. */
typedef enum PellucidUse {
  PELLUCID_USE_TRANSLUCENCY = 1 << 0,    /* lights that are not gathered from, and frames without diffusion */
  PELLUCID_USE_GATHER = 1 << 1,          /* gathered light */
  PELLUCID_USE_DIFFUSION = 1 << 2,
  PELLUCID_USE_QUALITY_0 = 1 << 3,       /* besides qualities 1 and 2, which take the same pipelines */
  PELLUCID_USE_REUSE = 1 << 4,           /* frame.reuse without a gather */
  PELLUCID_USE_DEBUG_VIEWS = 1 << 5
} PellucidUse;

/* Calls job(data, i) for each i in 0..count - 1, on any threads and in any order, and returns when all have returned. */
typedef void (*PellucidParallelForFn)(void* user, uint32_t count, void (*job)(void* data, uint32_t index), void* data);

typedef struct PellucidContextDesc {
  uint32_t structSize;    /* sizeof(PellucidContextDesc), written by pellucidInitContextDesc */
  uint32_t headerVersion; /* PELLUCID_HEADER_VERSION, likewise */
  uint32_t apiVersion;    /* the VkApplicationInfo::apiVersion in use, >= VK_API_VERSION_1_1 */
  VkInstance instance;
  VkPhysicalDevice physicalDevice;
  VkDevice device;        /* VK_KHR_push_descriptor enabled */
  PFN_vkGetInstanceProcAddr getInstanceProcAddr;
  VkPipelineCache pipelineCache;          /* optional */
  const VkAllocationCallbacks* allocator; /* optional; host memory of Vulkan objects */
  PellucidMessageFn message;              /* optional */
  void* messageUser;
  uint32_t uses;            /* PellucidUse bits; 0 (default): all */
  VkFormat outputFormat;    /* of all frames: R16G16B16A16_SFLOAT (default) or R32G32B32A32_SFLOAT; UNDEFINED: any that
                               PellucidFrame::outputFormat lists, on a device with the feature
                               shaderStorageImageWriteWithoutFormat enabled */
  PellucidParallelForFn parallelFor; /* optional: lends threads to the creation of pipelines */
  void* parallelUser;
} PellucidContextDesc;

void pellucidInitContextDesc(PellucidContextDesc* desc);

/* Builds the pipelines of desc.uses. The context is immutable: any thread may use it. On failure *context is
 * NULL and the message callback has the sentence. */
PellucidResult pellucidCreateContext(const PellucidContextDesc* desc, PellucidContext** context);

/* The device must have finished with commands recorded through the context. NULL is allowed. */
void pellucidDestroyContext(PellucidContext* context);

/* ---- Planning: pure functions, no device, no allocation -------------------------------------- */

void pellucidInitFrame(PellucidFrame* frame);

/* Bit (1 << PellucidResource) of each screen-sized image that `features` cannot do without. */
uint32_t pellucidGetRequiredInputs(uint32_t features);

/* The transients of this frame in order, then with reuse the persistent image. Writes up to *count needs, sets
 * *count to the number there are; `needs` may be NULL. Views are not looked at: call it before creating them. */
PellucidResult pellucidGetImageNeeds(const PellucidFrame* frame, uint32_t* count,
                                     PellucidImageNeed* needs);

/* Checks every convention and the domains of all fields (docs/domains.md); calls `fn` for each finding. PELLUCID_OK unless one is
 * an error. PELLUCID_ERROR_CAPACITY exactly where pellucidBuildPlan returns it, too: more shadow images than a plan can bind. */
PellucidResult pellucidValidateFrame(const PellucidFrame* frame, PellucidMessageFn fn, void* user);

/* Same frame and previous plan, same plan. `previous` is the last recorded frame's plan or NULL; history
 * comes in here and nowhere else; see PellucidReuse. The plan keeps no pointer to the frame.
 * Of the views only whether the optional inputs are given is read. */
PellucidResult pellucidBuildPlan(const PellucidFrame* frame, const PellucidPlan* previous,
                                 PellucidPlan* plan);

/* ---- Frame budget ---------------------------------------------------------------------------- */

/* A setting that holds a frame time, and what it was decided from. `quality` is frame.quality, to which the
 * caller may add what else it can lower (resolution, lights, gatherSamples); `reuse` asks for reuse of results
 * between frames, frame.reuse. */
typedef struct PellucidBudgetState {
  uint32_t quality; /* 2 best .. 0 cheapest */
  uint32_t reuse;   /* 1: reuse; given up last when there is room again */
  uint32_t overFrames, underFrames;   /* on end above the budget; on end with room for more */
  uint32_t settleFrames;              /* times of the setting before that may still arrive */
  uint32_t waitFrames;                /* of room before a better setting is tried */
  uint32_t raised, heldFrames;        /* 1: the last change was upwards; frames since */
  float raisedMs;                     /* time before the last step upwards; 0: no step to compare with */
  uint32_t easierFrames;              /* on end well below raisedMs after that step failed */
} PellucidBudgetState;

void pellucidInitBudgetState(PellucidBudgetState* state); /* quality 2, no reuse */

/* One frame's time, ms, against the budget (Whelan 2009, 6.2.5). Pure. Goes one setting down (reuse first,
 * then quality) after 3 frames on end above the budget, so a setting that fits is reached within 20 frames;
 * one up after waitFrames at most 70 % of it. An upward step that does not hold doubles the wait, until
 * 30 frames on end take 70 % of the time from before it. Times that are negative or not finite, and
 * budgets that are not > 0, change nothing. A damaged state goes on from the nearest valid one. */
void pellucidStepBudget(PellucidBudgetState* state, float measuredMs, float budgetMs);

/* ---- Recording ------------------------------------------------------------------------------- */

/* Host-visible, host-coherent memory for one recording, usage STORAGE_BUFFER | UNIFORM_BUFFER, with
 * frame.indirectDispatches INDIRECT_BUFFER, too: then the device writes there what it decides, which
 * holds until the constants are written again. All passes read it, so it should be device-local, too,
 * where there is such memory: in the host's a frame of 3840 x 2160 takes 3 us longer on an NVIDIA H200. */
typedef struct PellucidConstantsSlice {
  VkBuffer buffer;
  VkDeviceSize offset; /* multiple of 256, the largest alignment Vulkan lets a device ask for */
  VkDeviceSize size;   /* >= plan.constantsSize */
  void* mapped;        /* address of `offset` */
} PellucidConstantsSlice;

/* Writes the slice and records every dispatch and the barriers between them. Before: the inputs
 * are readable by, and the output and transients free for, COMPUTE_SHADER. After: `output` was
 * written by COMPUTE_SHADER / SHADER_WRITE. Compute pipeline, push constants and set 0 are left
 * changed. `frame` is the one that made the plan, with its views filled in. One that differs in anything else, or
 * lacks an image of the plan's, is PELLUCID_ERROR_INVALID_ARGUMENT; the message names the part that differs. */
PellucidResult pellucidRecordPlan(const PellucidContext* context, VkCommandBuffer commandBuffer,
                                  const PellucidPlan* plan, const PellucidFrame* frame,
                                  const PellucidConstantsSlice* constants);

typedef struct PellucidSpecialization {
  uint32_t id, value; /* of 32 bits; booleans are 0 or 1 */
} PellucidSpecialization;

typedef struct PellucidShader {
  const uint32_t* words; /* SPIR-V; entry point "main", push constants PELLUCID_PUSH_CONSTANT_BYTES. Declares
                            StorageImageWriteWithoutFormat */
  size_t wordCount;
  uint32_t constantCount;
  const PellucidSpecialization* constants;
} PellucidShader;

/* For engines that record themselves: the constants RecordPlan would write, and what each pipeline is made of. */
PellucidResult pellucidWriteConstants(const PellucidPlan* plan, const PellucidFrame* frame,
                                      void* mapped, size_t size);
uint32_t pellucidGetPipelineCount(void);
PellucidResult pellucidGetShader(uint32_t pipeline, PellucidShader* shader);

/* ---- Text ------------------------------------------------------------------------------------ */

/* Zero-terminated JSON. *size is the room in `text` and becomes the bytes needed, terminator
 * included; `text` may be NULL to ask. */
PellucidResult pellucidPlanToJson(const PellucidPlan* plan, char* text, size_t* size);

const char* pellucidResultName(PellucidResult result);
const char* pellucidResourceName(uint32_t resource); /* "frontDepth", ... */
const char* pellucidPipelineName(uint32_t pipeline);

#ifdef __cplusplus
}
#endif
#endif
