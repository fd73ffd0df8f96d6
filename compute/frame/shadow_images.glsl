// The shadow images of one dispatch: 2D views, or with PELLUCID_SHADOW_ARRAY views of all layers of array images. Entry
// points define MORE_SHADOW_IMAGES.
#ifndef PELLUCID_SHADOW_IMAGES_GLSL
#define PELLUCID_SHADOW_IMAGES_GLSL

#include "lib/shadow.glsl"

#ifdef PELLUCID_SHADOW_ARRAY
#define PELLUCID_SHADOW_TEXTURE texture2DArray
#define PELLUCID_SHADOW_SLOT(image) ((image) & 0xFFu)
#define PELLUCID_SHADOW_PLACE(texel, image) ivec3(texel, (image) >> 8)
#else
#define PELLUCID_SHADOW_TEXTURE texture2D
#define PELLUCID_SHADOW_SLOT(image) (image)
#define PELLUCID_SHADOW_PLACE(texel, image) (texel)
#endif

#ifndef SHADOW_BINDING
#define SHADOW_BINDING PELLUCID_BINDING_SHADOW_IMAGES
#endif

layout(set = 0, binding = SHADOW_BINDING + 0) uniform PELLUCID_SHADOW_TEXTURE shadowImage0;
layout(set = 0, binding = SHADOW_BINDING + 1) uniform PELLUCID_SHADOW_TEXTURE shadowImage1;
layout(set = 0, binding = SHADOW_BINDING + 2) uniform PELLUCID_SHADOW_TEXTURE shadowImage2;
layout(set = 0, binding = SHADOW_BINDING + 3) uniform PELLUCID_SHADOW_TEXTURE shadowImage3;
layout(set = 0, binding = SHADOW_BINDING + 4) uniform PELLUCID_SHADOW_TEXTURE shadowImage4;
layout(set = 0, binding = SHADOW_BINDING + 5) uniform PELLUCID_SHADOW_TEXTURE shadowImage5;
layout(set = 0, binding = SHADOW_BINDING + 6) uniform PELLUCID_SHADOW_TEXTURE shadowImage6;
layout(set = 0, binding = SHADOW_BINDING + 7) uniform PELLUCID_SHADOW_TEXTURE shadowImage7;
#ifdef MORE_SHADOW_IMAGES
layout(set = 0, binding = SHADOW_BINDING + 8) uniform PELLUCID_SHADOW_TEXTURE shadowImage8;
layout(set = 0, binding = SHADOW_BINDING + 9) uniform PELLUCID_SHADOW_TEXTURE shadowImage9;
layout(set = 0, binding = SHADOW_BINDING + 10) uniform PELLUCID_SHADOW_TEXTURE shadowImage10;
layout(set = 0, binding = SHADOW_BINDING + 11) uniform PELLUCID_SHADOW_TEXTURE shadowImage11;
#define PELLUCID_MORE_SLOTS(fetch)           \
    case 8u: return fetch(shadowImage8);     \
    case 9u: return fetch(shadowImage9);     \
    case 10u: return fetch(shadowImage10);   \
    case 11u: return fetch(shadowImage11);
#else
#define PELLUCID_MORE_SLOTS(fetch)
#endif

#define PELLUCID_TEXEL(slot, texel) texelFetch(slot, PELLUCID_SHADOW_PLACE(texel, image), 0).x

// Returns what `fetch` makes of the image's slot. A switch over bindings, unlike an index, does not need
// shaderSampledImageArrayDynamicIndexing.
#define PELLUCID_RETURN_OF_SLOT(fetch)       \
  switch (PELLUCID_SHADOW_SLOT(image)) {     \
    case 0u: return fetch(shadowImage0);     \
    case 1u: return fetch(shadowImage1);     \
    case 2u: return fetch(shadowImage2);     \
    case 3u: return fetch(shadowImage3);     \
    case 4u: return fetch(shadowImage4);     \
    case 5u: return fetch(shadowImage5);     \
    case 6u: return fetch(shadowImage6);     \
    PELLUCID_MORE_SLOTS(fetch)               \
    default: return fetch(shadowImage7);     \
  }

// `image`, here and below: a slot, from bit 8 on the layer, which is 0 of 2D views.
#define PELLUCID_ONE(slot) PELLUCID_TEXEL(slot, texel)
float shadowTexel(uint image, ivec2 texel) { PELLUCID_RETURN_OF_SLOT(PELLUCID_ONE) }

struct ShadowTexels {
  float own;
  vec4 beside; // texels to the right, to the left, below and above
};

#define PELLUCID_CROSS(slot)                                                                        \
  ShadowTexels(PELLUCID_TEXEL(slot, texel), vec4(PELLUCID_TEXEL(slot, right), PELLUCID_TEXEL(slot, left), \
                                                 PELLUCID_TEXEL(slot, below), PELLUCID_TEXEL(slot, above)))

// `first`, `last`: texels of the tile, beyond which its border is read again.
ShadowTexels shadowTexels(uint image, ivec2 texel, ivec2 first, ivec2 last) {
  ivec4 at = besideTexel(texel, first, last);
  ivec2 right = ivec2(at.x, texel.y), left = ivec2(at.y, texel.y), below = ivec2(texel.x, at.z), above = ivec2(texel.x, at.w);
  PELLUCID_RETURN_OF_SLOT(PELLUCID_CROSS)
}

#define PELLUCID_FOUR(slot) \
  vec4(PELLUCID_TEXEL(slot, a), PELLUCID_TEXEL(slot, b), PELLUCID_TEXEL(slot, c), PELLUCID_TEXEL(slot, d))

vec4 shadowTexels(uint image, ivec2 a, ivec2 b, ivec2 c, ivec2 d) { PELLUCID_RETURN_OF_SLOT(PELLUCID_FOUR) }

#undef PELLUCID_ONE
#undef PELLUCID_CROSS
#undef PELLUCID_FOUR
#undef PELLUCID_RETURN_OF_SLOT
#undef PELLUCID_MORE_SLOTS
#undef PELLUCID_TEXEL

#endif
