/* The pipelines of one device. pellucid.h includes this header. */
#ifndef PELLUCID_CONTEXT_H
#define PELLUCID_CONTEXT_H

#include <stddef.h>
#include <stdint.h>
#include <vulkan/vulkan_core.h>

#include "pellucid_result.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The pipelines of one device. */
typedef struct PellucidContext PellucidContext;

/* Uses that frames ask of a context. A pipeline is made if all that it is for is asked for; recording refuses a plan that
 * needs one of the others. */
typedef enum PellucidUse {
  PELLUCID_USE_TRANSLUCENCY = 1 << 0, /* lights that are not gathered from, and thin walls */
  PELLUCID_USE_GATHER = 1 << 1,       /* gathered light */
  PELLUCID_USE_DIFFUSION = 1 << 2,    /* light that spreads under the surface */
  PELLUCID_USE_REUSE = 1 << 3,        /* frame.reuse without a gather */
  PELLUCID_USE_DEBUG_VIEWS = 1 << 4,  /* frame.debugView */
  /* Options that pipelines look for, unless the context's uses leave them out: */
  PELLUCID_USE_THIN_WALLS = 1 << 5, /* materials with thinWalled */
  PELLUCID_USE_AMBIENT = 1 << 6,    /* frame.ambient */
  PELLUCID_USE_THESIS = 1 << 7      /* thesis->angleModel other than NORMAL, and transmittance models but EXP2 and SINH_EXP */
} PellucidUse;

/* Calls job(data, i) for each i below count, on any threads and in any order, and returns when all have returned. */
typedef void (*PellucidParallelForFn)(void* user, uint32_t count, void (*job)(void* data, uint32_t index), void* data);

/* How the normal image holds a vector n, of world space or of view space by frame.normalsInViewSpace. */
typedef enum PellucidNormalEncoding {
  PELLUCID_NORMALS_SNORM = 0,            /* n in RGB, -1..1: SNORM and float formats; (0, 0, 0): none at this pixel */
  PELLUCID_NORMALS_UNORM = 1,            /* (n + 1) / 2 in RGB, 0..1; (0, 0, 0), which is none of them: none */
  PELLUCID_NORMALS_OCTAHEDRAL = 2,       /* "oct" of Cigolle et al. 2014 in RG, -1..1: n / (|x| + |y| + |z|), whose lower
                                            half, z < 0, is folded over the corners; cannot say none */
  PELLUCID_NORMALS_OCTAHEDRAL_UNORM = 3  /* (that + 1) / 2 in RG, 0..1 */
} PellucidNormalEncoding;

/* Description of a context. */
typedef struct PellucidContextDesc {
  uint32_t structSize;    /* sizeof(PellucidContextDesc), written by pellucidInitContextDesc */
  uint32_t headerVersion; /* PELLUCID_HEADER_VERSION, likewise */
  uint32_t apiVersion;    /* the VkApplicationInfo::apiVersion in use, >= VK_API_VERSION_1_1 */
  VkInstance instance;    /* of the device */
  VkPhysicalDevice physicalDevice; /* of the device */
  VkDevice device;        /* VK_KHR_push_descriptor enabled, or pushDescriptor of Vulkan 1.4, or else descriptorPools below */
  PFN_vkGetInstanceProcAddr getInstanceProcAddr; /* from which all other functions come */
  /* ---- fields that may be missing ---- */
  VkPipelineCache pipelineCache;          /* optional */
  const VkAllocationCallbacks* allocator; /* optional; host memory of Vulkan objects */
  PellucidMessageFn message;              /* optional */
  void* messageUser;                      /* passed to message */
  uint32_t uses;                          /* PellucidUse bits; 0 (default): all */
  VkFormat outputFormat; /* of all frames: R16G16B16A16_SFLOAT (default) or R32G32B32A32_SFLOAT; UNDEFINED: any, on a device
                            with shaderStorageImageWriteWithoutFormat enabled */
  PellucidParallelForFn parallelFor; /* optional: lends threads to the creation of pipelines; the allocator's and the
                                        cache's functions are called on them */
  void* parallelUser;                /* passed to parallelFor */
  VkImageViewType shadowViewType; /* of all shadow images of all frames: 2D (default), or 2D_ARRAY, of which one view of all
                                     layers serves every map in them; each frame then has a shadow image, maps or not */
  uint32_t normalEncoding;        /* PellucidNormalEncoding of all frames; default SNORM. A specialization constant. Unused by
                                     a library built with PELLUCID_GBUFFER_DECODE, whose file decodes */
  uint32_t lightTables;           /* 1: frames may have light tables, which pipelines without them need not look for; 0
                                     (default): none has. A specialization constant */
  uint32_t deferPipelines;        /* 1: creation makes no pipelines, pellucidCreatePipelines makes those of a plan; 0 (default):
                                     creation makes all of `uses` */
  uint32_t descriptorPools;       /* 1: each frame brings a pool that its descriptors come from, for devices that cannot push them;
                                     0 (default): they are pushed */
  uint32_t reserved;              /* 0 */
} PellucidContextDesc;

/* The defaults, written into a struct of that many bytes; pellucidInit* without it have the header's size. */
PELLUCID_API void pellucidInitContextDescSized(PellucidContextDesc* desc, size_t structSize);
/* The defaults. */
static inline void pellucidInitContextDesc(PellucidContextDesc* d) { pellucidInitContextDescSized(d, sizeof *d); }

/* Checks the device's limits and builds the pipelines of desc.uses. The context is immutable but for pellucidCreatePipelines: any thread may use it. On
 * failure *context is NULL and the message callback has the sentence. */
PELLUCID_API PellucidResult pellucidCreateContext(const PellucidContextDesc* desc, PellucidContext** context);

/* Makes a frame.descriptorPool, with room for any plan's recording. vkDestroyDescriptorPool with desc.allocator destroys it. On
 * failure *pool is NULL and the message callback has the sentence. */
PELLUCID_API PellucidResult pellucidCreateDescriptorPool(const PellucidContext* context, VkDescriptorPool* pool);

/* The device must have finished with commands recorded through the context. NULL is allowed. */
PELLUCID_API void pellucidDestroyContext(PellucidContext* context);

#ifdef __cplusplus
}
#endif
#endif
