// What every shader that draws a part shares; DrawConstants of draw.h.
#ifndef PELLUCID_RASTER_DRAW_GLSL
#define PELLUCID_RASTER_DRAW_GLSL

layout(push_constant) uniform Draw {
  mat4 clipFromWorld;
  vec4 planar;     // dot(planar, (x, 1)): planar distance in front of the eye
  vec4 baseColor;  // a: alpha below this is a hole
  vec4 addedColor; // a: object
  uvec4 ids;       // x: material, LOBES_APART, and in the upper half how much the lobe map displaces;
                   // y: 1 reversed depth, IS_OFFSET, and in the upper half the backscatter;
                   // z: 0, or one of BEHIND_* where only back faces behind the front count; and HAS_*
                   // w: lights in transmit.frag, with IS_OFFSET bits of the offset, else bits of the normal map's
                   // scale, 0: no map
} draw;

layout(set = 0, binding = 0) uniform sampler2D baseColorTexture;
// Device depth that an earlier pass wrote: of the front faces, or in count.frag of the back faces.
layout(set = 0, binding = 1) uniform sampler2D earlierDepth;
// Object of the front faces.
#define BEHIND_FRONT 1u  // a: of surface.frag
#define BEHIND_CASTER 2u // r: of caster.frag
layout(set = 0, binding = 2) uniform sampler2D frontObject;
layout(set = 0, binding = 3) uniform sampler2D normalMap; // vectors
layout(set = 0, binding = 4) uniform sampler2D lobeMap;   // linear rgb; a: strength

#define LOBES_APART 256u
#define IS_OFFSET 2u
// Images of the part; others are one white texel.
#define HAS_COLOR 4u
#define HAS_LOBES 8u

uint behindWhat() { return draw.ids.z & 3u; }

uint partMaterial() { return draw.ids.x & 255u; }

bool isNearer(float depth, float other) {
  return (draw.ids.y & 1u) != 0u ? depth > other : depth < other;
}

// alpha: the vertices'.
bool isHole(vec2 uv, float alpha) {
  // Level 0 and one sample, so that every pass agrees.
  return draw.baseColor.a > 0.0 && textureLod(baseColorTexture, uv, 0.0).a * alpha < draw.baseColor.a;
}

#endif
