// R_l = (1 - s) E_l + s R_(l+1) from the coarsest level of the pyramid to level 2, s the profile's share of the coarser
// levels at the texel, and the shares of the pixels under level 2. A group makes 32 x 16 texels of level 2 and, before
// them, as much of each coarser level as they need. REDUCES: it makes levels 6 and 7 as well, from level 5.
#version 460
#extension GL_EXT_control_flow_attributes : require
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require

#define GROUP_SIDE PELLUCID_RESOLVE_GROUP
#include "passes/resolved.glsl"

layout(set = 0, binding = PELLUCID_BINDING_KERNELS) readonly buffer Kernels { KernelConstants kernels[]; };

// Resolved texels of level 3 and coarser ones, level after level; see Window. Color and material as packed, depth, and in
// place of the slope the share of the kernel that the surface fills, of each channel.
const int kResolved = 153 + 60 + 24 + 12 + 9;
#ifdef REDUCES
shared uvec4 resolved[kResolved + 73]; // and what is made
#else
shared uvec4 resolved[kResolved];
#endif

#ifdef REDUCES
// Sides of what a group needs of level 5 to make level 6, and of that to make level 7.
const int kSide5 = 18, kSide6 = 8;

shared uvec2 colors[kSide5 * kSide5];
shared float depths[kSide5 * kSide5];
shared uint needsMade;
const int kMade = kResolved; // in resolved[], texels of level 6 and then, 3 x 3, of level 7

#include "passes/reduced.glsl"
#endif

// What a group needs of a level. Groups start at texels 16 k - 1 of level 2, k.x even, so that these are the same
// everywhere.
struct Window {
  ivec2 corner; // first texel
  int columns;  // texels
  int first;    // in resolved[]
};

Window windowOf(uint level, ivec2 k) {
  if (level == 3u) return Window(8 * k - 1, 17, 0);
  if (level == 4u) return Window(4 * k - 1, 10, 153);
  if (level == 5u) return Window(2 * k - 1, 6, 213);
  if (level == 6u) return Window(k - 1, 4, 237);
  return Window((k - 2) >> 1, 3, 249);
}

// In resolved[], of a texel in the window.
int indexOf(Window window, ivec2 texel) {
  ivec2 at = texel - window.corner;
  return window.first + at.y * window.columns + at.x;
}

// The other way round, from the window's first one on.
ivec2 texelOf(Window window, int index) {
  int row = int((float(index) + 0.5) / float(window.columns));
  return window.corner + ivec2(index - row * window.columns, row);
}

#ifdef REDUCES
// First texel of level 6 or 7 that the group makes.
ivec2 firstMade(uint level, ivec2 k) {
  ivec2 last = windowOf(7u, k).corner;
  return level == 6u ? 2 * last - 1 : last;
}
#endif

// Whether the group can tell what a texel around its window is. Of levels that it makes it knows few others.
bool known(uint level, ivec2 texel, ivec2 k) {
#ifdef REDUCES
  if (level > 5u) {
    ivec2 at = texel - firstMade(level, k);
    return all(greaterThanEqual(at, ivec2(0))) && all(lessThan(at, ivec2(level == 6u ? kSide6 : 3)));
  }
#endif
  return true;
}

uvec4 texelAt(uint level, ivec2 texel, ivec2 k) {
#ifdef REDUCES
  if (level > 5u) {
    ivec2 at = texel - firstMade(level, k);
    return resolved[kMade + (level == 6u ? at.y * kSide6 + at.x : kSide6 * kSide6 + at.y * 3 + at.x)];
  }
#endif
  return texelFetch(pyramidImage, inAtlas(level, texel), 0);
}

void writeResolved(ivec2 texel, uvec4 color, uvec4 shares) {
  imageStore(levelsDestination, resolvedPlace(texel), color);
  imageStore(levelsDestination, sharesPlace(texel), shares);
}

