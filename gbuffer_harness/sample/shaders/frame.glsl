// Declarations that all shaders share; Uniforms and DrawConstants of renderer.cpp.
#ifndef SAMPLE_FRAME_GLSL
#define SAMPLE_FRAME_GLSL

struct Light {
  vec4 position;  // w: PellucidLightType's order: 0 directional, 1 point, 2 spot
  vec4 direction; // of travel; w: cosine of the inner cone
  vec4 color;     // times intensity; w: cosine of the outer cone
  uvec4 tiles;    // x: first, y: count
};
struct Tile {
  mat4 clipFromWorld;
  vec4 rect;   // of the tile in its image: offset and size, 0..1
  vec4 places; // x: image, y: layer, z: side of a texel per clip w, scene units, w: of a texel, 0..1
};

layout(set = 0, binding = 0, std140) uniform Frame {
  mat4 worldFromClip;       // of the rect, jittered
  mat4 previousFromCurrent; // clip space of the frame before from that of this one, both without jitter
  vec4 eye;
  vec4 rect;    // xy: pixels that are rendered, from the images' corner; zw: 1 / xy
  vec4 extent;  // xy: pixels of the images; zw: 1 / xy
  vec4 jitter;  // xy: pixels that the rect's picture is moved by; z: weight of this frame in the history
  vec4 scale;   // x: exposure; y: pre-exposure of irradiance; z: of specular light, 0 or 1
  uvec4 flags;  // x: lights; y: MISTAKE_*; z: 1: Pellucid adds the diffuse light of pixels with a material
  vec4 ambient[9]; // coefficients of radiance, in the order of PellucidFrameOptions::ambient
  Light lights[6];
  Tile tiles[16];
} frame;

layout(push_constant) uniform Draw {
  mat4 clipFromWorld;
  vec4 baseColor;
  vec4 surface; // x: material, y: roughness
} draw;

// Mistakes of integrations, shown on purpose; Mistake of renderer.h.
#define MISTAKE_GAMMA 4u
#define MISTAKE_ALBEDO_TWICE 5u
#define MISTAKE_SPECULAR_DIFFUSED 6u

// The third image of the G-buffer: roughness in bits 0..7, material in bits 16..23, 0: none.
uint packedSurface(float roughness, uint material) { return uint(roughness * 255.0 + 0.5) | material << 16; }
float roughnessOf(uint surface) { return float(surface & 255u) / 255.0; }
uint materialOf(uint surface) { return surface >> 16 & 255u; }

#endif
