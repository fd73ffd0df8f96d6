/* A light's shadow map as the caller's engine drew it. pellucid.h includes this header.
 *
 * docs/integration.md, "Shadow maps as engines draw them", says which field an engine's habit asks for. */
#ifndef PELLUCID_SHADOW_MAP_H
#define PELLUCID_SHADOW_MAP_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Faces that a map holds the nearest ones of. */
typedef enum PellucidMapFaces {
  PELLUCID_FACES_FRONT = 0, /* light enters by them: drawn with back faces culled, or nothing */
  PELLUCID_FACES_BACK = 1   /* light leaves by them: drawn with front faces culled. Such a map does not know where light
                               enters. Its light has the camera's thickness, is not gathered, and needs
                               frame.backDepth; what lies beyond the stored face is in shadow. All maps of one light hold
                               the same faces */
} PellucidMapFaces;

/* Fields that are not a place have 0 as their default. */
typedef struct PellucidShadowMap {
  uint32_t image;        /* index into frame.shadowImages */
  uint32_t offset[2];    /* texels, 0..65535: first texel of the map's tile in the image (an atlas); default 0, 0 */
  uint32_t extent[2];    /* texels, 1..65536: size of the tile, beyond which nothing is read. offset + extent <= 65536 */
  uint32_t layer;        /* array layer, 0..65535; above 0 only with PellucidContextDesc::shadowViewType 2D_ARRAY */
  uint32_t encoding;     /* PellucidDepthEncoding */
  uint32_t faces;        /* PellucidMapFaces; default FRONT */
  float clipFromWorld[16]; /* clip -1..1 is the tile */
  float viewFromWorld[16]; /* right-handed, -z forward; not read for DEVICE, nor for DISTANCE of point and spot lights */

  /* How far the stored depths lie from the surface. Each is subtracted again before a depth is used. Depth biases have
   * the sign with which they were added, so that those of reversed depths are negative. */
  float depthBiasConstant; /* in units of the stored depth, -1e15..1e15. VIEW_Z and DISTANCE: scene units. DEVICE: the
                              constant factor of vkCmdSetDepthBias times 1.53e-5 (2^-16) for D16, 5.96e-8 (2^-24) for
                              D24, and 2^(e - 23) for D32, where 2^e <= the triangle's largest depth: 5.96e-8 from .5 on */
  float depthBiasSlope;    /* slope factor of vkCmdSetDepthBias, -1e6..1e6: times the larger of the changes of the stored
                              depth per texel along x and y, which is taken from the nearer of the tile's neighbors */
  float offsetLength;      /* scene units along the light's ray, 0..1e15, by which the stored surface lies farther from the
                              light: an offset of the drawn vertices, or one that a shader added to the depth */
  float depthStep;         /* smallest difference of stored depths, 0..1e15: 1/65535 for D16, 2^-24 for D24. Tolerances
                              allow for it. 0: as fine as floats */

  /* Two optional images of the image's size say what lies behind the stored surface, with the map's offset, extent and
   * layer. Without them everything between that surface and the receiver counts as the receiver's medium, air behind an
   * occluder included. Both are indices into frame.shadowImages plus 1; 0 (default): not given. */
  uint32_t exitImage; /* depth, in the map's encoding and matrices and without its biases, of the nearest back face
                         behind the stored surface. Receivers beyond it are in shadow. A texel that holds nothing, or NaN:
                         no back face is known, and the medium goes on. Not read by PELLUCID_THICKNESS_CAMERA, nor of
                         maps that hold back faces */
  uint32_t casterMaterialImage; /* one float channel: material of the stored surface, numbered as in
                                   frame.material without the mark bit; 0: opaque. Light enters receivers of that
                                   material only */
  float casterMaterialScale; /* the number is round(value * scale); >= 0; 0 (default): 255, for R8_UNORM; 1 for
                                formats that hold the number itself */
} PellucidShadowMap;

#ifdef __cplusplus
}
#endif
#endif
