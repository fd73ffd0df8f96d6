// Curvature of the surface at a probe, and thinness of the body there.
#ifndef PELLUCID_PROBE_SHAPE_GLSL
#define PELLUCID_PROBE_SHAPE_GLSL

#include "diffusion/texel.glsl"
#include "frame/facet.glsl"
#include "gather/probe.glsl"
#include "gather/probe_light.glsl"
#include "lib/surface.glsl"

// Step from a probe to a quad beside it.
struct Beside {
  vec4 apart; // change of position, mm; w: 1 where the surface goes on, down to 0 at two to three times `reach`: turned by 60 to 70 degrees
  vec3 turn;  // change of the normal
};

Beside besideAt(ivec2 pixel, Surface x, float reach) {
  ivec2 quad = pixel >> 1;
  Texel t = unpackTexel(writtenQuad(quad, false));
  vec2 center = pixelOf(1u, quad);
  ViewRay ray = viewRay(frame.camera, center);
  vec3 apart = (ray.origin + t.depth * ray.direction - x.position) * frame.camera.range.w;
  float ratio = dot(apart, apart) / max(reach * reach, 1.0e-30);
  bool there = t.area != 0.0;
  return Beside(vec4(apart, there ? clamp((9.0 - ratio) / 5.0, 0.0, 1.0) : 0.0),
                there ? normalOfSlope(t.slope, facingRayAt(center)) - x.normal : vec3(0.0));
}

// Step across the probe, from one side to the other.
Beside acrossOf(Beside forward, Beside backward) {
  float f = forward.apart.w, b = backward.apart.w;
  return Beside(vec4(f * forward.apart.xyz - b * backward.apart.xyz, max(f, b)), f * forward.turn - b * backward.turn);
}

// Steps in pixels that reach `reach` mm on the surface's tangent plane, and a quad at least: then that is the reach. `known`: 1, down to
// 0 where the reach was less than a pixel's side, which no pixel tells.
ivec2 stepsOf(Surface x, ViewRay ray, float front, inout float reach, out float known) {
  Camera c = frame.camera;
  vec3 sideX = vec3(c.rayX.zw + front * c.rayX.xy, 0.0), sideY = vec3(c.rayY.zw + front * c.rayY.xy, 0.0);
  float facing = min(dot(x.normal, ray.direction), -0.1); // planes seen edge-on would have no end; any small value will do
  sideX -= ray.direction * (dot(x.normal, sideX) / facing);
  sideY -= ray.direction * (dot(x.normal, sideY) / facing);
  vec2 size = sqrt(vec2(dot(sideX, sideX), dot(sideY, sideY))) * c.range.w;
  known = clamp(reach / max(max(size.x, size.y), 1.0e-30), 0.0, 1.0);
  reach = max(reach, 2.0 * max(size.x, size.y));
  return ivec2(clamp(reach / max(size, vec2(1.0e-30)) + 0.5, vec2(2.0), vec2(1.0e4)));
}

// Mean curvature of the surface around x, 1/mm, positive where convex; 0 where it does not go on.
float meanCurvature(ivec2 pixel, Surface x, ViewRay ray, float front, float reach) {
  float known;
  ivec2 steps = stepsOf(x, ray, front, reach, known);
  Beside a, b = Beside(vec4(0.0), vec3(0.0));
  [[dont_unroll]] for (int axis = 0; axis < 2; ++axis) {
    ivec2 step = axis == 0 ? ivec2(steps.x, 0) : ivec2(0, steps.y);
    a = b;
    b = acrossOf(besideAt(pixel + step, x, reach), besideAt(pixel - step, x, reach));
  }
  // The curvature is half the trace of the map from steps to turns. Steps within 6 degrees of one direction do not tell it.
  float area = dot(x.normal, cross(a.apart.xyz, b.apart.xyz));
  float least = 0.1 * sqrt(dot(a.apart.xyz, a.apart.xyz) * dot(b.apart.xyz, b.apart.xyz));
  float trace = dot(x.normal, cross(a.turn, b.apart.xyz) + cross(a.apart.xyz, b.turn));
  return abs(area) > least ? known * a.apart.w * b.apart.w * 0.5 * trace / area : 0.0;
}

// Back face of a pixel.
struct BackFace {
  vec3 position; // view space
  float chord;   // from the front face to the back face along the view ray; 0: the pixel has none
};

BackFace backAt(ivec2 pixel) {
  ivec2 at = withinRect(pixel);
  float stored = texelFetch(frontDepthImage, inImage(at), 0).x, front = frontDistanceOf(stored);
  ViewRay ray = viewRay(frame.camera, at);
  float chord = chordOf(ray, front, stored, texelFetch(backDepthImage, inImage(at), 0).x);
  bool there = at == pixel && materialAt(inImage(at)) != 0u && front > 0.0 && chord > 0.0;
  return BackFace(ray.origin + front * ray.direction + chord * normalize(ray.direction), there ? chord : 0.0);
}

// Back face one pixel away, or two where a pixel of hair lies between.
BackFace backBeside(ivec2 pixel, ivec2 axis) {
  BackFace back;
  [[dont_unroll]] for (int away = 1; away <= 2; ++away) {
    back = backAt(pixel + away * axis);
    if (back.chord > 0.0) break;
  }
  return back;
}

