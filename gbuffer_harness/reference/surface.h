// Geometry of a capture, pixel by pixel: what the depths say in double precision.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "capture/capture.h"
#include "reference/camera.h"

namespace pellucid::harness::reference {

// View space, scene units.
struct Surface {
  glm::dvec3 position;
  glm::dvec3 ray;     // unit, from the eye to the position
  glm::dvec3 normal;  // unit, towards the eye, of the pixel's quad; against the ray if depths have no plane
  glm::dvec3 middle;  // of the quad, where its surface has that normal
  glm::ivec2 pixel;
  std::optional<double> chord;  // length of the ray between the front and back surface, > 0, or the stored thickness
};

// Quads are squares of 2 x 2 pixels from the image's first pixel on. A quad's surface is its nearest pixel
// with a material, and the pixels of that material within reach of it. A plane through the middles of the
// quads around has its normal: normals of single pixels turn from triangle to triangle, and with the rounding
// of depths.
class SurfaceReader {
public:
  // Keeps a reference to the capture. Throws InputError when an image is missing or has the wrong size.
  explicit SurfaceReader(const Capture& capture);

  // Nothing where the front depth holds nothing. Pixel center of (x, y).
  std::optional<Surface> at(int x, int y) const;

  // Unit normals of the front and back depths of the surface's pixel and the pixels beside, view space,
  // towards the eye. A front whose depths span no plane faces the eye. Such a back has no normal.
  glm::dvec3 facet(const Surface& surface) const;
  std::optional<glm::dvec3> backFacet(const Surface& surface) const;

  // The face that a pixel hides, from the depths of the pixel and the pixels beside.
  struct HiddenFace {
    glm::dvec3 position, normal;  // view space; unit, outward: opposite to the front where back depths span no plane
    double thickness;             // of the body, scene units
    double opposite;              // part of the light that enters there that leaves at the pixel
  };
  // `surface` has a chord.
  HiddenFace hiddenFace(const Surface& surface) const;

  // Parallelogram of the surface's tangent plane that the pixel covers: its two half-axes, scene
  // units, view space. Tilted planes tile without gaps. Planes seen more obliquely than
  // kLeastCosine are turned towards the eye until they are not, so no pixel stands for more than
  // 1/kLeastCosine times the area facing the eye.
  struct Footprint {
    glm::dvec3 halfX, halfY;
  };
  static constexpr double kLeastCosine = 0.05;
  Footprint footprint(int x, int y, const Surface& surface) const;

  double millimetersPerUnit() const { return 1000 * capture_.metersPerUnit; }
  const Camera& camera() const { return camera_; }
  const glm::dmat4& worldFromView() const { return worldFromView_; }

private:
  struct Quad {
    std::uint8_t material = 0;  // 0: no surface
    double farthest = 0;        // planar depth of the pixels that count, at most
    glm::dvec3 middle{0};       // mean of their positions
  };

  std::uint8_t materialAt(int x, int y) const;
  // The surface's chord, unless it is shorter than all chords of pixels beside.
  double chordBeside(const Surface& surface) const;
  std::optional<double> planarDepth(const DepthImage& depth, int x, int y) const;
  Quad makeQuad(int column, int row) const;
  // One that has no surface beyond the image.
  Quad quadAt(glm::ivec2 place) const;
  std::optional<glm::dvec3> quadNormal(glm::ivec2 place) const;
  // From a quad to whichever of its neighbors along an axis is nearer in depth and of the same material: the
  // other one may lie across an edge. That of a facing surface where there is none.
  glm::dvec3 quadSlope(glm::ivec2 place, glm::ivec2 step) const;
  glm::dvec3 slopeAlong(const DepthImage& depth, int x, int y, int stepX, int stepY,
                        const glm::dvec3& position) const;
  // Unit, towards the eye; absent where depths span no plane. `position`: of the surface at the pixel.
  std::optional<glm::dvec3> normalFromDepth(const DepthImage& depth, int x, int y,
                                            const glm::dvec3& position) const;
  // Displacement of one pixel's step at the surface's distance, facing the camera.
  glm::dvec3 flatStep(int x, int y, const glm::dvec3& position, const glm::dvec2& step) const;

  const Capture& capture_;
  Camera camera_;
  glm::dmat4 worldFromView_;
  int quadColumns_, quadRows_;
  std::vector<Quad> quads_;
};

}  // namespace pellucid::harness::reference
