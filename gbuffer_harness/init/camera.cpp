#include "init/manifest.h"

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <limits>
#include <numbers>

#include "capture/exr.h"
#include "common/error.h"
#include "scene/vector.h"

namespace pellucid::harness {

namespace {

struct Attributes {
  std::string file;  // of worldToCamera, or else of worldToNDC
  std::optional<Matrix> worldToCamera, worldToNdc;
  std::optional<double> screenWindowWidth, pixelAspectRatio;
  std::optional<std::array<double, 2>> screenWindowCenter;
};

Attributes attributesOf(std::vector<std::filesystem::path> files, const ChannelGroup& color) {
  Attributes all;
  std::stable_partition(files.begin(), files.end(), [&](const auto& path) { return path == color.file; });
  for (const std::filesystem::path& path : files) {
    const ExrFile file(path);
    const int first = path == color.file ? color.part : 0;
    const auto take = [&](auto& to, auto found) {
      if (!to && found) {
        to = found;
        all.file = path.string();
      }
    };
    take(all.worldToCamera, file.findMatrix("worldToCamera", first));
    take(all.worldToNdc, file.findMatrix("worldToNDC", first));
    if (!all.screenWindowWidth) all.screenWindowWidth = file.findNumber("screenWindowWidth", first);
    if (!all.screenWindowCenter) all.screenWindowCenter = file.findPair("screenWindowCenter", first);
    if (!all.pixelAspectRatio) all.pixelAspectRatio = file.findNumber("pixelAspectRatio", first);
  }
  return all;
}

// OpenEXR's camera space is left-handed and looks along +z; some programs write a right-handed one that looks
// along -z.
Matrix viewOf(const Attributes& attributes) {
  glm::dmat4 view = toGlm(*attributes.worldToCamera);
  if (!(glm::length(glm::transpose(view)[3] - glm::dvec4(0, 0, 0, 1)) < 1e-3))
    throw InputError(attributes.file, "worldToCamera", "is no rotation and translation, or transposed; give --eye and --target instead");
  for (int i = 0; i < 3; ++i)
    if (std::abs(glm::length(glm::dvec3(view[i])) - 1) > 1e-3)
      throw InputError(attributes.file, "worldToCamera", "has a scale; give --eye and --target instead");
  if (glm::determinant(glm::dmat3(view)) < 0)
    for (int column = 0; column < 4; ++column) view[column][2] = -view[column][2];
  return fromGlm(view);
}

ClipRange rangeOf(const CameraWords& words, const DepthFacts& depth) {
  if (depth.isDevice && !words.nearPlane)
    throw UsageError(
        "--near: is needed, because depths within 0 .. 1 are the device's, and only its planes say how far "
        "they are; --depth viewz says that they are distances");
  ClipRange range;
  range.nearPlane = words.nearPlane.value_or(0.5 * depth.nearest);
  range.farPlane = words.farPlane.value_or(std::numeric_limits<double>::infinity());
  range.reversed = words.reversedZ.value_or(depth.looksReversed);
  if (words.orthographicHeight && !std::isfinite(range.farPlane)) {
    if (depth.isDevice) throw UsageError("--far: is needed with --ortho-height and the device's depths");
    range.farPlane = range.nearPlane + 1e6 * depth.nearest;
  }
  return range;
}

// The rows of clipFromView from a matrix to 0 .. 1 with y down (OpenEXR), or to -1 .. 1 with y up.
Matrix projectionOf(const Attributes& attributes, const Matrix& viewFromWorld, const ClipRange& range) {
  const glm::dmat4 ndc = glm::transpose(toGlm(*attributes.worldToNdc) * glm::inverse(toGlm(viewFromWorld)));
  glm::dvec4 x = ndc[0], y = ndc[1], w = ndc[3];
  const glm::dvec4 ahead(0, 0, -1, 1);
  const double scale = glm::dot(w, ahead);
  const bool isPerspective = std::abs(w.z) > 1e-6 * std::abs(w.w);
  if (!(scale > 0))
    throw InputError(attributes.file, "worldToNDC",
                     "what lies before the camera of worldToCamera is not in front of it");
  x /= scale;
  y /= scale;
  w /= scale;
  // The axis meets the image near the middle of 0 .. 1, or of -1 .. 1.
  const bool isOpenExr =
      std::abs(glm::dot(x, ahead) - 0.5) < 0.25 && std::abs(glm::dot(y, ahead) - 0.5) < 0.25;
  glm::dmat4 clip(0);
  clip[0] = isOpenExr ? 2.0 * x - w : x;
  clip[1] = isOpenExr ? 2.0 * y - w : -y;
  clip[3] = w;
  const glm::dmat4 depths =
      glm::transpose(toGlm(isPerspective ? perspective(1, 1, range) : orthographic(1, 1, range)));
  clip[2] = depths[2];
  return fromGlm(glm::transpose(clip));
}

std::string degrees(double radians) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g degrees", radians * 180 / std::numbers::pi);
  return text;
}

}  // namespace

