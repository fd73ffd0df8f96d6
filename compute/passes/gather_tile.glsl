// main() of the pass that adds gathered light to the pixels, which take what the four points around them have.
#ifndef PELLUCID_PASS_GATHER_TILE_GLSL
#define PELLUCID_PASS_GATHER_TILE_GLSL

const int kTile = 2 * PELLUCID_GATHER_GROUP; // an invocation does four pixels, whose loads overlap
const int kThreads = PELLUCID_GATHER_GROUP * PELLUCID_GATHER_GROUP;
const ivec2 kPointPixels = ivec2(kTile);
const int kLeastSide = 2;
#include "passes/gathered.glsl"

// The i-th pixel of an invocation: half a tile apart, so that neighbors load neighbors.
ivec2 pixelInTile(int i) { return ivec2(gl_LocalInvocationID.xy) + PELLUCID_GATHER_GROUP * ivec2(i & 1, i >> 1); }

// What came through of the lights without a map, which come last.
vec3 otherLight(ivec2 pixel, float front, float frontStored, uint m) {
  float back = hasFlag(PELLUCID_FLAG_CHORD) ? texelFetch(backDepthImage, pixel, 0).x : 0.0;
  Surface s = surfaceAt(pixel, front, frontStored, back, texelFetch(normalImage, pixel, 0));
  vec3 transmitted = vec3(0.0);
  for (uint i = pass.value.w; i < pass.value.y; ++i) {
    Transmitted t = lightTransmission(lights[i], s);
    vec3 through = t.arriving * t.visible;
    if (t.thickness >= 0.0) transmitted += through * materialTransmittance(m, t.thickness * frame.camera.range.w);
  }
  return transmitted * materials[m].inverseReflectance.rgb;
}

// `others`: there are lights without a map.
void writePixel(ivec2 pixel, ivec2 local, int side, uint value, vec4 source, float frontStored, bool others) {
  uint material = materialIndex(value);
  if (material == 0u) return;
  vec3 result = sanitize(source.rgb);
  float front = (value & frame.marks.x) != 0u ? -1.0 : frontDistanceOf(frontStored);
  if (front > 0.0 && someLight != 0u) result = withGathered(result, local, side, front, material);
  if (front > 0.0 && others) result += otherLight(pixel, front, frontStored, material - 1u);
  writeResult(pixel, max(result, vec3(0.0)), source.a, pass.value.z == PELLUCID_WRITE_LAST);
}

void main() {
  int side = int(pass.value.x), index = int(gl_LocalInvocationIndex);
  ivec2 tile = (ivec2(frame.rect.xy) / kTile + ivec2(gl_WorkGroupID.xy)) * kTile;
  uint value[4];
  vec4 source[4];
  float front[4];
  [[unroll]] for (int i = 0; i < 4; ++i) {
    ivec2 pixel = withinRect(tile + pixelInTile(i));
    value[i] = materialValueAt(pixel);
    source[i] = texelFetch(sourceImage, pixel, 0);
    front[i] = texelFetch(frontDepthImage, pixel, 0).x;
  }
  if (index == 0) someLight = 0u;
  barrier();
  uint light = loadPoints(index, kThreads, side, tile);
  if (light != 0u) atomicOr(someLight, light);
  barrier();
  if (someLight != 0u) unpackPoints(index, kThreads, side, tile);
  barrier();
  if (pass.value.w == pass.value.y) {
    // Unrolled, so that the arrays stay in registers.
    [[unroll]] for (int i = 0; i < 4; ++i) {
      ivec2 local = pixelInTile(i);
      if (insideRect(tile + local)) writePixel(tile + local, local, side, value[i], source[i], front[i], false);
    }
  } else {
    // The code of other lights once.
    [[dont_unroll]] for (int i = 0; i < 4; ++i) {
      ivec2 local = pixelInTile(i), pixel = tile + local;
      if (insideRect(pixel))
        writePixel(pixel, local, side, materialValueAt(pixel), texelFetch(sourceImage, pixel, 0),
                   texelFetch(frontDepthImage, pixel, 0).x, true);
    }
  }
}

#endif
