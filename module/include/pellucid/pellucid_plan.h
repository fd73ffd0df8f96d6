/* Fields of a plan, for engines that record plans themselves. docs/integration.md, "Through an RHI", has the calls that replace
 * pellucidRecordPlan.
 *
 * A plan is plain data with pointers to static strings alone. A copy of a plan is a valid plan. A plan outlives its
 * frame. pellucid.h includes pellucid_plan.h, because a caller's plan needs a complete type.
 */
#ifndef PELLUCID_PLAN_H
#define PELLUCID_PLAN_H

#include "pellucid.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Images and buffers that a dispatch binds. Transient i is PELLUCID_RESOURCE_TRANSIENT0 + i, and shadow image i is
 * PELLUCID_RESOURCE_SHADOW0 + i. */
typedef enum PellucidResource {
  PELLUCID_RESOURCE_FRONT_DEPTH = 0,
  PELLUCID_RESOURCE_BACK_DEPTH = 1,
  PELLUCID_RESOURCE_IRRADIANCE = 2,
  PELLUCID_RESOURCE_ALBEDO = 3,
  PELLUCID_RESOURCE_MATERIAL = 4,
  PELLUCID_RESOURCE_OUTPUT = 5,
  PELLUCID_RESOURCE_CONSTANTS = 6, /* a range of the constants slice */
  PELLUCID_RESOURCE_TRANSIENT0 = 7,
  PELLUCID_RESOURCE_HISTORY = 15,
  PELLUCID_RESOURCE_HIDDEN_IRRADIANCE = 16,
  PELLUCID_RESOURCE_MOTION = 17,
  PELLUCID_RESOURCE_SHADOW0 = 32 /* numbers in between are for further images */
} PellucidResource;

/* Limits of plans and dispatches. */
enum {
  PELLUCID_MAX_DISPATCHES = 32,
  PELLUCID_MAX_BINDINGS = 24,       /* bindings of a dispatch or pipeline */
  PELLUCID_MAX_BINDING_NUMBER = 39, /* the largest PellucidBinding::binding */
  PELLUCID_MAX_SKIPS = 16,
  PELLUCID_PUSH_CONSTANT_BYTES = 16,
  PELLUCID_PLAN_SLOTS = 13,
  PELLUCID_PLAN_SHADOW_IMAGES = 256,
  PELLUCID_PLAN_STATE_WORDS = 48
};

/* One binding of a dispatch, by pellucidGetBindings, or of a pipeline, by pellucidGetPipelineBindings. */
typedef struct PellucidBinding {
  /* Number in set 0, 0..PELLUCID_MAX_BINDING_NUMBER, the same in all pipelines. pellucidBindingName names it. */
  uint32_t binding;
  /* Type of the descriptor. */
  VkDescriptorType type;
  /* 1: the pipeline writes the resource, and may read it, too. 0: the pipeline only reads it. A storage image or buffer may have 0. */
  uint32_t writes;
  /* PellucidResource; 0 for a pipeline. */
  uint32_t resource;
  /* Bytes: the range of the constants slice. The offset is a multiple of 256, and so is the size of a uniform buffer, at most 16384. The
   * range ends inside plan.constantsSize. Images and pipelines have 0. */
  VkDeviceSize offset, size;
} PellucidBinding;

/* One dispatch of a plan. */
typedef struct PellucidDispatch {
  /* Static string. */
  const char* name;
  /* Workgroups; with `indirect` the largest possible numbers. */
  uint32_t groups[3];
  /* Push constants from offset 0 on. */
  uint32_t pushConstants[PELLUCID_PUSH_CONSTANT_BYTES / 4];
  /* Bytes from the slice's offset to five 32-bit words. The first three are the VkDispatchIndirectCommand. After the frame, word 4 has
   * the x of the workgroups that ran. Words 1 and 2 have their y and z. Word 0 is 0 again. A host that reads the words needs a barrier
   * from PELLUCID_STAGES / PELLUCID_WRITES to HOST / HOST_READ. The host reads after the submission's fence and before the next
   * pellucidWriteConstants into the slice. */
  uint32_t indirectOffset;
  /* Index below pellucidGetPipelineCount(). pellucidPipelineName names it. */
  uint8_t pipeline;
  /* 1: the VkDispatchIndirectCommand at indirectOffset has the workgroups. Earlier dispatches write it. */
  uint8_t indirect;
  /* 1: a compute-to-compute memory barrier precedes the dispatch. */
  uint8_t barrierBefore;
  /* 1: this barrier also includes DRAW_INDIRECT / INDIRECT_COMMAND_READ as destination. */
  uint8_t barrierIndirect;
  /* Private; pellucidGetBindings reads the slots. */
  uint16_t slots[PELLUCID_PLAN_SLOTS];
  /* Range of plan.shadowImages. Private; pellucidGetBindings reads it. */
  uint8_t firstShadowImage, shadowImageCount;
} PellucidDispatch;

/* Something that a plan leaves out. */
typedef struct PellucidSkip {
  /* Name of the part, a static string. */
  const char* what;
  /* Static string. */
  const char* reason;
  /* Number of parts left out, as the number of lights. */
  uint32_t count;
} PellucidSkip;

