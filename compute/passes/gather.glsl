// The gather over one light's shadow maps; gather.comp includes it after its bindings.
#ifndef PELLUCID_PASS_GATHER_GLSL
#define PELLUCID_PASS_GATHER_GLSL

#include "lib/gather.glsl"

// The camera may miss a texel's point by the slope of the surface within the texel and the pixel.
const float kSeenTolerance = 2.0; // texels
// A surface that the light sees more obliquely counts as if it did not.
const float kLeastCosine = 0.05;

struct Gathered {
  vec3 transmitted; // exitance
  vec3 entering;    // irradiance that reaches x as diffusion does
  vec3 displaced;   // share of the diffusion's profile that lies on hidden texels
};

// Where the camera has a surface at y or in front of it: what it sees is in the irradiance that diffusion
// spreads. Call it for points that face the camera.
bool cameraSees(vec3 y, float tolerance) {
  ivec2 pixel;
  if (!projectToPixel(frame.camera, y, pixel) || !insideRect(pixel)) return false;
  float front = frontDistance(pixel);
  return front > 0.0 && y.z * frame.camera.range.x <= front + tolerance;
}

// Where the light ray through s meets the surface that a texel stores.
vec3 entryPoint(ShadowConstants shadow, LightConstants light, ShadowReceiver receiver, vec3 s, float stored) {
  Incident ray = Incident(vec3(0.0), -light.direction.xyz, 1.0);
  float perDistance = 1.0;
  if (shadow.meta.z != 0u) {
    // As a fraction of the way to the light, which saves the square root where the map is planar.
    ray.toLight = light.position.xyz - s;
    if (shadow.meta.y == PELLUCID_SHADER_DEPTH_DISTANCE) {
      ray.distanceTo = length(ray.toLight);
      perDistance = 1.0 / max(ray.distanceTo, 1.0e-12);
    }
  }
  return s + lightThickness(shadow, receiver, s, ray, stored) * perDistance * ray.toLight;
}

// One texel's step along an axis of the map from y, towards whichever neighbor is nearer: the other may lie
// across an edge. `across`: the step at s, across the light; clipAcross: the same in clip space.
vec3 entrySlope(ShadowConstants shadow, LightConstants light, ShadowReceiver receiver, vec3 s, vec3 y,
                ivec2 axis, vec3 across, vec4 clipAcross) {
  vec3 best = vec3(0.0);
  float least = 3.0e38;
  for (int side = 1; side >= -1; side -= 2) {
    ivec2 texel = receiver.texel + side * axis;
    vec3 neighbor = s + float(side) * across;
    ShadowReceiver at = ShadowReceiver(receiver.clip + float(side) * clipAcross, texel, true);
    if (any(lessThan(texel, ivec2(0))) || any(greaterThanEqual(texel, ivec2(shadow.depth.zw)))) continue;
    float stored = shadowTexel(shadow.meta.x, texel);
    if (!shadowHolds(shadow, stored)) continue;
    vec3 toward = float(side) * (entryPoint(shadow, light, at, neighbor, stored) - y);
    float squared = dot(toward, toward);
    if (squared < least) {
      least = squared;
      best = toward;
    }
    // Less steep than 60 degrees: no edge, and the other side need not be read.
    if (squared < 4.0 * dot(across, across)) break;
  }
  return best;
}

// Steps of one texel across the light around a point; the same in clip space; how far from the front depth a
// texel's point may be and still be seen.
struct GatherSteps {
  vec3 x, y;
  vec4 clipX, clipY;
  float tolerance;
};

// The inverse of the map's derivative at a point in front of it. clip: the point's, w > 0.
GatherSteps gatherSteps(ShadowConstants shadow, vec4 clip, vec3 toLight) {
  vec3 side = abs(toLight.x) < 0.7 ? vec3(1.0, 0.0, 0.0) : vec3(0.0, 1.0, 0.0);
  vec3 u = normalize(cross(toLight, side)), v = cross(toLight, u);
  vec4 clipU = shadow.clipFromView * vec4(u, 0.0), clipV = shadow.clipFromView * vec4(v, 0.0);
  vec2 ndc = clip.xy / clip.w;
  vec2 perU = (clipU.xy - ndc * clipU.w) * shadow.depth.zw, perV = (clipV.xy - ndc * clipV.w) * shadow.depth.zw;
  float determinant = perU.x * perV.y - perU.y * perV.x;
  // A map that is not singular has one; texels of no size would leave the normals out.
  float scale = abs(determinant) > 0.0 ? 2.0 * clip.w / determinant : 0.0;
  GatherSteps steps;
  steps.x = scale * (perV.y * u - perU.y * v);
  steps.y = scale * (perU.x * v - perV.x * u);
  steps.clipX = shadow.clipFromView * vec4(steps.x, 0.0);
  steps.clipY = shadow.clipFromView * vec4(steps.y, 0.0);
  steps.tolerance = kSeenTolerance * sqrt(length(steps.x) * length(steps.y)) + shadow.depth.y;
  return steps;
}

// The rings around an axis through x; t, mm: along it, from x to the lit surface.
struct GatherRings {
  vec3 axis, across, along, center;
  float t, axisCosine; // of the axis with the light's ray
};

