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
  /* N'.L, where N' is the outward normal of the hidden face. With camera-space thickness, N' follows from back depths, or is -N where they
   * show no face. With light-space thickness, thin walls and backDepthEncoding THICKNESS, N' is -N. N, of the visible face, follows from
   * front depths. */
  PELLUCID_ANGLE_NORMAL = 0,
  /* x (Whelan 2009, 4.2). */
  PELLUCID_ANGLE_COSINE = 1,
  /* 1 - acos(x) 2/pi (Whelan 2009, 4.4). */
  PELLUCID_ANGLE_INVERSE_COSINE = 2,
  /* c0 + c1 a + c2 a^2 + c3 a^3 for x > 0, else 0 (Whelan 2009, eqs. 4.4 and 4.5). a = pi - acos(x), in radians, is the angle
   * between the directions to eye and light. */
  PELLUCID_ANGLE_POLYNOMIAL = 3,
  /* (m + x) / (m + 1), m = PellucidLight::minimumDot (Whelan 2009, eq. 4.6). */
  PELLUCID_ANGLE_MINIMUM_DOT = 4
} PellucidAngleModel;

/* Options of Whelan 2009, and their defaults. */
struct PellucidThesisOptions {
  /* PellucidAngleModel; default NORMAL. */
  uint32_t angleModel;
  /* c0..c3 of POLYNOMIAL, -1e6..1e6; default 0. */
  float anglePolynomial[4];
  /* 1: COSINE, INVERSE_COSINE and POLYNOMIAL take (m + x) / (m + 1) in place of x, with m = PellucidLight::minimumDot. Light then begins at the
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
  /* World-space point where reuse COHERENCE begins the directions to point and spot lights, -1e15..1e15; default 0, 0, 0. */
  float objectCenter[3];
};

/* Writes the defaults. */
PELLUCID_API void pellucidInitThesisOptions(PellucidThesisOptions* options);

#ifdef __cplusplus
}
#endif
#endif
