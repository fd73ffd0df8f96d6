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
  struct Found {
    std::optional<Matrix> matrix;
    std::string file;
    bool isUsed = false;
  };
  Found worldToCamera, worldToNdc;
  std::optional<double> screenWindowWidth, pixelAspectRatio;
  std::optional<std::array<double, 2>> screenWindowCenter;
  std::string windowFile;

  bool hasProjection() const { return worldToCamera.matrix && worldToNdc.matrix; }
};

constexpr double kSameEntry = 1e-4, kSameDigits = 1e-5;

std::string digits(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

constexpr const char* kTwoCameras =
    ": these are files of two cameras. Render all buffers with one; or, if an attribute is wrong, give the camera by --eye, --target and "
    "--fov";

// Of worldToNDC, the row of depths may have other planes.
void requireSame(const Attributes::Found& first, const Matrix& other, const std::string& file, const char* name, bool hasDepths) {
  for (std::size_t i = 0; i < 16; ++i) {
    const double a = (*first.matrix)[i], b = other[i];
    const double most = std::max(kSameEntry, kSameDigits * std::max(std::abs(a), std::abs(b)));
    if ((hasDepths || i % 4 != 2) && !(std::abs(a - b) <= most))
      throw InputError(file, name, "holds " + digits(b) + " where that of " + first.file + " holds " + digits(a) + kTwoCameras);
  }
}

// The first matrix is taken, and those of other buffers have to be the same.
class Takes {
public:
  Takes(const CameraSource& source, bool compares) : source_(source), compares_(compares && source.isUsed) {}

  void operator()(Attributes::Found& to, const std::optional<Matrix>& found, const char* name, bool hasDepths) const {
    if (!found) return;
    if (!to.matrix)
      to = {found, source_.file.string(), source_.isUsed};
    else if (compares_ && to.isUsed)
      requireSame(to, *found, source_.file.string(), name, hasDepths);
  }

private:
  const CameraSource& source_;
  bool compares_;
};

// A width of 1 says nothing: every file has it.
void takeWindow(Attributes& all, const CameraSource& source, const ExrFile& file, bool compares) {
  const std::optional<double> width = file.findNumber("screenWindowWidth", source.part);
  if (!width || *width == 1) return;
  if (!all.screenWindowWidth) {
    all.screenWindowWidth = width;
    all.screenWindowCenter = file.findPair("screenWindowCenter", source.part);
    all.windowFile = source.file.string();
  } else if (compares && source.isUsed && !(std::abs(*width - *all.screenWindowWidth) <= kSameEntry)) {
    throw InputError(source.file.string(), "screenWindowWidth",
                     "is " + digits(*width) + ", but that of " + all.windowFile + " is " + digits(*all.screenWindowWidth) + kTwoCameras);
  }
}

// Who gives the whole camera says it of all files.
bool isGiven(const CameraWords& words) {
  return words.eye && words.target && (words.verticalFov || words.orthographicHeight);
}

Attributes attributesOf(const std::vector<CameraSource>& sources, const CameraWords& words) {
  Attributes all;
  for (const CameraSource& source : sources) {
    const ExrFile file(source.file);
    const Takes take(source, !isGiven(words));
    take(all.worldToCamera, file.findMatrix("worldToCamera", source.part), "worldToCamera", true);
    // A program that says nothing writes the identity.
    const std::optional<Matrix> ndc = file.findMatrix("worldToNDC", source.part);
    if (ndc != kIdentity) take(all.worldToNdc, ndc, "worldToNDC", false);
    takeWindow(all, source, file, !words.verticalFov && !words.orthographicHeight);
    if (!all.pixelAspectRatio) all.pixelAspectRatio = file.findNumber("pixelAspectRatio", source.part);
  }
  return all;
}

// OpenEXR's camera space is left-handed and looks along +z; some programs write a right-handed one that looks
// along -z.
Matrix viewOf(const Attributes& attributes) {
  glm::dmat4 view = toGlm(*attributes.worldToCamera.matrix);
  if (!(glm::length(glm::transpose(view)[3] - glm::dvec4(0, 0, 0, 1)) < 1e-3))
    throw InputError(attributes.worldToCamera.file, "worldToCamera", "is no rotation and translation, or transposed; give --eye and --target instead");
  for (int i = 0; i < 3; ++i)
    if (std::abs(glm::length(glm::dvec3(view[i])) - 1) > 1e-3)
      throw InputError(attributes.worldToCamera.file, "worldToCamera", "has a scale; give --eye and --target instead");
  if (glm::determinant(glm::dmat3(view)) < 0)
    for (int column = 0; column < 4; ++column) view[column][2] = -view[column][2];
  return fromGlm(view);
}

ClipRange rangeOf(const CameraWords& words, const DepthFacts& depth, bool isOrthographic) {
  if (depth.isDevice && !words.nearPlane)
    throw UsageError(
        "--near: is needed, because depths within 0 .. 1 are the device's, and only its planes say how far "
        "they are; --depth viewz says that they are distances");
  ClipRange range;
  range.nearPlane = words.nearPlane.value_or(0.5 * depth.nearest);
  range.farPlane = words.farPlane.value_or(std::numeric_limits<double>::infinity());
  range.reversed = words.reversedZ.value_or(depth.looksReversed);
  if (isOrthographic && !std::isfinite(range.farPlane)) {
    if (depth.isDevice) throw UsageError("--far: is needed with an orthographic camera and the device's depths");
    range.farPlane = range.nearPlane + 1e6 * depth.nearest;
  }
  return range;
}

// Rows of a matrix from the view to the image, whose w is 1 at distance 1.
struct Ndc {
  glm::dvec4 x, y, w;
  bool isPerspective;
};

Ndc ndcOf(const Attributes& attributes) {
  const glm::dmat4 rows = glm::transpose(toGlm(*attributes.worldToNdc.matrix) * glm::inverse(toGlm(viewOf(attributes))));
  const glm::dvec4 w = rows[3], ahead(0, 0, -1, 1);
  const double scale = glm::dot(w, ahead);
  if (!(scale > 0))
    throw InputError(attributes.worldToNdc.file, "worldToNDC",
                     "what lies before the camera of worldToCamera is not in front of it; give --fov or --ortho-height instead");
  return {rows[0] / scale, rows[1] / scale, w / scale, std::abs(w.z) > 1e-6 * std::abs(w.w)};
}

// The image is 0 .. 1 with y down (OpenEXR), or -1 .. 1 with y up. Which one is no matter of its middle: lenses shift.
Matrix projectionOf(const Ndc& ndc, const ClipRange& range) {
  const bool isOpenExr = ndc.y.y < 0;
  glm::dmat4 clip(0);
  clip[0] = isOpenExr ? 2.0 * ndc.x - ndc.w : ndc.x;
  clip[1] = isOpenExr ? 2.0 * ndc.y - ndc.w : -ndc.y;
  clip[3] = ndc.w;
  const glm::dmat4 depths =
      glm::transpose(toGlm(ndc.isPerspective ? perspective(1, 1, range) : orthographic(1, 1, range)));
  clip[2] = depths[2];
  return fromGlm(glm::transpose(clip));
}

std::string degrees(double radians) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g degrees", radians * 180 / std::numbers::pi);
  return text;
}

}  // namespace

