#include "cli/minimum_dot_table.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scene/vector.h"

namespace pellucid::harness {
namespace {

struct Axes {
  glm::dvec3 side, up, front;
};

Axes axesOf(const DotTable& table) {
  const glm::dvec3 up = glm::normalize(toGlm(table.up));
  const glm::dvec3 side = glm::normalize(glm::cross(up, toGlm(table.face)));
  return {side, up, glm::cross(side, up)};
}

glm::dvec3 unfolded(double x, double y) {
  const double u = 1 - std::abs(x) - std::abs(y);
  if (u >= 0) return {x, u, y};
  return {std::copysign(1 - std::abs(y), x), u, std::copysign(1 - std::abs(x), y)};
}

// Across the light, so that the eye swings about the up axis where the light does not stand on it.
glm::dvec3 sidewaysOf(const glm::dvec3& toLight, const Axes& axes) {
  const glm::dvec3 across = glm::cross(axes.up, toLight);
  return glm::length(across) > 1e-6 ? glm::normalize(across) : axes.side;
}

}  // namespace

std::vector<Vector3> lightDirections(const DotTable& table) {
  const Axes axes = axesOf(table);
  std::vector<Vector3> directions;
  const auto add = [&](const glm::dvec3& local) {
    directions.push_back(
        fromGlm(glm::normalize(local.x * axes.side + local.y * axes.up + local.z * axes.front)));
  };
  if (table.sphere) {
    const double spacing = 2.0 / (table.size - 1);
    for (int j = 0; j < table.size; ++j)
      for (int i = 0; i < table.size; ++i) add(unfolded(i * spacing - 1, j * spacing - 1));
  } else {
    for (int i = 0; i < table.size; ++i) {
      const double azimuth = 2 * std::numbers::pi * i / table.size;
      add({std::sin(azimuth), 0, std::cos(azimuth)});
    }
  }
  return directions;
}

std::vector<double> measureMinimumDots(const DotTable& table, const Swing& swing,
                                       const LightThrough& through) {
  const Axes axes = axesOf(table);
  const auto dotAt = [&](int step) {
    return step == 0 ? 0 : std::cos(std::numbers::pi / 2 * (1 + static_cast<double>(step) / swing.steps));
  };
  std::vector<std::vector<double>> light;  // by entry and step
  double most = 0;
  for (const Vector3& direction : lightDirections(table)) {
    const glm::dvec3 toLight = toGlm(direction), sideways = sidewaysOf(toLight, axes);
    light.emplace_back();
    for (int step = 0; step <= swing.steps; ++step) {
      const double dot = dotAt(step);
      const glm::dvec3 away = std::sqrt(std::max(0.0, 1 - dot * dot)) * sideways;
      const double one = through(direction, fromGlm(dot * toLight + away));
      const double other = step < swing.steps ? through(direction, fromGlm(dot * toLight - away)) : one;
      light.back().push_back(std::max(one, other));
      most = std::max(most, light.back().back());
    }
  }
  const double enough = swing.threshold * most;
  std::vector<double> dots;
  for (const std::vector<double>& steps : light) {
    const auto first = std::find_if(steps.begin(), steps.end(), [&](double v) { return v > enough; });
    const int step = static_cast<int>(first - steps.begin());
    double dot = -1;
    if (step == 0) {
      dot = 0;
    } else if (first != steps.end()) {
      const double from = dotAt(step - 1), to = dotAt(step), before = *(first - 1);
      dot = from + (to - from) * (enough - before) / (*first - before);
    }
    dots.push_back(std::round(dot * 1e4) / 1e4 + 0.0);  // no minus zero
  }
  return dots;
}

}  // namespace pellucid::harness
