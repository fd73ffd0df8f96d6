#include "capture/read.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <glm/glm.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <limits>
#include <map>
#include <set>
#include <sstream>
#include <tuple>
#include <vector>

#include "common/error.h"

namespace pellucid::harness {

namespace {

// Marks material pixels outside the data window: no material, whatever the map says of 0.
constexpr float kOutside = -std::numeric_limits<float>::infinity();

struct Request {
  const BufferSource* source;
  Image* image;  // channels set
  float outside;
  bool screen;                      // must have the screen's size
  bool mustCover;                   // pixels outside the data window are an error
  const Request* beside = nullptr;  // must have that one's size; comes after it
  const DepthImage* depth = nullptr;
  bool isHalf = false;              // the file has half floats
};

std::string sizeText(int width, int height) { return std::to_string(width) + "x" + std::to_string(height); }

// Opens each file once, agrees on the screen's size, then reads each part in one pass.
class Loader {
public:
  explicit Loader(const Manifest& manifest) : manifest_(manifest) {}

  Request& want(const BufferSource& source, Image& image, int channels, float outside, bool screen) {
    image.channels = channels;
    return requests_.emplace_back(Request{&source, &image, outside, screen, false});
  }
  Request& wantDepth(const BufferSource& source, DepthImage& depth, bool screen) {
    Request& request = want(source, depth.image, 1, kNoDepth, screen);
    request.depth = &depth;
    request.mustCover = depth.encoding == PELLUCID_DEPTH_DEVICE;
    return request;
  }
  void wantBeside(const Request& map, const BufferSource& source, Image& image, float outside,
                  bool mustCover) {
    Request& request = want(source, image, 1, outside, false);
    request.mustCover = mustCover;
    request.beside = &map;
  }

  void load(int& screenWidth, int& screenHeight, std::vector<std::string>& warnings) {
    std::map<std::tuple<std::filesystem::path, int, ExrWindow>, std::vector<ExrPlane>> parts;
    const Request* first = nullptr;
    const Request* ofView = nullptr;  // the first of a stereo file
    std::string firstView;
    std::set<std::string> said;
    for (Request& request : requests_) {
      const BufferSource& source = *request.source;
      if (source.isConstant()) continue;
      const ExrFile& file = open(source.file, source.field + ".file");
      const int part = file.findPart(source.channels, source.part, source.field);
      request.isHalf = file.channelFormat(part, source.channels.front()) == "half";
      if (const std::string lossy = file.lossyCompression(part, source.channels.front()); !lossy.empty() && request.image->channels == 1)
        warnings.push_back(source.field + ": " + lossy + " compression changes the channel \"" + source.channels.front() +
                           "\", as it does colors; write depths and ids with ZIP");
      const std::string view = request.screen ? file.viewOf(part, source.channels.front()) : "";
      if (!view.empty() && ofView && view != firstView)
        throw InputError(source.file.string(), source.field,
                         "of the view \"" + view + "\", but " + ofView->source->field + " is of \"" +
                             firstView + "\"; a capture has one eye");
      if (!view.empty() && !ofView) {
        ofView = &request;
        firstView = view;
      }
      if (request.image->channels == 3)
        for (const std::string& sentence : file.unusedAttributes(part))
          if (said.insert(source.file.string() + sentence).second)
            warnings.push_back(source.field + ": " + source.file.filename().string() + ", " + sentence);
      // In a file of several parts the display window is the screen's, whatever the shadow map's size.
      const ExrWindow window = request.screen || file.partCount() == 1 ? ExrWindow::Display : ExrWindow::Data;
      if (const auto [x, y] = file.dataOrigin(part); !request.screen && window == ExrWindow::Data && (x != 0 || y != 0))
        throw InputError(source.file.string(), source.field,
                         "the part's data window begins at (" + std::to_string(x) + ", " + std::to_string(y) +
                             "); a cropped shadow map lacks texels: write the whole window, or a file of one part");
      const int width = file.width(part, window), height = file.height(part, window);
      if (request.screen && !first) {
        first = &request;
        screenWidth = width;
        screenHeight = height;
      } else if (request.screen && (width != screenWidth || height != screenHeight)) {
        throw InputError(source.file.string(), source.field,
                         sizeText(width, height) + " pixels, but " + first->source->field + " has " +
                             sizeText(screenWidth, screenHeight));
      }
      if (request.mustCover && window == ExrWindow::Display && !file.coversDisplay(part))
        throw InputError(
            source.file.string(), source.field,
            "the data window leaves out pixels of the display window, for which device depth has no "
            "value; use viewZ or write the whole window");
      auto& planes = parts[{source.file, part, window}];
      for (std::size_t i = 0; i < source.channels.size(); ++i)
        planes.push_back({source.channels[i], request.image, static_cast<int>(i), request.outside});
    }
    if (!first)
      throw InputError(manifest_.path.string(), "buffers",
                       "every buffer is a constant; one must come from a file, to give the size");
    for (const auto& [key, planes] : parts) {
      const auto& [path, part, window] = key;
      files_.at(path).read(part, window, planes);
    }
    for (const Request& request : requests_) {
      if (request.source->isConstant()) fill(request, screenWidth, screenHeight);
      if (request.beside) checkBeside(request);
      scale(request);
      if (request.isHalf && request.depth) warnOfHalves(request, warnings);
    }
  }

