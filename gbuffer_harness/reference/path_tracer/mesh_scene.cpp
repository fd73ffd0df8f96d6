#include "reference/path_tracer/trace_scene.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <vector>

#include "common/error.h"
#include "raster/framing.h"
#include "raster/model.h"
#include "scene/vector.h"

namespace pellucid::harness::reference {

namespace {

// Share of the model's radius: some hundred roundings of Embree's single precision there.
constexpr double kOffset = 1e-5;

struct DeviceDeleter {
  void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
};
struct SceneDeleter {
  void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
};
using EmbreeDevice = std::unique_ptr<RTCDeviceTy, DeviceDeleter>;
using EmbreeScene = std::unique_ptr<RTCSceneTy, SceneDeleter>;

struct Triangle {
  glm::dvec3 corner[3], normal[3];
  glm::dvec3 face;
  std::uint8_t material;
  bool doubleSided;
};

RTCRay embreeRay(const Ray& ray, double from, double limit) {
  RTCRay result = {};
  result.org_x = static_cast<float>(ray.origin.x);
  result.org_y = static_cast<float>(ray.origin.y);
  result.org_z = static_cast<float>(ray.origin.z);
  result.dir_x = static_cast<float>(ray.direction.x);
  result.dir_y = static_cast<float>(ray.direction.y);
  result.dir_z = static_cast<float>(ray.direction.z);
  result.tnear = static_cast<float>(from);
  result.tfar = static_cast<float>(limit);
  result.mask = ~0u;
  return result;
}

// Triangles of one scene of Embree's, by its primitive numbers.
struct TriangleScene {
  EmbreeScene scene;
  std::vector<Triangle> triangles;
  std::vector<int> body;

  std::optional<RTCRayHit> hit(const Ray& ray, double from, double limit) const {
    RTCRayHit query = {};
    query.ray = embreeRay(ray, from, limit);
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcIntersect1(scene.get(), &context, &query);
    if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
    return query;
  }

  // The point of the hit by its barycentric coordinates: in doubles, and on the triangle itself.
  SurfacePoint point(const RTCRayHit& hit) const {
    const Triangle& t = triangles[hit.hit.primID];
    const double u = hit.hit.u, v = hit.hit.v, w = 1 - u - v;
    SurfacePoint point;
    point.position = w * t.corner[0] + u * t.corner[1] + v * t.corner[2];
    point.face = t.face;
    const glm::dvec3 normal = w * t.normal[0] + u * t.normal[1] + v * t.normal[2];
    const double length = glm::length(normal);
    point.normal = length > 1e-6 ? normal / length : t.face;
    point.body = body[hit.hit.primID];
    point.material = t.material;
    return point;
  }
};

void fill(TriangleScene& to, RTCDevice device) {
  to.scene.reset(rtcNewScene(device));
  // Rays through edges and corners must not slip out of a closed body.
  rtcSetSceneFlags(to.scene.get(), RTC_SCENE_FLAG_ROBUST);
  rtcSetSceneBuildQuality(to.scene.get(), RTC_BUILD_QUALITY_HIGH);
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), 3 * to.triangles.size()));
  auto* indices = static_cast<unsigned*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(unsigned), to.triangles.size()));
  if (!vertices || !indices) {
    rtcReleaseGeometry(geometry);
    throw std::bad_alloc();
  }
  unsigned next = 0;
  for (const Triangle& triangle : to.triangles)
    for (const glm::dvec3& corner : triangle.corner) {
      for (int i = 0; i < 3; ++i) *vertices++ = static_cast<float>(corner[i]);
      *indices++ = next++;
    }
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(to.scene.get(), geometry);
  rtcReleaseGeometry(geometry);
  rtcCommitScene(to.scene.get());
}

class MeshScene : public TraceScene {
public:
  MeshScene(const Model& model, const Bounds& bounds)
      : TraceScene(toGlm(bounds.center), model.metersPerUnit * 1000),
        radius_(bounds.radius * millimetersPerUnit()),
        offset_(kOffset * radius_),
        device_(rtcNewDevice("threads=1")) {
    if (!device_) throw InputError(model.name, "", "Embree could not be started");
    std::map<std::uint32_t, int> bodies;
    for (const Part& part : model.parts) {
      const int body = bodies.emplace(part.object, static_cast<int>(bodies.size())).first->second;
      if (static_cast<std::size_t>(body) == bodies_.size()) bodies_.emplace_back();
      add(model, part, body);
    }
    for (TriangleScene& body : bodies_)
      if (!body.triangles.empty()) fill(body, device_.get());
    if (!opaque_.triangles.empty()) fill(opaque_, device_.get());
    if (all_.triangles.empty()) throw InputError(model.name, "", "has no triangle that has an area");
    fill(all_, device_.get());
  }

