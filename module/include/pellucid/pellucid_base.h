/* Results, messages and images, which all headers share. pellucid.h includes this header. */
#ifndef PELLUCID_BASE_H
#define PELLUCID_BASE_H

#include <stddef.h>
#include <stdint.h>
#include <vulkan/vulkan_core.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Marks functions that a shared library exports. On Windows a program that links the shared library defines PELLUCID_SHARED. CMake's
 * pellucid::pellucid defines it for its users. */
#if defined(_WIN32) && defined(PELLUCID_SHARED)
#ifdef PELLUCID_EXPORTS /* the library itself */
#define PELLUCID_API __declspec(dllexport)
#else
#define PELLUCID_API __declspec(dllimport)
#endif
#elif defined(__GNUC__)
#define PELLUCID_API __attribute__((visibility("default")))
#else
#define PELLUCID_API
#endif

/* The result of a function: one of the PELLUCID_OK and PELLUCID_ERROR_ values. */
typedef int32_t PellucidResult;
enum {
  PELLUCID_OK = 0,                      /* the call did all its work */
  PELLUCID_ERROR_INVALID_ARGUMENT = -1, /* a field is wrong; the message names it */
  PELLUCID_ERROR_VERSION = -2,          /* headers of another version made the description of the context */
  PELLUCID_ERROR_MISSING_FEATURE = -3,  /* the device lacks a function, feature or limit; the message names it */
  PELLUCID_ERROR_OUT_OF_MEMORY = -4,    /* host or device memory is exhausted */
  PELLUCID_ERROR_VULKAN = -5,        /* a Vulkan call failed; the message has the VkResult */
  PELLUCID_ERROR_CAPACITY = -6,      /* the frame needs more dispatches or shadow images than a plan holds */
  PELLUCID_ERROR_BUFFER_TOO_SMALL = -7 /* a constants slice is too short */
};

/* Severity of a message. An error stops a frame. */
typedef enum PellucidSeverity { PELLUCID_SEVERITY_WARNING = 0, PELLUCID_SEVERITY_ERROR = 1 } PellucidSeverity;

/* Takes a message. `field` is the API field at fault ("lights[2].color"). `message` is a UTF-8 sentence. Both texts are valid
 * during the call only. The thread that made the API call runs the function. */
typedef void (*PellucidMessageFn)(void* user, PellucidSeverity severity, const char* field, const char* message);

/* An image of the caller: 2D, with one mip and one layer. A view of shadow images may have all layers
 * (PellucidContextOptions::shadowViewType). */
typedef struct PellucidImage {
  /* Null (default): the caller gives no image. */
  VkImageView view;
  /* The image's layout while the recorded commands run: GENERAL, or a READ_ONLY layout of an image that is only read. The commands do
   * not change the layout. */
  VkImageLayout layout;
} PellucidImage;

/* Name of a result: "PELLUCID_OK", ... */
PELLUCID_API const char* pellucidResultName(PellucidResult result);

#ifdef __cplusplus
}
#endif
#endif
