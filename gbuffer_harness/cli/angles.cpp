// `pellucid angles`: the curves by which Whelan 2009 weighs the angle between view and light.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <functional>
#include <iostream>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include "cli/commands.h"
#include "cli/settings.h"
#include "common/plot.h"
#include "reference/translucency.h"

namespace pellucid::harness {

namespace {

constexpr double kRightAngle = std::numbers::pi / 2;

// x: the angle between the directions of camera and light in radians, pi / 2 .. pi.
struct Curve {
  const char* name;
  Color color;
  std::function<double(double x)> value;
};

TranslucencySettings settingsOf(std::vector<std::string> set) {
  SettingsOptions options;
  options.set = std::move(set);
  return options.parse().translucency;
}

// Whelan 2009, eqs. 4.4 and 4.5, as printed; below 0 the quadratic takes light away.
std::function<double(double)> printed(const std::string& name) {
  const std::array<float, 4> c = settingsOf({"polynomial=" + name}).anglePolynomial;
  return [c](double x) {
    return static_cast<double>(c[0]) +
           x * (static_cast<double>(c[1]) + x * (static_cast<double>(c[2]) + x * static_cast<double>(c[3])));
  };
}

// The module's own curve, of `--set angle=MODEL`; it takes the cosine.
std::function<double(double)> module(std::vector<std::string> set) {
  const TranslucencySettings settings = settingsOf(std::move(set));
  return [settings](double x) { return reference::angleFactor(settings, -std::cos(x), 0); };
}

std::vector<std::vector<Curve>> curves() {
  constexpr Color kRed = {200, 40, 40}, kGreen = {30, 140, 50}, kBlue = {40, 70, 200},
                  kGray = {120, 120, 120};
  return {{{"dot product", kRed, module({"angle=cosine"})},
           {"inverse cosine", kBlue, module({"angle=inverse-cosine"})}},
          {{"quadratic, eq. 4.4", kRed, printed("quadratic")},
           {"cubic, eq. 4.5", kBlue, printed("cubic")},
           {"clamped, polynomial=quadratic", kGray, module({"angle=polynomial", "polynomial=quadratic"})},
           {"clamped, polynomial=cubic", kGreen, module({"angle=polynomial", "polynomial=cubic"})}}};
}

void plot(const std::string& output) {
  constexpr int kPoints = 181;  // half degrees
  const std::vector<std::vector<Curve>> figures = curves();
  std::vector<Plot> plots;
  for (const char* title : {"Whelan 2009, figure 4.7", "Whelan 2009, figure 4.8"}) {
    Plot& result = plots.emplace_back();
    result.title = title;
    result.x = {"angle between camera and light, degrees", false, 90.0, 180.0};
    result.y = {"factor of the light that comes through", false, -0.2, 1.4};  // the legend above the curves
    for (const Curve& curve : figures[plots.size() - 1]) {
      Series& series = result.series.emplace_back(Series{curve.name, curve.color, {}, {}, false});
      for (int i = 0; i < kPoints; ++i) {
        const double x = kRightAngle * (1 + i / (kPoints - 1.0));
        series.x.push_back(x * 180 / std::numbers::pi);
        series.y.push_back(curve.value(x));
      }
    }
  }
  writePlot(output, plots);
  std::cout << "wrote " << output << '\n';
}

}  // namespace

void addAnglesCommand(const Command& app) {
  const auto output = std::make_shared<std::string>();
  const Command command = app.subcommand(
      "angles", "Plot the curves of the angle between view and light in Whelan 2009, figures 4.7 and 4.8");
  command.option("-o,--output", *output, "PNG of both figures").required();
  command.run([output] { plot(*output); });
}

}  // namespace pellucid::harness
