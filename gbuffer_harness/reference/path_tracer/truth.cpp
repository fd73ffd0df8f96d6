#include "reference/path_tracer/truth.h"

#include <algorithm>
#include <cmath>

#include "common/error.h"
#include "common/parallel.h"
#include "reference/color.h"
#include "reference/path_tracer/walk.h"

namespace pellucid::harness::reference {

namespace {

// Factor of the exitance at each pixel: its albedo, 1 where there is none, over rho of its medium; 0 without a material.
std::vector<glm::dvec3> albedoOverRho(const Capture& capture, const std::vector<TraceMedium>& media) {
  std::vector<glm::dvec3> scale(capture.material.size());
  std::vector<glm::dvec3> rho;
  for (std::size_t i = 0; i < media.size(); ++i) {
    rho.push_back(halfSpaceReflectance(media[i]));
    if (!glm::all(glm::greaterThan(rho[i], glm::dvec3(0))))
      throw InputError(capture.name, "materials[" + std::to_string(i) + "]",
                       "scatters nothing back in one of the channels");
  }
  for (std::size_t i = 0; i < scale.size(); ++i) {
    if (capture.material[i] == 0) continue;
    const glm::dvec3 albedo = capture.albedo.empty() ? glm::dvec3(1) : readColor(capture.albedo.data.data() + 3 * i);
    scale[i] = albedo / rho[capture.material[i] - 1u];
  }
  return scale;
}

}  // namespace

TruthTracer::TruthTracer(const Capture& capture, const VisibleSurface& surface, const TraceScene& scene,
                         const std::vector<TraceMedium>& media, const Emitters& emitters)
    : capture_(capture),
      surface_(surface),
      scene_(scene),
      media_(media),
      emitters_(emitters),
      scale_(albedoOverRho(capture, media)) {}

glm::dvec3 TruthTracer::sampleWall(std::size_t pixel, const TraceMedium::Wall& wall,
                                   PathRandom& random) const {
  SurfacePoint other = *surface_.points[pixel];
  other.face = -other.face;
  other.normal = -other.normal;
  const glm::dvec3 reflected = wall.reflectance * readColor(capture_.irradiance.data.data() + 3 * pixel);
  return scale_[pixel] *
         (reflected + wall.transmittance * sampleIrradiance(scene_, emitters_, other, random));
}

glm::dvec3 TruthTracer::sample(std::size_t pixel, std::uint64_t number, std::uint64_t seed) const {
  PathRandom random(seed, pixel, number);
  const TraceMedium& medium = media_[capture_.material[pixel] - 1u];
  if (medium.wall) return sampleWall(pixel, *medium.wall, random);
  const std::optional<WalkExit> exit = walk(scene_, medium, *surface_.points[pixel], random);
  if (!exit) return glm::dvec3(0);
  return scale_[pixel] * exit->weight * sampleIrradiance(scene_, emitters_, exit->surface, random);
}

void TruthTracer::trace(TruthSums& sums, std::uint64_t count, std::uint64_t seed, int jobs,
                        const std::function<void()>& progress) const {
  sums.width = surface_.width;
  sums.height = surface_.height;
  sums.sum.resize(scale_.size(), glm::dvec3(0));
  sums.sumOfSquares.resize(scale_.size(), glm::dvec3(0));
  const auto width = static_cast<std::size_t>(surface_.width);
  parallelRows(surface_.height, jobs, [&](int y) {
    const std::size_t begin = static_cast<std::size_t>(y) * width;
    for (std::size_t i = begin; i < begin + width; ++i) {
      if (!surface_.points[i]) continue;
      for (std::uint64_t s = sums.samples; s < sums.samples + count; ++s) {
        const glm::dvec3 value = sample(i, s, seed);
        sums.sum[i] += value;
        sums.sumOfSquares[i] += value * value;
      }
    }
    progress();
  });
  sums.samples += count;
}

Truth truthOf(const TruthSums& sums) {
  Truth truth;
  truth.image = truth.standardError = Image(sums.width, sums.height, 3);
  truth.samples = sums.samples;
  const double n = static_cast<double>(std::max<std::uint64_t>(sums.samples, 1));
  for (std::size_t i = 0; i < sums.sum.size(); ++i)
    for (int c = 0; c < 3; ++c) {
      const double mean = sums.sum[i][c] / n;
      const double variance = std::max(0.0, sums.sumOfSquares[i][c] / n - mean * mean);
      const std::size_t k = 3 * i + static_cast<std::size_t>(c);
      truth.image.data[k] = static_cast<float>(mean);
      truth.standardError.data[k] = static_cast<float>(std::sqrt(variance / std::max(1.0, n - 1)));
    }
  return truth;
}

TruthSums sumsOf(const Truth& truth) {
  TruthSums sums{truth.image.width, truth.image.height, truth.samples, {}, {}};
  const double n = static_cast<double>(truth.samples);
  for (std::size_t i = 0; i < truth.image.pixels(); ++i) {
    glm::dvec3 sum, squares;
    for (int c = 0; c < 3; ++c) {
      const double mean = truth.image.data[3 * i + static_cast<std::size_t>(c)];
      const double error = truth.standardError.data[3 * i + static_cast<std::size_t>(c)];
      sum[c] = n * mean;
      squares[c] = n * (mean * mean + error * error * std::max(1.0, n - 1));
    }
    sums.sum.push_back(sum);
    sums.sumOfSquares.push_back(squares);
  }
  return sums;
}

}  // namespace pellucid::harness::reference
