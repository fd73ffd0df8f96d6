// R_l = (1 - s) E_l + s R_(l+1) from the coarsest level of the pyramid to level 2, s the profile's share of the coarser
// levels at the texel, and the shares of the pixels under level 2. A group makes 32 x 32 texels of level 2 and, before
// them, as much of each coarser level as they need.
#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require

#define GROUP_SIDE PELLUCID_RESOLVE_GROUP
#include "passes/resolved.glsl"

layout(set = 0, binding = PELLUCID_BINDING_KERNELS) readonly buffer Kernels { KernelConstants kernels[]; };

const int kInvocations = PELLUCID_RESOLVE_GROUP * PELLUCID_RESOLVE_GROUP;
// Of 32 texels in a row, what level 3 needs, and level 4. Coarser levels need less.
const int kOdd = 18, kEven = 11;
// Resolved texels: color and material as packed, depth, and the share of the kernel that the surface fills, of each
// channel, in place of the slope.
shared uvec4 odd[kOdd * kOdd];
shared uvec4 even[kEven * kEven];

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
vec4 stretched(ivec2 texel, uint level, Texel own, Foreshortening f) {
  vec4 sum = own.coverage * vec4(own.color, 1.0);
  float variance = (7.0 / 12.0 - 13.0 / 12.0 * exp2(-2.0 * float(level))) * f.stretch;
  bool alongX = abs(f.axis.x) >= abs(f.axis.y);
  float dominant = alongX ? f.axis.x : f.axis.y; // its square is at least 1/2
  float gradient = (alongX ? f.axis.y : f.axis.x) / dominant;
  variance = min(variance * dominant * dominant, float(kReach));
  if (variance < 0.02) return sum;
  float weights = 1.0;
  vec2 size = texelSize(own.depth, level);
  float spread2 = inverseSpread(own.slope, size);
  ivec4 rect = levelRect(level);
  // Three standard deviations.
  int reach = min(int(ceil(3.0 * sqrt(variance))), kReach);
  for (int i = -reach; i <= reach; ++i) {
    if (i == 0) continue;
    int across = int(floor(gradient * float(i) + 0.5));
    ivec2 offset = alongX ? ivec2(i, across) : ivec2(across, i);
    float w = exp(-0.5 * float(i * i) / variance);
    weights += w;
    if (!insideLevel(rect, texel + offset)) continue;
    Texel t = unpackTexel(texelFetch(pyramidImage, inAtlas(level, texel + offset), 0));
    if (t.coverage == 0.0 || t.material != own.material) continue;
    w *= t.coverage * sameSurface(t.depth - own.depth - dot(own.slope, vec2(offset) * size), spread2);
    sum += w * vec4(t.color, 1.0);
  }
  return sum / weights;
}

struct Level {
  vec3 color, density; // share of the kernel that the surface fills, of each channel
  float lengthMm;      // of the texel, see Foreshortening
};

