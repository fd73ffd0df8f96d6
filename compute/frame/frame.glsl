// Bindings that passes share, and the functions that read the G-buffer through them. A pass defines GROUP_SIDE and, for groups
// that are not square, GROUP_ROWS before it includes this file.
#ifndef PELLUCID_FRAME_GLSL
#define PELLUCID_FRAME_GLSL

#extension GL_EXT_control_flow_attributes : require
#extension GL_EXT_samplerless_texture_functions : require

#include "frame/gbuffer_decode.glsl"
#include "lib/camera.glsl"
#include "shared/pellucid_shared.h"

#ifndef GROUP_SIDE
#define GROUP_SIDE PELLUCID_GROUP_X
#endif
#ifndef GROUP_ROWS
#define GROUP_ROWS GROUP_SIDE
#endif
layout(local_size_x = GROUP_SIDE, local_size_y = GROUP_ROWS) in;

layout(set = 0, binding = PELLUCID_BINDING_FRAME) uniform Frame { FrameConstants frame; };
layout(set = 0, binding = PELLUCID_BINDING_FRONT_DEPTH) uniform texture2D frontDepthImage;
layout(set = 0, binding = PELLUCID_BINDING_SOURCE) uniform texture2D sourceImage;
layout(set = 0, binding = PELLUCID_BINDING_ALBEDO) uniform texture2D albedoImage;
layout(set = 0, binding = PELLUCID_BINDING_MATERIAL) uniform utexture2D materialImage;
// The destination has no format, so that one shader writes every output format; see module/src/pipelines.cpp.
layout(set = 0, binding = PELLUCID_BINDING_DESTINATION) uniform writeonly image2D destinationImage;
// The output's content, if the frame adds to it. An invocation reads its pixel before it writes it.
layout(set = 0, binding = PELLUCID_BINDING_HELD) uniform texture2D heldImage;

// Frame-wide switches.
bool hasFlag(uint flag) { return (frame.flags.x & flag) != 0u; }

// Passes of cells and blocks, the rect and rays count pixels from up to 127 before the image's first one: cells and texels of the
// pyramid then follow options.anchor. Images of the frame's extent are read and written `inImage`, as functions below that read
// them say by `at`.
ivec2 inImage(ivec2 pixel) { return pixel - frame.lattice.xy; }
ivec2 inLattice(ivec2 at) { return at + frame.lattice.xy; }

// For passes that go over images.
ivec2 invocationPlace() { return inImage(ivec2(frame.rect.xy)) + ivec2(gl_GlobalInvocationID.xy); }

bool insideRect(ivec2 pixel) { return contains(ivec4(frame.rect), pixel); }

// The nearest pixel of the rect, where loads need no branch.
ivec2 withinRect(ivec2 pixel) { return clamp(pixel, ivec2(frame.rect.xy), ivec2(frame.rect.zw) - 1); }

// Index without the mark bit. It is 0 for none and for values beyond the material list, so that a stray id
// cannot read past the list.
uint materialIndex(uint value) {
  uint id = value & frame.marks.z;
  return id <= frame.flags.y ? id : 0u;
}

uint materialValueAt(ivec2 at) { return decodeMaterial(texelFetch(materialImage, at, 0)) >> frame.marks.y; }

uint materialAt(ivec2 at) { return materialIndex(materialValueAt(at)); }

// Planar distance of the front surface, -1 where there is none.
float frontDistanceOf(float stored) {
  stored = decodeDepth(stored);
  return hasFlag(PELLUCID_FLAG_FRONT_VIEW_Z) ? planarDistanceViewZ(stored) : planarDistance(frame.camera, stored);
}

float frontDistance(ivec2 at) { return frontDistanceOf(texelFetch(frontDepthImage, at, 0).x); }

// Planar distance of the back surface, -1 where there is none. A thickness does not tell the place of the back surface.
float backDistanceOf(float stored) {
  if (hasFlag(PELLUCID_FLAG_BACK_THICKNESS)) return -1.0;
  stored = decodeDepth(stored);
  return hasFlag(PELLUCID_FLAG_BACK_VIEW_Z) ? planarDistanceViewZ(stored) : planarDistance(frame.camera, stored);
}

// Thickness in mm where the image of back depths holds thicknesses; -1: not known.
float thicknessOf(float stored) { return isWithin(stored, 0.0, kNoDepth) ? stored : -1.0; }

