#include "metrics/anova.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <unsupported/Eigen/SpecialFunctions>

#include "common/error.h"

namespace pellucid::harness {

namespace {

double mean(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

double square(double value) { return value * value; }

void requireBalanced(const Cells& cells) {
  if (cells.size() < 2) throw InputError("", "", "an analysis needs two levels of the first factor");
  const std::size_t levels = cells[0].size(), count = levels > 0 ? cells[0][0].size() : 0;
  if (levels < 2 || count < 2)
    throw InputError("", "",
                     "an analysis needs two levels of the second factor and two answers in each cell; "
                     "there are " +
                         std::to_string(levels) + " and " + std::to_string(count));
  for (const auto& row : cells) {
    if (row.size() != levels) throw InputError("", "", "an analysis needs every cell");
    for (const auto& cell : row)
      if (cell.size() != count)
        throw InputError("", "",
                         "an analysis needs as many answers in every cell; there are " +
                             std::to_string(cell.size()) + " and " + std::to_string(count));
  }
}

void test(VarianceSource& source, const VarianceSource& residual) {
  const double effect = source.sumOfSquares / source.degrees,
               noise = residual.sumOfSquares / residual.degrees;
  if (noise > 0)
    source.f = effect / noise;
  else
    source.f = effect > 0 ? std::numeric_limits<double>::infinity() : 0;
  source.p = upperTailF(source.f, source.degrees, residual.degrees);
}

}  // namespace

double upperTailF(double f, double degrees1, double degrees2) {
  if (!(f > 0)) return 1;
  return Eigen::numext::betainc(degrees2 / 2, degrees1 / 2, degrees2 / (degrees2 + degrees1 * f));
}

double bothTailsT(double t, double degrees) { return upperTailF(t * t, 1, degrees); }

Anova twoWayAnova(const Cells& cells) {
  requireBalanced(cells);
  const std::size_t a = cells.size(), b = cells[0].size(), n = cells[0][0].size();
  std::vector<double> firstMeans(a, 0), secondMeans(b, 0);
  double all = 0;
  for (std::size_t i = 0; i < a; ++i)
    for (std::size_t j = 0; j < b; ++j) {
      const double m = mean(cells[i][j]);
      firstMeans[i] += m / static_cast<double>(b);
      secondMeans[j] += m / static_cast<double>(a);
      all += m / static_cast<double>(a * b);
    }
  Anova result;
  const auto count = static_cast<double>(n);
  for (const double m : firstMeans)
    result.first.sumOfSquares += count * static_cast<double>(b) * square(m - all);
  for (const double m : secondMeans)
    result.second.sumOfSquares += count * static_cast<double>(a) * square(m - all);
  for (std::size_t i = 0; i < a; ++i)
    for (std::size_t j = 0; j < b; ++j) {
      const double m = mean(cells[i][j]);
      result.interaction.sumOfSquares += count * square(m - firstMeans[i] - secondMeans[j] + all);
      for (const double value : cells[i][j]) result.residual.sumOfSquares += square(value - m);
    }
  result.first.degrees = static_cast<double>(a - 1);
  result.second.degrees = static_cast<double>(b - 1);
  result.interaction.degrees = static_cast<double>((a - 1) * (b - 1));
  result.residual.degrees = static_cast<double>(a * b * (n - 1));
  for (VarianceSource* source : {&result.first, &result.second, &result.interaction})
    test(*source, result.residual);
  return result;
}

std::vector<CellComparison> compareLevels(const Cells& cells, std::size_t levelA, std::size_t levelB,
                                          const Anova& anova) {
  const double noise = anova.residual.sumOfSquares / anova.residual.degrees;
  std::vector<CellComparison> result;
  for (std::size_t j = 0; j < cells[levelA].size(); ++j) {
    CellComparison c;
    c.difference = mean(cells[levelA][j]) - mean(cells[levelB][j]);
    const double error = std::sqrt(2 * noise / static_cast<double>(cells[levelA][j].size()));
    if (c.difference != 0) c.t = std::abs(c.difference) / error;
    c.p = std::min(1.0, bothTailsT(c.t, anova.residual.degrees) * static_cast<double>(cells[levelA].size()));
    result.push_back(c);
  }
  return result;
}

std::string significance(double p) { return p < 0.001 ? "***" : p < 0.01 ? "**" : p < 0.05 ? "*" : "ns"; }

}  // namespace pellucid::harness