  std::vector<std::filesystem::path> files() const {
    std::vector<std::filesystem::path> paths = {manifest_.path};
    for (const auto& [path, file] : files_) paths.push_back(path);
    return paths;
  }

private:
  const ExrFile& open(const std::filesystem::path& path, const std::string& field) {
    auto found = files_.find(path);
    if (found == files_.end()) found = files_.emplace(path, ExrFile(path, field)).first;
    return found->second;
  }

  // Halves tell distances apart by a part in 2048; device depths are coarser still.
  void warnOfHalves(const Request& request, std::vector<std::string>& warnings) const {
    double nearest = kLeastNoDepth;
    for (const float v : request.image->data)
      if (v > 0) nearest = std::min(nearest, static_cast<double>(v));
    const double step = nearest / 2048 * manifest_.capture.metersPerUnit * 1000;
    constexpr double kFine = 0.05;  // mm, of a thickness of a millimeter
    if (request.depth->encoding == PELLUCID_DEPTH_DEVICE)
      warnings.push_back(request.source->field + ": device depths in half floats are too coarse for thicknesses; write 32-bit floats");
    else if (step > kFine && nearest < kLeastNoDepth) {
      std::ostringstream sentence;
      sentence.precision(2);
      sentence << request.source->field << ": half floats tell depths apart by " << step
               << " mm or more; thin parts need 32-bit floats";
      warnings.push_back(sentence.str());
    }
  }

  void checkBeside(const Request& request) const {
    const Image &image = *request.image, &map = *request.beside->image;
    if (image.width == map.width && image.height == map.height) return;
    throw InputError(
        (request.source->isConstant() ? manifest_.path : request.source->file).string(),
        request.source->field,
        sizeText(image.width, image.height) + " texels, but its map has " + sizeText(map.width, map.height));
  }

  // A constant shadow map is one texel; screen buffers and what lies beside a map have that one's size.
  static void fill(const Request& request, int width, int height) {
    Image& image = *request.image;
    if (request.beside)
      image = Image(request.beside->image->width, request.beside->image->height, 1);
    else
      image = request.screen ? Image(width, height, image.channels) : Image(1, 1, image.channels);
    for (std::size_t i = 0; i < image.data.size(); ++i)
      image.data[i] = static_cast<float>(request.source->constant[i % request.source->constant.size()]);
  }

  static void scale(const Request& request) {
    if (request.source->scale == 1) return;
    for (float& value : request.image->data)
      if (value < kLeastNoDepth) value *= static_cast<float>(request.source->scale);
  }