// Place of a length on the surface among a material's shares, see KernelConstants.
float shareEntry(uint m, float lengthMm) {
  // The floor keeps log2 finite where the camera gives a pixel no size.
  float at = (log2(max(lengthMm, 1.0e-30)) - kernels[m].range.x) * kernels[m].range.y;
  return clamp(at, 0.0, float(PELLUCID_SHARE_ENTRIES - 1));
}

// Of level `level` and coarser ones, the share of the coarser ones at texels with this entry.
vec3 coarserShare(uint m, uint level, float entry) {
  uint i = min(uint(entry), uint(PELLUCID_SHARE_ENTRIES - 2));
  uint first = min(level - 2u, uint(PELLUCID_SHARE_COARSER)) * uint(PELLUCID_SHARE_ENTRIES) + i;
  return mix(kernels[m].share[first].rgb, kernels[m].share[first + 1u].rgb, entry - float(i));
}

const int kReach = 4; // of the stretch, texels

// A level's kernel has variance 7/12 - 13/12 4^-level squared texels of an axis; foreshortened surfaces need it
// longer along one axis: a 1-D Gaussian of what is missing, at the texels nearest to the axis.
vec4 stretched(ivec2 texel, uint level, ivec2 k, Texel own, Foreshortening f) {
  vec4 sum = own.mass * vec4(own.color, 1.0);
  float variance = (7.0 / 12.0 - 13.0 / 12.0 * exp2(-2.0 * float(level))) * f.stretch;
  bool alongX = abs(f.axis.x) >= abs(f.axis.y);
  float dominant = alongX ? f.axis.x : f.axis.y; // its square is at least 1/2
  float gradient = (alongX ? f.axis.y : f.axis.x) / dominant;
  variance = min(variance * dominant * dominant, float(kReach));
  if (own.mass == 0.0 || variance < 0.02) return sum;
  float weights = 1.0;
  vec2 size = texelSize(own.depth, level);
  float spread2 = inverseSpread(own.slope, size);
  ivec4 rect = levelRect(level);
  // Of the next texels. A narrow Gaussian at texels' centers alone has next to none of its variance; two taps beside one have all
  // of it, up to where both are alike.
  float next = max(exp(-0.5 / variance), min(0.5 * variance / (1.0 - min(variance, 0.5)), 0.17));
  // Three standard deviations.
  int reach = min(int(ceil(3.0 * sqrt(variance))), kReach);
  for (int i = 1; i <= reach; ++i) {
    float weight = pow(next, float(i * i));
    int across = int(floor(gradient * float(i) + 0.5));
    ivec2 offset = alongX ? ivec2(i, across) : ivec2(across, i);
    // Both sides at once, so that their latencies overlap.
    uvec4 bits[2];
    [[unroll]] for (int side = 0; side < 2; ++side) {
      ivec2 at = texel + (1 - 2 * side) * offset;
      bool isKnown = known(level, at, k);
      weights += isKnown ? weight : 0.0;
      bits[side] = isKnown && contains(rect, at) ? texelAt(level, at, k) : uvec4(0u);
    }
    [[unroll]] for (int side = 0; side < 2; ++side) {
      Texel t = unpackTexel(bits[side]);
      float along = dot(own.slope, vec2((1 - 2 * side) * offset) * size);
      float w = weight * t.mass * sameSurface(t.depth - own.depth - along, along, spread2, kStretchFalloff);
      sum += (t.mass != 0.0 && t.material == own.material ? w : 0.0) * vec4(t.color, 1.0);
    }
  }
  return sum / weights;
}

// What a texel's level says of it, without the coarser ones.
struct Own {
  Texel texel;
  vec4 here;  // the level's own part, times the share of its kernel that the surface fills, which is in a
  vec3 share; // of the coarser levels
};

// Without branches, so that what is looked up is waited for once.
Own ownPart(uint level, ivec2 texel, ivec2 k, uvec4 bits, out Foreshortening f) {
  Own own;
  own.texel = unpackTexel(bits);
  f = foreshortening(texel, level, own.texel.depth, own.texel.slope);
  // A plane fills all of its kernel, however its area was rounded.
  float area = isPlane(bits) ? own.texel.mass : areaOf(level, texel, own.texel.slope);
  own.here = stretched(texel, level, k, own.texel, f) / area;
  // Material 0 looks at what it does not use.
  uint m = max(own.texel.material, 1u) - 1u;
  own.share = coarserShare(m, level, shareEntry(m, f.lengthMm));
  return own;
}

