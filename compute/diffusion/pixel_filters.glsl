// Filters of pixels. The spline interpolates level 2. The fine filter takes five taps in each direction of shared vertical[],
// wider along rows or columns where the surface is foreshortened.

// The quadratic B-spline at -1, 0 and 1 for a point at most half a texel from 0.
vec3 spline(float at) {
  return vec3(0.5 * (0.5 - at) * (0.5 - at), 0.75 - at * at, 0.5 * (0.5 + at) * (0.5 + at));
}

// The spline at a pixel of a texel of level 2, in one direction.
vec3 splineAt(int pixel) { return spline(0.25 * (float(pixel & 3) - 1.5)); }

// Weights in one direction: of the pixel, of its neighbors and of theirs.
const vec3 kFineWeights = vec3(PELLUCID_FINE_OWN, PELLUCID_FINE_NEXT, PELLUCID_FINE_LAST);
const vec3 kWideFineWeights = vec3(PELLUCID_WIDE_FINE_OWN, PELLUCID_WIDE_FINE_NEXT, PELLUCID_WIDE_FINE_LAST);

// `wider`: FineShape's, negative in the other direction.
vec3 fineWeights(float wider) { return mix(kFineWeights, kWideFineWeights, max(wider, 0.0)); }

float weightAt(vec3 weights, int i) { return i == 0 ? weights.x : abs(i) == 1 ? weights.y : weights.z; }

struct FineFilter {
  vec3 own, next, last; // weights of each channel
};

// `direct`: part of each channel that goes through unfiltered.
FineFilter fineFilter(float wider, vec3 direct) {
  vec3 weights = fineWeights(wider), rest = 1.0 - direct;
  return FineFilter(direct + weights.x * rest, weights.y * rest, weights.z * rest);
}

vec3 fineSum(FineFilter f, vec3 a, vec3 b, vec3 c, vec3 d, vec3 e) {
  return f.own * c + f.next * (b + d) + f.last * (a + e);
}

// Filters along columns and along rows: light that is thin along one passes the other unfiltered. `shape`: z of a texel's
// shares.
FineFilter columnFilter(uint shape, bool shaped) {
  FineShape s = shaped ? unpackShape(shape) : kNoShape;
  return fineFilter(-s.wider, s.wider > 0.0 ? s.thin : vec3(0.0));
}

FineFilter rowFilter(uint shape, bool shaped) {
  FineShape s = shaped ? unpackShape(shape) : kNoShape;
  return fineFilter(s.wider, s.wider > 0.0 ? vec3(0.0) : s.thin);
}

// The horizontal half, at a place whose vertical half is done.
vec3 fineOf(FineFilter f, int at) {
  return fineSum(f, unpackHalves(vertical[at - 2]), unpackHalves(vertical[at - 1]), unpackHalves(vertical[at]),
                 unpackHalves(vertical[at + 1]), unpackHalves(vertical[at + 2]));
}

// Both halves where all around the pixel is one plane. `place`: in what keepBand kept.
vec3 fineOfPlane(int place, uint shape) {
  FineFilter columns = columnFilter(shape, true), rows = rowFilter(shape, true);
  vec3 fine = vec3(0.0);
  for (int y = -2; y <= 2; ++y) {
    vec3 weight = y == 0 ? columns.own : abs(y) == 1 ? columns.next : columns.last;
    fine += weight * fineOf(rows, place + y * kColumns);
  }
  return fine;
}
