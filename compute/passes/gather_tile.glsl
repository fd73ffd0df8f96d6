// main() of the gather. Light that has gone through a part is smooth, so one point in 2x2 pixels gathers;
// neighbors among these take samples of their own, nine patterns in 3x3, and share what they found with
// those that lie near on the same side. A tile's points are in shared memory, with a border.
#ifndef PELLUCID_PASS_GATHER_TILE_GLSL
#define PELLUCID_PASS_GATHER_TILE_GLSL

#include "passes/gather.glsl"

const int kSide = PELLUCID_GATHER_GROUP;
const int kPoints = kSide + 3;  // one before the tile and two behind: 3x3 around the points that pixels read
const int kShared = kSide + 1;
const uint kThreads = uint(kSide * kSide);

shared vec3 pointPosition[kPoints * kPoints];
shared uint pointFacing[kPoints * kPoints]; // normal in three bytes, material in the highest; 0: nothing there
shared uvec3 pointLight[kPoints * kPoints]; // halves: added irradiance, displaced share
shared uvec3 sharedLight[kShared * kShared];

struct Light {
  vec3 added, displaced;
};

uvec3 packLight(Light l) {
  vec3 a = min(l.added, vec3(kLargestHalf));
  return uvec3(packHalf2x16(a.xy), packHalf2x16(vec2(a.z, l.displaced.x)), packHalf2x16(l.displaced.yz));
}

Light unpackLight(uvec3 bits) {
  vec2 middle = unpackHalf2x16(bits.y), last = unpackHalf2x16(bits.z);
  return Light(vec3(unpackHalf2x16(bits.x), middle.x), vec3(middle.y, last));
}

// Index of the material where light comes through a surface at the pixel, 0 elsewhere.
uint lightAt(ivec2 pixel, out float front) {
  front = -1.0;
  if (!insideRect(pixel)) return 0u;
  uint value = materialValueAt(pixel);
  if (materialIndex(value) == 0u || (value & frame.marks.x) != 0u) return 0u;
  front = frontDistance(pixel);
  return front > 0.0 ? materialIndex(value) : 0u;
}

Surface gatherSurface(ivec2 pixel, float front) {
  float back = hasFlag(PELLUCID_FLAG_CHORD) ? texelFetch(backDepthImage, pixel, 0).x : 0.0;
  return surfaceAt(pixel, front, texelFetch(frontDepthImage, pixel, 0).x, back, texelFetch(normalImage, pixel, 0));
}

uint packFacing(Surface s, uint material) {
  return packSnorm4x8(vec4(s.hasNormal ? s.normal : -s.view, 0.0)) & 0xFFFFFFu | material << 24;
}

// How much of a neighbor's light is also light here, (0, 1]; 0 for other materials. The floor leaves a pixel
// without a like neighbor the most alike.
float likeness(vec3 x, uint facing, int other, float perSquare) {
  if ((facing ^ pointFacing[other]) >> 24 != 0u) return 0.0;
  vec3 apart = pointPosition[other] - x;
  vec3 a = unpackSnorm4x8(facing).xyz, b = unpackSnorm4x8(pointFacing[other]).xyz;
  return exp2(-dot(apart, apart) * perSquare) * max(dot(a, b), 0.0) + 1.0e-4;
}

float perSquareOf(uint m) {
  float mm = frame.camera.range.w;
  return materials[m].gather.profile.w * mm * mm;
}

// The nine patterns fill the strata and the turn between a sample and its like in the next ring.
void gatherPoint(int index, ivec2 tile) {
  ivec2 cell = ivec2(index % kPoints, index / kPoints) - 1;
  ivec2 corner = tile + 2 * cell;
  pointFacing[index] = 0u;
  float front;
  uint material = 0u;
  ivec2 pixel = corner;
  for (int i = 0; i < 4 && material == 0u; ++i) {
    pixel = corner + ivec2((i ^ (i >> 1)) & 1, i >> 1); // the corner, then around
    material = lightAt(pixel, front);
  }
  if (material == 0u) return;
  uint m = material - 1u;
  Surface s = gatherSurface(pixel, front);
  pointPosition[index] = s.position;
  pointFacing[index] = packFacing(s, material);
  // Where points are too far apart to share, all take the middle pattern.
  vec2 spacing = 2.0 * pixelSize(frame.camera, front);
  float vary = clamp(2.0 - dot(spacing, spacing) * materials[m].gather.profile.w, 0.0, 1.0);
  ivec2 at = (tile / 2 + cell + 3) % 3;
  int pattern = (at.x + 3 * at.y) * 4 % 9;
  float within = 0.5 + vary * (float(pattern) - 4.0) / 9.0;
  float turn = vary * float(at.x + 3 * at.y) / 9.0;
  vec3 transmitted = vec3(0.0), entering = vec3(0.0), displaced = vec3(0.0);
  for (uint i = 0u; i < pass.value.y; ++i) {
    LightConstants light = lights[i];
    if (light.meta.z == 0u) continue;
    Gathered g = gatherLight(m, light, s, pass.value.w, turn, within);
    transmitted += g.transmitted;
    entering += g.entering;
    displaced = max(displaced, g.displaced); // of the same surface, whatever the light
  }
  transmitted *= frame.filterAndLimit.rgb * materials[m].inverseReflectance.rgb;
  bool spreads = hasFlag(PELLUCID_FLAG_DIFFUSED);
  pointLight[index] = packLight(Light(transmitted + (spreads ? entering : vec3(0.0)),
                                      spreads ? min(displaced, vec3(1.0)) : vec3(0.0)));
}

