#include "fit.h"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "material/transmittance.h"

namespace pellucid::material {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

template <int N>
using Vector = Eigen::Matrix<double, N, 1>;

// Each family maps free parameters to a curve. Rates enter as logarithms, which keeps them positive and
// in order.
struct Exp2Family {
  using Parameters = Vector<4>;  // a1, ln k1, a2, ln(k2 - k1)

  double operator()(const Parameters& p, double d, Parameters& gradient) const {
    const double k1 = std::exp(p[1]), excess = std::exp(p[3]);
    const double e1 = std::exp(-k1 * d), e2 = std::exp(-(k1 + excess) * d);
    gradient << e1, -(p[0] * e1 + p[2] * e2) * d * k1, e2, -p[2] * e2 * d * excess;
    return p[0] * e1 + p[2] * e2;
  }

  Curve curve(const Parameters& p) const {
    const double k1 = std::exp(p[1]);
    return {PELLUCID_TRANSMITTANCE_EXP2,
            {static_cast<float>(p[0]), static_cast<float>(k1), static_cast<float>(p[2]),
             static_cast<float>(k1 + std::exp(p[3])), 0}};
  }
};

struct SinhExpFamily {
  using Parameters = Vector<5>;  // a, ln z, b, ln(c - kappa), ln kappa
  bool freeKappa;

  double operator()(const Parameters& p, double d, Parameters& gradient) const {
    const double kappa = std::exp(p[4]), z = std::exp(p[1]), excess = std::exp(p[3]);
    const double ey = std::exp(-kappa * d - z), shrink = 1 - ey * ey;
    const double s = 2 * ey / shrink, slope = -p[0] * s * (1 + ey * ey) / shrink;
    const double e = std::exp(-(kappa + excess) * d);
    gradient << s, slope * z, e, -p[2] * e * d * excess, freeKappa ? (slope - p[2] * e) * d * kappa : 0;
    return p[0] * s + p[2] * e;
  }

  Curve curve(const Parameters& p) const {
    const double kappa = std::exp(p[4]);
    return {PELLUCID_TRANSMITTANCE_SINH_EXP,
            {static_cast<float>(p[0]), static_cast<float>(kappa), static_cast<float>(std::exp(p[1])),
             static_cast<float>(p[2]), static_cast<float>(kappa + std::exp(p[3]))}};
  }
};

// Weighted nonlinear least squares of the scaled error, Levenberg-Marquardt.
template <class Family>
class Solver {
public:
  using Parameters = typename Family::Parameters;
  static constexpr int kSize = Parameters::SizeAtCompileTime;

  Solver(const Family& family, std::span<const Sample> samples)
      : family_(family), samples_(samples), weights_(samples.size()), residuals_(samples.size()) {
    resetWeights();
  }

  void resetWeights() {
    std::fill(weights_.begin(), weights_.end(), 1.0 / static_cast<double>(weights_.size()));
  }

  // The least-squares solution from `start`, at most `steps` steps away.
  void descend(Parameters& p, int steps) {
    double damping = 1e-3, cost = linearize(p);
    for (int step = 0; step < steps && std::isfinite(cost); ++step) {
      const double before = cost;
      const Matrix normal = normal_;
      const Parameters gradient = gradient_;
      bool improved = false;
      for (int attempt = 0; attempt < 8 && !improved; ++attempt) {
        Matrix damped = normal;
        // The constant keeps the row of a fixed parameter, which is zero, from being singular.
        damped.diagonal() += damping * normal.diagonal() + Parameters::Constant(1e-14);
        const Parameters trial = p - damped.ldlt().solve(gradient);
        cost = linearize(trial);
        improved = cost < before;
        if (improved) p = trial;
        damping = improved ? std::max(damping * 0.1, 1e-14) : damping * 10;
      }
      if (!improved) {
        linearize(p);
        return;
      }
      if (cost > before * (1 - 1e-7)) return;
    }
  }

  // Least worst error: Lawson's weights (1961), which grow where the error is largest.
  Fit minimax(Parameters p) {
    constexpr int kRounds = 40, kPatience = 6;
    resetWeights();
    Fit best{{}, kInfinity};
    int idle = 0;  // rounds since the error last fell by a percent
    for (int round = 0; round < kRounds && idle < kPatience; ++round) {
      descend(p, round == 0 ? 30 : 3);
      const double worst = worstResidual();
      if (!std::isfinite(worst) || worst == 0) break;
      const Fit fit = rounded(p);
      idle = fit.error < 0.99 * best.error ? 0 : idle + 1;
      if (fit.error < best.error) best = fit;
      double sum = 0;
      for (std::size_t i = 0; i < weights_.size(); ++i)
        sum += weights_[i] *= std::abs(residuals_[i]) / worst + 1e-3;
      for (double& weight : weights_) weight /= sum;
    }
    return best;
  }

