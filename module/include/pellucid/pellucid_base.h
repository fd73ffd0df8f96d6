/* What all headers share: results, messages, images. pellucid.h includes this header. */
#ifndef PELLUCID_BASE_H
#define PELLUCID_BASE_H

#include <stddef.h>
#include <stdint.h>
#include <vulkan/vulkan_core.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Functions that a shared library exports. Whoever links one on Windows defines PELLUCID_SHARED, as its CMake target does. */
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

/* One of the values below. */
typedef int32_t PellucidResult;
enum {
  PELLUCID_OK = 0,                      /* all is done */
  PELLUCID_ERROR_INVALID_ARGUMENT = -1, /* a field is wrong; the message names it */
  PELLUCID_ERROR_VERSION = -2,          /* structSize or headerVersion that this library cannot take */
  PELLUCID_ERROR_MISSING_FEATURE = -3,  /* the device lacks a function, feature or limit; the message names it */
  PELLUCID_ERROR_OUT_OF_MEMORY = -4,    /* of the host or the device */
  PELLUCID_ERROR_VULKAN = -5,        /* a Vulkan call failed; the message has the VkResult */
  PELLUCID_ERROR_CAPACITY = -6,      /* more dispatches or shadow images than a plan holds */
  PELLUCID_ERROR_BUFFER_TOO_SMALL = -7 /* constants slice or text buffer shorter than needed */
};

/* Severity of a finding; an error stops a frame. */
typedef enum PellucidSeverity { PELLUCID_SEVERITY_WARNING = 0, PELLUCID_SEVERITY_ERROR = 1 } PellucidSeverity;

/* `field` is the API field at fault ("lights[2].color"), `message` a UTF-8 sentence. Both are valid
 * during the call only. Called on the thread that made the API call. */
typedef void (*PellucidMessageFn)(void* user, PellucidSeverity severity, const char* field, const char* message);

/* An image of the caller: 2D, one mip, one layer, or all layers of shadow images by PellucidContextOptions::shadowViewType. It is in
 * `layout` while the recorded commands run, which never change that layout: GENERAL, or a READ_ONLY one of images that are only read. */
typedef struct PellucidImage {
  /* A null handle (default): not given. */
  VkImageView view;
  VkImageLayout layout;
} PellucidImage;

PELLUCID_API const char* pellucidResultName(PellucidResult result); /* "PELLUCID_OK", ... */

#ifdef __cplusplus
}
#endif
#endif
