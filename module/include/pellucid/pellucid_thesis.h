/* Options of Whelan 2009, "Real-time Rendering of Translucency in Skin" (docs/thesis.md), which a frame may point to.
 * None is on by default.
 */
#ifndef PELLUCID_THESIS_H
#define PELLUCID_THESIS_H

#include "pellucid.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Models of the cosine of the light on the hidden face. x is the cosine between the view ray and
 * the direction to the light: 1 when the light is straight behind. Every factor is clamped to 0..1. */
typedef enum PellucidAngleModel {
  PELLUCID_ANGLE_NORMAL = 0,         /* -N.L, the hidden face taken antiparallel to N; COSINE where
                                        there is no normal */
  PELLUCID_ANGLE_COSINE = 1,         /* x (Whelan 2009, 4.2) */
  PELLUCID_ANGLE_INVERSE_COSINE = 2, /* 1 - acos(x) 2/pi (Whelan 2009, 4.4) */
  PELLUCID_ANGLE_POLYNOMIAL = 3,     /* c0 + c1 a + c2 a^2 + c3 a^3 of the angle between the directions to
                                        eye and light, a = pi - acos(x) in radians, for x > 0, else 0
                                        (Whelan 2009, eqs. 4.4 and 4.5) */
  PELLUCID_ANGLE_MINIMUM_DOT = 4,    /* (m + x) / (m + 1), m = minimumDot (Whelan 2009, eq. 4.6) */
  PELLUCID_ANGLE_MINIMUM_DOT_AZIMUTH = 5, /* m per light from minimumDotTable by the light's azimuth around
                                             the object (Whelan 2009, 4.6.2) */
  PELLUCID_ANGLE_MINIMUM_DOT_SPHERE = 6   /* the same by the direction on the sphere */
} PellucidAngleModel;

struct PellucidThesisOptions {
  uint32_t structSize; /* sizeof(PellucidThesisOptions), written by pellucidInitThesisOptions */
  /* ---- fields that may be missing ---- */
  uint32_t angleModel;      /* PellucidAngleModel */
  float anglePolynomial[4]; /* c0..c3 of POLYNOMIAL */
  float minimumDot;         /* of MINIMUM_DOT and prescaleAngle: the cosine between the directions to the eye
                               and to the light above which nothing comes through, [-1, 0]; -1: nothing ever does */
  uint32_t prescaleAngle;   /* 1: COSINE, INVERSE_COSINE and POLYNOMIAL take (m + x) / (m + 1), m = minimumDot,
                               in place of x, so that they begin at the minimum dot and still reach their
                               value at 1 (our reading of Whelan 2009's pre-scaling); 0 (default): x itself */
  uint32_t constantViewDirection; /* 1: one view ray for all pixels, the camera's axis (Whelan 2009) */
  uint32_t chordThickness;  /* 1: camera-space thickness is the chord itself, without the cosine
                               between N and the view ray */
  float maximumThickness;   /* mm; thicker parts let nothing through; 0: no limit */
  float transmittanceFilter[3]; /* multiplies T, [0, 1]; default 1 (Whelan 2009, 4.5: .55 .29 .28) */
  uint32_t materialMarkBit; /* a power of two above materialCount, or 0: pixels whose material value has the
                               bit get diffusion and no translucency; the rest of the value is the index */

  /* Minimum dots by the direction from the object to a light, each [-1, 0]. AZIMUTH: minimumDotTableSize
   * entries, 1..360 (Whelan: 36), at equal angles about upAxis, the first where the face looks and the next
   * towards cross(upAxis, faceVector); linear in between, around the turn. SPHERE: size x size entries, size
   * 3..16, rows first: the octahedral map x = s / l, y = f / l of the direction (s along cross(upAxis,
   * faceVector), u up, f along the face; l = |s| + |u| + |f|), corners folded under for u < 0, both
   * coordinates -1 at the first entry and 1 at the last; bilinear. Entries that share a direction on the
   * border should agree. Looked up once a light. */
  uint32_t minimumDotTableSize;
  float faceVector[3];   /* world, not along upAxis; default +z */
  float upAxis[3];       /* world; default +y */
  float objectCenter[3]; /* world; where point and spot lights are seen from */
  const float* minimumDotTable; /* as said above */
};

/* The defaults, written into a struct of that many bytes. */
PELLUCID_API void pellucidInitThesisOptionsSized(PellucidThesisOptions* options, size_t structSize);
/* The defaults. */
static inline void pellucidInitThesisOptions(PellucidThesisOptions* options) {
  pellucidInitThesisOptionsSized(options, sizeof(PellucidThesisOptions));
}

#ifdef __cplusplus
}
#endif
#endif