  const Manifest& manifest_;
  std::deque<Request> requests_;  // its elements stay where they are
  std::map<std::filesystem::path, ExrFile> files_;
};

// The map's tile of an image that it shares.
void crop(const BufferSource& source, const ShadowMap& map, const std::array<int, 2>& size, Image& image) {
  if (image.empty()) return;
  const auto [x, y] = map.offset;
  if (x > image.width - size[0] || y > image.height - size[1])
    throw InputError(source.file.string(), source.field,
                     "the tile of " + sizeText(size[0], size[1]) + " texels at (" + std::to_string(x) + ", " +
                         std::to_string(y) + ") is outside the image of " +
                         sizeText(image.width, image.height));
  image = cropped(image, x, y, size[0], size[1]);
}

std::vector<std::uint8_t> materialIndices(const Manifest& manifest, const BufferSource& source,
                                          const MaterialMap& map, const Image& stored) {
  const std::size_t count = manifest.capture.materials.size();
  const auto fail = [&](std::size_t pixel, const std::string& why) {
    const auto width = static_cast<std::size_t>(stored.width);
    std::ostringstream sentence;
    sentence << "pixel (" << pixel % width << ", " << pixel / width << ") holds " << stored.data[pixel]
             << why;
    throw InputError((source.isConstant() ? manifest.path : source.file).string(), source.field,
                     sentence.str());
  };
  std::vector<std::uint8_t> indices(stored.pixels());
  const auto others = map.find(kOtherValues);
  for (std::size_t i = 0; i < indices.size(); ++i) {
    if (stored.data[i] == kOutside) continue;
    const float value = std::round(stored.data[i]);
    const float asByte = 255 * stored.data[i];
    if (others == map.end() && asByte > 0.5f && asByte < 254.5f && std::abs(asByte - std::round(asByte)) < 0.1f)
      fail(i, " = " + std::to_string(std::lround(asByte)) + "/255, a byte that was read as a fraction; give \"scale\": 255");
    // Halves are off by a part in 4096.
    const bool isFiltered = std::abs(value - stored.data[i]) > 0.01f + 2.5e-4f * std::abs(value);
    if (isFiltered && others == map.end()) fail(i, ", which is no whole number; images of materials must not be filtered");
    const bool isWhole = !isFiltered && std::abs(value) <= kMaxStoredMaterial;
    int index = isWhole ? static_cast<int>(value) : -1;
    if (const auto mapped = map.find(index); isWhole && mapped != map.end())
      index = mapped->second;
    else if (others != map.end())
      index = others->second;
    else if (index < 0)
      fail(i, ", which is no material; \"map\": {\"*\": 0} makes what it does not name opaque");
    else if (!map.empty() && index != 0)
      fail(i, ", which \"map\" does not name; \"*\": 0 in it makes such values opaque");
    if (static_cast<std::size_t>(index) > count)
      fail(i, ", but there are " + std::to_string(count) + " materials");
    indices[i] = static_cast<std::uint8_t>(index);
  }
  return indices;
}

bool holdsSurface(const DepthImage& depth, std::size_t pixel) {
  const float value = depth.image.data[pixel];
  return value > 0 && value < (depth.encoding == PELLUCID_DEPTH_DEVICE ? 1 : kLeastNoDepth);
}

// Distances in front of the eye are above 0. Where the sign is another, every pixel would be empty.
void requirePositive(const BufferSource& source, const DepthImage& depth) {
  if (depth.encoding == PELLUCID_DEPTH_DEVICE) return;
  const bool isThickness = depth.encoding == PELLUCID_DEPTH_THICKNESS;
  const auto within = [&](float v) { return isThickness ? holdsThickness(v) : v > 0 && v < kLeastNoDepth; };
  const std::vector<float>& values = depth.image.data;
  if (std::any_of(values.begin(), values.end(), within) ||
      std::none_of(values.begin(), values.end(), [&](float v) { return within(-v); }))
    return;
  throw InputError(source.file.string(), source.field,
                   isThickness ? "holds no thickness from 0 on but negative ones; a thickness is in mm, and "
                                 "\"scale\" gives the mm of 1"
                               : "holds no depth above 0 but negative ones; give \"scale\": -1, as depths "
                                 "are positive in front of the eye");
}

// View z of distances from the eye along the ray. A direction (x, y, -1) whose ray meets the pixel is a
// solution of two linear equations: its clip x and y are those of the pixel times its clip w.
void toViewZ(const Matrix& clipFromView, DepthImage& depth) {
  const auto clip = [&](std::size_t row, std::size_t column) { return clipFromView[4 * column + row]; };
  for (int y = 0; y < depth.image.height; ++y)
    for (int x = 0; x < depth.image.width; ++x) {
      float& value = *depth.image.at(x, y);
      if (!(value < kLeastNoDepth)) continue;
      const double ndc[] = {(x + 0.5) / depth.image.width * 2 - 1, (y + 0.5) / depth.image.height * 2 - 1};
      double m[2][3];
      for (std::size_t r = 0; r < 2; ++r)
        for (std::size_t c = 0; c < 3; ++c) m[r][c] = clip(r, c) - ndc[r] * clip(3, c);
      const double determinant = m[0][0] * m[1][1] - m[0][1] * m[1][0];
      if (determinant == 0) continue;  // no camera has such a matrix, and the frame refuses it
      const double dx = (m[0][2] * m[1][1] - m[0][1] * m[1][2]) / determinant,
                   dy = (m[0][0] * m[1][2] - m[0][2] * m[1][0]) / determinant;
      value = static_cast<float>(double(value) / std::hypot(dx, dy, 1.0));
    }
  depth.encoding = PELLUCID_DEPTH_VIEW_Z;
}

void multiply(Image& image, const Image& times) {
  for (std::size_t i = 0; i < times.data.size(); ++i) image.data[i] *= times.data[i];
}

// The light on a black surface is not known. A pixel without a material needs none.
void divideByAlbedo(const Manifest& manifest, Capture& capture) {
  // A black surface that rounding made nearly black becomes a lamp.
  constexpr float kMostTimes = 100;
  float largest = 0;
  for (const float light : capture.irradiance.data)
    if (std::isfinite(light)) largest = std::max(largest, light);
  std::size_t bright = 0;
  for (std::size_t i = 0; i < capture.irradiance.data.size(); ++i) {
    float& light = capture.irradiance.data[i];
    const float albedo = capture.albedo.data[i];
    const std::size_t pixel = i / 3, width = static_cast<std::size_t>(capture.width);
    if (albedo > 0) {
      light /= albedo;
      bright += capture.material[pixel] != 0 && light > kMostTimes * largest;
    } else if (capture.material[pixel] == 0 || !holdsSurface(capture.frontDepth, pixel)) {
      light = 0;
    } else {
      std::ostringstream sentence;
      sentence << "pixel (" << pixel % width << ", " << pixel / width << ") holds " << light << " in "
               << "RGB"[i % 3] << ", which its albedo of " << albedo << " cannot divide";
      throw InputError(manifest.path.string(), manifest.irradiance.field + ".includesAlbedo", sentence.str());
    }
  }
  if (bright > 0)
    capture.warnings.push_back(manifest.irradiance.field + ".includesAlbedo: " + std::to_string(bright) +
                               " values are over 100 times the largest stored one, as their albedo is next to 0; raise the albedo there");
}

// Planar distance of a stored depth.
double planarOf(const Matrix& clip, PellucidDepthEncoding encoding, float stored) {
  const double depth = stored, z = encoding == PELLUCID_DEPTH_DEVICE ? (clip[14] - depth * clip[15]) / (depth * clip[11] - clip[10]) : 0;
  return encoding == PELLUCID_DEPTH_DEVICE ? (clip[11] > 0 ? z : -z) : depth;
}

// Between the front and the back depth of a pixel with a material, a light enters no face.
void warnOfLightsInBodies(Capture& c) {
  if (c.backDepth.image.empty() || c.backDepth.encoding == PELLUCID_DEPTH_THICKNESS) return;
  for (std::size_t i = 0; i < c.lights.size(); ++i) {
    if (c.lights[i].type == PELLUCID_LIGHT_DIRECTIONAL) continue;
    const glm::dvec4 view = glm::make_mat4(c.viewFromWorld.data()) * glm::dvec4(glm::make_vec3(c.lights[i].position.data()), 1),
                     clip = glm::make_mat4(c.clipFromView.data()) * view;
    const glm::dvec2 at = (glm::dvec2(clip) / clip.w * 0.5 + 0.5) * glm::dvec2(c.width, c.height);
    if (!(clip.w > 0 && at.x >= 0 && at.y >= 0 && at.x < c.width && at.y < c.height)) continue;
    const int x = static_cast<int>(at.x), y = static_cast<int>(at.y);
    const double light = c.clipFromView[11] > 0 ? view.z : -view.z;
    const double front = planarOf(c.clipFromView, c.frontDepth.encoding, *c.frontDepth.image.at(x, y)),
                 back = planarOf(c.clipFromView, c.backDepth.encoding, *c.backDepth.image.at(x, y));
    if (c.material[static_cast<std::size_t>(y) * static_cast<std::size_t>(c.width) + static_cast<std::size_t>(x)] != 0 &&
        front > 0 && front < light && light < back && back < static_cast<double>(kLeastNoDepth))
      c.warnings.push_back("lights[" + std::to_string(i) + "].position: lies inside the body that pixel (" + std::to_string(x) + ", " +
                           std::to_string(y) + ") shows: its light enters no face, and none comes through; move it outside");
  }
}

Capture readImages(const Manifest& manifest) {
  Capture capture = manifest.capture;
  Image material, irradianceTimes, truthTimes;
  Loader loader(manifest);
  loader.wantDepth(manifest.frontDepth, capture.frontDepth, true);
  if (manifest.backDepth) loader.wantDepth(*manifest.backDepth, capture.backDepth, true);
  loader.want(manifest.irradiance, capture.irradiance, 3, 0, true);
  if (manifest.hiddenIrradiance)
    loader.want(*manifest.hiddenIrradiance, capture.hiddenIrradiance, 3, 0, true);
  if (manifest.motion) loader.want(*manifest.motion, capture.motion, 2, 0, true);
  if (manifest.albedo) loader.want(*manifest.albedo, capture.albedo, 3, 0, true);
  loader.want(manifest.material, material, 1, kOutside, true);
  if (manifest.truth) loader.want(*manifest.truth, capture.truth->image, 3, 0, true);
  if (manifest.truthStandardError)
    loader.want(*manifest.truthStandardError, capture.truth->standardError, 3, 0, true);
  if (manifest.irradianceTimes) loader.want(*manifest.irradianceTimes, irradianceTimes, 3, 0, true);
  if (manifest.truthTimes) loader.want(*manifest.truthTimes, truthTimes, 3, 0, true);
  std::deque<Image> casters;
  for (std::size_t i = 0; i < capture.lights.size(); ++i)
    for (std::size_t k = 0; k < capture.lights[i].shadowMaps.size(); ++k) {
      const ShadowSources& sources = manifest.shadowMaps[i][k];
      ShadowMap& map = capture.lights[i].shadowMaps[k];
      const Request& depth = loader.wantDepth(sources.depth, map.depth, false);
      if (sources.exit) loader.wantBeside(depth, *sources.exit, map.exitDepth, kNoDepth, depth.mustCover);
      if (sources.casterMaterial)
        loader.wantBeside(depth, *sources.casterMaterial, casters.emplace_back(), kOutside, false);
    }
  loader.load(capture.width, capture.height, capture.warnings);
  capture.files = loader.files();
  requirePositive(manifest.frontDepth, capture.frontDepth);
  if (manifest.backDepth) requirePositive(*manifest.backDepth, capture.backDepth);
  for (std::size_t i = 0; i < capture.lights.size(); ++i)
    for (std::size_t k = 0; k < capture.lights[i].shadowMaps.size(); ++k)
      requirePositive(manifest.shadowMaps[i][k].depth, capture.lights[i].shadowMaps[k].depth);
  for (DepthImage* depth : {&capture.frontDepth, &capture.backDepth})
    if (depth->encoding == PELLUCID_DEPTH_DISTANCE) toViewZ(capture.clipFromView, *depth);

  multiply(capture.irradiance, irradianceTimes);
  for (std::size_t i = 0; i < capture.motion.data.size(); ++i)
    capture.motion.data[i] *= static_cast<float>(manifest.motionScale[i % 2]);
  if (capture.truth) multiply(capture.truth->image, truthTimes);

  auto tile = casters.begin();
  for (std::size_t i = 0; i < capture.lights.size(); ++i)
    for (std::size_t k = 0; k < capture.lights[i].shadowMaps.size(); ++k) {
      const ShadowSources& sources = manifest.shadowMaps[i][k];
      ShadowMap& map = capture.lights[i].shadowMaps[k];
      Image* const caster = sources.casterMaterial ? &*tile++ : nullptr;
      if (!sources.tile) continue;
      crop(sources.depth, map, *sources.tile, map.depth.image);
      crop(sources.depth, map, *sources.tile, map.exitDepth);
      if (caster) crop(sources.depth, map, *sources.tile, *caster);
    }
  capture.material = materialIndices(manifest, manifest.material, manifest.materialMap, material);
  auto caster = casters.begin();
  for (std::size_t i = 0; i < capture.lights.size(); ++i)
    for (std::size_t k = 0; k < capture.lights[i].shadowMaps.size(); ++k)
      if (const ShadowSources& sources = manifest.shadowMaps[i][k]; sources.casterMaterial)
        capture.lights[i].shadowMaps[k].casterMaterial =
            materialIndices(manifest, *sources.casterMaterial, sources.casterMaterialMap, *caster++);
  if (manifest.irradianceIncludesAlbedo) divideByAlbedo(manifest, capture);
  const std::vector<float>& backs = capture.backDepth.image.data;
  if (manifest.backDepth && capture.backDepth.encoding == PELLUCID_DEPTH_THICKNESS && manifest.backDepth->scale == 1 &&
      std::none_of(backs.begin(), backs.end(), [](float v) { return v > 1; }))
    capture.warnings.push_back("buffers.backDepth: no thickness is above 1 mm; \"scale\" gives the mm of 1 if the map holds values from 0 to 1");
  warnOfLightsInBodies(capture);
  return capture;
}

}  // namespace

Capture readCapture(const std::filesystem::path& path) {
  return readCapture(withinMemory(path.string(), [&] { return readManifest(path); }));
}

Capture readCapture(const Manifest& manifest) {
  return withinMemory(manifest.path.string(), [&] { return readImages(manifest); });
}

}  // namespace pellucid::harness
