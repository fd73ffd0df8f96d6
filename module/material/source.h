// A described material as exact transport per color channel: what the fits are made to.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "transport.h"

namespace pellucid::material {

// One color channel or wavelength. `outer` layers stand between air and the core, from outside in; empty:
// homogeneous.
struct Stack {
  struct Outer {
    Coefficients coefficients;
    double thickness;  // mm, in front of a half-space
  };
  std::vector<Outer> outer;
  Coefficients core;
};

using Rgb = std::array<double, 3>;

// Samples of color: the value of channel c is the sum over samples s of weight[s][c] value_s, where the
// weights of each channel sum to 1.
struct Description {
  double ior;
  std::vector<Stack> stacks;
  std::vector<Rgb> weights;  // as many as stacks
};

// Three channels of their own, no mixing.
Description rgbDescription(double ior, std::vector<Stack> channels);

class Source {
public:
  explicit Source(const Description& description);
  ~Source();
  Source(const Source&) = delete;  // the media point at angles_
  Source& operator=(const Source&) = delete;

  // A slab of `thickness` mm in air; INFINITY: the half-space. Colors outside Rec. 709 are cut to [0, 1].
  //
  // A slab of layered material has the outer layers at both faces. Of full thickness they would not fit
  // into a thin one, so all of them together take the share s (1 - e^{-d/s}) of d, s their full
  // thickness on both faces: all of a thin slab, all of their thickness in a thick one.
  std::array<Slab, 3> slabs(double thickness) const;

  // d of Burley's profile, mm. A mixture of profiles has the mixture's mean radius; a layered half-space
  // takes the albedo that gives its rho and the extinction met by the light, weighted by e^{-2 kappa z}.
  Rgb burleyDistance() const;

  // True where channels are mixed from wavelengths.
  bool mixed() const { return mixed_; }

  // Asymptotic decay of T, 1/mm: that of the core. Mixed wavelengths have none in common.
  std::optional<double> decay(int channel) const;

  // Mean extinction, 1/mm; the scale on which T(d) starts to fall.
  double extinction(int channel) const;

private:
  struct Solved;

  Slab stackSlab(const Solved& solved, double thickness) const;
  double stackBurleyDistance(const Solved& solved, double rho) const;

  Angles angles_;
  std::vector<Solved> solved_;
  std::vector<Rgb> weights_;
  bool mixed_;
};

}  // namespace pellucid::material
