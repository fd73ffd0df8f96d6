// The last level of upsampling, level 2, and its pixels' shares.

void writeUpsampled(ivec2 texel, uvec4 color, uvec4 shares) {
  imageStore(levelsDestination, upsampledPlace(texel), color);
  imageStore(levelsDestination, sharesPlace(texel), shares);
}

// `bits`: the texel of the pyramid; `k`: the group.
void upsampleFine(ivec2 texel, ivec2 k, uvec4 bits) {
  if (!contains(levelRect(2u), texel)) return;
  if (!hasSurface(bits)) {
    writeUpsampled(texel, uvec4(0u, bits.y & 0xFFFF0000u, 0u, 0u), uvec4(0u));
    return;
  }
  Foreshortening f;
  Own own = ownPart(2u, texel, k, bits, f);
  Level r = withCoarser(own, 2u, texel, windowOf(3u, k));
  uint upper = bits.y >> 16 & ~(kPlane >> 16);
  if ((bits.x & kFlat) != 0u) upper |= kPlane >> 16;
  PixelShares share = pixelShares(own.texel.material - 1u, f);
  share.coarser = share.coarser * r.coverage / max(1.0 - share.coarser + share.coarser * r.coverage, vec3(1.0e-6));
  writeUpsampled(texel, uvec4(packColor(r.color, upper), bits.zw),
                 uvec4(packShares(share), packCoverage(r.coverage) | (isPlane(bits) ? kFull : 0u)));
}