  std::optional<SurfacePoint> first(const Ray& ray, double from) const override {
    constexpr double kFar = std::numeric_limits<float>::max();
    for (;;) {
      const auto hit = all_.hit(ray, from, kFar);
      if (!hit) return std::nullopt;
      SurfacePoint point = all_.point(*hit);
      if (glm::dot(point.face, ray.direction) < 0) return point;
      if (all_.triangles[hit->hit.primID].doubleSided) {
        point.face = -point.face;
        point.normal = -point.normal;
        return point;
      }
      from = behind(*hit);
    }
  }

  bool occluded(const Ray& ray, double distance) const override {
    RTCRay query = embreeRay(ray, 0, std::min<double>(distance, std::numeric_limits<float>::max()));
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcOccluded1(all_.scene.get(), &context, &query);
    return query.tfar < 0;
  }

  std::optional<SurfacePoint> exit(int body, const Ray& ray, double limit) const override {
    std::optional<SurfacePoint> exit = ownExit(body, ray, limit);
    if (opaque_.triangles.empty()) return exit;
    const auto block = opaque_.hit(ray, 0, exit ? glm::distance(ray.origin, exit->position) : limit);
    return block ? opaque_.point(*block) : exit;
  }

  std::optional<Sphere> bounds() const override { return Sphere{glm::dvec3(0), radius_}; }
  double offset() const override { return offset_; }

private:
  // The exit where nothing opaque stands before it.
  std::optional<SurfacePoint> ownExit(int body, const Ray& ray, double limit) const {
    const TriangleScene& scene = bodies_[static_cast<std::size_t>(body)];
    double from = 0;
    for (;;) {
      const auto hit = scene.hit(ray, from, limit);
      if (!hit) return std::nullopt;
      if (glm::dot(scene.triangles[hit->hit.primID].face, ray.direction) > 0) return scene.point(*hit);
      from = behind(*hit);
      if (from >= limit) return std::nullopt;
    }
  }

  // Distance at which the search for the next hit begins: further on even where the offset is below a float's
  // step.
  double behind(const RTCRayHit& hit) const {
    return std::max<double>(hit.ray.tfar + offset_,
                            std::nextafter(hit.ray.tfar, std::numeric_limits<float>::max()));
  }

  void add(const Model& model, const Part& part, int body) {
    const Surface& surface = model.surfaces[part.surface];
    TriangleScene& own = bodies_[static_cast<std::size_t>(body)];
    for (std::uint32_t i = 0; i + 2 < part.indexCount; i += 3) {
      Triangle triangle;
      for (std::uint32_t k = 0; k < 3; ++k) {
        const Vertex& vertex = model.vertices[model.indices[part.firstIndex + i + k]];
        const auto at = [](const std::array<float, 3>& v) { return glm::dvec3(v[0], v[1], v[2]); };
        triangle.corner[k] = fromWorld(at(vertex.position));
        triangle.normal[k] = at(vertex.normal);
      }
      const glm::dvec3 across =
          glm::cross(triangle.corner[1] - triangle.corner[0], triangle.corner[2] - triangle.corner[0]);
      const double area = glm::length(across);
      if (!(area > 0)) continue;  // no ray meets it
      triangle.face = across / area;
      triangle.material = surface.material;
      triangle.doubleSided = surface.doubleSided;
      for (TriangleScene* scene : {&own, &all_, &opaque_}) {
        if (scene == &opaque_ && triangle.material != 0) continue;
        scene->triangles.push_back(triangle);
        scene->body.push_back(body);
      }
    }
  }

  double radius_, offset_;
  EmbreeDevice device_;
  std::vector<TriangleScene> bodies_;
  TriangleScene all_, opaque_;
};

}  // namespace

std::unique_ptr<TraceScene> makeMeshScene(const Model& model) {
  return std::make_unique<MeshScene>(model, boundsOf(model));
}

}  // namespace pellucid::harness::reference
