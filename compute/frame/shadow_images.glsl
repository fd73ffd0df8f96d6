// The shadow images of one dispatch.
#ifndef PELLUCID_SHADOW_IMAGES_GLSL
#define PELLUCID_SHADOW_IMAGES_GLSL

layout(set = 0, binding = PELLUCID_BINDING_SHADOW_IMAGES + 0) uniform texture2D shadowImage0;
layout(set = 0, binding = PELLUCID_BINDING_SHADOW_IMAGES + 1) uniform texture2D shadowImage1;
layout(set = 0, binding = PELLUCID_BINDING_SHADOW_IMAGES + 2) uniform texture2D shadowImage2;
layout(set = 0, binding = PELLUCID_BINDING_SHADOW_IMAGES + 3) uniform texture2D shadowImage3;
layout(set = 0, binding = PELLUCID_BINDING_SHADOW_IMAGES + 4) uniform texture2D shadowImage4;
layout(set = 0, binding = PELLUCID_BINDING_SHADOW_IMAGES + 5) uniform texture2D shadowImage5;
layout(set = 0, binding = PELLUCID_BINDING_SHADOW_IMAGES + 6) uniform texture2D shadowImage6;
layout(set = 0, binding = PELLUCID_BINDING_SHADOW_IMAGES + 7) uniform texture2D shadowImage7;

// A switch over bindings, unlike an index, does not need shaderSampledImageArrayDynamicIndexing.
float shadowTexel(uint image, ivec2 texel) {
  switch (image) {
    case 0u: return texelFetch(shadowImage0, texel, 0).x;
    case 1u: return texelFetch(shadowImage1, texel, 0).x;
    case 2u: return texelFetch(shadowImage2, texel, 0).x;
    case 3u: return texelFetch(shadowImage3, texel, 0).x;
    case 4u: return texelFetch(shadowImage4, texel, 0).x;
    case 5u: return texelFetch(shadowImage5, texel, 0).x;
    case 6u: return texelFetch(shadowImage6, texel, 0).x;
    default: return texelFetch(shadowImage7, texel, 0).x;
  }
}

struct ShadowTexels {
  float own;
  vec4 beside; // texels to the right, to the left, below and above
};

#define PELLUCID_TEXELS(image)                                                                                       \
  ShadowTexels(texelFetch(image, texel, 0).x, vec4(texelFetch(image, right, 0).x, texelFetch(image, left, 0).x,      \
                                                   texelFetch(image, below, 0).x, texelFetch(image, above, 0).x))

// `most`: the last texel of the image.
ShadowTexels shadowTexels(uint image, ivec2 texel, ivec2 most) {
  ivec2 right = ivec2(min(texel.x + 1, most.x), texel.y), left = ivec2(max(texel.x - 1, 0), texel.y);
  ivec2 below = ivec2(texel.x, min(texel.y + 1, most.y)), above = ivec2(texel.x, max(texel.y - 1, 0));
  switch (image) {
    case 0u: return PELLUCID_TEXELS(shadowImage0);
    case 1u: return PELLUCID_TEXELS(shadowImage1);
    case 2u: return PELLUCID_TEXELS(shadowImage2);
    case 3u: return PELLUCID_TEXELS(shadowImage3);
    case 4u: return PELLUCID_TEXELS(shadowImage4);
    case 5u: return PELLUCID_TEXELS(shadowImage5);
    case 6u: return PELLUCID_TEXELS(shadowImage6);
    default: return PELLUCID_TEXELS(shadowImage7);
  }
}

#undef PELLUCID_TEXELS

#endif
