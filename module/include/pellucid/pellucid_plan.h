/* Contents of a plan, for engines that record plans themselves, and its text.
 *
 * A plan is plain data without pointers but to static strings: it may be copied, and it outlives the frame
 * that it was made from. pellucid.h includes this header, so that callers of pellucidRecordPlan can have plans
 * on their stacks; they need not read it.
 */
#ifndef PELLUCID_PLAN_H
#define PELLUCID_PLAN_H

#include "pellucid.h"

#ifdef __cplusplus
extern "C" {
#endif

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
  PELLUCID_RESOURCE_HISTORY = 16,
  PELLUCID_RESOURCE_HIDDEN_IRRADIANCE = 17,
  PELLUCID_RESOURCE_MOTION = 18,
  PELLUCID_RESOURCE_SHADOW0 = 19
} PellucidResource;

enum {
  PELLUCID_MAX_DISPATCHES = 32,
  PELLUCID_MAX_BINDINGS = 24,
  PELLUCID_MAX_SKIPS = 16,
  PELLUCID_PUSH_CONSTANT_BYTES = 16,
  PELLUCID_PLAN_SLOTS = 13,
  PELLUCID_PLAN_SHADOW_IMAGES = 256,
  PELLUCID_PLAN_STATE_WORDS = 48
};

/* One binding of a dispatch, by pellucidGetBindings. */
typedef struct PellucidBinding {
  uint32_t binding;            /* of set 0; pellucidBindingName() reads it. A number is one binding in all pipelines */
  VkDescriptorType type;       /* of the binding */
  uint32_t resource;           /* PellucidResource */
  VkDeviceSize offset, size;   /* bytes in the constants slice; buffers only */
} PellucidBinding;

/* One dispatch of a plan. */
typedef struct PellucidDispatch {
  const char* name;             /* static string */
  uint32_t groups[3];           /* workgroups; the most there may be when indirect */
  uint32_t pushConstants[PELLUCID_PUSH_CONSTANT_BYTES / 4]; /* from offset 0 on */
  uint32_t indirectOffset;      /* bytes from the slice's offset */
  uint8_t pipeline;             /* index below pellucidGetPipelineCount(); pellucidPipelineName() reads it */
  uint8_t indirect;             /* 1: VkDispatchIndirectCommand at indirectOffset of the constants slice, which earlier
                                   dispatches decide */
  uint8_t barrierBefore;        /* 1: a compute-to-compute memory barrier precedes the dispatch */
  uint8_t barrierIndirect;      /* 1: DRAW_INDIRECT / INDIRECT_COMMAND_READ waits for that barrier, too */
  uint16_t slots[PELLUCID_PLAN_SLOTS]; /* what it binds, for pellucidGetBindings */
  uint8_t firstShadowImage, shadowImageCount;  /* of plan.shadowImages, for pellucidGetBindings */
} PellucidDispatch;

/* Something that a plan leaves out. */
typedef struct PellucidSkip {
  const char* what;   /* static string */
  const char* reason; /* static string */
  uint32_t count;     /* how many (lights, say) */
} PellucidSkip;

/* At most 4096 bytes. */
struct PellucidPlan {
  uint32_t dispatchCount, barrierCount; /* of dispatches, and how many have a barrier before */
  uint32_t skipCount;         /* of skips */
  uint32_t activeLights;      /* lights that can contribute; the others are in skips */
  VkDeviceSize constantsSize; /* bytes pellucidWriteConstants writes */
  PellucidDispatch dispatches[PELLUCID_MAX_DISPATCHES]; /* in order */
  PellucidSkip skips[PELLUCID_MAX_SKIPS]; /* what is left out, and why */
  float largestRadius; /* pixels within which 99.9 % of the diffused energy lies, of the widest channel of all
                          materials at options.nearestDistance; 0: not known, or nothing diffuses */
  uint32_t gatherSamples; /* of each probe: options.gatherSamples; 0: lights with a shadow map
                             have one thickness a pixel */
  uint32_t historyAge;    /* frames since options.history was written (ACCUMULATE: begun), by the last one that computed light that
                             comes through; 0: this frame computes it */
  uint32_t shadowImages[PELLUCID_PLAN_SHADOW_IMAGES]; /* that dispatches bind, for pellucidGetBindings */
  uint32_t state[PELLUCID_PLAN_STATE_WORDS]; /* not for callers: how the next plan decides about reuse, and what recording asks of a
                                                context */
};

