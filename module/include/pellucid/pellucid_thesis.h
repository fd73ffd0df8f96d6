/* Options of Whelan 2009, "Real-time Rendering of Translucency in Skin" (docs/thesis.md). A frame's options.thesis points to
 * them. All are off by default.
 */
#ifndef PELLUCID_THESIS_H
#define PELLUCID_THESIS_H

#include "pellucid.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Models of the cosine of the light on the hidden face, without a gather. x is the cosine between the view ray and the
 * direction to the light: 1 if the light is straight behind. Every factor is clamped to 0..1. */
typedef enum PellucidAngleModel {
  /* -N.L, as if the hidden face had the normal -N. N, of the visible face, follows from the front depths of the pixel and its neighbors. */
  PELLUCID_ANGLE_NORMAL = 0,
  /* x (Whelan 2009, 4.2). */
  PELLUCID_ANGLE_COSINE = 1,
  /* 1 - acos(x) 2/pi (Whelan 2009, 4.4). */
  PELLUCID_ANGLE_INVERSE_COSINE = 2,
  /* c0 + c1 a + c2 a^2 + c3 a^3 for x > 0, else 0 (Whelan 2009, eqs. 4.4 and 4.5). a = pi - acos(x), in radians, is the angle
   * between the directions to eye and light. */
  PELLUCID_ANGLE_POLYNOMIAL = 3,
  /* (m + x) / (m + 1), m = minimumDot (Whelan 2009, eq. 4.6). */
  PELLUCID_ANGLE_MINIMUM_DOT = 4,
  /* MINIMUM_DOT with m from minimumDotTable, by the light's azimuth around the object (Whelan 2009, 4.6.2). */
  PELLUCID_ANGLE_MINIMUM_DOT_AZIMUTH = 5,
  /* MINIMUM_DOT with m from minimumDotTable, by the light's direction on the sphere. */
  PELLUCID_ANGLE_MINIMUM_DOT_SPHERE = 6
} PellucidAngleModel;

/* Options of Whelan 2009, and their defaults. */
struct PellucidThesisOptions {
  /* PellucidAngleModel; default NORMAL. */
  uint32_t angleModel;
  /* c0..c3 of POLYNOMIAL, -1e6..1e6; default 0. */
  float anglePolynomial[4];
  /* The largest cosine between the directions to eye and light for which light comes through, -1..0; default 0. -1: no light comes
   * through. MINIMUM_DOT and prescaleAngle read it. */
  float minimumDot;
  /* 1: COSINE, INVERSE_COSINE and POLYNOMIAL take (m + x) / (m + 1) in place of x, with m = minimumDot. Light then begins at the
   * minimum dot, and the model's value at x = 1 does not change. This is our reading of Whelan 2009's pre-scaling. 0 (default): x. */
  uint32_t prescaleAngle;
  /* 1: all pixels have the camera's axis as view ray (Whelan 2009). 0 (default): each pixel has its own view ray. */
  uint32_t constantViewDirection;
  /* 1: camera-space thickness is back depth minus front depth along the view ray. 0 (default): this length times the mean of the
   * cosines of both faces with the view ray. */
  uint32_t chordThickness;
  /* mm, 0..1e9: no light comes through thicker parts. 0 (default): no limit. */
  float maximumThickness;
  /* Factor of T for R, G, B, 0..1; default 1 (Whelan 2009, 4.5: .55 .29 .28). */
  float transmittanceFilter[3];
  /* 0 (default): no mark bit. Other values are a power of two above materialCount. Pixels whose material value has the bit get diffusion
   * and no translucency. The other bits of the value are the index. */
  uint32_t materialMarkBit;

  /* ---- The table of minimum dots, by the direction from objectCenter to a light. It is looked up once a light ---- */

  /* AZIMUTH: number of entries, 1..360 (Whelan 2009: 36). SPHERE: entries a side, 3..16. */
  uint32_t minimumDotTableSize;
  /* World-space direction in which the face looks, not parallel to upAxis; default +z. */
  float faceVector[3];
  /* World-space direction; default +y. */
  float upAxis[3];
  /* World-space point; default 0, 0, 0. Directions to point and spot lights start there. */
  float objectCenter[3];
  /* Minimum dots, each -1..0.
   * - AZIMUTH: entries at equal angles about upAxis, linear in between, around the whole turn. The first entry is at faceVector, and the
   *   next entries are towards cross(upAxis, faceVector).
   * - SPHERE: size x size entries, row by row, bilinear in an octahedral map. A direction has the components s along cross(upAxis,
   *   faceVector), u along upAxis and f along the face. Its place is x = s / l, y = f / l with l = |s| + |u| + |f|. For u < 0 this place
   *   is folded over the corners. The first entry of a row or column is at -1, and the last one at 1. Entries that share a direction on the
   *   border should agree. */
  const float* minimumDotTable;
};

/* Writes the defaults. */
PELLUCID_API void pellucidInitThesisOptions(PellucidThesisOptions* options);

#ifdef __cplusplus
}
#endif
#endif