struct Level {
  vec3 color, density; // share of the kernel that the surface fills, of each channel
};

Level alone(Own own) {
  return Level(own.here.a > 0.0 ? own.here.rgb / own.here.a : own.texel.color, vec3(own.here.a));
}

// `window`: of the coarser level, which is resolved.
Level withCoarser(Own own, uint level, ivec2 texel, Window window) {
  // 9, 3, 3 and 1 sixteenths of the four nearest: the refinement of the quadratic B-spline.
  ivec2 nearest = texel >> 1, toward = 2 * (texel & 1) - 1;
  vec2 size = texelSize(own.texel.depth, level + 1u);
  float spread2 = inverseSpread(own.texel.slope, size);
  vec3 coarser = vec3(0.0), found = vec3(0.0);
  [[unroll]] for (int i = 0; i < 4; ++i) {
    ivec2 at = nearest + toward * ivec2(i & 1, i >> 1);
    uvec4 theirs = resolved[indexOf(window, at)];
    vec2 off = vec2(at) + 0.5 - 0.5 * (vec2(texel) + 0.5);
    float w = (i == 0 ? 9.0 / 16.0 : i == 3 ? 1.0 / 16.0 : 3.0 / 16.0) / kDensityOne;
    float along = dot(own.texel.slope, off * size);
    w *= sameSurface(uintBitsToFloat(theirs.z) - own.texel.depth - along, along, spread2, kResolveFalloff);
    w = materialBits(theirs) == own.texel.material ? w : 0.0;
    vec3 density = w * unpackDensity(theirs.w);
    coarser += density * unpackColor(theirs.xy);
    found += density;
  }
  // Both are weighted with the density that they found, which renormalizes at silhouettes and borders.
  vec3 density = (1.0 - own.share) * own.here.a + own.share * found;
  vec3 here = (1.0 - own.share) * own.here.rgb, light = here + own.share * coarser;
  // Where a channel has nothing here, the level's own color stands in: the finer level weights it with 0.
  vec3 color = mix(own.texel.color, light / max(density, vec3(1.0e-6)), greaterThan(density, vec3(1.0e-6)));
  return Level(color, density);
}

// Parts of all energy at pixels with this entry, `element` as in KernelConstants::pixelShare.
vec3 beyondPixel(uint m, uint element, float entry) {
  entry = max(entry, 0.0);
  uint i = min(uint(entry), uint(PELLUCID_SHARE_ENTRIES - 2)), first = uint(PELLUCID_PIXEL_SHARES) * i + element;
  vec3 next = kernels[m].pixelShare[first + uint(PELLUCID_PIXEL_SHARES)].rgb;
  return mix(kernels[m].pixelShare[first].rgb, next, entry - float(i));
}

// Of pixels of a texel of level 2, on a surface that fills all of the kernel. By how many octaves the kernel's longest side is
// longer than its shortest, which the level goes by, and how much of that goes for the pixel, its neighbors and level 2, was
// fitted on tilted planes, for kernels along rows or columns and along diagonals. Next to silhouettes, where surfaces bend
// away from their tangent planes, it is none.
PixelShares pixelShares(uint m, Foreshortening f) {
  // The stretch is >= 0 but for rounding.
  float longer = 0.5 * log2(1.0 + max(f.stretch, 0.0)), octaves = clamp(2.5 - longer, 0.0, min(longer, 1.0));
  // A length of a pixel is a quarter of a texel's.
  float entry = shareEntry(m, 0.25 * f.lengthMm), perOctave = kernels[m].range.y * octaves;
  // 1: along rows or columns, 0: along a diagonal.
  float straight = abs(f.axis.x * f.axis.x - f.axis.y * f.axis.y);
  vec3 coarser = beyondPixel(m, 0u, entry - perOctave * (0.3 - 0.15 * straight));
  vec3 both = max(beyondPixel(m, 1u, entry - perOctave * (0.5 - 0.5 * straight)), coarser);
  vec3 beyond = max(beyondPixel(m, 1u, entry - 0.5 * perOctave), both);
  // What one Gaussian asks for may be more than all.
  vec3 fine = min((beyond - coarser) / max(1.0 - coarser, vec3(1.0e-3)), vec3(kMostFine));
  float wider = min(exp2(octaves) - 1.0, 1.0) * straight;
  FineShape shape = FineShape(abs(f.axis.x) < abs(f.axis.y) ? -wider : wider,
                              (beyond - both) / max(beyond - coarser, vec3(1.0e-6)));
  return PixelShares(coarser, fine, shape);
}

