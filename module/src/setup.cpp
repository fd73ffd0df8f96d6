#include "setup.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "material/transmittance.h"

namespace pellucid {
namespace {

const char* whyNot(const Inputs& inputs, bool solids) {
  const PellucidThesisOptions& t = inputs.thesis;
  if (inputs.frame.options.cameraThickness == 1) return "thickness comes from the camera";
  if (t.materialMarkBit != 0) return "materialMarkBit is of one thickness a pixel";
  if (t.angleModel != PELLUCID_ANGLE_NORMAL || t.constantViewDirection != 0 || t.maximumThickness > 0)
    return "angleModel, constantViewDirection and maximumThickness are of one thickness a pixel";
  if (!solids) return "every material is thin-walled";
  for (uint32_t i = 0; i < inputs.frame.materialCount; ++i)
    if (!canBeGathered(modelOf(inputs.frame.materials[i])))
      return "a material's transmittance model has no profile";
  return nullptr;
}

// At most 2^19 probes in frames of up to 3840 x 2160, so that their time hardly grows with the frame.
uint32_t spacingOf(const PellucidFrame& frame) {
  if (frame.options.gatherSpacing != 0) return frame.options.gatherSpacing;
  const uint64_t pixels = static_cast<uint64_t>(frame.imageExtent[0]) * frame.imageExtent[1];
  return pixels > 1u << 20 ? 4 : pixels > 1u << 19 ? 2 : 1;
}

// The lattice begins a whole number of the coarsest level's texels from the anchor's pixel.
Lattice latticeOf(const PellucidFrame& f) {
  Lattice lattice{.extent = {f.imageExtent[0], f.imageExtent[1]}};
  const glm::dvec4 anchor(glm::vec4(f.options.anchor[0], f.options.anchor[1], f.options.anchor[2], 1));
  if (f.options.anchor[3] == 0) return lattice;
  constexpr int kSide = 1 << PELLUCID_LAST_LEVEL;
  static_assert(kSide % PELLUCID_BLOCK == 0);
  lattice.extent += kSide - 1;
  const glm::dvec4 clip = toMatrix(f.clipFromView) * (toMatrix(f.viewFromWorld) * anchor);
  if (!(clip.w > 0)) return lattice;
  const glm::dvec2 extent(f.imageExtent[0], f.imageExtent[1]);
  // Far outside of the image any pixel will do. Cameras often look at the anchor, where the image has a corner or a center of pixels:
  // neither may decide by its rounding.
  constexpr double kFar = 1 << 24, kOffCorners = 0.3;
  const glm::dvec2 at = (glm::dvec2(clip) / clip.w * 0.5 + 0.5) * extent;
  const glm::ivec2 pixel(glm::clamp(glm::floor(at + kOffCorners), -kFar, kFar));
  lattice.first = -pixel & (kSide - 1);
  lattice.period = -pixel - lattice.first;
  return lattice;
}

// Passes take planar distances above 0 for surfaces. The near plane of an orthographic camera may lie behind the eye: the eye then moves
// behind that plane, in both matrices. View z is what it is, and has no surface behind the eye.
void moveEyeBack(const PellucidFrame& f, const DepthRange& range, glm::dmat4& clipFromView, glm::dmat4& viewFromWorld) {
  const bool front = f.options.frontDepthEncoding == PELLUCID_DEPTH_DEVICE,
             back = !given(f.backDepth) || f.options.backDepthEncoding != PELLUCID_DEPTH_VIEW_Z;
  if (range.perspective || !front || !back) return;
  const double at0 = -(range.b / range.a), at1 = (range.d - range.b) / range.a;  // planar distances of depths 0 and 1
  const double least = std::min(at0, at1), most = std::max(at0, at1);
  if (least >= 0) return;
  constexpr double kAhead = 1e-3;  // of the range: the near plane's own distance is above 0
  const glm::dvec4 moved(0, 0, range.forward * (kAhead * (most - least) - least), 0);
  clipFromView[3] -= clipFromView * moved;
  viewFromWorld[3] += moved;
}

}  // namespace

double deviationOf(const PellucidMaterial& m) {
  double variance = 0;
  for (int c = 0; c < 3; ++c)
    for (uint32_t i = 0; i < m.gaussianCount; ++i)
      if (m.gaussianWeight[c][i] > 0)
        variance = std::max(variance, static_cast<double>(m.gaussianVariance[c][i]));
  return std::sqrt(variance);
}

Setup::Setup(const Inputs& inputs)
    : Inputs(inputs),
      lattice(latticeOf(frame)),
      rect(renderRect(frame).movedBy(lattice.first)),
      wide(frame.options.outputFormat == VK_FORMAT_R32G32B32A32_SFLOAT),
      colorFormat(wide ? VK_FORMAT_R32G32B32A32_SFLOAT : VK_FORMAT_R16G16B16A16_SFLOAT),
      clipFromView(toMatrix(frame.clipFromView)),
      viewFromWorld(toMatrix(frame.viewFromWorld)),
      pyramid(lattice.extent, rect) {
  const glm::uvec2 extent(frame.imageExtent[0], frame.imageExtent[1]);
  readDepthRange(clipFromView, &depthRange);
  moveEyeBack(frame, depthRange, clipFromView, viewFromWorld);
  readDepthRange(clipFromView, &depthRange);
  camera = makeCamera(clipFromView, depthRange, extent, frame.metersPerUnit, lattice.first);

  const double mmPerPixel =
      pixelSide(clipFromView, depthRange, extent) * static_cast<double>(frame.metersPerUnit) * 1000;
  pixelsPerMm = mmPerPixel > 0 ? 1 / mmPerPixel : 0;
  float shortestLength = std::numeric_limits<float>::infinity();
  for (uint32_t i = 0; i < frame.materialCount; ++i) {
    const PellucidMaterial& m = frame.materials[i];
    (m.thinWalled != 0 ? thinWalls : solids) = true;
    if (m.thinWalled == 0) shortestLength = std::min(shortestLength, diffusionLength(m));
    if (diffusedCount(m) == 0) continue;
    diffuses = true;
    widestDeviation = std::max(widestDeviation, pixelsPerMm * deviationOf(m));
  }

  whyNotGathered = whyNot(inputs, solids);
  gatherSamples = whyNotGathered ? 0 : frame.options.gatherSamples;
  gatherSpacing = spacingOf(frame);
  gathers = translucency() && gatherSamples > 0 && !debug();
  shapes = gathers && diffuses;
  constexpr float kEntriesPerLength = 2;  // the fewest that resolve light which varies over a length
  longestEntrySide = shortestLength / (kEntriesPerLength * 1000 * frame.metersPerUnit);
}

}  // namespace pellucid