// An axis between the light's ray and the normal inwards suits slabs: their rings are around the foot of the
// perpendicular. The receiver is inside the map.
GatherRings gatherRings(ShadowConstants shadow, ShadowReceiver receiver, LightConstants light, Surface x,
                        float longest) {
  float mm = frame.camera.range.w;
  vec3 toLight = incidentLight(light, x.position).toLight;
  float facing = x.hasNormal ? max(-dot(x.normal, toLight), 0.0) : 0.0;
  GatherRings rings;
  rings.axis = normalize(toLight - facing * x.normal); // the two are within 90 degrees
  rings.axisCosine = dot(rings.axis, toLight);
  float t = 0.0, stored = shadowTexel(shadow.meta.x, receiver.texel);
  if (shadowHolds(shadow, stored)) {
    vec3 y = entryPoint(shadow, light, receiver, x.position, stored);
    t = clamp(dot(y - x.position, toLight), 0.0, longest / mm);
    vec3 guess = x.position + t * rings.axis;
    ShadowReceiver below = projectReceiver(shadow, guess);
    stored = below.inside ? shadowTexel(shadow.meta.x, below.texel) : stored;
    if (below.inside && shadowHolds(shadow, stored)) {
      y = entryPoint(shadow, light, below, guess, stored);
      t = clamp(dot(y - x.position, rings.axis), 0.0, longest / mm);
    }
  }
  rings.center = x.position + t * rings.axis;
  rings.t = t * mm;
  rings.across = normalize(cross(rings.axis, abs(rings.axis.x) < 0.7 ? vec3(1.0, 0.0, 0.0) : vec3(0.0, 1.0, 0.0)));
  rings.along = cross(rings.axis, rings.across);
  return rings;
}

// Adds the samples whose light ray meets the map `index` of shadows[] and none of the light's before it.
void gatherMap(uint m, LightConstants light, uint index, Surface x, GatherRings rings, uint samples, float turn,
               float within, inout Gathered sum) {
  float mm = frame.camera.range.w;
  ShadowConstants shadow = shadows[index];
  vec4 clip = shadow.clipFromView * vec4(x.position, 1.0);
  if (!(clip.w > 0.0)) return; // a face of a cube that looks away
  vec3 toLight = incidentLight(light, x.position).toLight;
  GatherSteps steps = gatherSteps(shadow, clip, toLight);
  GatherConstants material = materials[m].gather;
  vec2 direction = vec2(cos(6.28318531 * turn), sin(6.28318531 * turn));
  float inner = 0.0, perSample = 1.0 / float(samples);
  for (uint i = 0u; i < samples; ++i) {
    float outer = i + 1u == samples ? 1.0e6 : gatherRadius(material, rings.t, float(i + 1u) * perSample);
    float rho = gatherRadius(material, rings.t, (float(i) + within) * perSample);
    vec3 s = rings.center + (rho / mm) * (direction.x * rings.across + direction.y * rings.along);
    float from = inner;
    inner = outer;
    direction = mat2(-0.73736888, 0.67549029, -0.67549029, -0.73736888) * direction; // the golden angle
    ShadowReceiver receiver = projectReceiver(shadow, s);
    bool first = receiver.inside;
    for (uint before = light.meta.y; before < index && first; ++before)
      first = !projectReceiver(shadows[before], s).inside;
    if (!first) continue;
    float stored = shadowTexel(shadow.meta.x, receiver.texel);
    if (!shadowHolds(shadow, stored)) continue;
    vec3 y = entryPoint(shadow, light, receiver, s, stored);

    vec3 normal = cross(entrySlope(shadow, light, receiver, s, y, ivec2(1, 0), steps.x, steps.clipX),
                        entrySlope(shadow, light, receiver, s, y, ivec2(0, 1), steps.y, steps.clipY));
    float size = length(normal);
    float cosine = dot(normal, toLight);
    normal = size > 0.0 ? normal * (sign(cosine) / size) : toLight; // towards the light
    cosine = size > 0.0 ? max(abs(cosine) / size, kLeastCosine) : 1.0;
    // What faces away cannot be seen, however thin the part is.
    if (dot(normal, x.view) < 0.0 && cameraSees(y, steps.tolerance)) continue;

    vec3 to = (x.position - y) * mm;
    float squared = dot(to, to), r = sqrt(squared);
    float opposite = x.hasNormal ? 0.5 - 0.5 * dot(x.normal, normal) : 1.0; // 1 - m
    float through = max(-dot(normal, to), 0.0);
    float h = x.hasNormal ? sqrt(through * max(dot(x.normal, to), 0.0) / max(opposite, 1.0e-4)) : through;
    h = min(h, r);
    // The ring, seen as if all of it lay in y's plane across the axis.
    float plane = max(squared - rho * rho, 0.0);
    float near = sqrt(plane + from * from), far = sqrt(plane + outer * outer);
    vec3 flux = incidentLight(light, s).irradiance * rings.axisCosine;
    sum.transmitted += flux * opposite * gatherTransmitted(gatherSlab(material, h), h, near, far);
    if (opposite < 0.99) {
      vec3 reflected = (1.0 - opposite) * gatherReflected(material.profile.rgb, near, far);
      sum.entering += flux * reflected;
      sum.displaced += reflected * (rings.axisCosine / cosine);
    }
  }
}

// From `samples` points of the light's maps, around the first that contains x; a cube's seams are no borders.
// `turn` and `within`, [0, 1): which of the patterns this point takes; neighbors take others, and share what
// they find.
Gathered gatherLight(uint m, LightConstants light, Surface x, uint samples, float turn, float within) {
  Gathered sum = Gathered(vec3(0.0), vec3(0.0), vec3(0.0));
  uint end = light.meta.y + light.meta.z;
  GatherRings rings;
  bool inside = false;
  for (uint index = light.meta.y; index < end && !inside; ++index) {
    ShadowReceiver receiver = projectReceiver(shadows[index], x.position);
    inside = receiver.inside;
    if (inside) rings = gatherRings(shadows[index], receiver, light, x, materials[m].gather.lengths.z);
  }
  if (!inside) return sum;
  for (uint index = light.meta.y; index < end; ++index)
    gatherMap(m, light, index, x, rings, samples, turn, within, sum);
  return sum;
}

#endif
