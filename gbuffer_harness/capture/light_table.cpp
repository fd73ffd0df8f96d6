#include "capture/light_table.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <tuple>

namespace pellucid::harness {

namespace {

// Linear between the table's factors, at a place from 0 to 1.
double between(const std::vector<double>& table, double place) {
  const double at = place * static_cast<double>(table.size() - 1);
  const std::size_t below = std::min(static_cast<std::size_t>(at), table.size() - 2);
  return std::lerp(table[below], table[below + 1], at - static_cast<double>(below));
}

double placeOf(std::size_t i, std::size_t count) {
  return static_cast<double>(i) / static_cast<double>(count - 1);
}

}  // namespace

std::vector<double> readLightTable(const Field& field, PellucidLightType type, double& error) {
  if (type == PELLUCID_LIGHT_DIRECTIONAL) field.fail("is of point and spot lights; the light is directional");
  const std::vector<double> given = field.numbers(0, 1);
  if (given.size() < 2) field.fail("needs two factors or more, has " + std::to_string(given.size()));
  std::vector<double> table(PELLUCID_LIGHT_TABLE_ENTRIES);
  for (std::size_t i = 0; i < table.size(); ++i) table[i] = between(given, placeOf(i, table.size()));
  error = 0;
  for (std::size_t i = 0; i < given.size(); ++i)
    error = std::max(error, std::abs(between(table, placeOf(i, given.size())) - given[i]));
  return table;
}

std::vector<std::string> coarseTables(const Capture& capture) {
  constexpr double kVisible = 0.01;
  std::vector<std::string> sentences;
  for (std::size_t i = 0; i < capture.lights.size(); ++i) {
    const Light& light = capture.lights[i];
    for (const auto& [key, error, step] :
         {std::tuple("angleTable", light.angleTableError, "180 degrees"),
          std::tuple("distanceTable", light.distanceTableError, "the range")}) {
      if (!(error > kVisible)) continue;
      char sentence[200];
      std::snprintf(sentence, sizeof sentence,
                    "lights[%zu].%s: factors at 1/%d of %s miss the file's by up to %.2g of the most: its "
                    "lobes are narrower",
                    i, key, PELLUCID_LIGHT_TABLE_ENTRIES - 1, step, error);
      sentences.emplace_back(sentence);
    }
  }
  return sentences;
}

}  // namespace pellucid::harness
