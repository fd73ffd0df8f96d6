// Computes U_l = (1 - s) E_l + s U_(l+1), s the coarser levels' share of the profile, from the coarsest level of the pyramid to
// level 2, and the shares of level 2's pixels. A group makes the 16 x 16 texels of level 2 of a block and, before them, what
// they need of each coarser level.
#version 460
#extension GL_GOOGLE_include_directive : require

#define GROUP_SIDE PELLUCID_BLOCK_GROUP
#include "diffusion/profile.glsl"

const int kInvocations = GROUP_SIDE * GROUP_ROWS;

layout(push_constant) uniform Pass { UpsamplePass pass; };
layout(set = 0, binding = PELLUCID_BINDING_COARSER_LEVELS) uniform utexture2D coarserLevelsImage; // 4 to 7; pyramidImage has 2 and 3

uvec4 levelTexel(uint level, ivec2 texel) {
  if (level < 4u) return writtenTexel(level, texel);
  return contains(levelRect(level), texel) ? texelFetch(coarserLevelsImage, inAtlas(level, texel), 0) : uvec4(0u);
}

// ---- Parts of coarser levels that the group holds, whose texels have been upsampled: color and material as packed, depth and, in
// place of the slope, the kernel coverage of each channel

struct Window {
  ivec2 corner; // first texel
  int columns;  // texels, and as many rows
  int first;    // in upsampled[]
};

// A block has 8 x 8 texels of level 3, 4 x 4 of level 4 and so on, and its windows one more on each side.
const int kFirst4 = 10 * 10, kFirst5 = kFirst4 + 6 * 6, kFirst6 = kFirst5 + 4 * 4, kFirst7 = kFirst6 + 3 * 3, kUpsampled = kFirst7 + 3 * 3;
shared uvec4 upsampled[kUpsampled];
shared uvec4 fineTexels[kInvocations]; // of level 2, each of the invocation that writes and reads it: registers limit how many groups run

// `k`: the block. A texel takes the two nearest coarser ones along each axis.
Window windowOf(uint level, ivec2 k) {
  if (level == 3u) return Window(8 * k - 1, 10, 0);
  if (level == 4u) return Window(4 * k - 1, 6, kFirst4);
  if (level == 5u) return Window(2 * k - 1, 4, kFirst5);
  if (level == 6u) return Window(k - 1, 3, kFirst6);
  return Window((k >> 1) - 1, 3, kFirst7);
}

// Level of a place in upsampled[].
uint levelOf(int place) {
  return 3u + uint(place >= kFirst4) + uint(place >= kFirst5) + uint(place >= kFirst6) + uint(place >= kFirst7);
}

int indexOf(Window window, ivec2 texel) {
  ivec2 at = texel - window.corner;
  return window.first + at.y * window.columns + at.x;
}

// ---- A level's own part of the kernel, and the coarser levels under it

// Texels to both sides that the stretch reads, eight in all: kernels widen in full up to 69 degrees from facing the camera.
const int kReach = 4;
// Variance of the stretch, squared texels, from which on it runs. Below, a texel beside has less than 1 % of the weight: areas are rounded by more.
const float kLeastVariance = 0.02;