  double worstResidual() const {
    double worst = 0;
    for (const double residual : residuals_)
      worst = std::isfinite(residual) ? std::max(worst, std::abs(residual)) : kInfinity;
    return worst;
  }

private:
  using Matrix = Eigen::Matrix<double, kSize, kSize>;

  // Residuals, gradient and Gauss-Newton matrix at p; returns the cost.
  double linearize(const Parameters& p) {
    normal_.setZero();
    gradient_.setZero();
    double cost = 0;
    for (std::size_t i = 0; i < samples_.size(); ++i) {
      Parameters slope;
      const double value = family_(p, samples_[i].thickness, slope);
      residuals_[i] = (value - samples_[i].transmittance) / samples_[i].scale;
      slope /= samples_[i].scale;
      cost += weights_[i] * residuals_[i] * residuals_[i];
      normal_ += weights_[i] * slope * slope.transpose();
      gradient_ += weights_[i] * residuals_[i] * slope;
    }
    return std::isfinite(cost) ? cost : kInfinity;
  }

  // The curve in float, with T(0) <= 1, and its own error.
  Fit rounded(const Parameters& p) const;

  Family family_;
  std::span<const Sample> samples_;
  std::vector<double> weights_, residuals_;
  Matrix normal_;
  Parameters gradient_;
};

double worstError(const Curve& curve, std::span<const Sample> samples) {
  if (!isTransmittance(curve)) return kInfinity;
  double worst = 0;
  for (const Sample& sample : samples)
    worst =
        std::max(worst, std::abs(evaluate(curve, sample.thickness) - sample.transmittance) / sample.scale);
  return worst;
}

template <class Family>
Fit Solver<Family>::rounded(const Parameters& p) const {
  Parameters scaled = p, unused;
  const double atZero = family_(p, 0, unused);
  if (atZero > 1) {
    // Amplitudes are parameters 0 and 2 of both families.
    scaled[0] /= atZero;
    scaled[2] /= atZero;
  }
  const Curve curve = family_.curve(scaled);
  return {curve, worstError(curve, samples_)};
}

// Several valleys exist, told apart by the sign and the reach of the second term: descends from each
// start and refines the most promising.
template <class Family>
Fit bestFit(const Family& family, std::span<const Sample> samples,
            std::span<const typename Family::Parameters> starts) {
  constexpr std::size_t kRefined = 8;
  struct Candidate {
    double worst;
    typename Family::Parameters parameters;
  };
  Solver<Family> solver(family, samples);
  std::vector<Candidate> candidates;
  for (auto parameters : starts) {
    solver.descend(parameters, 15);
    candidates.push_back({solver.worstResidual(), parameters});
  }
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Candidate& a, const Candidate& b) { return a.worst < b.worst; });
  Fit best{{}, kInfinity};
  for (std::size_t i = 0; i < std::min(kRefined, candidates.size()); ++i)
    if (const Fit fit = solver.minimax(candidates[i].parameters); fit.error < best.error) best = fit;
  return best;
}

// The last sample whose error is relative to itself; at least 4.
std::size_t lastRelative(std::span<const Sample> samples) {
  std::size_t last = samples.size() - 1;
  while (last > 4 && samples[last].transmittance < samples[last].scale) --last;
  return last;
}

// -d ln T / dd between two samples, 1/mm.
double meanSlope(const Sample& a, const Sample& b) {
  constexpr double kTiny = 1e-9;
  return std::log(std::max(a.transmittance, kTiny) / std::max(b.transmittance, kTiny)) /
         (b.thickness - a.thickness);
}

// Where to start from, 1/mm.
struct Rates {
  std::vector<double> kappa, excess;  // of the slow term; of the fast over the slow one
  double extinction;
};