#ifdef REDUCES
// Of all energy: what a plane of 82 pixels' radius has beyond level 5, where a plan that knows radii begins to use level 6.
const float kLeastBeyondMade = 0.004;

// Whether a texel of level 5 has energy at coarser levels. Where the plan does not know how large radii are, most have next to
// none.
bool reachesBeyond(ivec2 texel, uvec4 bits) {
  if (!hasSurface(bits)) return false;
  uint m = materialBits(bits) - 1u;
  Foreshortening f = foreshortening(texel, 5u, uintBitsToFloat(bits.z), unpackHalf2x16(bits.w));
  vec3 beyond = vec3(1.0);
  [[unroll]] for (uint level = 2u; level <= 5u; ++level)
    beyond *= coarserShare(m, level, shareEntry(m, f.lengthMm * exp2(float(level) - 5.0)));
  return any(greaterThan(beyond, vec3(kLeastBeyondMade)));
}

// Levels 6 and 7 where windows of group k are, before others need them.
void makeLevels(ivec2 k, int invocation) {
  ivec2 first7 = firstMade(7u, k), first6 = firstMade(6u, k), first5 = 2 * first6 - 1;
  for (int i = invocation; i < kSide5 * kSide5; i += PELLUCID_RESOLVE_GROUP * PELLUCID_RESOLVE_GROUP) {
    ivec2 at = ivec2(i % kSide5, i / kSide5), texel = first5 + at;
    uvec4 bits = contains(levelRect(5u), texel) ? texelFetch(pyramidImage, inAtlas(5u, texel), 0) : uvec4(0u);
    colors[slot(at, kSide5)] = bits.xy;
    depths[slot(at, kSide5)] = uintBitsToFloat(bits.z);
  }
  barrier();
  // In a loop, as one reduction in the code takes fewer registers than two.
  for (uint finer = 5u; finer < 7u; ++finer) {
    bool isFirst = finer == 5u;
    int side = isFirst ? kSide6 : 3, width = isFirst ? kSide5 : kSide6;
    ivec2 at = ivec2(invocation % side, invocation / side), texel = (isFirst ? first6 : first7) + at;
    bool makes = at.y < side && contains(levelRect(finer + 1u), texel);
    uvec4 bits = makes ? reduced(finer, texel, 2 * at.y * width + at.x, width) : uvec4(0u);
    barrier();
    if (at.y < side) {
      resolved[(isFirst ? kMade : kMade + kSide6 * kSide6) + invocation] = bits;
      if (isFirst) {
        colors[slot(at, side)] = bits.xy;
        depths[slot(at, side)] = uintBitsToFloat(bits.z);
      }
    }
    barrier();
  }
}
#endif

uvec4 packLevel(Level r, uvec4 bits) {
  return uvec4(packColor(r.color, bits.y >> 16), bits.z, packDensity(r.density));
}