// Foreshortened surfaces need a level's kernel longer along one axis: the filter is a 1-D Gaussian of what is missing, at the
// texels nearest to the axis.
vec4 stretched(ivec2 texel, uint level, Texel own, Foreshortening f) {
  vec4 sum = own.area * vec4(own.color, 1.0);
  float variance = (PELLUCID_LEVEL_VARIANCE_SCALE + PELLUCID_LEVEL_VARIANCE_REST * exp2(-2.0 * float(level))) * f.stretch;
  bool alongX = abs(f.axis.x) >= abs(f.axis.y);
  float dominant = alongX ? f.axis.x : f.axis.y; // its square is at least 1/2
  float gradient = (alongX ? f.axis.y : f.axis.x) / dominant;
  variance = min(variance * dominant * dominant, float(kReach));
  if (own.area == 0.0 || variance < kLeastVariance) return sum;
  float weights = 1.0;
  vec2 size = texelSize(own.depth, level);
  vec2 ray = facingRayAt(pixelOf(level, texel));
  TangentPlane plane = tangentPlane(own.slope, ray, inverseSpread(own.slope, ray, size));
  // The weight of the next texels. A narrow Gaussian at texels' centers alone has next to none of its variance; two taps
  // beside one have all of it, up to where both are alike: taps of .17 have a variance of 1/4, a Gaussian of .28 has that weight.
  float next = max(exp(-0.5 / variance), min(0.5 * variance / (1.0 - min(variance, 0.5)), 0.17));
  int reach = min(int(ceil(3.0 * sqrt(variance))), kReach); // three standard deviations
  for (int i = 1; i <= reach; ++i) {
    float weight = pow(next, float(i * i));
    int across = int(floor(gradient * float(i) + 0.5));
    ivec2 offset = alongX ? ivec2(i, across) : ivec2(across, i);
    // Both sides are looked up at once, so that their latencies overlap.
    uvec4 bits[2];
    [[unroll]] for (int side = 0; side < 2; ++side) {
      ivec2 at = texel + (1 - 2 * side) * offset;
      weights += weight;
      bits[side] = levelTexel(level, at);
    }
    [[unroll]] for (int side = 0; side < 2; ++side) {
      Texel t = unpackTexel(bits[side]);
      vec2 x = vec2((1 - 2 * side) * offset) * size;
      float w = weight * t.area * tangentPlaneWeight(plane, t.depth - own.depth - dot(own.slope, x), x, kStretchFalloff);
      sum += (t.area != 0.0 && t.material == own.material ? w : 0.0) * vec4(t.color, 1.0);
    }
  }
  return sum / weights;
}

// A texel's own level, without the coarser ones.
struct Own {
  Texel texel;
  vec4 here;  // the level's own part, times its kernel coverage, which is in a
  vec3 share; // of the coarser levels
  Foreshortening foreshortening;
};

// All texels load before this function, except the stretch's, so that the invocation waits for memory once.
Own ownPart(uint level, ivec2 texel, uvec4 bits) {
  Own own;
  own.texel = unpackTexel(bits);
  Foreshortening f = foreshortening(texel, level, own.texel.depth, own.texel.slope);
  // A plane fills all of its kernel, however its area was rounded.
  float area = isPlane(bits) ? own.texel.area : areaOf(level, texel, own.texel.slope);
  own.here = stretched(texel, level, own.texel, f) / area;
  // Material 0 looks up what it does not use.
  uint m = max(own.texel.material, 1u) - 1u;
  own.share = coarserShare(m, level, shareEntry(m, f.lengthMm));
  own.foreshortening = f;
  return own;
}

struct Level {
  vec3 color, coverage; // kernel coverage of each channel
};

uvec4 packLevel(Level r, uvec4 bits) {
  return uvec4(packColor(r.color, bits.y >> 16), bits.z, packCoverage(r.coverage));
}

Level alone(Own own) {
  return Level(own.here.a > 0.0 ? own.here.rgb / own.here.a : own.texel.color, vec3(own.here.a));
}