Fit fitExp2(std::span<const Sample> samples, const Rates& rates) {
  std::vector<Exp2Family::Parameters> starts;
  for (const double kappa : rates.kappa)
    for (const double excess : rates.excess) starts.push_back({0.5, std::log(kappa), 0.3, std::log(excess)});
  const Fit fit = bestFit<Exp2Family>(Exp2Family{}, samples, starts);
  if (std::isfinite(fit.error)) return fit;
  // Data no single medium gives: one exponential through the ends of what is meant to be met.
  const Sample &first = samples.front(), &last = samples[lastRelative(samples)];
  const double k = std::max(meanSlope(first, last), 0.0);
  const double a = std::min(first.transmittance * std::exp(k * first.thickness), 1.0);
  const Curve curve{PELLUCID_TRANSMITTANCE_EXP2,
                    {static_cast<float>(a), static_cast<float>(k), 0, static_cast<float>(k), 0}};
  return {curve, worstError(curve, samples)};
}

Fit fitSinhExp(std::span<const Sample> samples, const Rates& rates, bool exact) {
  // z is kappa times the extrapolated distance from one face's image to the other's: 1.42 transport
  // mean free paths without internal reflection (Milne), more with.
  std::vector<SinhExpFamily::Parameters> starts;
  for (const double kappa : rates.kappa)
    for (const double paths : {0.5, 1.4, 3.5, 7.0})
      for (const double excess : rates.excess) {
        const double z = paths * kappa / rates.extinction;
        for (const double b : {0.1, -0.2})
          starts.push_back({(0.7 - b) * std::sinh(z), std::log(z), b, std::log(excess), std::log(kappa)});
      }
  Fit held{{}, kInfinity};
  if (exact) {
    // The exact kappa makes the curve right beyond the samples too. Where absorption dominates, T falls
    // below 1e-4 before it decays with kappa; only there is it released.
    constexpr double kAccepted = 1e-3;
    held = bestFit<SinhExpFamily>(SinhExpFamily{false}, samples, starts);
    if (held.error <= kAccepted) return held;
  }
  const Fit released = bestFit<SinhExpFamily>(SinhExpFamily{true}, samples, starts);
  return released.error < held.error ? released : held;
}

}  // namespace

double evaluate(const Curve& curve, double thickness) {
  return transmittance(curve.model, curve.parameters.data(), thickness);
}

bool isTransmittance(const Curve& curve) {
  const bool exp2 = curve.model == PELLUCID_TRANSMITTANCE_EXP2;
  for (const float parameter : curve.parameters)
    if (!std::isfinite(parameter)) return false;
  const double slow = curve.parameters[1], fast = curve.parameters[exp2 ? 3 : 4];
  if (!(slow >= 0 && fast >= 0)) return false;
  if (!exp2 && !(curve.parameters[2] > 0)) return false;
  if (!(evaluate(curve, 0) <= 1 + 1e-6)) return false;  // the amplitudes are floats
  // A sum of two decays has at most one extremum, so sampling from well below the shortest to well
  // beyond the longest length finds it.
  const double shortest = 1 / std::max({slow, fast, 1e-12}),
               longest = 1 / std::max(std::min(slow, fast), 1e-12);
  double previous = evaluate(curve, 0);
  if (!(previous > 0)) return false;
  for (double d = 1e-3 * shortest; d < 30 * longest; d *= 1.2) {
    const double value = evaluate(curve, d);
    if (value > previous || value < 0) return false;
    previous = value;
  }
  return true;
}

Fits fitTransmittance(std::span<const Sample> samples, std::optional<double> decay, double extinction) {
  Rates rates{{}, {}, extinction};
  for (const double excess : {0.2, 0.7, 1.6, 4.3}) rates.excess.push_back(excess * extinction);
  if (decay) {
    rates.kappa = {*decay};
  } else {
    const std::size_t last = lastRelative(samples);
    for (const std::size_t quarter : {1, 2, 3})
      rates.kappa.push_back(meanSlope(samples[quarter * last / 4], samples[(quarter + 1) * last / 4]));
  }
  // Without absorption T falls like 1/d, the limit of a / sinh(kappa d + z) as kappa goes to 0; a kappa at
  // which sinh y = y to float precision over all samples stands in for it.
  for (double& kappa : rates.kappa) kappa = std::max(kappa, 1e-3 / samples.back().thickness);
  return {fitExp2(samples, rates), fitSinhExp(samples, rates, decay.has_value())};
}

Curve asSinhExp(const Curve& curve) {
  constexpr double z = 9;  // e^{-2z} is below half a float's last bit
  const auto& p = curve.parameters;
  return {PELLUCID_TRANSMITTANCE_SINH_EXP,
          {static_cast<float>(p[0] * std::exp(z) / 2), p[1], static_cast<float>(z), p[2], p[3]}};
}

}  // namespace pellucid::material