/* What a dispatch binds, in the order of binding numbers: writes at most PELLUCID_MAX_BINDINGS, returns how many. 0 for a
 * dispatch that the plan does not have. */
PELLUCID_API uint32_t pellucidGetBindings(const PellucidPlan* plan, uint32_t dispatch, PellucidBinding* bindings);

/* Makes those pipelines that the plan dispatches and a context with options.deferPipelines lacks, of those of options.uses: for tools,
 * which render few frames. options.pipelineCache and parallelFor must be alive still. No other thread uses the context at the
 * same time. On failure the message callback has the sentence, and pipelines made so far stay. */
PELLUCID_API PellucidResult pellucidCreatePipelines(PellucidContext* context, const PellucidPlan* plan);

/* Makes an options.descriptorPool of a frame, with room for any plan's recording. vkDestroyDescriptorPool with options.allocator
 * destroys it. On failure *pool is NULL and the message callback has the sentence. */
PELLUCID_API PellucidResult pellucidCreateDescriptorPool(const PellucidContext* context, VkDescriptorPool* pool);

/* One specialization constant. */
typedef struct PellucidSpecialization {
  uint32_t id, value; /* of 32 bits; booleans are 0 or 1 */
} PellucidSpecialization;

/* Description of a pipeline. */
typedef struct PellucidShader {
  const uint32_t* words; /* SPIR-V; entry point "main", push constants PELLUCID_PUSH_CONSTANT_BYTES. Declares
                            StorageImageWriteWithoutFormat */
  size_t wordCount;      /* of words */
  uint32_t constantCount; /* of constants */
  const PellucidSpecialization* constants; /* of the pipeline */
} PellucidShader;

/* Ids of the specialization constants of all shaders that hold PellucidContextOptions::normalEncoding, lightTables, and uses with all
 * bits in place of 0. They are not among PellucidShader::constants. */
enum { PELLUCID_SPECIALIZATION_NORMALS = 4, PELLUCID_SPECIALIZATION_LIGHT_TABLES = 5, PELLUCID_SPECIALIZATION_USES = 6 };

/* What each pipeline is made of; shadowViewType as in PellucidContextOptions. */
PELLUCID_API uint32_t pellucidGetPipelineCount(void); /* pipelines have the indices below it */
PELLUCID_API PellucidResult pellucidGetShader(uint32_t pipeline, VkImageViewType shadowViewType,
                                              PellucidShader* shader); /* INVALID_ARGUMENT: no such pipeline or type */

/* Bit (1 << PellucidResource) of each screen-sized image that `features` cannot do without. */
PELLUCID_API uint32_t pellucidGetRequiredInputs(uint32_t features);

/* Zero-terminated JSON. *size is the room in `text` and becomes the bytes needed, terminator
 * included; `text` may be NULL to ask. */
PELLUCID_API PellucidResult pellucidPlanToJson(const PellucidPlan* plan, char* text, size_t* size);

PELLUCID_API const char* pellucidResourceName(uint32_t resource); /* "frontDepth", ... */
PELLUCID_API const char* pellucidPipelineName(uint32_t pipeline); /* "unknown pipeline" beyond the last */
PELLUCID_API const char* pellucidBindingName(uint32_t binding); /* as in the shaders' sources, "frontDepthImage"; "unknown binding" */

#ifdef __cplusplus
}
#endif
#endif
