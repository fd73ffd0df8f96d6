// Two-way analysis of variance of a balanced experiment, and Bonferroni's comparisons after it.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace pellucid::harness {

// values[i][j]: the answers at level i of the first factor and level j of the second.
using Cells = std::vector<std::vector<std::vector<double>>>;

struct VarianceSource {
  double sumOfSquares = 0, degrees = 0;
  double f = 0, p = 1;  // of the residual's none
};

struct Anova {
  VarianceSource first, second, interaction, residual;
};

// Fixed effects with interaction (Montgomery, Design and Analysis of Experiments, 5.3). Throws InputError
// unless there are two or more levels of both factors and as many answers in each cell, at least two. Answers
// that do not vary within cells give an infinite F for what differs, and 0 for what does not.
Anova twoWayAnova(const Cells& cells);

struct CellComparison {
  double difference = 0, t = 0;
  double p = 1;  // two-sided, times the number of comparisons, at most 1
};

// The means of two levels of the first factor at each level of the second, by the residual of the analysis
// (Bonferroni's comparisons after a two-way analysis).
std::vector<CellComparison> compareLevels(const Cells& cells, std::size_t levelA, std::size_t levelB,
                                          const Anova& anova);

// "***" below .001, "**" below .01, "*" below .05, else "ns".
std::string significance(double p);

// Upper tail of F's distribution and both tails of Student's; degrees > 0.
double upperTailF(double f, double degrees1, double degrees2);
double bothTailsT(double t, double degrees);

}  // namespace pellucid::harness
