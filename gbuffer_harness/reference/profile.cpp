#include "reference/profile.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <string>

#include "common/error.h"

namespace pellucid::harness::reference {

double BurleyProfile::cumulative(double r) const {
  const double x = std::exp(-r / (3 * distance));
  return 1 - 0.25 * x * x * x - 0.75 * x;
}

double BurleyProfile::ringDensity(double r) const {
  const double x = std::exp(-r / (3 * distance));
  return (x * x * x + x) / (4 * distance);
}

double GaussianProfile::cumulative(double r) const {
  double sum = 0;
  for (std::size_t i = 0; i < variance.size(); ++i) sum -= weight[i] * std::expm1(-r * r / (2 * variance[i]));
  return sum;
}

double GaussianProfile::ringDensity(double r) const {
  double sum = 0;
  for (std::size_t i = 0; i < variance.size(); ++i)
    sum += weight[i] / variance[i] * std::exp(-r * r / (2 * variance[i]));
  return r * sum;
}

double GaussianProfile::finestScale() const {
  return std::sqrt(*std::min_element(variance.begin(), variance.end()));
}

double cumulative(const Profile& p, double r) {
  return std::visit([&](const auto& profile) { return profile.cumulative(r); }, p);
}

double ringDensity(const Profile& p, double r) {
  return std::visit([&](const auto& profile) { return profile.ringDensity(r); }, p);
}

double radiusOfTail(const Profile& p, double fraction) {
  double high = std::visit([](const auto&profile) { return profile.finestScale(); }, p), low = 0;
  for (; 1 - cumulative(p, high) > fraction; high *= 2) low = high;
  while (high - low > 1e-6 * high) {
    const double middle = 0.5 * (low + high);
    (1 - cumulative(p, middle) > fraction ? low : high) = middle;
  }
  return high;
}

namespace {

// Cells per sqrt(finest scale) that keep the interpolation error below the documented 1e-6, and a cap on
// memory for profiles whose channels differ by more than about 1e5 in width.
constexpr double kCellsPerRootScale = 32;
constexpr double kMostCells = 16384;

}  // namespace

ProfileTable::ProfileTable(const std::array<Profile, 3>& profiles, double radius) : radius_(radius) {
  double finest = radius;
  for (const Profile& p : profiles)
    finest = std::min(finest, std::visit([](const auto& profile) { return profile.finestScale(); }, p));
  const double cells = std::min(std::ceil(kCellsPerRootScale * std::sqrt(radius / finest)), kMostCells);
  cellsPerRoot_ = cells / std::sqrt(radius);
  const std::size_t count = static_cast<std::size_t>(cells);
  ring_ = tabulate(profiles, 1 / cellsPerRoot_, count, &reference::ringDensity);
  cumulative_ = tabulate(profiles, 1 / cellsPerRoot_, count, &reference::cumulative);
}

// The cubic through the function at f = 0, 1/3, 2/3 and 1 of every cell. One cell more than needed, so
// that r = radius() rounded up still finds one.
std::vector<ProfileTable::Cubic> ProfileTable::tabulate(const std::array<Profile, 3>& profiles, double step,
                                                        std::size_t cells,
                                                        double (*function)(const Profile&, double)) {
  std::vector<Cubic> table(cells + 1, Cubic{Lanes{0}, Lanes{0}, Lanes{0}, Lanes{0}});
  for (std::size_t i = 0; i <= cells; ++i)
    for (int c = 0; c < 3; ++c) {
      double y[4];
      for (int k = 0; k < 4; ++k) {
        const double root = step * (double(i) + k / 3.0);
        y[k] = function(profiles[static_cast<std::size_t>(c)], root * root);
      }
      table[i][0][c] = y[0];
      table[i][1][c] = -5.5 * y[0] + 9 * y[1] - 4.5 * y[2] + y[3];
      table[i][2][c] = 9 * y[0] - 22.5 * y[1] + 18 * y[2] - 4.5 * y[3];
      table[i][3][c] = 4.5 * (y[3] - y[0]) + 13.5 * (y[1] - y[2]);
    }
  return table;
}

namespace {

std::optional<Profile> burley(const PellucidMaterial& m, int channel) {
  const double d = m.burleyDistance[channel];
  if (d == 0) return std::nullopt;
  if (!(d > 0) || !std::isfinite(d))
    throw InputError("", "burleyDistance[" + std::to_string(channel) + "]",
                     std::to_string(d) + " is not a length");
  return BurleyProfile{d};
}

std::optional<Profile> gaussians(const PellucidMaterial& m, int channel) {
  if (m.gaussianCount == 0) return std::nullopt;
  if (m.gaussianCount > PELLUCID_MAX_GAUSSIANS)
    throw InputError("", "gaussianCount", std::to_string(m.gaussianCount) + " is more than a material holds");
  GaussianProfile p;
  for (unsigned i = 0; i < m.gaussianCount; ++i) {
    const double variance = m.gaussianVariance[channel][i], weight = m.gaussianWeight[channel][i];
    if (!(variance > 0) || !std::isfinite(variance) || !std::isfinite(weight))
      throw InputError("", "gaussian " + std::to_string(i),
                       "variance " + std::to_string(variance) + " and weight " + std::to_string(weight) +
                           " (variance > 0, both finite)");
    p.variance.push_back(variance);
    p.weight.push_back(weight);
  }
  const double total = std::accumulate(p.weight.begin(), p.weight.end(), 0.0);
  if (!(total > 0)) throw InputError("", "gaussianWeight", "the weights do not have a positive sum");
  for (double& w : p.weight) w /= total;  // single precision leaves 1e-7
  return p;
}

}  // namespace

std::optional<Profile> channelProfile(const PellucidMaterial& m, int channel) {
  return m.burleyDistance[channel] != 0 ? burley(m, channel) : gaussians(m, channel);
}

namespace {

// Gauss-Legendre, 8 points; Abramowitz & Stegun table 25.4.
constexpr double kNode[4] = {0.1834346424956498, 0.5255324099163290, 0.7966664774136267, 0.9602898564975363};
constexpr double kWeight[4] = {0.3626837833783620, 0.3137066458778873, 0.2223810344533745,
                               0.1012285362903763};

// Longest stretch of w = asinh(s / D) that 8 points integrate.
constexpr double kPanel = 2;

// One edge's angle integral. With s along the edge and D its distance from the foot, s = D sinh w makes
// rho = D cosh w and dtheta = dw / cosh w: smooth however close or long the edge is.
void addEdge(const ProfileTable& profile, double distance, double from, double to, double height,
             const ProfileTable::Lanes& below, double sign, ProfileTable::Lanes& sum) {
  const double start = std::asinh(from / distance), length = std::asinh(to / distance) - start;
  const int panels = 1 + static_cast<int>(std::abs(length) / kPanel);
  const double half = 0.5 * length / panels;
  for (int panel = 0; panel < panels; ++panel)
    for (int i = 0; i < 8; ++i) {
      const double node = i < 4 ? kNode[i] : -kNode[i - 4], weight = kWeight[i % 4];
      const double coshW = std::cosh(start + half * (2 * panel + 1 + node));
      const double rho = distance * coshW;
      const ProfileTable::Lanes within = profile.cumulativeEnergy(std::sqrt(rho * rho + height * height));
      const double scale = sign * half * weight / coshW;
      sum += scale * (within - below);
    }
}

}  // namespace

ProfileTable::Lanes integratedEnergy(const ProfileTable& profile, const Parallelogram& p) {
  const glm::dvec3 normal = glm::normalize(glm::cross(p.x, p.y));
  const double height = glm::dot(p.center, normal);
  const glm::dvec3 foot = p.center - height * normal;
  const ProfileTable::Lanes below = profile.cumulativeEnergy(std::abs(height));
  const glm::dvec3 corner[4] = {foot - p.x - p.y, foot + p.x - p.y, foot + p.x + p.y, foot - p.x + p.y};
  ProfileTable::Lanes sum{0};
  for (int i = 0; i < 4; ++i) {
    const glm::dvec3& a = corner[i];
    const glm::dvec3 edge = corner[(i + 1) % 4] - a;
    const double length = glm::length(edge);
    const glm::dvec3 along = edge / length;
    const double distance = glm::dot(glm::cross(a, along), normal);  // > 0: the foot is on the inner side
    // An edge through the foot sweeps no angle that encloses energy: its integral goes to 0 with D.
    if (std::abs(distance) < 1e-9 * length) continue;
    const double from = glm::dot(a, along);
    addEdge(profile, std::abs(distance), from, from + length, height, below, distance > 0 ? 1 : -1, sum);
  }
  return sum / (2 * std::numbers::pi);
}

ProfileTable::Lanes sampledEnergy(const ProfileTable& profile, const Parallelogram& p) {
  const double area = 4 * glm::length(glm::cross(p.x, p.y));
  ProfileTable::Lanes sum{0};
  for (const double a : {-std::numbers::inv_sqrt3, std::numbers::inv_sqrt3})
    for (const double b : {-std::numbers::inv_sqrt3, std::numbers::inv_sqrt3}) {
      const glm::dvec3 point = p.center + a * p.x + b * p.y;
      const double rSquared = glm::dot(point, point);
      if (!(rSquared < profile.radius() * profile.radius())) continue;
      sum += 0.25 * area * profile.value(rSquared);
    }
  return sum;
}

}  // namespace pellucid::harness::reference
