#include "profile.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace pellucid::material {
namespace {

// Least worst edge error for each count, by sequential linear programming on both variances and weights
// (material_profile_test measures the errors).
constexpr double kVariance[] = {2.20174,                                                                    //
                                0.146074,    7.70823,                                                       //
                                0.0174318,   0.849084,    13.4476,                                          //
                                0.00295167,  0.146652,    2.0324,    18.8179,                               //
                                0.000623084, 0.03117,     0.427408,  3.60473,  23.8448,                     //
                                0.000153221, 0.00767825,  0.105937,  0.85508,  5.45969,  28.5973,           //
                                4.23113e-05, 0.00212115,  0.0293385, 0.237144, 1.41762,  7.49122, 33.1224,  //
                                1.28089e-05, 0.000642239, 0.0088905, 0.072047, 0.428003, 2.10465, 9.62023,
                                37.4497};
constexpr double kWeight[] = {
    1,                                                                             //
    0.391889,   0.608111,                                                          //
    0.141911,   0.448562,  0.409527,                                               //
    0.058747,   0.222472,  0.425293,  0.293488,                                    //
    0.0270187,  0.106294,  0.266902,  0.382292, 0.2174933,                         //
    0.0134011,  0.0531677, 0.144936,  0.284591, 0.339336,  0.1645682,              //
    0.00704247, 0.0279974, 0.0780373, 0.174027, 0.285267,  0.301186,  0.12644283,  //
    0.00387493, 0.0154136, 0.0432322, 0.100446, 0.194117,  0.27667,   0.267858,   0.09838827};
constexpr double kEdgeError[] = {0.05927, 0.01404, 0.00479, 0.00197, 0.00091, 0.00045, 0.00024, 0.00013};

// d in transport mean free paths, by Monte Carlo: Lambertian light on a point of a half-space, 2 million
// photons per index, one walk weighted with each albedo; the d of least worst difference between the
// half-plane steps. Rows: sqrt(1 - albedo). Columns: index of refraction.
constexpr double kIor[] = {1, 1.05, 1.1, 1.2, 1.3, 1.4, 1.5, 1.7, 2, 2.5, 3};
constexpr double kAbsorbed[] = {0,    0.005, 0.01, 0.02, 0.03, 0.05, 0.07, 0.1, 0.15, 0.2,
                                0.25, 0.3,   0.4,  0.5,  0.6,  0.7,  0.8,  0.9, 0.95, 1};
constexpr double kDistance[20][11] = {
    {1.4718, 1.6762, 1.8785, 2.2785, 2.7047, 3.1346, 3.6020, 4.5951, 6.2683, 9.5353, 13.3031},
    {1.4369, 1.6307, 1.8239, 2.1990, 2.5987, 2.9997, 3.4264, 4.3211, 5.7892, 8.5378, 11.5536},
    {1.3813, 1.5621, 1.7402, 2.0813, 2.4412, 2.7955, 3.1709, 3.9275, 5.1243, 7.2283, 9.3325},
    {1.2885, 1.4485, 1.6024, 1.8936, 2.1935, 2.4893, 2.7913, 3.3669, 4.2186, 5.6378, 6.9727},
    {1.2135, 1.3580, 1.4941, 1.7480, 2.0017, 2.2468, 2.4868, 2.9506, 3.6419, 4.7233, 5.6097},
    {1.0975, 1.2184, 1.3284, 1.5265, 1.7083, 1.8861, 2.0844, 2.4510, 2.9285, 3.5895, 4.0694},
    {1.0085, 1.1118, 1.2026, 1.3607, 1.5327, 1.6964, 1.8441, 2.1085, 2.4547, 2.9023, 3.2027},
    {0.9048, 0.9876, 1.0618, 1.2092, 1.3425, 1.4535, 1.5589, 1.7446, 1.9739, 2.2502, 2.4230},
    {0.7784, 0.8504, 0.9103, 1.0106, 1.0975, 1.1700, 1.2368, 1.3492, 1.4785, 1.6217, 1.7066},
    {0.6873, 0.7445, 0.7890, 0.8624, 0.9240, 0.9729, 1.0166, 1.0882, 1.1671, 1.2473, 1.2860},
    {0.6163, 0.6610, 0.6949, 0.7490, 0.7933, 0.8265, 0.8530, 0.8963, 0.9380, 0.9704, 0.9841},
    {0.5588, 0.5933, 0.6188, 0.6577, 0.6852, 0.7050, 0.7193, 0.7430, 0.7630, 0.7738, 0.7745},
    {0.4700, 0.4887, 0.5016, 0.5132, 0.5218, 0.5265, 0.5276, 0.5302, 0.5281, 0.5174, 0.5064},
    {0.4039, 0.4107, 0.4111, 0.4092, 0.4072, 0.4041, 0.3991, 0.3914, 0.3795, 0.3597, 0.3434},
    {0.3527, 0.3477, 0.3418, 0.3319, 0.3234, 0.3162, 0.3080, 0.2951, 0.2786, 0.2551, 0.2373},
    {0.3118, 0.2973, 0.2875, 0.2724, 0.2599, 0.2503, 0.2407, 0.2251, 0.2068, 0.1830, 0.1651},
    {0.2779, 0.2564, 0.2440, 0.2255, 0.2106, 0.1999, 0.1898, 0.1731, 0.1543, 0.1319, 0.1145},
    {0.2486, 0.2228, 0.2084, 0.1877, 0.1714, 0.1603, 0.1503, 0.1337, 0.1155, 0.0951, 0.0791},
    {0.2357, 0.2081, 0.1929, 0.1714, 0.1549, 0.1437, 0.1339, 0.1174, 0.1000, 0.0807, 0.0655},
    {0.2240, 0.1949, 0.1786, 0.1568, 0.1400, 0.1291, 0.1194, 0.1031, 0.0868, 0.0685, 0.0539},
};

struct Place {
  std::size_t index;  // of the node below
  double t;           // from it to the next, [0, 1]
};

Place locate(std::span<const double> nodes, double at) {
  const auto above = std::upper_bound(nodes.begin() + 1, nodes.end() - 1, at);
  const auto i = static_cast<std::size_t>(above - nodes.begin()) - 1;
  return {i, std::clamp((at - nodes[i]) / (nodes[i + 1] - nodes[i]), 0.0, 1.0)};
}

}  // namespace

