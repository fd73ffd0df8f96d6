#include "scene/polynomial.h"

#include <cmath>

namespace pellucid::harness {

namespace {

double evaluate(const std::vector<double>& c, double x) {
  double value = 0;
  for (auto it = c.rbegin(); it != c.rend(); ++it) value = value * x + *it;
  return value;
}

// The one root between a and b, where the polynomial is monotonic and changes sign.
double bracketedRoot(const std::vector<double>& c, const std::vector<double>& derivative, double a,
                     double b) {
  const bool rising = evaluate(c, b) > 0;
  double x = (a + b) / 2;
  for (int i = 0; i < 100; ++i) {
    const double value = evaluate(c, x);
    ((value > 0) == rising ? b : a) = x;
    double next = x - value / evaluate(derivative, x);
    if (!(next > a && next < b)) next = (a + b) / 2;
    if (std::abs(next - x) <= 1e-15 * std::abs(next)) return next;
    x = next;
  }
  return x;
}

}  // namespace

std::vector<double> realRoots(const std::vector<double>& c, double low, double high) {
  if (c.size() < 2) return {};
  std::vector<double> derivative;
  for (std::size_t i = 1; i < c.size(); ++i) derivative.push_back(c[i] * static_cast<double>(i));

  // Between neighboring extrema the polynomial is monotonic, so each sign change is one root.
  std::vector<double> limits = realRoots(derivative, low, high);
  limits.insert(limits.begin(), low);
  limits.push_back(high);
  std::vector<double> roots;
  for (std::size_t i = 0; i + 1 < limits.size(); ++i) {
    const double a = limits[i];
    const double b = limits[i + 1];
    if (a < b && (evaluate(c, a) > 0) != (evaluate(c, b) > 0))
      roots.push_back(bracketedRoot(c, derivative, a, b));
  }
  return roots;
}

}  // namespace pellucid::harness
