// Probes share the light that they found with those that lie near on the same side, and with the earlier frame's. A group does
// 16 x 16 cells.
#version 460
#extension GL_GOOGLE_include_directive : require

#define GROUP_SIDE PELLUCID_FILTER_GROUP
#include "gather/probe.glsl"

layout(push_constant) uniform Pass { FilterProbesPass pass; };
layout(set = 0, binding = PELLUCID_BINDING_MATERIALS) readonly buffer Materials { MaterialConstants materials[]; };
layout(set = 0, binding = PELLUCID_BINDING_FOUND_PROBES) uniform utexture2D foundImage;
layout(set = 0, binding = PELLUCID_BINDING_FILTERED_DESTINATION, rgba32ui) uniform uimage2D sharedImage;
layout(set = 0, binding = PELLUCID_BINDING_MOTION) uniform texture2D motionImage;

const int kReach = PELLUCID_SHARE_REACH;
const float kReturnedReach = 2.0; // cells; the light that bodies return has no noise
// Squared cells at which a probe counts half. At the reach a probe counts a ninth: a mean whose ends count fully is grainy, because
// probes come in and fall out from cell to cell.
const float kHalfAway = 8.0;
const int kRow = PELLUCID_FILTER_GROUP + 2 * kReach;
const int kInside = PELLUCID_FILTER_GROUP * PELLUCID_FILTER_GROUP, kBorder = kRow * kRow - kInside;

shared uint fronts[kRow * kRow];  // as probes have planar distance and material, 0: nothing there
shared uvec4 found[kRow * kRow];  // as probes have light; the normal in halves, in place of the probes' own
shared uint someLight, someReturned;

// The cell's place in the shared arrays; `local`: the cell from the group's first one.
int placeOf(ivec2 local) { return (local.y + kReach) * kRow + local.x + kReach; }

// A cell takes 20 bytes, as every device has 16 KiB for a group.
void keepProbe(ivec2 local, uvec4 bits) {
  vec3 normal = normalOf(bits);
  fronts[placeOf(local)] = bits.z;
  found[placeOf(local)] = uvec4(bits.x, (bits.y & 0xFFFFu) | packHalf2x16(vec2(0.0, normal.x)), packHalf2x16(normal.yz),
                                bits.w);
}

// The i-th cell of the border: whole rows above and below come first, then the rest row by row.
ivec2 borderCell(int i) {
  bool whole = i < 2 * kReach * kRow;
  if (!whole) i -= 2 * kReach * kRow;
  int columns = whole ? kRow : 2 * kReach, across = i % columns, along = i / columns;
  int skips = (whole ? along : across) < kReach ? 0 : PELLUCID_FILTER_GROUP;
  return (whole ? ivec2(across, along + skips) : ivec2(across + skips, along + kReach)) - kReach;
}

// ---- The earlier frame

layout(constant_id = PELLUCID_CONSTANT_KEEPS_PROBES) const bool kKeeps = false;

// False in the first frame, and with reuse that does not accumulate.
bool accumulates() { return kKeeps && frame.motion.z > 0.0; }

const float kOwnFrame = 0.1;      // part of the frame's own light: a mean over ten frames, whose noise falls to sqrt(.1 / 1.9)
const float kSameFront = 0.02;    // of the distance, that a surface's may change in a frame: 1.2 m/s at 1 m and 60 frames a second
const float kSameFacing = 0.7;    // cosine between normals of both frames: beyond 45 degrees probes count less than half
const float kMostErrors = 3.0;    // standard errors of the mean over all that share: light that stays is within them in 99.7 % of frames
// The differences of few probes do not tell the error of their mean. The error then is this part of the light, about that of eight samples.
const float kLoneError = 0.1;
const float kFewShare = 0.1; // sum of squared weights of a mean over few, as over fewer than ten alike

// `light`, the mean of the probes around, averaged with the light that the earlier frame had at the probe's place, as far as that is
// within the mean's error: light that changed does not linger.
vec3 accumulated(uvec4 own, ivec2 cell, int side, vec3 light, vec3 standardError) {
  ProbePlace p = unpackPlace(own);
  ivec2 pixel = inImage(pixelInCell(cell, side, p.index));
  vec2 moved = texelFetch(motionImage, pixel, 0).xy * frame.motion.xy;
  const float kFar = 65536.0; // also no place at all
  if (!isWithin(moved.x + kFar, 0.0, 2.0 * kFar) || !isWithin(moved.y + kFar, 0.0, 2.0 * kFar)) return light;
  vec2 at = (vec2(pixel + frame.kept.xy) - moved) / float(side);
  ivec2 base = ivec2(floor(at)), moves = frame.kept.xy - frame.lattice.xy;
  // The earlier frame had the same rect of the image, and wrote all cells of it.
  ivec4 cells = cellsOf(uvec4(ivec4(frame.rect) + moves.xyxy), side);
  vec2 part = at - vec2(base);
  vec3 kept = vec3(0.0);
  float total = 0.0;
  [[unroll]] for (int i = 0; i < 4; ++i) {
    ivec2 corner = ivec2(i & 1, i >> 1), from = base + corner;
    if (!contains(cells, from)) continue;
    uvec4 bits = imageLoad(sharedImage, from + ivec2(0, frame.kept.z));
    ProbePlace q = unpackPlace(bits);
    vec2 linear = mix(1.0 - part, part, vec2(corner));
    bool same = q.material == p.material && abs(q.front - p.front) < kSameFront * abs(p.front) && dot(q.normal, p.normal) > kSameFacing;
    float weight = same ? linear.x * linear.y : 0.0;
    kept += mix(vec3(0.0), weight * addedOf(bits), bvec3(same)); // 0 times NaN is NaN
    total += weight;
  }
  if (total < 0.01) return light;
  kept *= frame.motion.z / total;
  vec3 most = kMostErrors * standardError;
  return mix(clamp(kept, light - most, light + most), light, kOwnFrame);
}