double equivalentAlbedo(const Angles& angles, double rho) {
  double low = 0, high = 1;
  for (int step = 0; step < 24; ++step) {
    const double albedo = (low + high) / 2;
    const Medium medium(angles, {albedo, 1 - albedo});
    (medium.slab(std::numeric_limits<double>::infinity()).reflectance < rho ? low : high) = albedo;
  }
  return (low + high) / 2;
}

UnitGaussians burleyGaussians(int count) {
  const auto n = static_cast<std::size_t>(count);
  const std::size_t first = n * (n - 1) / 2;
  return {std::span(kVariance).subspan(first, n), std::span(kWeight).subspan(first, n), kEdgeError[n - 1]};
}

double gaussianRadius999(std::span<const double> variance, std::span<const double> weight) {
  double low = 0, high = 40 * std::sqrt(*std::max_element(variance.begin(), variance.end()));
  for (int step = 0; step < 60; ++step) {
    const double r = (low + high) / 2;
    double beyond = 0;
    for (std::size_t i = 0; i < variance.size(); ++i)
      beyond += weight[i] * std::exp(-r * r / (2 * variance[i]));
    (beyond > 1e-3 ? low : high) = r;
  }
  return (low + high) / 2;
}

double burleyDistance(const Coefficients& coefficients, double ior) {
  const double absorbed = std::sqrt(coefficients.absorption / coefficients.extinction());
  const auto [row, y] = locate(kAbsorbed, absorbed);
  const auto [column, x] = locate(kIor, ior);
  // Bilinear in the logarithm.
  const auto across = [&](std::size_t r, std::size_t i, double t) {
    return std::lerp(std::log(kDistance[r][i]), std::log(kDistance[r][i + 1]), t);
  };
  return std::exp(std::lerp(across(row, column, x), across(row + 1, column, x), y)) /
         coefficients.extinction();
}

}  // namespace pellucid::material
