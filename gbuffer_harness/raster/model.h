// Triangle meshes with what a rasterizer needs to draw them: what a glTF file becomes, and what tests build
// by hand. World space is right-handed and in scene units throughout.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "capture/capture.h"
#include "scene/camera.h"

namespace pellucid::harness {

struct Vertex {
  std::array<float, 3> position;  // world
  std::array<float, 3> normal;    // world, unit
  std::array<float, 2> uv = {0, 0};
  std::array<float, 3> color = {1, 1, 1};  // linear; multiplies the base color
  float mark = 1;                          // pixels where it interpolates to less than 0.5 get material 0
  std::array<float, 2> normalUv = {0, 0};  // of the normal map
  // World, unit, along which u grows; the map's +y is along w cross(normal, tangent), w = 1 or -1. 0: both
  // follow from positions and normalUv.
  std::array<float, 4> tangent = {0, 0, 0, 0};
  std::array<float, 2> lobeUv = {0, 0};  // of the lobe map
  float alpha = 1;                       // multiplies that of the base color's texel
};

inline glm::dvec3 positionOf(const Vertex& vertex) {
  return {vertex.position[0], vertex.position[1], vertex.position[2]};
}

enum class TextureWrap { Repeat, Clamp, Mirror };

struct Texture {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgba;  // row 0 first; sRGB color, linear alpha
  TextureWrap wrapU = TextureWrap::Repeat, wrapV = TextureWrap::Repeat;
  bool isNormalMap = false;  // rgb are vectors, 0 .. 255 for -1 .. 1
};

enum class SurfaceLobes {
  Together,  // the albedo is the sum of both
  Apart  // the albedo is addedColor's, which light that comes through has, too; that of other light is apart
};

// How a part is drawn, with rgb and a of the lobe map: albedo = texture * baseColor * vertex color *
// (1 - displaced * a) + addedColor * rgb * a. With lobes apart the first term, and `backscatter` times the
// second, reflect light, and the capture's irradiance is times their ratio to the second.
struct Surface {
  std::string name;
  std::array<double, 3> baseColor = {1, 1, 1};   // linear
  bool hasReflectance = false;                   // baseColor is the diffuse reflectance of the material
  std::array<double, 3> addedColor = {0, 0, 0};  // linear
  int texture = -1;                              // into Model::textures; -1: white
  double alphaCutoff = 0;                        // where alpha is less there is a hole; 0: nowhere
  bool doubleSided = false;                      // drawn from behind too, with the normal turned round
  std::uint8_t material = 0;                     // value in the material image; 0: not translucent
  int normalMap = -1;                            // into Model::textures; -1: none
  double normalScale = 1;                        // of the map's x and y
  int lobeMap = -1;                              // into Model::textures; -1: white
  double displaced = 0;                          // 0 .. 1
  double backscatter = 0;                        // >= 0
  SurfaceLobes lobes = SurfaceLobes::Together;
  bool isEmissive = false;  // glows in the file; a capture holds no such light
};

struct Part {
  std::uint32_t firstIndex = 0, indexCount = 0;  // triangles, counterclockwise from outside
  std::uint32_t surface = 0;                     // into Model::surfaces
  // Parts of one object bound one volume: a back face closes the volume only of its own object. < 2^24.
  std::uint32_t object = 0;
};

struct ModelCamera {
  std::string name, node;            // of the camera, or the node's if it has none; of the node
  Matrix viewFromWorld = kIdentity;  // rigid, -z forward
  bool orthographic = false;
  double verticalFov = 0.5;  // radians; perspective
  double height = 1;         // scene units from the lower to the upper edge; orthographic
  double aspect = 0;         // width / height of the image it is meant for; 0: any
  ClipRange range;           // `reversed` is decided by the rasterizer's options
};

struct Model {
  std::string name;
  double metersPerUnit = 1;
  // Place in the file's world at which the model's world begins; other than 0 if floats would be too coarse.
  std::array<double, 3> origin = {0, 0, 0};
  std::vector<Vertex> vertices;
  std::vector<std::uint32_t> indices;
  std::vector<Part> parts;
  std::vector<Surface> surfaces;
  std::vector<Texture> textures;
  std::vector<MaterialSource> materials;
  // For each number of a body (bodies.h) the index in `materials`. These numbers follow those of materials.
  std::vector<std::uint8_t> bodies;
  std::vector<ModelCamera> cameras;
  std::vector<Light> lights;  // without shadow maps
};

}  // namespace pellucid::harness