GuessedCamera guessCamera(const std::vector<std::filesystem::path>& files, const ChannelGroup& color, int width, int height,
                          const CameraWords& words, const DepthFacts& depth) {
  const Attributes attributes = attributesOf(files, color);
  GuessedCamera camera;
  if (words.eye || words.target) {
    if (!words.eye || !words.target)
      throw UsageError(words.eye ? "--eye: needs --target" : "--target: needs --eye");
    if (*words.eye == *words.target) throw UsageError("--target: is where --eye is");
    camera.viewFromWorld = lookAt(*words.eye, *words.target, words.up);
    camera.isPlaced = true;
  } else if (attributes.worldToCamera) {
    camera.viewFromWorld = viewOf(attributes);
    camera.isPlaced = true;
  } else {
    camera.unknown.push_back(
        "where the camera is (--eye X,Y,Z --target X,Y,Z): the world is taken for the camera's space, in "
        "which x is right, y up and -z ahead");
  }
  const double aspect = static_cast<double>(width) / height * attributes.pixelAspectRatio.value_or(1);
  ClipRange range = rangeOf(words, depth);
  if (words.orthographicHeight) {
    camera.clipFromView = orthographic(*words.orthographicHeight * aspect, *words.orthographicHeight, range);
    camera.why = "--ortho-height";
  } else if (words.verticalFov) {
    camera.clipFromView = perspective(*words.verticalFov * std::numbers::pi / 180, aspect, range);
    camera.why = "--fov";
  } else if (attributes.worldToNdc && attributes.worldToCamera) {
    camera.clipFromView = projectionOf(attributes, viewOf(attributes), range);
    camera.why = "the attributes worldToCamera and worldToNDC";
  } else if (attributes.screenWindowWidth && *attributes.screenWindowWidth > 0 &&
             *attributes.screenWindowWidth != 1) {
    // 1 is what every file has whose program says nothing.
    const double fov = 2 * std::atan(*attributes.screenWindowWidth / aspect / 2);
    camera.clipFromView = perspective(fov, aspect, range);
    // The center is a place in the plane at distance 1, y up, as the width is a length there.
    const auto [x, y] = attributes.screenWindowCenter.value_or(std::array<double, 2>{});
    camera.clipFromView[8] += camera.clipFromView[0] * x;
    camera.clipFromView[9] += camera.clipFromView[5] * y;
    camera.why = "the attribute screenWindowWidth, " + degrees(fov) + " vertically";
  } else {
    throw UsageError(
        "--fov: is needed, the vertical field of view in degrees (or --ortho-height): no file has the "
        "attributes worldToCamera and worldToNDC, or a screenWindowWidth other than 1");
  }
  if (!words.nearPlane)
    camera.unknown.push_back(
        "the near plane (--near): half of the nearest depth is taken, which changes nothing, "
        "because depths are distances");
  return camera;
}

}  // namespace pellucid::harness
