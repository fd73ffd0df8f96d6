// Which pixels are summed fast (passes/fast_edges.glsl) and not filtered: those that filters of planes err on, where the light
// that they take is not alike, as any average of what is alike is the same, and does not change evenly, which averages keep.
#ifndef PELLUCID_SUMMED_FAST_GLSL
#define PELLUCID_SUMMED_FAST_GLSL

// Of planes that are summed: how tilted they are, 35 degrees.
const float kMostFastStretch = 0.49;

// Levels count from which, and from coarser ones, more than that comes: of the energy, or of the light, which may be next to
// nothing of the energy where it is dark and near a bright rim.
const float kLeastPart = 0.02;

// The coarsest level that is looked at. What comes from beyond it counts as planes and, if it is that much of the energy, as
// light that is not alike.
const uint kLastLooked = 5u;
const float kLeastBeyond = 0.0005;

// Whether a texel of level 2 is no plane because the rect ends beside it: farther in is one, on which it lies.
bool continuesPlane(ivec2 texel, uvec4 bits) {
  ivec4 inner = inset(levelRect(2u), 3);
  ivec2 nearest = clamp(texel, inner.xy, inner.zw - 1);
  if (nearest == texel || any(lessThanEqual(inner.zw, inner.xy))) return false;
  uvec4 theirs = texelFetch(pyramidImage, inAtlas(2u, nearest), 0);
  vec2 slope = unpackHalf2x16(theirs.w), size = texelSize(uintBitsToFloat(theirs.z), 2u);
  float off = uintBitsToFloat(bits.z) - uintBitsToFloat(theirs.z) - dot(slope, vec2(texel - nearest) * size);
  return (theirs.x & kFlat) != 0u && materialBits(theirs) == materialBits(bits) &&
         off * off * inverseSpread(slope, size) < kPlaneOffset;
}

// Whether a texel of level 2 is a plane that is not too tilted. `margin`: for a second evaluation, which may round differently and
// must find all that the first one does.
bool isPlaneFast(ivec2 texel, uvec4 bits, Foreshortening f, float margin) {
  return f.stretch <= kMostFastStretch * (1.0 - margin) && ((bits.x & kFlat) != 0u || continuesPlane(texel, bits));
}

// Whether a texel of a coarser level is a plane as far as is known. One that has something from beyond the rect's border, up to a
// side less two pixels around it, is none, whatever is there: the nearest one that has not stands for it, if there is any.
bool countsAsPlane(uint level, ivec2 texel, uvec4 bits) {
  if (isPlane(bits) || level > pass.value.x) return true;
  int l = int(level), side = 1 << l;
  ivec2 first = ((ivec2(frame.rect.xy) + side - 3) >> l) + 1, last = ((ivec2(frame.rect.zw) + 2) >> l) - 2;
  ivec2 nearest = clamp(texel, first, max(first, last));
  if (any(lessThan(last, first))) return true;
  return nearest != texel && isPlane(texelFetch(pyramidImage, inAtlas(level, nearest), 0));
}

// `f`: of the texel, of level 2.
bool isSummedFast(ivec2 texel, uvec4 bits, Foreshortening f, float margin) {
  if (!hasSurface(bits)) return false;
  const int kLevels = int(kLastLooked) - 2;
  uvec4 coarser[kLevels];
  // All before the first is used. What stands for a level that is not there is not looked at.
  [[unroll]] for (int i = 0; i < kLevels; ++i) {
    uint level = min(pass.value.x, uint(i) + 3u);
    coarser[i] = texelFetch(pyramidImage, inAtlas(level, texel >> int(level - 2u)), 0);
  }
  bool plane = isPlaneFast(texel, bits, f, margin), planes[kLevels], allPlanes = plane;
  [[unroll]] for (int i = 0; i < kLevels; ++i) {
    planes[i] = countsAsPlane(uint(i) + 3u, texel >> (i + 1), coarser[i]);
    allPlanes = allPlanes && planes[i];
  }
  if (allPlanes) return false;
  uint m = materialBits(bits) - 1u;
  // In the direction in which most texels are under the kernel, as slopes across edges are none of the surface's.
  float entry = shareEntry(m, f.lengthMm * inversesqrt(1.0 + max(f.stretch, 0.0)));
  // Of level 2 + i: the energy beyond it, of the channel in which it is most, and its own light, of the last one with all beyond.
  float energy[kLevels + 1], light[kLevels + 1], all = 0.0;
  vec3 left = vec3(1.0);
  [[unroll]] for (int i = 0; i <= kLevels; ++i) {
    float at = min(entry + float(i) * kernels[m].range.y, float(PELLUCID_SHARE_ENTRIES - 1));
    vec3 beyond = uint(i) + 2u < pass.value.x ? left * coarserShare(m, uint(i) + 2u, at) : vec3(0.0);
    energy[i] = max(beyond.r, max(beyond.g, beyond.b));
    light[i] = dot(i < kLevels ? left - beyond : left, unpackTexel(i == 0 ? bits : coarser[i - 1]).color);
    all += light[i];
    left = beyond;
  }
  bool varied = isVaried(bits) || energy[kLevels] > kLeastBeyond * (1.0 - margin);
  float lightBeyond = 0.0, limit = kLeastPart * (1.0 - margin);
  [[unroll]] for (int i = kLevels - 1; i >= 0; --i) {
    lightBeyond += light[i + 1];
    bool counts = energy[i] > limit || lightBeyond > limit * all;
    plane = plane && (!counts || planes[i]);
    varied = varied || (counts && isVaried(coarser[i]));
  }
  return !plane && varied;
}

// The same, from the pyramid.
bool isSummedFast(ivec2 texel) {
  uvec4 bits = texelFetch(pyramidImage, inAtlas(2u, texel), 0);
  return isSummedFast(texel, bits, foreshortening(texel, 2u, uintBitsToFloat(bits.z), unpackHalf2x16(bits.w)), 1.0e-3);
}

#endif
