/* A light, and tables of its own falloff. pellucid.h includes this header. */
#ifndef PELLUCID_LIGHT_H
#define PELLUCID_LIGHT_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Types of KHR_lights_punctual. */
typedef enum PellucidLightType {
  PELLUCID_LIGHT_DIRECTIONAL = 0, /* from infinitely far away */
  PELLUCID_LIGHT_POINT = 1,       /* in all directions */
  PELLUCID_LIGHT_SPOT = 2         /* within a cone */
} PellucidLightType;

/* Names and units of KHR_lights_punctual. */
typedef struct PellucidLight {
  uint32_t type;        /* PellucidLightType */
  float position[3];    /* world; point and spot */
  float direction[3];   /* world, direction of travel; directional and spot; any length > 0 */
  float color[3];       /* linear, >= 0 */
  float intensity;      /* directional: irradiance at normal incidence; else E = intensity cos/r^2, r in units */
  float range;          /* scene units; 0: unlimited (window of KHR_lights_punctual) */
  float innerConeAngle; /* radians from the axis; spot; < outerConeAngle */
  float outerConeAngle; /* radians, (0, pi/2]; spot */
  uint32_t firstShadowMap, shadowMapCount; /* into frame.shadowMaps, 0..PELLUCID_MAX_LIGHT_SHADOW_MAPS; the first
                                              that contains the receiver is used: 6 for a cube, n for cascades.
                                              0 maps: unshadowed, thickness from the camera's depths */
  /* Own falloff of point and spot lights. Both are indices into frame.lightTables plus 1; 0 (default): none. */
  uint32_t angleTable;    /* factor by the angle from `direction`, which point lights then have, too: entry i is that of
                             i / 63 pi. An IES profile that is the same all around is one, over its most candela, which
                             are the intensity. A spot keeps its cone */
  uint32_t distanceTable; /* factor of 1 / r^2 in place of the range's window: entry i is that of i / 63 range; range > 0,
                             beyond which there is no light. An engine's falloff f(r) has entries r^2 f(r) over their maximum */
} PellucidLight;

enum { PELLUCID_LIGHT_TABLE_ENTRIES = 64, PELLUCID_MAX_LIGHT_TABLES = 16 };

/* Factors of a light, linear between entries. */
typedef struct PellucidLightTable {
  float factor[PELLUCID_LIGHT_TABLE_ENTRIES]; /* [0, 1]; light.intensity has the scale. Kept as halves */
} PellucidLightTable;

#ifdef __cplusplus
}
#endif
#endif
