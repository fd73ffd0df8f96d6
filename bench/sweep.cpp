#include "sweep.h"

#include <optional>
#include <string>

#include "floor.h"
#include "measure.h"
#include "scene.h"

namespace pellucid::bench {

using namespace harness;

namespace {

struct Size {
  int width, height;

  std::string text() const { return std::to_string(width) + "x" + std::to_string(height); }
};

// Of the diffusions at one size and radius; nothing where `wanted` is false.
std::vector<std::optional<Time>> times(const Site& site, const Size& size, int repeat,
                                       const std::vector<bool>& wanted) {
  const std::vector<Variant> variants = diffusions(site, slab(size.width, size.height, 1, site.pixel));
  std::vector<std::optional<Time>> result(variants.size());
  for (size_t i = 0; i < variants.size(); ++i)
    if (wanted[i]) result[i] = measure(site.device, repeat, variants[i].record);
  return result;
}

}  // namespace

nlohmann::json sweep(const Site& site, const SweepOptions& options, int repeat, std::FILE* table,
                     std::vector<Plot>* plots) {
  std::vector<Size> sizes;
  for (const int height : options.heights) sizes.push_back({height * 16 / 9, height});
  std::vector<double> floors;
  std::fprintf(table, "\n%-32s %7s %9s", "sweep: us (x floor)", "radius", "error");
  for (const Size& size : sizes) {
    const harness::Capture scene = slab(size.width, size.height, 1, site.pixel);
    floors.push_back(measureFloors(site.device, scene, repeat).front().time.median);
    std::fprintf(table, " %18s", size.text().c_str());
  }
  std::fprintf(table, "\n");

  nlohmann::json rows = nlohmann::json::array();
  std::vector<std::vector<TimedError>> points(sizes.size());
  for (const double radius : options.radii) {
    const Site scaled{site.device, site.context, site.material, pixelSizeFor(site.material, radius),
                      site.errorPixels};
    const std::vector<double> errors = diffusionErrors(scaled);
    // The last size comes first: it says which baselines are worth the time at the others.
    std::vector<bool> wanted(errors.size(), true);
    std::vector<std::vector<std::optional<Time>>> all(sizes.size());
    for (size_t s = sizes.size(); s-- > 0;) {
      all[s] = times(scaled, sizes[s], repeat, wanted);
      for (size_t i = 1; s + 1 == sizes.size() && i < errors.size(); ++i)
        wanted[i] = all[s][i]->median <= kSlowest * floors[s];
    }
    const std::vector<Variant> named = diffusions(scaled, slab(64, 64, 1, scaled.pixel));
    for (size_t i = 0; i < errors.size(); ++i) {
      std::fprintf(table, "  %-30s %7g %9.2g", named[i].name.c_str(), radius, errors[i]);
      if (!wanted[i]) std::fprintf(table, " more than %g floors", kSlowest);
      for (size_t s = 0; wanted[i] && s < sizes.size(); ++s) {
        const Time& t = *all[s][i];
        std::fprintf(table, " %9.1f (%6.2f)", t.median, t.median / floors[s]);
        points[s].push_back({named[i].name, errors[i], t.median});
        rows.push_back({{"section", "sweep"},
                        {"name", named[i].name},
                        {"size", sizes[s].text()},
                        {"radius", radius},
                        {"relative_rmse", errors[i]},
                        {"us", t.median},
                        {"p10_us", t.low},
                        {"p90_us", t.high},
                        {"floor_ratio", t.median / floors[s]}});
      }
      std::fprintf(table, "\n");
    }
  }
  plots->clear();
  for (size_t s = 0; s < sizes.size(); ++s)
    plots->push_back(timeAgainstError(sizes[s].text() + ", " + site.device.description(), points[s]));
  return rows;
}

}  // namespace pellucid::bench