// A texel of level 2 and its pixels' shares.
void resolveFine(ivec2 texel, ivec2 k, uvec4 bits) {
  if (!contains(levelRect(2u), texel)) return;
  uvec4 color = uvec4(0u, bits.y & 0xFFFF0000u, 0u, 0u), shares = uvec4(0u);
  if (hasSurface(bits)) {
    Foreshortening f;
    Own own = ownPart(2u, texel, k, bits, f);
    uint m = own.texel.material - 1u;
    Level r = withCoarser(own, 2u, texel, windowOf(3u, k));
    uint upper = bits.y >> 16 & ~(kPlane >> 16);
    color = uvec4(packColor(r.color, (bits.x & kFlat) != 0u ? upper | kPlane >> 16 : upper), bits.zw);
    PixelShares share = pixelShares(m, f);
    share.coarser = share.coarser * r.density / max(1.0 - share.coarser + share.coarser * r.density, vec3(1.0e-6));
    shares = uvec4(packShares(share), packDensity(r.density) | (isPlane(bits) ? kFull : 0u));
  }
  writeResolved(texel, color, shares);
}

void main() {
  int invocation = int(gl_LocalInvocationIndex);
  uint coarsest = pass.value.x;
  // An invocation does two texels of level 2 and, before them, one of levels 3 to 6. The first ones have level 7, too.
  ivec2 k = (((levelRect(2u).xy + 1) >> ivec2(5, 4)) + ivec2(gl_WorkGroupID.xy)) * ivec2(2, 1);
  ivec2 fine = 16 * k - 1 + ivec2(gl_LocalInvocationID.xy), nextFine = fine + ivec2(PELLUCID_RESOLVE_GROUP, 0);
  uint level = 3u + uint(invocation >= 153) + uint(invocation >= 213) + uint(invocation >= 237);
  Window window = windowOf(level, k), last = windowOf(7u, k);
  bool within = invocation < last.first, hasLast = last.first + invocation < kResolved;
  ivec2 texel = texelOf(window, invocation - window.first), lastTexel = texelOf(last, invocation);
  bool inside = level <= coarsest && within && contains(levelRect(level), texel);
  bool lastInside = coarsest == 7u && hasLast && contains(levelRect(7u), lastTexel);
  bool fetches = inside, fetchesLast = lastInside;
#ifdef REDUCES
  if (invocation == 0) needsMade = 0u;
  fetches = fetches && level <= 5u;
  fetchesLast = false;
#endif
  // All before the first is used.
  uvec4 bits = fetches ? texelFetch(pyramidImage, inAtlas(level, texel), 0) : uvec4(0u);
  uvec4 lastBits = fetchesLast ? texelFetch(pyramidImage, inAtlas(7u, lastTexel), 0) : uvec4(0u);
  uvec4 fineBits = contains(levelRect(2u), fine) ? texelFetch(pyramidImage, inAtlas(2u, fine), 0) : uvec4(0u);
  uvec4 nextBits = contains(levelRect(2u), nextFine) ? texelFetch(pyramidImage, inAtlas(2u, nextFine), 0) : uvec4(0u);
#ifdef REDUCES
  barrier();
  if (level == 5u && reachesBeyond(texel, bits)) needsMade = 1u; // whoever writes, writes this
  barrier();
  if (needsMade != 0u) {
    makeLevels(k, invocation);
    if (inside && level == 6u) bits = texelAt(6u, texel, k);
    if (lastInside) lastBits = texelAt(7u, lastTexel, k);
  } else {
    coarsest = 5u;
  }
#endif
  Foreshortening unused;
  if (coarsest == 7u && hasLast) {
    Own own = ownPart(7u, lastTexel, k, lastBits, unused);
    resolved[last.first + invocation] = own.texel.mass > 0.0 ? packLevel(alone(own), lastBits) : uvec4(0u);
  }
  Own own = ownPart(level, texel, k, bits, unused);
  for (uint l = min(coarsest, 6u); l > 2u; --l) {
    barrier();
    if (level == l && within) {
      Level r = l == coarsest ? alone(own) : withCoarser(own, level, texel, windowOf(level + 1u, k));
      resolved[invocation] = own.texel.mass > 0.0 ? packLevel(r, bits) : uvec4(0u);
    }
  }
  barrier();
  // In a loop, because both in a row are a third more code and no faster.
  for (int i = 0; i < 2; ++i) {
    resolveFine(fine, k, fineBits);
    fine = nextFine;
    fineBits = nextBits;
  }
}
