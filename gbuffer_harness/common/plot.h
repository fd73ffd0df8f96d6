// Line plots as PNG.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace pellucid::harness {

using Color = std::array<std::uint8_t, 3>;  // sRGB

struct Series {
  std::string name;  // in the legend; empty: not listed
  Color color = {0, 0, 0};
  std::vector<double> x, y;  // as many of each; what an axis cannot show breaks the line
  bool points = false;       // dots instead of a line
};

struct Axis {
  std::string label;
  bool logarithmic = false;
  std::optional<double> low, high;  // default: what the series need
};

struct Plot {
  std::string title;  // ASCII, like every text
  Axis x, y;
  std::vector<Series> series;
};

// The plots side by side, each `width` x `height` pixels. Throws InputError when the file cannot be written.
void writePlot(const std::filesystem::path& path, const std::vector<Plot>& plots, int width = 720,
               int height = 520);

}  // namespace pellucid::harness