// `window`: of the coarser level, which has been upsampled.
Level withCoarser(Own own, uint level, ivec2 texel, Window window) {
  // The refinement, of the four nearest.
  const float kNear = PELLUCID_REFINEMENT_NEAR, kFar = PELLUCID_REFINEMENT_FAR;
  ivec2 nearest = texel >> 1, toward = 2 * (texel & 1) - 1;
  vec2 size = texelSize(own.texel.depth, level + 1u);
  vec2 slope = own.texel.slope, ray = facingRayAt(pixelOf(level, texel));
  TangentPlane plane = tangentPlane(slope, ray, inverseSpread(slope, ray, size));
  vec3 coarser = vec3(0.0), found = vec3(0.0);
  [[dont_unroll]] for (int i = 0; i < 4; ++i) {
    ivec2 at = nearest + toward * ivec2(i & 1, i >> 1);
    uvec4 theirs = upsampled[indexOf(window, at)];
    vec2 x = (vec2(at) + 0.5 - 0.5 * (vec2(texel) + 0.5)) * size;
    float w = (i == 0 ? kNear * kNear : i == 3 ? kFar * kFar : kNear * kFar) / kCoverageOne;
    w *= tangentPlaneWeight(plane, uintBitsToFloat(theirs.z) - own.texel.depth - dot(slope, x), x, kUpsampleFalloff);
    w = materialBits(theirs) == own.texel.material ? w : 0.0;
    vec3 coverage = w * unpackCoverage(theirs.w);
    coarser += coverage * unpackHalves(theirs.xy);
    found += coverage;
  }
  // Coverage weights both parts, which renormalizes at silhouettes and borders.
  vec3 coverage = (1.0 - own.share) * own.here.a + own.share * found;
  vec3 here = (1.0 - own.share) * own.here.rgb, light = here + own.share * coarser;
  // The level's own color stands in for a channel that has nothing here: the finer level weights it with 0.
  vec3 color = mix(own.texel.color, light / max(coverage, vec3(1.0e-6)), greaterThan(coverage, vec3(1.0e-6)));
  return Level(color, coverage);
}

// ---- Level 2

void writeUpsampled(ivec2 texel, uvec4 color, uvec4 shares) {
  imageStore(levelsDestination, upsampledPlace(texel), color);
  imageStore(levelsDestination, sharesPlace(texel), shares);
}

// `bits`: the texel of the pyramid.
void writeFine(ivec2 texel, uvec4 bits, Own own, Level r) {
  if (!hasSurface(bits)) {
    writeUpsampled(texel, uvec4(0u, bits.y & 0xFFFF0000u, 0u, 0u), uvec4(0u));
    return;
  }
  uint upper = bits.y >> 16 & ~(kPlane >> 16);
  PixelShares share = pixelShares(own.texel.material - 1u, own.foreshortening);
  if ((bits.x & kFlat) != 0u) {
    upper |= kPlane >> 16;
    share.rest /= max(share.rest + (1.0 - share.rest) * r.coverage, vec3(1.0e-6)); // a small plane has not all of the kernel
  }
  writeUpsampled(texel, uvec4(packColor(r.color, upper), bits.zw), uvec4(packShares(share), packCoverage(r.coverage)));
}

void main() {
  int invocation = int(gl_LocalInvocationIndex);
  uint coarsest = pass.coarsest, level = levelOf(invocation);
  ivec2 k = firstPixel(blockOf(listedBlock(nearList()))) >> kBlockShift, fine = 16 * k + ivec2(gl_LocalInvocationID.xy);
  // An invocation does a texel of level 2 and, before it, one of a coarser level.
  Window window = windowOf(level, k);
  int place = invocation - window.first;
  ivec2 texel = window.corner + ivec2(place % window.columns, place / window.columns);
  bool inside = level <= coarsest && invocation < kUpsampled;
  // All loads come before the first use.
  uvec4 bits = inside ? levelTexel(level, texel) : uvec4(0u);
  fineTexels[invocation] = levelTexel(2u, fine);
  Own own;
  [[dont_unroll]] for (uint l = coarsest; l > 1u; --l) {
    if (l == 2u) {
      level = 2u;
      texel = fine;
      bits = fineTexels[invocation];
      inside = contains(levelRect(2u), fine);
    }
    if (l == coarsest || l == 2u) own = ownPart(level, texel, bits); // of all coarser levels at once
    if (level == l && inside) {
      Level r = l == coarsest ? alone(own) : withCoarser(own, l, texel, windowOf(l + 1u, k));
      if (l == 2u)
        writeFine(texel, bits, own, r);
      else
        upsampled[invocation] = hasSurface(bits) ? packLevel(r, bits) : uvec4(0u);
    }
    barrier();
  }
}
