// Real roots of a polynomial of low degree.
#pragma once

#include <vector>

namespace pellucid::harness {

// Roots in [low, high], ascending, of c[0] + c[1] x + ... + c[n] x^n, to the precision of double
// arithmetic. Roots of even multiplicity (a ray that only touches) may be left out.
std::vector<double> realRoots(const std::vector<double>& c, double low, double high);

}  // namespace pellucid::harness