GuessedCamera guessCamera(const std::vector<CameraSource>& sources, int width, int height, const CameraWords& words,
                          const DepthFacts& depth) {
  const Attributes attributes = attributesOf(sources, words);
  GuessedCamera camera;
  if (words.eye || words.target) {
    if (!words.eye || !words.target)
      throw UsageError(words.eye ? "--eye: needs --target" : "--target: needs --eye");
    if (*words.eye == *words.target) throw UsageError("--target: is where --eye is");
    camera.viewFromWorld = lookAt(*words.eye, *words.target, words.up);
    camera.isPlaced = true;
  } else if (attributes.worldToCamera.matrix) {
    camera.viewFromWorld = viewOf(attributes);
    camera.isPlaced = true;
  } else {
    camera.unknown.push_back(
        "where the camera is (--eye X,Y,Z --target X,Y,Z): the world is taken for the camera's space, in "
        "which x is right, y up and -z ahead");
  }
  const double aspect = static_cast<double>(width) / height * attributes.pixelAspectRatio.value_or(1);
  std::optional<Ndc> ndc;
  if (!words.orthographicHeight && !words.verticalFov && attributes.hasProjection()) ndc = ndcOf(attributes);
  const ClipRange range = rangeOf(words, depth, words.orthographicHeight || (ndc && !ndc->isPerspective));
  if (words.orthographicHeight) {
    camera.clipFromView = orthographic(*words.orthographicHeight * aspect, *words.orthographicHeight, range);
    camera.why = "--ortho-height";
  } else if (words.verticalFov) {
    camera.clipFromView = perspective(*words.verticalFov * std::numbers::pi / 180, aspect, range);
    camera.why = "--fov";
  } else if (ndc) {
    camera.clipFromView = projectionOf(*ndc, range);
    camera.why = "the attributes worldToCamera and worldToNDC";
  } else if (attributes.screenWindowWidth && *attributes.screenWindowWidth > 0) {
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