// Scene units along the view ray, or the stored thickness; -1 where no back face is behind the front one. `front`: planar distance of
// `frontStored`.
float chordOf(ViewRay ray, float front, float frontStored, float backStored) {
  if (hasFlag(PELLUCID_FLAG_BACK_THICKNESS)) return thicknessOf(backStored) / frame.camera.range.w;
  float back = backDistanceOf(backStored);
  bool device = !hasFlag(PELLUCID_FLAG_BACK_VIEW_Z) && !hasFlag(PELLUCID_FLAG_FRONT_VIEW_Z);
  float difference =
      device ? planarDifference(frame.camera, decodeDepth(backStored), decodeDepth(frontStored)) : back - front;
  return back > 0.0 ? chord(difference, ray) : -1.0;
}

// ---- Colors

const float kLargestHalf = 65504.0;

// v of bits in (0, end), at most the largest half; 0 elsewhere. Bits say what is above 0 and no NaN, because compilers may take for
// granted that floats are none. No function loops over components: compilers keep dynamically indexed vectors in memory.
vec3 positive(vec3 v, uint end) {
  return mix(vec3(0.0), min(v, vec3(kLargestHalf)), lessThan(floatBitsToUint(v) - 1u, uvec3(end - 1u)));
}

const uint kInfinity = 0x7F800000u;

// A texel's color, finite and >= 0. Infinity is a half that overflowed. It counts as 0, as NaN does, because the largest half would light
// all skin around the pixel.
vec3 sanitize(vec3 v) { return positive(v, kInfinity); }

// A color that no other pixel reads, or a computed one: infinity counts as the largest half.
vec3 limited(vec3 v) { return positive(v, kInfinity + 1u); }

// A change of a color: finite, of either sign.
vec3 change(vec3 v) {
  return mix(vec3(0.0), clamp(v, -kLargestHalf, kLargestHalf), lessThan(floatBitsToUint(v) & 0x7FFFFFFFu, uvec3(kInfinity)));
}

// v rounded to the nearest half, ties away from 0. Image stores may truncate (Vulkan leaves it open), which darkens by up
// to 1e-3 a pass. Every device stores a half as it is.
vec3 roundToHalf(vec3 v) {
  return uintBitsToFloat((floatBitsToUint(v) + 0x1000u) & 0xFFFFE000u); // halves keep 10 of 23 mantissa bits
}

// v rounded to the nearest color of B10G11R11, at most the largest of each channel. Truncation would darken by 1, 1 and 2 %.
vec3 roundToPacked(vec3 v) {
  v = min(v, vec3(65024.0, 65024.0, 64512.0));
  return uintBitsToFloat((floatBitsToUint(v) + uvec3(0x10000u, 0x10000u, 0x20000u)) & uvec3(0xFFFE0000u, 0xFFFE0000u, 0xFFFC0000u));
}

// A color as the destination holds it. `last`: the destination is the output.
vec3 asStored(vec3 color, bool last) {
  if (hasFlag(PELLUCID_FLAG_WIDE_OUTPUT)) return color;
  return last && hasFlag(PELLUCID_FLAG_PACKED_OUTPUT) ? roundToPacked(color) : roundToHalf(color);
}

// True where the post-scatter albedo applies. `last`: this is the frame's final write.
bool tinted(bool last) { return last && hasFlag(PELLUCID_FLAG_ALBEDO); }

vec3 albedoAt(ivec2 at) { return sanitize(texelFetch(albedoImage, at, 0).rgb); }

// True where the result is added to what the output holds.
bool adds(bool last) { return last && hasFlag(PELLUCID_FLAG_ADDS); }

// `color` with alpha, on top of what the output holds, of which NaN counts as 0. The sum alone is clamped.
vec4 onHeld(ivec2 at, vec3 color) {
  vec4 held = texelFetch(heldImage, at, 0);
  bvec3 isNumber = lessThanEqual(floatBitsToUint(held.rgb) & 0x7FFFFFFFu, uvec3(kInfinity));
  return vec4(limited(mix(vec3(0.0), held.rgb, isNumber) + color), held.a);
}

void writeResult(ivec2 at, vec3 color, float alpha, bool last) {
  vec4 result = vec4(sanitize(color), alpha);
  if (tinted(last)) result.rgb = sanitize(result.rgb * albedoAt(at));
  if (adds(last)) result = onHeld(at, result.rgb);
  imageStore(destinationImage, at, vec4(asStored(result.rgb, last), result.a));
}

#endif
