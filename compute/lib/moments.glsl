// Surfaces by their moments: what a cluster is made of, and how it lies in space.
#ifndef PELLUCID_MOMENTS_GLSL
#define PELLUCID_MOMENTS_GLSL

// Twelve times the second moments of surfaces: a parallelogram's are the squares of its sides.
struct Tensor {
  vec3 diagonal, other; // xx yy zz, yz zx xy
};

void addSide(inout Tensor t, float weight, vec3 side) {
  t.diagonal += weight * side * side;
  t.other += weight * side.yzx * side.zxy;
}

// Takes a side out of the tensor, that along which it is largest, by a step of Cholesky's decomposition with pivots. Two of them
// are the sides of what is flat.
vec3 takeSide(inout Tensor t) {
  vec3 d = t.diagonal, side;
  if (d.x >= d.y && d.x >= d.z)
    side = vec3(d.x, t.other.zy);
  else if (d.y >= d.z)
    side = vec3(t.other.z, d.y, t.other.x);
  else
    side = vec3(t.other.yx, d.z);
  // None is larger than the largest square; what rounding leaves of a long side's may say so.
  float largest = max(max(d.x, max(d.y, d.z)), 0.0);
  side = clamp(side, vec3(-largest), vec3(largest)) * inversesqrt(max(largest, 1.0e-30));
  addSide(t, -1.0, side);
  return side;
}

// A pixel's surface, or what a finer cluster stands for.
struct Part {
  float area; // mm^2
  vec3 center, x, y; // mm, x and y: sides
  vec3 color, momentX, momentY; // of each channel's light from the center, along the sides
};

// Sums over parts, times their areas. Places are from a point that all have.
struct PartSums {
  float area;
  vec3 center, color;
  Tensor tensor;
  vec3 light[3]; // moments of red, green and blue
};

const PartSums kNoParts =
    PartSums(0.0, vec3(0.0), vec3(0.0), Tensor(vec3(0.0), vec3(0.0)), vec3[3](vec3(0.0), vec3(0.0), vec3(0.0)));

// `point`: that from which places are.
void addPart(inout PartSums sums, Part p, vec3 point) {
  vec3 center = p.center - point, light = p.area * p.color;
  sums.area += p.area;
  sums.center += p.area * center;
  sums.color += light;
  addSide(sums.tensor, p.area, p.x);
  addSide(sums.tensor, p.area, p.y);
  addSide(sums.tensor, 12.0 * p.area, center);
  [[unroll]] for (int c = 0; c < 3; ++c)
    sums.light[c] += light[c] * (center + p.momentX[c] * p.x + p.momentY[c] * p.y);
}

// All parts as one. Its area is 0 where there are none.
Part together(PartSums sums, vec3 point) {
  Part p;
  float inverse = sums.area > 0.0 ? 1.0 / sums.area : 0.0;
  vec3 center = inverse * sums.center;
  p.area = sums.area;
  p.center = point + center;
  p.color = inverse * sums.color;
  Tensor tensor = sums.tensor;
  addSide(tensor, -12.0 * sums.area, center);
  tensor.diagonal *= inverse;
  tensor.other *= inverse;
  p.x = takeSide(tensor);
  p.y = takeSide(tensor);
  // The second has nothing along that axis on which the first is longest, so the sine of their angle is at least .57.
  float xx = dot(p.x, p.x), xy = dot(p.x, p.y), yy = dot(p.y, p.y), perSquare = 1.0 / max(xx * yy - xy * xy, 1.0e-30);
  [[unroll]] for (int c = 0; c < 3; ++c) {
    // Where a channel has no light its moments do not matter.
    vec3 to = sums.light[c] / max(sums.color[c], 1.0e-20) - (sums.color[c] > 0.0 ? center : vec3(0.0));
    float alongX = dot(to, p.x), alongY = dot(to, p.y);
    p.momentX[c] = (yy * alongX - xy * alongY) * perSquare;
    p.momentY[c] = (xx * alongY - xy * alongX) * perSquare;
  }
  return p;
}

#endif
