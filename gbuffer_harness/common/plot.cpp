#include "common/plot.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "common/png.h"

namespace pellucid::harness {

namespace {

constexpr Color kInk = {40, 40, 40}, kGrid = {225, 225, 225}, kMinorGrid = {242, 242, 242};

struct Rect {
  int left, top, right, bottom;
};

// White paper in sRGB bytes.
class Canvas {
public:
  Canvas(int width, int height) : width_(width), height_(height), rgb_(bytes(width, height), 255) {}

  int width() const { return width_; }
  int height() const { return height_; }
  const std::vector<std::uint8_t>& rgb() const { return rgb_; }

  void blend(int x, int y, const Color& color, double coverage) {
    if (x < 0 || y < 0 || x >= width_ || y >= height_) return;
    std::uint8_t* pixel = rgb_.data() + bytes(width_, y) + 3 * static_cast<std::size_t>(x);
    for (std::size_t c = 0; c < 3; ++c)
      pixel[c] = static_cast<std::uint8_t>(std::lround(pixel[c] + (color[c] - pixel[c]) * coverage));
  }

  void fill(const Rect& rect, const Color& color) {
    for (int y = rect.top; y < rect.bottom; ++y)
      for (int x = rect.left; x < rect.right; ++x) blend(x, y, color, 1);
  }

  // Anti-aliased, clipped; equal ends make a dot.
  void line(double x0, double y0, double x1, double y1, double thickness, const Color& color,
            const Rect& clip) {
    const double reach = thickness / 2 + 1;
    const auto pixel = [](double value, int low, int high) {
      return static_cast<int>(std::clamp<double>(value, low, high));
    };
    const int left = pixel(std::min(x0, x1) - reach, clip.left, clip.right);
    const int right = pixel(std::max(x0, x1) + reach + 1, clip.left, clip.right);
    const int top = pixel(std::min(y0, y1) - reach, clip.top, clip.bottom);
    const int bottom = pixel(std::max(y0, y1) + reach + 1, clip.top, clip.bottom);
    const double dx = x1 - x0, dy = y1 - y0, length2 = dx * dx + dy * dy;
    for (int y = top; y < bottom; ++y)
      for (int x = left; x < right; ++x) {
        const double px = x + 0.5 - x0, py = y + 0.5 - y0;
        const double t = length2 > 0 ? std::clamp((px * dx + py * dy) / length2, 0.0, 1.0) : 0;
        const double coverage = thickness / 2 + 0.5 - std::hypot(px - t * dx, py - t * dy);
        if (coverage > 0) blend(x, y, color, std::min(coverage, 1.0));
      }
  }

  void text(int x, int y, const std::string& words, const Color& color, bool upward = false) {
    for (const TextRect& r : textRects(words))
      fill(upward ? Rect{x + r.top, y - r.right, x + r.bottom, y - r.left}
                  : Rect{x + r.left, y + r.top, x + r.right, y + r.bottom},
           color);
  }

private:
  static std::size_t bytes(int width, int rows) {
    return static_cast<std::size_t>(width) * static_cast<std::size_t>(rows) * 3;
  }

  int width_, height_;
  std::vector<std::uint8_t> rgb_;
};

struct Tick {
  double value;
  bool major;
};

// An axis with its range settled.
class Scale {
public:
  Scale(const Axis& axis, const std::vector<Series>& series, std::vector<double> Series::*values)
      : logarithmic_(axis.logarithmic) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const Series& one : series)
      for (const double value : one.*values)
        if (shows(value)) {
          low = std::min(low, value);
          high = std::max(high, value);
        }
    low_ = axis.low.value_or(low);
    high_ = axis.high.value_or(high);
    if (!(low_ < high_) || !shows(low_) || !std::isfinite(high_)) {
      low_ = logarithmic_ ? 0.1 : 0;  // nothing to show
      high_ = 1;
    }
  }

  bool shows(double value) const { return std::isfinite(value) && (!logarithmic_ || value > 0); }

  // 0 at the low end, 1 at the high end.
  double operator()(double value) const {
    return logarithmic_ ? std::log(value / low_) / std::log(high_ / low_) : (value - low_) / (high_ - low_);
  }

