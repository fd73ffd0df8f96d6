// Lookups in a material's profile table, KernelConstants.

layout(set = 0, binding = PELLUCID_BINDING_KERNELS) readonly buffer Kernels { KernelConstants kernels[]; };

// Place of a length on the surface among a material's shares.
float shareEntry(uint m, float lengthMm) {
  // The floor keeps log2 finite where the camera gives a pixel no size.
  float at = (log2(max(lengthMm, 1.0e-30)) - kernels[m].range.x) * kernels[m].range.y;
  return clamp(at, 0.0, float(PELLUCID_SHARE_ENTRIES - 1));
}

// The coarser levels' share of the energy that `level` and they have, at texels with this entry.
vec3 coarserShare(uint m, uint level, float entry) {
  // In the table, whatever a NaN converts to, here and below.
  uint i = min(uint(entry), uint(PELLUCID_SHARE_ENTRIES - 2));
  uint first = min(level - 2u, uint(PELLUCID_SHARE_COARSER)) * uint(PELLUCID_SHARE_ENTRIES) + i;
  return mix(kernels[m].share[first].rgb, kernels[m].share[first + 1u].rgb, entry - float(i));
}

// Parts of all energy at pixels with this entry, `element` as in KernelConstants::pixelShare.
vec3 beyondPixel(uint m, uint element, float entry) {
  entry = max(entry, 0.0);
  uint i = min(uint(entry), uint(PELLUCID_SHARE_ENTRIES - 2)), first = uint(PELLUCID_PIXEL_SHARES) * i + element;
  vec3 next = kernels[m].pixelShare[first + uint(PELLUCID_PIXEL_SHARES)].rgb;
  return mix(kernels[m].pixelShare[first].rgb, next, entry - float(i));
}

// Shares of pixels of a texel of level 2, on a surface that fills all of the kernel. The octaves between the kernel's sides
// count by factors of pellucid_filters.h, and not at silhouettes, where surfaces leave their tangent planes.
PixelShares pixelShares(uint m, Foreshortening f) {
  // The stretch is >= 0 but for rounding.
  float longer = 0.5 * log2(1.0 + max(f.stretch, 0.0)), octaves = clamp(2.5 - longer, 0.0, min(longer, 1.0));
  float entry = shareEntry(m, 0.25 * f.lengthMm), perOctave = kernels[m].range.y * octaves; // of a pixel, 1/4 of the texel
  float straight = abs(f.axis.x * f.axis.x - f.axis.y * f.axis.y); // 1: along rows or columns, 0: along a diagonal
  float less = PELLUCID_FORESHORTENED_COARSER - PELLUCID_FORESHORTENED_STRAIGHT * straight;
  vec3 coarser = beyondPixel(m, 0u, entry - perOctave * less);
  vec3 both = max(beyondPixel(m, 1u, entry - perOctave * PELLUCID_FORESHORTENED_FINE * (1.0 - straight)), coarser);
  vec3 beyond = max(beyondPixel(m, 1u, entry - perOctave * PELLUCID_FORESHORTENED_FINE), both);
  float wider = min(exp2(octaves) - 1.0, 1.0) * straight;
  // One Gaussian may ask for more than all.
  vec3 fine = min((beyond - coarser) / max(1.0 - coarser, vec3(1.0e-3)), vec3(mostFine(wider)));
  FineShape shape = FineShape(abs(f.axis.x) < abs(f.axis.y) ? -wider : wider,
                              (beyond - both) / max(beyond - coarser, vec3(1.0e-6)));
  return PixelShares(coarser, fine, shape);
}
