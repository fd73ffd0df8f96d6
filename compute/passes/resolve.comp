// R_l = (1 - s) E_l + s R_(l+1) from the coarsest level of the pyramid to the one that is asked for, s the profile's
// share of the coarser levels at the texel. A group makes one tile of the last level and, before it, as much of
// each coarser one as the tile needs.
#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require

#include "passes/pyramid.glsl"

// A tile of 8 lies on up to 5 parents and needs one more on each side; 7 of those lie on 4, and so on.
const int kWindow = 8;
shared vec4 planes[2][kWindow * kWindow]; // depth, slope, inverseSpread
shared uint materials[2][kWindow * kWindow]; // 0: nothing
shared vec4 colors[2][kWindow * kWindow]; // a: density

const int kReach = 4; // of the stretch, texels

// The level's kernel has variance 2/3 - 41/12 4^-level squared texels of an axis; foreshortened surfaces need it
// longer along one axis: a 1-D Gaussian of what is missing, at the texels nearest to the axis.
vec4 stretched(ivec4 rect, ivec2 texel, uint level, Texel own, Foreshortening f) {
  vec4 sum = own.coverage * vec4(own.color, 1.0);
  float variance = (2.0 / 3.0 - 41.0 / 12.0 * exp2(-2.0 * float(level))) * f.stretch;
  bool alongX = abs(f.axis.x) >= abs(f.axis.y);
  float dominant = alongX ? f.axis.x : f.axis.y; // its square is at least 1/2
  float gradient = (alongX ? f.axis.y : f.axis.x) / dominant;
  variance = min(variance * dominant * dominant, float(kReach));
  if (variance < 0.02) return sum;
  float weights = 1.0;
  vec2 size = texelSize(own.depth, level);
  float spread2 = inverseSpread(own.slope, size);
  for (int i = -kReach; i <= kReach; ++i) {
    if (i == 0) continue;
    int across = int(floor(gradient * float(i) + 0.5));
    ivec2 offset = alongX ? ivec2(i, across) : ivec2(across, i);
    float w = exp(-0.5 * float(i * i) / variance);
    weights += w;
    if (!insideLevel(rect, texel + offset)) continue;
    Texel t = unpackTexel(levelTexel(level, texel + offset));
    if (t.coverage == 0.0 || t.material != own.material) continue;
    w *= t.coverage * sameSurface(t.depth - own.depth - dot(own.slope, vec2(offset) * size), spread2);
    sum += w * vec4(t.color, 1.0);
  }
  return sum / weights;
}

// Texels [xy, zw) of `level` that the tile of `last` needs.
ivec4 windowOf(uint level, uint last, ivec2 tile) {
  ivec4 window = ivec4(tile, tile + 8);
  for (uint l = last; l < level; ++l) window = ivec4((window.xy >> 1) - 1, ((window.zw - 1) >> 1) + 2);
  return window;
}

void main() {
  uint last = pass.value.x, first = pass.value.y;
  ivec2 tile = levelRect(last).xy + ivec2(gl_WorkGroupID.xy) * 8;
  int invocation = int(gl_LocalInvocationIndex);
  ivec4 coarserWindow = ivec4(0);
  for (uint level = first; level >= last; --level) {
    uint current = level & 1u, above = current ^ 1u;
    ivec4 rect = levelRect(level), window = windowOf(level, last, tile);
    int width = window.z - window.x;
    ivec2 texel = window.xy + ivec2(invocation % width, invocation / width);
    bool inside = texel.y < window.w && insideLevel(rect, texel);
    Texel own = unpackTexel(inside ? levelTexel(level, texel) : uvec4(0u));
    vec4 color = vec4(0.0);
    float sideMm = 0.0;
    if (own.coverage > 0.0) {
      Foreshortening f = foreshortening(vec2(texel), level, own.depth, own.slope);
      sideMm = f.lengthMm;
      vec4 here = stretched(rect, texel, level, own, f);
      color = vec4(own.color, own.coverage);
      if (here.a > 0.0) color = vec4(here.rgb / here.a, here.a);
      if (pass.value.z != 0u && level == first) {
        Resolved r = unpackResolved(texelFetch(resolvedImage, inAtlas(level, texel), 0));
        color = vec4(r.color, r.density);
      } else if (level < pass.value.w) {
        vec4 coarser = vec4(0.0);
        vec2 size = texelSize(own.depth, level + 1u);
        int stride = coarserWindow.z - coarserWindow.x;
        for (int i = 0; i < 9; ++i) {
          ivec2 at = (texel >> 1) + ivec2(i % 3, i / 3) - 1;
          int index = (at.y - coarserWindow.y) * stride + at.x - coarserWindow.x;
          if (materials[above][index] != own.material) continue;
          vec4 plane = planes[above][index];
          // 10, 5 or 1 sixteenths at distances of 1/4, 3/4 and 5/4 texels: the refinement of the quintic B-spline.
          vec2 off = 0.5 * (vec2(texel) + 0.5) - (vec2(at) + 0.5);
          vec2 part = mix(mix(vec2(0.0625), vec2(0.3125), lessThan(abs(off), vec2(1.0))), vec2(0.625), lessThan(abs(off), vec2(0.5)));
          vec4 resolved = colors[above][index];
          float w = part.x * part.y * resolved.a *
                    sameSurface(own.depth - plane.x - dot(plane.yz, off * size), plane.w);
          coarser += w * vec4(resolved.rgb, 1.0);
        }
        coarser.rgb /= max(coarser.a, 1.0e-6);
        vec3 share = coarserShare(own.material - 1u, level, shareEntry(own.material - 1u, f.lengthMm));
        // Both are weighted with the density that they found, which renormalizes at silhouettes and borders.
        vec3 theirs = share * coarser.a;
        vec3 density = (1.0 - share) * here.a + theirs;
        // Where a channel has nothing here, the level's own color stands in: the finer level weights it with 0.
        color.rgb = mix(own.color, ((1.0 - share) * here.rgb + theirs * coarser.rgb) / max(density, vec3(1.0e-6)),
                        greaterThan(density, vec3(1.0e-6)));
        color.a = dot(density, vec3(1.0 / 3.0));
      }
    }
    planes[current][invocation] = vec4(own.depth, own.slope, inverseSpread(own.slope, texelSize(own.depth, level)));
    materials[current][invocation] = own.coverage > 0.0 ? own.material : 0u;
    colors[current][invocation] = color;
    if (level == last && inside) {
      Resolved r = Resolved(color.rgb, color.a, 0.0, own.coverage > 0.0 ? own.material : 0u);
      if (level == 2u && r.material != 0u) r.pixelEntry = shareEntry(r.material - 1u, 0.25 * sideMm);
      writeLevel(level, texel, packResolved(r));
    }
    coarserWindow = window;
    barrier();
  }
}
