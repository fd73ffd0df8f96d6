// First fundamental form of the surface over a texel, reduced to what the kernel needs.
struct Foreshortening {
  float lengthMm; // of a texel along the foreshortened direction, the longest on the surface
  float stretch;  // its square over that of the shortest, minus 1: 0 facing the camera
  vec2 axis;      // unit, in texels: direction of the shortest, in which the kernel is longest
};

Foreshortening foreshortening(ivec2 texel, uint level, float depth, vec2 slope) {
  float scale = exp2(float(level));
  Camera c = frame.camera;
  vec2 pixel = pixelOf(level, texel);
  vec2 direction = c.rayBase.xy + pixel.x * c.rayX.xy + pixel.y * c.rayY.xy;
  vec2 facingX = (c.rayX.xy * depth + c.rayX.zw) * scale, facingY = (c.rayY.xy * depth + c.rayY.zw) * scale;
  float dx = slope.x * length(facingX), dy = slope.y * length(facingY);
  vec3 x = vec3(facingX + direction * dx, dx), y = vec3(facingY + direction * dy, dy);
  float a = dot(x, x), b = dot(x, y), d = dot(y, y);
  float middle = 0.5 * (a + d), difference = 0.5 * (a - d), root = sqrt(difference * difference + b * b);
  // Eigenvector of the smaller eigenvalue, from whichever row does not cancel.
  vec2 axis = difference > 0.0 ? vec2(b, -(difference + root)) : vec2(difference - root, b);
  float norm = dot(axis, axis);
  axis = norm > 0.0 ? axis * inversesqrt(norm) : vec2(1.0, 0.0);
  float least = max(middle - root, 1.0e-6 * middle);
  // middle > 0 in front of the eye; the floor is for cameras without a pixel size.
  return Foreshortening(sqrt(middle + root) * c.range.w, (middle + root) / max(least, 1.0e-30) - 1.0, axis);
}
