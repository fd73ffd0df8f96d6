#include "capture/light_table.h"

#include <algorithm>
#include <cmath>

namespace pellucid::harness {

std::vector<double> readLightTable(const Field& field, PellucidLightType type) {
  if (type == PELLUCID_LIGHT_DIRECTIONAL) field.fail("is of point and spot lights; the light is directional");
  std::vector<double> given;
  for (const Field& item : field.items()) given.push_back(item.number(0, 1));
  if (given.size() < 2) field.fail("needs two factors or more, has " + std::to_string(given.size()));
  std::vector<double> table(PELLUCID_LIGHT_TABLE_ENTRIES);
  for (std::size_t i = 0; i < table.size(); ++i) {
    const double place = static_cast<double>(i * (given.size() - 1)) / static_cast<double>(table.size() - 1);
    const std::size_t below = std::min(static_cast<std::size_t>(place), given.size() - 2);
    table[i] = std::lerp(given[below], given[below + 1], place - static_cast<double>(below));
  }
  return table;
}

}  // namespace pellucid::harness