void sharePoint(int index) {
  ivec2 cell = ivec2(index % kShared, index / kShared) + 1;
  int center = cell.y * kPoints + cell.x;
  uint facing = pointFacing[center];
  if (facing == 0u) return;
  float perSquare = perSquareOf((facing >> 24) - 1u), total = 0.0;
  Light sum = Light(vec3(0.0), vec3(0.0));
  for (int y = -1; y <= 1; ++y)
    for (int x = -1; x <= 1; ++x) {
      int other = center + y * kPoints + x;
      float weight = likeness(pointPosition[center], facing, other, perSquare);
      if (weight == 0.0) continue;
      Light l = unpackLight(pointLight[other]);
      sum.added += weight * l.added;
      sum.displaced += weight * l.displaced;
      total += weight;
    }
  // The point itself is among them.
  sharedLight[index] = packLight(Light(sum.added / total, sum.displaced / total));
}

// Linear between the four points around the pixel, as far as they are of its kind.
Light lightOf(ivec2 local, Surface s, uint material) {
  uint facing = packFacing(s, material);
  float perSquare = perSquareOf(material - 1u), total = 0.0;
  Light sum = Light(vec3(0.0), vec3(0.0));
  vec2 fraction = 0.5 * vec2(local & 1);
  for (int i = 0; i < 4; ++i) {
    ivec2 corner = ivec2(i & 1, i >> 1), cell = local / 2 + corner;
    vec2 linear = mix(1.0 - fraction, fraction, vec2(corner));
    int point = (cell.y + 1) * kPoints + cell.x + 1;
    float weight = likeness(s.position, facing, point, perSquare) * (linear.x * linear.y + 1.0e-4);
    if (weight == 0.0) continue;
    Light l = unpackLight(sharedLight[cell.y * kShared + cell.x]);
    sum.added += weight * l.added;
    sum.displaced += weight * l.displaced;
    total += weight;
  }
  // The quad's own point is of its material, unless the quad has several.
  return total > 0.0 ? Light(sum.added / total, sum.displaced / total) : sum;
}

void writePixel(ivec2 pixel, ivec2 local) {
  if (!insideRect(pixel)) return;
  uint value = materialValueAt(pixel), material = materialIndex(value);
  bool starts = pass.value.z == PELLUCID_WRITE_STARTS;
  if (material == 0u) {
    if (starts) imageStore(destinationImage, pixel, vec4(0.0));
    return;
  }
  vec4 source = starts ? vec4(0.0) : texelFetch(sourceImage, pixel, 0);
  vec3 result = sanitize(source.rgb);
  float front;
  if (lightAt(pixel, front) != 0u) {
    Surface s = gatherSurface(pixel, front);
    Light l = lightOf(local, s, material);
    result = result * (1.0 - l.displaced) + l.added;
    vec3 transmitted = vec3(0.0);
    for (uint i = 0u; i < pass.value.y; ++i) {
      LightConstants light = lights[i];
      if (light.meta.z != 0u) continue;
      Transmitted t = lightTransmission(light, s);
      vec3 through = t.arriving * t.visible;
      if (t.thickness >= 0.0)
        transmitted += through * materialTransmittance(material - 1u, t.thickness * frame.camera.range.w);
    }
    result += transmitted * materials[material - 1u].inverseReflectance.rgb;
  }
  writeResult(pixel, result, source.a, pass.value.z == PELLUCID_WRITE_LAST);
}

void main() {
  ivec2 tile = ivec2(frame.rect.xy) + ivec2(gl_WorkGroupID.xy) * (2 * kSide);
  for (uint i = gl_LocalInvocationIndex; i < uint(kPoints * kPoints); i += kThreads) gatherPoint(int(i), tile);
  barrier();
  for (uint i = gl_LocalInvocationIndex; i < uint(kShared * kShared); i += kThreads) sharePoint(int(i));
  barrier();
  for (int i = 0; i < 4; ++i) {
    ivec2 local = ivec2(gl_LocalInvocationID.xy) + kSide * ivec2(i & 1, i >> 1);
    writePixel(tile + local, local);
  }
}

#endif
