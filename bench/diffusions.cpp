#include "diffusions.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "common/compare.h"
#include "common/error.h"
#include "names.h"
#include "reference/reference.h"
#include "scene.h"

namespace pellucid::bench {

using namespace harness;

namespace {

// A logarithmic axis from decade to decade.
Axis decades(const std::string& label, const std::vector<TimedError>& points, double TimedError::*value) {
  const auto [low, high] =
      std::minmax_element(points.begin(), points.end(),
                          [&](const TimedError& a, const TimedError& b) { return a.*value < b.*value; });
  return {label, true, std::pow(10, std::floor(std::log10(*low.*value))),
          std::pow(10, std::ceil(std::log10(*high.*value)))};
}

}  // namespace

std::shared_ptr<const BenchFrame> Site::frame(const Capture& capture, ReplaySettings settings) const {
  settings.normalFormat = VK_FORMAT_R8G8B8A8_SNORM;  // four bytes, as those of engines' G-buffers
  return std::make_shared<BenchFrame>(device, context, capture, std::vector{material}, settings);
}

Image Site::run(const Variant& variant) const {
  device.run(variant.record);
  return variant.output();
}

double requireNear(const Variant& v, const Image& image, const Image& truth, const Capture& capture,
                   double limit, const std::vector<std::uint8_t>& pixels) {
  const Comparison c = compareImages(
      image, truth,
      pixels.empty() ? comparisonMask(capture.material, capture.irradiance, Subset::All) : pixels);
  double sum = 0;
  for (const ChannelDifference& k : c.channels) sum += k.relativeRmse * k.relativeRmse;
  const double error = std::sqrt(sum / static_cast<double>(c.channels.size()));
  if (!(error <= limit) || c.nonFiniteA > 0)
    throw DeviceError(v.name + " on \"" + capture.name + "\" is off by " + std::to_string(error));
  return error;
}

std::vector<Variant> diffusions(const Site& site, const Capture& capture) {
  ReplaySettings settings;
  settings.features = PELLUCID_FEATURE_DIFFUSION;
  const auto frame = site.frame(capture, settings);
  std::vector<Variant> all = {moduleVariant(frame, kModule)};
  for (Variant& v : baselines(frame)) all.push_back(std::move(v));
  return all;
}

std::vector<double> diffusionErrors(const Site& site) {
  std::vector<double> errors;
  for (const ErrorScene& scene : errorScenes()) {
    const Capture capture = makeErrorCapture(scene, 96, site.pixel);
    reference::Settings settings;
    settings.features = PELLUCID_FEATURE_DIFFUSION;
    settings.wanted = spreadPixels(capture, site.errorPixels);
    const Image truth = reference::compute(capture, {site.material}, settings).image;
    const std::vector<Variant> variants = diffusions(site, capture);
    errors.resize(variants.size());
    for (size_t i = 0; i < variants.size(); ++i)
      errors[i] = std::max(
          errors[i], requireNear(variants[i], site.run(variants[i]), truth, capture, 0.5, settings.wanted));
  }
  return errors;
}

Plot timeAgainstError(const std::string& title, const std::vector<TimedError>& points,
                      const std::string& from) {
  const Color colors[] = {{200, 30, 30},  {30, 90, 200},  {20, 140, 60},
                          {150, 80, 160}, {220, 140, 20}, {80, 80, 80}};
  Plot plot;
  plot.title = title;
  plot.x = decades("relative RMSE from " + from, points, &TimedError::error);
  plot.y = decades("microseconds", points, &TimedError::time);
  for (const TimedError& p : points) {
    const std::string family = p.name.substr(0, p.name.find(','));
    auto series = std::find_if(plot.series.begin(), plot.series.end(),
                               [&](const Series& s) { return s.name == family; });
    if (series == plot.series.end()) {
      Series s;
      s.name = family;
      s.color = colors[plot.series.size() % std::size(colors)];
      s.points = true;
      series = plot.series.insert(plot.series.end(), s);
    }
    series->x.push_back(p.error);
    series->y.push_back(p.time);
  }
  return plot;
}

}  // namespace pellucid::bench