// Steps across and along the image on the back face. `chord` grows to the lesser of both sides' chords: a crease of a pixel's width,
// whose back face lies close, is no thin body. False: a step is not known.
bool backSteps(ivec2 pixel, vec3 back, inout float chord, out vec3 steps[2]) {
  bool known = true;
  steps[1] = vec3(0.0);
  [[dont_unroll]] for (int i = 0; i < 2; ++i) {
    ivec2 axis = i == 0 ? ivec2(1, 0) : ivec2(0, 1);
    BackFace f = backBeside(pixel, axis), b = backBeside(pixel, -axis);
    steps[0] = steps[1];
    steps[1] = nearerStep(vec4(f.position - back, f.chord > 0.0 ? 1.0 : 0.0), vec4(back - b.position, b.chord > 0.0 ? 1.0 : 0.0));
    chord = max(chord, min(f.chord, b.chord));
    known = known && (f.chord > 0.0 || b.chord > 0.0);
  }
  return known;
}

const float kThick = 1.0e6;          // mm
const float kMostCurvature = 1.0e3;  // 1/mm
const float kMostOfEdges = 0.1;      // of the diffused irradiance. Measured: procedural shells of skin
const float kRoundnessPower = 4.0;   // of the roundness, of the limit for balls. Measured: procedural shells of skin
const float kCurvatureReach = 0.25;  // of the thickness, as longer ones end outside of balls. Measured: procedural balls of 2 mm radius

// Thickness of the body at x, mm: of a slab seen at any angle, of a ball its diameter. kThick: not known, or the body is as good as
// a half-space.
float thicknessAt(ivec2 pixel, Surface x) {
  if (!hasFlag(PELLUCID_FLAG_BACK_DEPTH)) return kThick;
  if (hasFlag(PELLUCID_FLAG_BACK_THICKNESS)) {
    float stored = thicknessOf(texelFetch(backDepthImage, inImage(pixel), 0).x);
    return stored < 0.0 ? kThick : min(stored, kThick);
  }
  BackFace back = backAt(pixel);
  if (!(back.chord > 0.0)) return kThick;
  float chord = back.chord;
  vec3 steps[2], ray = (back.position - x.position) / back.chord, normal = -x.normal;
  bool known = backSteps(pixel, back.position, chord, steps);
  vec3 n = cross(steps[0], steps[1]);
  float squared = dot(n, n);
  if (known && squared > 0.0) normal = n * (dot(n, x.view) < 0.0 ? -inversesqrt(squared) : inversesqrt(squared));
  float opposite = 0.5 - 0.5 * dot(x.normal, normal);
  // Pixels do not tell steeper faces, as of limbs of one pixel.
  float cosines = max(abs(dot(ray, x.normal)), kLeastCosine) + max(abs(dot(ray, normal)), kLeastCosine);
  float h = 0.5 * chord * frame.camera.range.w * cosines / max(opposite, 0.01);
  return isWithin(h, 0.0, kThick) ? h : kThick;
}

// As GatherConstants::ball has them.
struct Ball {
  vec3 returned, through, instead;
};

Ball unpackBall(uvec4 bits) {
  vec2 middle = unpackHalf2x16(bits.y);
  return Ball(vec3(unpackHalf2x16(bits.x), middle.x), vec3(middle.y, unpackHalf2x16(bits.z)), unpackUnorm4x8(bits.w).rgb);
}

Ball ballAt(uint m, float diameter) {
  float place = gatherPlace(materials[m].gather.lengths, diameter);
  uint i = min(uint(place), uint(PELLUCID_GATHER_ENTRIES - 2));
  Ball a = unpackBall(materials[m].gather.ball[i]), b = unpackBall(materials[m].gather.ball[i + 1u]);
  float f = place - float(i);
  return Ball(mix(a.returned, b.returned, f), mix(a.through, b.through, f), mix(a.instead, b.instead, f));
}

// Factors of the body at x: R(h) / rho of a slab of the body's thickness, and besides the excess of a ball of its curvature. All of
// K comes through a slab; the more the body is a ball, the less comes through.
BodyFactors bodyAt(ivec2 pixel, Surface x, ViewRay ray, float front, uint m) {
  vec4 lengths = materials[m].gather.lengths;
  float reach = materials[m].gather.body.x;
  BodyFactors body = BodyFactors(vec3(1.0), vec3(1.0));
  if (reach == 0.0) return body;
  float h = thicknessAt(pixel, x), curvature = meanCurvature(pixel, x, ray, front, min(reach, kCurvatureReach * h));
  // Whatever depths and normals hold, the factors are finite.
  if (!isWithin(abs(curvature), 0.0, kMostCurvature)) curvature = 0.0;
  if (h < 2.5 * lengths.z) { // 5 / kappa: beyond, a slab returns all but e^-10 of a half-space's light
    GatherSlab s = slabOf(m, lengths, h);
    vec3 t = exp2(s.logarithm - s.decay * h);
    [[unroll]] for (int c = 0; c < 3; ++c) body.returned[c] = keptReflectance(materials[m].gather.reflectance[c], t[c]);
  }
  Ball ball = ballAt(m, 2.0 / max(abs(curvature), 1.0 / kThick));
  // 1 where curvature and thickness are those of one ball; 1e-6: the inverse is finite.
  float diameters = max(0.5 * h * curvature, 1.0e-6), round = min(diameters, 1.0 / diameters);
  // Lids, lips and other edges of a large body have no more than a half-space's surroundings.
  vec3 more = min(ball.returned + round * ball.instead, vec3(max(kMostOfEdges, pow(round, kRoundnessPower))));
  // Concave surfaces return less, by as much as convex ones return more; where they curve strongly, other walls are near.
  body.returned += curvature < 0.0 ? -clamp(ball.returned, vec3(0.0), vec3(kMostOfEdges)) : more;
  body.through += round * ball.through;
  return body;
}

#endif