// `window`: texels of the coarser level, whose texels are in shared memory.
Level resolvedLevel(uint level, ivec2 texel, Texel own, bool coarsest, ivec4 window) {
  Foreshortening f = foreshortening(vec2(texel), level, own.depth, own.slope);
  vec4 here = stretched(texel, level, own, f);
  if (coarsest) return Level(here.a > 0.0 ? here.rgb / here.a : own.color, vec3(here.a), f.lengthMm);
  // 9, 3, 3 and 1 sixteenths of the four nearest: the refinement of the quadratic B-spline.
  ivec2 nearest = texel >> 1, toward = 2 * (texel & 1) - 1;
  vec2 size = texelSize(own.depth, level + 1u);
  float spread2 = inverseSpread(own.slope, size);
  vec3 coarser = vec3(0.0), found = vec3(0.0);
  for (int i = 0; i < 4; ++i) {
    ivec2 at = nearest + toward * ivec2(i & 1, i >> 1);
    int index = (at.y - window.y) * (window.z - window.x) + at.x - window.x;
    uvec4 theirs = (level & 1u) == 0u ? odd[index] : even[index];
    if (materialBits(theirs) != own.material) continue;
    vec2 off = vec2(at) + 0.5 - 0.5 * (vec2(texel) + 0.5);
    float w = i == 0 ? 9.0 / 16.0 : i == 3 ? 1.0 / 16.0 : 3.0 / 16.0;
    w *= sameSurface(uintBitsToFloat(theirs.z) - own.depth - dot(own.slope, off * size), spread2);
    vec3 density = w * unpackUnorm4x8(theirs.w).rgb;
    coarser += density * unpackColor(theirs.xy);
    found += density;
  }
  vec3 share = coarserShare(own.material - 1u, level, shareEntry(own.material - 1u, f.lengthMm));
  // Both are weighted with the density that they found, which renormalizes at silhouettes and borders.
  vec3 density = (1.0 - share) * here.a + share * found;
  // Where a channel has nothing here, the level's own color stands in: the finer level weights it with 0.
  vec3 color = mix(own.color, ((1.0 - share) * here.rgb + share * coarser) / max(density, vec3(1.0e-6)),
                   greaterThan(density, vec3(1.0e-6)));
  return Level(color, density, f.lengthMm);
}

PixelShares pixelShares(uint m, float lengthMm, vec3 density) {
  float entry = shareEntry(m, lengthMm);
  uint i = min(uint(entry), uint(PELLUCID_SHARE_ENTRIES - 2));
  float part = entry - float(i);
  PixelShares s;
  s.coarser = mix(kernels[m].pixelShare[2u * i].rgb, kernels[m].pixelShare[2u * i + 2u].rgb, part);
  s.fine = mix(kernels[m].pixelShare[2u * i + 1u].rgb, kernels[m].pixelShare[2u * i + 3u].rgb, part);
  s.coarser = s.coarser * density / max(1.0 - s.coarser + s.coarser * density, vec3(1.0e-6));
  return s;
}

void main() {
  int invocation = int(gl_LocalInvocationIndex);
  uint coarsest = pass.value.x;
  ivec2 tile = levelRect(2u).xy + PELLUCID_RESOLVE_TILE * ivec2(gl_WorkGroupID.xy);
  ivec4 coarser = ivec4(0);
  for (uint level = coarsest; level >= 2u; --level) {
    ivec4 window = ivec4(tile, tile + PELLUCID_RESOLVE_TILE), rect = levelRect(level);
    for (uint l = 2u; l < level; ++l) window = ivec4((window.xy - 1) >> 1, (window.zw >> 1) + 1);
    int width = window.z - window.x, count = width * (window.w - window.y);
    for (int i = invocation; i < count; i += kInvocations) {
      ivec2 texel = window.xy + ivec2(i % width, i / width);
      bool inside = insideLevel(rect, texel);
      uvec4 bits = inside ? texelFetch(pyramidImage, inAtlas(level, texel), 0) : uvec4(0u);
      bool some = coverageBits(bits) != 0u;
      Level r = Level(vec3(0.0), vec3(0.0), 0.0);
      if (some) r = resolvedLevel(level, texel, unpackTexel(bits), level == coarsest, coarser);
      uvec2 color = packColor(r.color, bits.y >> 16);
      uint density = packUnorm4x8(vec4(r.density, 0.0));
      if (level > 2u) {
        uvec4 packed = some ? uvec4(color, bits.z, density) : uvec4(0u);
        if ((level & 1u) != 0u)
          odd[i] = packed;
        else
          even[i] = packed;
      } else if (inside) {
        uint m = materialBits(bits);
        // A length of a pixel is a quarter of a texel's.
        uvec3 shares = some ? packShares(pixelShares(m - 1u, 0.25 * r.lengthMm, r.density)) : uvec3(0u);
        // The material where the texel is one plane of it.
        uint plane = coverageBits(bits) == kFullCoverage ? m << 24 : 0u;
        writeResolved(texel, uvec4(color, bits.zw), uvec4(shares, density | plane));
      }
    }
    coarser = window;
    barrier();
  }
}