  std::vector<Tick> ticks() const {
    std::vector<Tick> result;
    const auto add = [&](double value, bool major) {
      const double at = (*this)(value);
      if (at > -1e-9 && at < 1 + 1e-9) result.push_back({value, major});
    };
    if (logarithmic_) {
      const int first = static_cast<int>(std::floor(std::log10(low_)));
      const int last = static_cast<int>(std::ceil(std::log10(high_)));
      const int stride = std::max(1, (last - first) / 10);
      for (int decade = first; decade <= last; ++decade)
        for (int digit = 1; digit < 10; ++digit)
          if (digit == 1 || stride == 1)
            add(digit * std::pow(10, decade), digit == 1 && (decade - first) % stride == 0);
      return result;
    }
    // Five or so round steps: 1, 2 or 5 times a power of ten.
    const double rough = (high_ - low_) / 5, power = std::pow(10, std::floor(std::log10(rough)));
    const double step = power * (rough < 2 * power ? 1 : rough < 5 * power ? 2 : 5);
    for (double i = std::ceil(low_ / step - 1e-9) + 0.0; i * step <= high_ * (1 + 1e-9) + 1e-12 * step; ++i)
      add(i * step, true);
    return result;
  }

private:
  bool logarithmic_;
  double low_, high_;
};

std::string label(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", value);
  return text;
}

void draw(Canvas& canvas, const Plot& plot, const Rect& frame) {
  const Scale xScale(plot.x, plot.series, &Series::x), yScale(plot.y, plot.series, &Series::y);
  const Rect area = {frame.left + 70, frame.top + 30, frame.right - 20, frame.bottom - 45};
  const auto xAt = [&](double value) { return area.left + xScale(value) * (area.right - area.left); };
  const auto yAt = [&](double value) { return area.bottom - yScale(value) * (area.bottom - area.top); };

  for (const bool major : {false, true}) {
    for (const Tick& tick : xScale.ticks()) {
      if (tick.major != major) continue;
      const int x = static_cast<int>(std::lround(xAt(tick.value)));
      canvas.fill({x, area.top, x + 1, area.bottom}, major ? kGrid : kMinorGrid);
      const std::string words = label(tick.value);
      if (major) canvas.text(x - textWidth(words) / 2, area.bottom + 6, words, kInk);
    }
    for (const Tick& tick : yScale.ticks()) {
      if (tick.major != major) continue;
      const int y = static_cast<int>(std::lround(yAt(tick.value)));
      canvas.fill({area.left, y, area.right, y + 1}, major ? kGrid : kMinorGrid);
      const std::string words = label(tick.value);
      if (major) canvas.text(area.left - 6 - textWidth(words), y - kTextHeight / 2, words, kInk);
    }
  }
  for (const Rect& edge : {Rect{area.left, area.bottom, area.right, area.bottom + 1},
                           Rect{area.left, area.top, area.left + 1, area.bottom}})
    canvas.fill(edge, kInk);

  for (const Series& series : plot.series) {
    const std::size_t count = std::min(series.x.size(), series.y.size());
    const auto shown = [&](std::size_t i) { return xScale.shows(series.x[i]) && yScale.shows(series.y[i]); };
    for (std::size_t i = 0; i < count; ++i) {
      if (!shown(i)) continue;
      const double x = xAt(series.x[i]), y = yAt(series.y[i]);
      if (series.points)
        canvas.line(x, y, x, y, 5, series.color, area);
      else if (i + 1 < count && shown(i + 1))
        canvas.line(x, y, xAt(series.x[i + 1]), yAt(series.y[i + 1]), 1.6, series.color, area);
    }
  }

  int widest = 0, row = area.top + 10;
  for (const Series& series : plot.series) widest = std::max(widest, textWidth(series.name));
  const int left = area.right - widest - 36;
  for (const Series& series : plot.series) {
    if (series.name.empty()) continue;
    canvas.fill({left - 4, row - 4, area.right - 6, row + kTextHeight + 2}, {255, 255, 255});
    const double middle = row + 3.5;
    canvas.line(series.points ? left + 10 : left, middle, series.points ? left + 10 : left + 20, middle,
                series.points ? 5 : 1.6, series.color, frame);
    canvas.text(left + 26, row, series.name, kInk);
    row += 14;
  }

  canvas.text((area.left + area.right - textWidth(plot.title)) / 2, frame.top + 12, plot.title, kInk);
  canvas.text((area.left + area.right - textWidth(plot.x.label)) / 2, frame.bottom - 18, plot.x.label, kInk);
  canvas.text(frame.left + 10, (area.top + area.bottom + textWidth(plot.y.label)) / 2, plot.y.label, kInk,
              true);
}

}  // namespace

void writePlot(const std::filesystem::path& path, const std::vector<Plot>& plots, int width, int height) {
  Canvas canvas(width * static_cast<int>(plots.size()), height);
  for (std::size_t i = 0; i < plots.size(); ++i) {
    const int left = width * static_cast<int>(i);
    draw(canvas, plots[i], {left, 0, left + width, height});
  }
  writePng(path, canvas.width(), canvas.height(), canvas.rgb());
}

}  // namespace pellucid::harness