// ---- Sharing

// xy: direction of planar length 1, zw: origin of a pixel's view ray.
vec4 rayOf(vec2 pixel) { return frame.camera.rayBase + pixel.x * frame.camera.rayX + pixel.y * frame.camera.rayY; }

vec3 onRay(vec4 ray, uint front) {
  float planar = uintBitsToFloat(front & 0xFFFFFF00u);
  return vec3(ray.zw + planar * ray.xy, planar * frame.camera.range.x);
}

// The probe `own` with its filtered light. `perSquare`: falloff by distance, per squared scene unit.
uvec4 filtered(ivec2 local, ivec2 cell, int side, uvec4 own, float perSquare) {
  int center = placeOf(local);
  // A cell stands where its first pixel's ray does: direction and origin, as ViewRay has them.
  vec4 ownRay = rayOf(vec2(side * cell)), alongX = float(side) * frame.camera.rayX, alongY = float(side) * frame.camera.rayY;
  vec3 place = onRay(ownRay, fronts[center]), normal = vec3(unpackHalf2x16(found[center].y).y, unpackHalf2x16(found[center].z));
  float total = 0.0, squaredWeights = 0.0, totalReturned = 0.0;
  vec3 added = vec3(0.0), squares = vec3(0.0), returned = vec3(0.0);
  // Unrolled, these loops would not fit caches of instructions. Floats count cells, because conversions from integers are slow.
  [[dont_unroll]] for (float y = -float(kReach); y <= float(kReach); y += 1.0) {
    float x = abs(y) - float(kReach);
    vec4 ray = ownRay + y * alongY;
    int at = center + int(y) * kRow + int(x), last = at - 2 * int(x);
    [[dont_unroll]] for (; at <= last; ++at, x += 1.0) {
      float squared = x * x + y * y;
      uint front = fronts[at];
      uvec4 bits = found[at];
      vec3 apart = onRay(ray + x * alongX, front) - place;
      vec2 middle = unpackHalf2x16(bits.y);
      float facing = max(dot(vec3(middle.y, unpackHalf2x16(bits.z)), normal), 0.0);
      // The square keeps what surfaces turn over from being evened out: at 45 degrees a probe counts half.
      float falls = exp2(-squared / kHalfAway - dot(apart, apart) * perSquare) * facing * facing;
      float weight = (front & 0xFFu) == (own.z & 0xFFu) ? falls : 0.0;
      vec3 light = vec3(unpackHalf2x16(bits.x), middle.x);
      added += weight * light;
      if (accumulates()) squares += weight * light * light;
      if (squared <= kReturnedReach * kReturnedReach && someReturned != 0u) {
        returned += weight * returnedOf(bits);
        totalReturned += weight;
      }
      total += weight;
      squaredWeights += weight * weight;
    }
  }
  // The probe itself is among them.
  added /= total;
  if (accumulates()) {
    float alone = squaredWeights / (total * total); // 1: no other probe shares; about 1/40: all around do
    vec3 variance = max(squares / total - added * added, vec3(0.0)) * alone;
    added = accumulated(own, cell, side, added, sqrt(variance) + kLoneError * max(alone - kFewShare, 0.0) * abs(added));
  }
  own = withAdded(own, added);
  return someReturned != 0u ? withReturned(own, returned / totalReturned) : own;
}

// Filters the cells from `first` on, for all invocations, as they wait for each other.
void filterCells(ivec2 first, int side) {
  int index = int(gl_LocalInvocationIndex);
  ivec2 local = ivec2(gl_LocalInvocationID.xy), cell = first + local;
  uvec4 own = probeOf(foundImage, cell, side, 0);
  bool light = hasLight(own), returned = hasReturned(own);
  keepProbe(local, own);
  for (int i = index; i < kBorder; i += kInside) {
    ivec2 border = borderCell(i);
    uvec4 beside = probeOf(foundImage, first + border, side, 0);
    light = light || hasLight(beside);
    returned = returned || hasReturned(beside);
    keepProbe(border, beside);
  }
  if (index == 0) someLight = someReturned = 0u;
  barrier();
  if (light) someLight = 1u; // whoever writes, writes this
  if (returned) someReturned = 1u;
  barrier();
  bool shares = someLight != 0u;
  // Probes kept from another frame may name a material that this frame's list lacks: the index is checked before it addresses.
  uint material = own.z & 0xFFu;
  if (shares && material != 0u && material <= frame.flags.y) {
    float mm = frame.camera.range.w;
    own = filtered(local, cell, side, own, materials[material - 1u].gather.profile.w * mm * mm);
  }
  if (contains(cellsOf(frame.rect, side), cell)) imageStore(sharedImage, cell + ivec2(0, frame.lattice.w), own);
}

// The next frame may read any cell of the rect.
void clearCells(ivec2 first, int side) {
  ivec2 cell = first + ivec2(gl_LocalInvocationID.xy);
  if (contains(cellsOf(frame.rect, side), cell)) imageStore(sharedImage, cell + ivec2(0, frame.lattice.w), kNoProbe);
}

void main() {
  int side = int(pass.spacing);
  ivec2 first;
  // Frames that keep probes go over all blocks, as lists lack those without material.
  uint word = kKeeps ? gl_WorkGroupID.x : listedBlock(materialList());
  if (materialPart(word, ivec2(side * PELLUCID_FILTER_GROUP), first))
    filterCells(first / side, side);
  else if (kKeeps)
    clearCells(first / side, side);
}
