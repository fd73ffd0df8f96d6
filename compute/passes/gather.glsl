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

// One of a light's maps as the gather reads it: steps of one texel across the light around a point.
struct GatherMap {
  ShadowConstants shadow;
  vec3 stepX, stepY;
  vec4 clipX, clipY; // of the steps
  float tolerance;
};

// The steps are the inverse of the map's derivative; `clip`: the point's, inside the map.
GatherMap gatherMap(uint index, vec4 clip, vec3 toLight) {
  GatherMap map;
  map.shadow = shadows[index];
  vec3 side = abs(toLight.x) < 0.7 ? vec3(1.0, 0.0, 0.0) : vec3(0.0, 1.0, 0.0);
  vec3 u = normalize(cross(toLight, side)), v = cross(toLight, u);
  vec4 clipU = map.shadow.clipFromView * vec4(u, 0.0), clipV = map.shadow.clipFromView * vec4(v, 0.0);
  vec2 ndc = clip.xy / clip.w; // inside: w > 0
  vec2 perU = (clipU.xy - ndc * clipU.w) * map.shadow.depth.zw;
  vec2 perV = (clipV.xy - ndc * clipV.w) * map.shadow.depth.zw;
  float determinant = perU.x * perV.y - perU.y * perV.x;
  // A map that is not singular has one; texels of no size would leave the normals out.
  float scale = abs(determinant) > 0.0 ? 2.0 * clip.w / determinant : 0.0;
  map.stepX = scale * (perV.y * u - perU.y * v);
  map.stepY = scale * (perU.x * v - perV.x * u);
  map.clipX = map.shadow.clipFromView * vec4(map.stepX, 0.0);
  map.clipY = map.shadow.clipFromView * vec4(map.stepY, 0.0);
  map.tolerance = kSeenTolerance * sqrt(length(map.stepX) * length(map.stepY)) + map.shadow.depth.y;
  return map;
}

// Index into shadows[] of the light's first map that contains s; the number beyond the light's last: none.
uint findMap(LightConstants light, vec3 s, out ShadowReceiver receiver) {
  uint map = light.meta.y, end = map + light.meta.z;
  for (; map < end; ++map) {
    receiver = projectReceiver(shadows[map], s);
    if (receiver.inside) break;
  }
  return map;
}

// From `samples` points of the light's maps, around the first that contains x; a cube's seams are no borders.
// `turn` and `within`, [0, 1): which of the patterns this point takes; neighbors take others, and share what
// they find.
Gathered gatherLight(uint m, LightConstants light, Surface x, uint samples, float turn, float within) {
  float mm = frame.camera.range.w;
  Gathered sum = Gathered(vec3(0.0), vec3(0.0), vec3(0.0));
  ShadowReceiver receiver;
  uint current = findMap(light, x.position, receiver), none = light.meta.y + light.meta.z;
  if (current == none) return sum;
  Incident incident = incidentLight(light, x.position);
  GatherMap map = gatherMap(current, receiver.clip, incident.toLight);
  GatherConstants material = materials[m].gather;

  // Rings around an axis between the light's ray and the normal inwards, the one that suits a slab: there
  // they are around the foot of the perpendicular. `t`: along it, from x to the lit surface.
  float facing = x.hasNormal ? max(-dot(x.normal, incident.toLight), 0.0) : 0.0;
  vec3 axis = normalize(incident.toLight - facing * x.normal); // the two are within 90 degrees
  float axisCosine = dot(axis, incident.toLight);
  float longest = material.lengths.z / mm, t = 0.0;
  float stored = shadowTexel(map.shadow.meta.x, receiver.texel);
  if (shadowHolds(map.shadow, stored)) {
    vec3 y = entryPoint(map.shadow, light, receiver, x.position, stored);
    t = clamp(dot(y - x.position, incident.toLight), 0.0, longest);
    ShadowReceiver along = projectReceiver(map.shadow, x.position + t * axis);
    if (along.inside) {
      stored = shadowTexel(map.shadow.meta.x, along.texel);
      if (shadowHolds(map.shadow, stored))
        t = clamp(dot(entryPoint(map.shadow, light, along, x.position + t * axis, stored) - x.position, axis), 0.0,
                  longest);
    }
  }
  vec3 center = x.position + t * axis;
  t *= mm;

  vec3 across = normalize(cross(axis, abs(axis.x) < 0.7 ? vec3(1.0, 0.0, 0.0) : vec3(0.0, 1.0, 0.0)));
  vec3 along = cross(axis, across);
  vec2 direction = vec2(cos(6.28318531 * turn), sin(6.28318531 * turn));
  float inner = 0.0, perSample = 1.0 / float(samples);
  for (uint i = 0u; i < samples; ++i) {
    float outer = i + 1u == samples ? 1.0e6 : gatherRadius(material, t, float(i + 1u) * perSample);
    float rho = gatherRadius(material, t, (float(i) + within) * perSample);
    vec3 s = center + (rho / mm) * (direction.x * across + direction.y * along);
    float from = inner;
    inner = outer;
    direction = mat2(-0.73736888, 0.67549029, -0.67549029, -0.73736888) * direction; // the golden angle
    uint found = findMap(light, s, receiver);
    if (found == none) continue;
    if (found != current) map = gatherMap(found, receiver.clip, incident.toLight);
    current = found;
    stored = shadowTexel(map.shadow.meta.x, receiver.texel);
    if (!shadowHolds(map.shadow, stored)) continue;
    vec3 y = entryPoint(map.shadow, light, receiver, s, stored);

    vec3 normal = cross(entrySlope(map.shadow, light, receiver, s, y, ivec2(1, 0), map.stepX, map.clipX),
                        entrySlope(map.shadow, light, receiver, s, y, ivec2(0, 1), map.stepY, map.clipY));
    float size = length(normal);
    float cosine = dot(normal, incident.toLight);
    normal = size > 0.0 ? normal * (sign(cosine) / size) : incident.toLight; // towards the light
    cosine = size > 0.0 ? max(abs(cosine) / size, kLeastCosine) : 1.0;
    // What faces away cannot be seen, however thin the part is.
    if (dot(normal, x.view) < 0.0 && cameraSees(y, map.tolerance)) continue;

    vec3 to = (x.position - y) * mm;
    float squared = dot(to, to), r = sqrt(squared);
    float opposite = x.hasNormal ? 0.5 - 0.5 * dot(x.normal, normal) : 1.0; // 1 - m
    float through = max(-dot(normal, to), 0.0);
    float h = x.hasNormal ? sqrt(through * max(dot(x.normal, to), 0.0) / max(opposite, 1.0e-4)) : through;
    h = min(h, r);
    // The ring, seen as if all of it lay in y's plane across the axis.
    float plane = max(squared - rho * rho, 0.0);
    float near = sqrt(plane + from * from), far = sqrt(plane + outer * outer);
    vec3 flux = incidentLight(light, s).irradiance * axisCosine;
    sum.transmitted += flux * opposite * gatherTransmitted(gatherSlab(material, h), h, near, far);
    if (opposite < 0.99) {
      vec3 reflected = (1.0 - opposite) * gatherReflected(material.profile.rgb, near, far);
      sum.entering += flux * reflected;
      sum.displaced += reflected * (axisCosine / cosine);
    }
  }
  return sum;
}

#endif