/* A plan, at most 4096 bytes. */
struct PellucidPlan {
  /* Dispatches, and the number of dispatches with barrierBefore 1. */
  uint32_t dispatchCount, barrierCount;
  /* Number of skips. */
  uint32_t skipCount;
  /* Lights that can contribute. Skips list the other lights. */
  uint32_t activeLights;
  /* Bytes that pellucidWriteConstants writes, a multiple of 256. */
  VkDeviceSize constantsSize;
  /* Bytes from the slice's offset to the lists, a multiple of 256; constantsSize in plans without lists. Dispatches write only the bytes
   * from here to constantsSize, which also hold all indirectOffset. These bytes may lie in another buffer of usage STORAGE_BUFFER |
   * INDIRECT_BUFFER. There, PellucidBinding::offset of the storage buffer with writes 1, and indirectOffset, are less by listsOffset. */
  VkDeviceSize listsOffset;
  /* dispatchCount dispatches, in the order of recording. */
  PellucidDispatch dispatches[PELLUCID_MAX_DISPATCHES];
  /* skipCount skips. */
  PellucidSkip skips[PELLUCID_MAX_SKIPS];
  /* Samples of each probe. 0: lights with a shadow map have one thickness a pixel. */
  uint32_t gatherSamples;
  /* Age of options.history in frames. ALTERNATE, COHERENCE: frames since a frame computed the light that comes through; 0: this frame
   * computes it. ACCUMULATE: frames since accumulation began. */
  uint32_t historyAge;
  /* Number of dispatches that sample and store one image, for which Vulkan's layout GENERAL serves. APIs with one state an image cannot run
   * them. Output and irradiance count as one image unless they have two views. Above 0 only with one of the following:
   * - options.addToOutput 1;
   * - an output that is the irradiance, in plans that do not diffuse, and in debug views;
   * - options.reuse ALTERNATE or COHERENCE of light that one dispatch cannot bind, without a gather. */
  uint32_t inPlaceDispatches;
  /* Private; pellucidGetBindings reads the images. */
  uint32_t shadowImages[PELLUCID_PLAN_SHADOW_IMAGES];
  /* Private: data by which the next plan decides about reuse, and the requirements of recording. */
  uint32_t state[PELLUCID_PLAN_STATE_WORDS];
};

/* Writes the bindings of dispatch number `dispatch`, in the order of binding numbers, at most PELLUCID_MAX_BINDINGS. Returns their
 * number. 0: the plan has no such dispatch. */
PELLUCID_API uint32_t pellucidGetBindings(const PellucidPlan* plan, uint32_t dispatch, PellucidBinding* bindings);

/* The frame's image of a PellucidResource, with or without a view. NULL: the frame has no such image, or the resource is no image. */
PELLUCID_API const PellucidImage* pellucidGetImage(const PellucidFrame* frame, uint32_t resource);

/* Makes a pool for PellucidFrameOptions::descriptorPool, with room for the recording of any plan. The caller destroys the pool by
 * vkDestroyDescriptorPool with the context's options.allocator. On failure *pool is NULL, and the context's `message` gets a sentence.
 * Errors: INVALID_ARGUMENT, OUT_OF_MEMORY, VULKAN. */
PELLUCID_API PellucidResult pellucidCreateDescriptorPool(const PellucidContext* context, VkDescriptorPool* pool);

/* One specialization constant. */
typedef struct PellucidSpecialization {
  /* constant_id of the shader, and the constant's 32 bits. Booleans are 0 or 1. */
  uint32_t id, value;
} PellucidSpecialization;

/* The shader of a pipeline. */
typedef struct PellucidShader {
  /* SPIR-V with entry point "main" and PELLUCID_PUSH_CONSTANT_BYTES of push constants. */
  const uint32_t* words;
  /* Number of words. */
  size_t wordCount;
  /* Number of constants. */
  uint32_t constantCount;
  /* Specialization constants of the pipeline. */
  const PellucidSpecialization* constants;
  /* PellucidUse bits of frames for which plans have the pipeline. An engine without one of these uses does not need the pipeline. */
  uint32_t uses;
} PellucidShader;

/* Ids of specialization constants that depend on the context. PellucidShader::constants does not contain them. Pipelines that lack an id
 * ignore it. */
enum {
  /* PellucidContextOptions::lightTables, a boolean. Default in the SPIR-V: 0. */
  PELLUCID_SPECIALIZATION_LIGHT_TABLES = 5,
  /* PellucidContextOptions::uses, where all bits stand for `uses` 0. Default in the SPIR-V: all bits. */
  PELLUCID_SPECIALIZATION_USES = 6
};

/* Number of pipelines. A pipeline has an index below this number. */
PELLUCID_API uint32_t pellucidGetPipelineCount(void);
/* Writes the bindings of a pipeline, in the order of binding numbers, at most PELLUCID_MAX_BINDINGS. Returns their number. Every dispatch
 * of the pipeline has these binding numbers, types and `writes`. 0: there is no such pipeline, or `bindings` is NULL. */
PELLUCID_API uint32_t pellucidGetPipelineBindings(uint32_t pipeline, PellucidBinding* bindings);
/* Writes the shader of a pipeline. shadowViewType and outputFormat are those of PellucidContextOptions.
 * - UNDEFINED: shader->words are the library's, and declare StorageImageWriteWithoutFormat. `words` may be NULL.
 * - Other formats: the function writes the words of this format to `words`, and shader->words becomes `words`. The caller has room for
 *   shader->wordCount words. `words` may be NULL to get the other fields of the shader.
 * Errors: INVALID_ARGUMENT for an unknown pipeline, type or format. */
PELLUCID_API PellucidResult pellucidGetShader(uint32_t pipeline, VkImageViewType shadowViewType, VkFormat outputFormat, uint32_t* words,
                                              PellucidShader* shader);

/* Name of a PellucidResource: "frontDepth", ... or "unknown resource". */
PELLUCID_API const char* pellucidResourceName(uint32_t resource);
/* Name of a pipeline, or "unknown pipeline". */
PELLUCID_API const char* pellucidPipelineName(uint32_t pipeline);
/* Name of a binding in the shaders' sources: "frontDepthImage", ... or "unknown binding". */
PELLUCID_API const char* pellucidBindingName(uint32_t binding);

#ifdef __cplusplus
}
#endif
#endif
