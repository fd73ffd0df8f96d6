// Checks of single bits: what may be written, what may be read.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "stress/checks.h"
#include "stress/random_parts.h"

namespace pellucid::harness::stress {

namespace {

bool aliased(const StressFrame& f) {
  return f.settings.aliasOutput && f.settings.debugView == PELLUCID_DEBUG_NONE;
}

// Some groups go by lists of the device's.
bool hasLists(const FrameRun& run) {
  const PellucidPlan& plan = run.plan();
  return std::any_of(plan.dispatches, plan.dispatches + plan.dispatchCount,
                     [](const PellucidDispatch& d) { return d.indirect != 0; });
}

// A frame with nothing to do, whose output is the irradiance, stays as it is, bad values included.
bool isLeft(const FrameRun& run) { return run.plan().dispatchCount == 0; }

std::optional<Worst> finite(Subject& s) {
  if (isLeft(*s.run)) return {};
  return notFinite(s.output, s.owned);
}

std::optional<Worst> notNegative(Subject& s) {
  if (s.frame.settings.debugView == PELLUCID_DEBUG_THICKNESS || isLeft(*s.run)) return {};
  return negative(s.output, s.owned);
}

std::optional<Worst> outside(Subject& s) { return changedOutside(s.before, s.output, s.owned); }

std::optional<Worst> written(Subject& s) {
  if (aliased(s.frame)) return {};
  return unwritten(s.output, s.owned);
}

std::optional<Worst> sameBits(Subject& s) {
  return differentBits(s.output, s.renderer.render(s.frame, *s.run, s.frame.index + 1), s.owned);
}

std::optional<Worst> alias(Subject& s) {
  if (s.frame.settings.debugView != PELLUCID_DEBUG_NONE) return {};
  StressFrame other = s.frame;
  other.settings.aliasOutput = !other.settings.aliasOutput;
  const std::unique_ptr<FrameRun> run = s.renderer.prepare(other);
  if (isLeft(*s.run) || isLeft(*run)) return {};
  return differentBits(s.output, s.renderer.render(other, *run, other.index), s.owned);
}

std::optional<Worst> lists(Subject& s) {
  StressFrame other = s.frame;
  const bool asks = s.frame.settings.indirectDispatches == 1;
  other.settings.indirectDispatches = asks ? 0 : 1;
  const std::unique_ptr<FrameRun> run = s.renderer.prepare(other);
  if (!hasLists(*s.run) && !hasLists(*run)) return {};
  return differentBits(s.output, s.renderer.render(other, *run, other.index), s.owned);
}

// Bits of `frame` with `change` made to each pixel that is not owned; none if all are owned.
template <class Change>
std::optional<Worst> withUnowned(Subject& s, const Change& change) {
  StressFrame other = s.frame;
  bool any = false;
  for (std::size_t i = 0; i < s.owned.size(); ++i)
    if (!s.owned[i]) {
      change(other.capture, i);
      any = true;
    }
  if (!any) return {};
  return differentBits(s.output, s.renderer.render(other), s.owned);
}

std::optional<Worst> unownedPixels(Subject& s) {
  Random random = s.random("unowned-pixels");
  return withUnowned(s, [&](Capture& c, std::size_t i) {
    for (Image* image : {&c.irradiance, &c.normal, &c.albedo})
      for (std::size_t k = 0; k < static_cast<std::size_t>(image->channels); ++k)
        image->data[i * static_cast<std::size_t>(image->channels) + k] = badFloat(random);
  });
}

std::optional<Worst> unownedDepths(Subject& s) {
  Random random = s.random("unowned-depths");
  return withUnowned(s, [&](Capture& c, std::size_t i) {
    const float other =
        c.frontDepth.image
            .data[static_cast<std::size_t>(random.whole(0, static_cast<int>(s.owned.size()) - 1))];
    c.frontDepth.image.data[i] =
        random.chance(0.5) ? badFloat(random) : other * static_cast<float>(random.real());
    if (!c.backDepth.image.empty()) c.backDepth.image.data[i] = random.chance(0.5) ? badFloat(random) : other;
  });
}

// Some owned pixels; none if there is none.
std::vector<std::size_t> someOwned(Subject& s, Random& random) {
  std::vector<std::size_t> all, some;
  for (std::size_t i = 0; i < s.owned.size(); ++i)
    if (s.owned[i]) all.push_back(i);
  for (int k = random.whole(1, 3); k > 0 && !all.empty(); --k)
    some.push_back(all[static_cast<std::size_t>(random.whole(0, static_cast<int>(all.size()) - 1))]);
  return some;
}

StressFrame withIrradiance(const StressFrame& frame, const std::vector<std::size_t>& pixels, int channels,
                           float value) {
  StressFrame other = frame;
  for (const std::size_t pixel : pixels)
    for (int k = 0; k < 3; ++k)
      if (channels >> k & 1) other.capture.irradiance.data[4 * pixel + static_cast<std::size_t>(k)] = value;
  return other;
}

// docs/integration.md, "Conventions": NaN and what is negative counts as 0, 65504 is the ceiling.
std::optional<Worst> badValues(Subject& s) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
  constexpr float kPairs[][2] = {{kNaN, 0},       {-kNaN, 0},  {-1, 0},
                                 {-kInfinity, 0}, {-65504, 0}, {kInfinity, 65504}};
  Random random = s.random("bad-values");
  const std::vector<std::size_t> pixels = someOwned(s, random);
  if (pixels.empty() || isLeft(*s.run)) return {};
  const int channels = random.whole(1, 7);
  const auto& [bad, counted] = kPairs[random.whole(0, 5)];
  return differentBits(s.renderer.render(withIrradiance(s.frame, pixels, channels, bad)),
                       s.renderer.render(withIrradiance(s.frame, pixels, channels, counted)), s.owned);
}

// Pixels to each side that the irradiance of a pixel may change. A texel of the coarsest level, whose sides
// are 2^l pixels, sees those that its filters do: 1.5 texels of each level below for the reductions, 2 for
// each refinement, and 4 for the Gaussian of a stretched kernel. Halving sizes sum to twice the last.
std::optional<int> kernelReach(const Subject& s) {
  if (!s.diffuses()) return 0;
  const PellucidPlan& plan = s.run->plan();
  for (std::uint32_t i = 0; i < plan.dispatchCount; ++i)
    if (std::strcmp(plan.dispatches[i].name, "upsample") == 0)
      return 15 << plan.dispatches[i].pushConstants[0];
  return {};
}

std::optional<Worst> reach(Subject& s) {
  Random random = s.random("reach");
  const std::vector<std::size_t> pixels = someOwned(s, random);
  const std::optional<int> distance = kernelReach(s);
  if (pixels.empty() || !distance) return {};
  const int width = s.frame.capture.width;
  const int x = static_cast<int>(pixels[0]) % width, y = static_cast<int>(pixels[0]) / width;
  Pixels beyond = s.owned;
  bool any = false;
  for (std::size_t i = 0; i < beyond.size(); ++i) {
    const int dx = std::abs(static_cast<int>(i) % width - x), dy = std::abs(static_cast<int>(i) / width - y);
    if (std::max(dx, dy) <= *distance) beyond[i] = 0;
    any = any || beyond[i];
  }
  if (!any) return {};
  return differentBits(s.output, s.renderer.render(withIrradiance(s.frame, {pixels[0]}, 7, badFloat(random))),
                       beyond);
}

std::optional<Worst> alpha(Subject& s) {
  return differentAlpha(aliased(s.frame) ? s.before : s.run->irradiance(), s.output, s.owned);
}

constexpr const char* kBits = "bits have no tolerance";

}  // namespace

std::span<const Check> bitChecks() {
  static const Check table[] = {
      {"finite", "RGB of every owned pixel is finite; counts values", "frames with dispatches", 0, 0, kBits,
       &finite},
      {"not-negative", "RGB of every owned pixel is >= 0; largest deficit",
       "frames with dispatches, but for debug view thickness, where -1 is none", 0, 0, kBits, &notNegative},
      {"outside", "pixels without material or outside the rect keep their bits; counts pixels", "all", 0, 0,
       kBits, &outside},
      {"written", "every owned pixel is written; counts pixels", "outputs that are not the irradiance", 0, 0,
       kBits, &written},
      {"same-bits", "a second recording over other garbage has the same bits", "all", 0, 0, kBits, &sameBits},
      {"alias", "an output that is the irradiance has the bits of one that is not",
       "frames with dispatches, but for debug views", 0, 0, kBits, &alias},
      {"lists", "groups that go by lists of blocks with material have the bits of all groups",
       "frames with lists, or with lists where they were asked for", 0, 0, kBits, &lists},
      {"unowned-pixels", "irradiance, normals and albedo of pixels that are not owned change no bit",
       "frames with pixels that are not owned", 0, 0, kBits, &unownedPixels},
      {"unowned-depths", "depths of pixels that are not owned change no bit",
       "frames with pixels that are not owned", 0, 0, kBits, &unownedDepths},
      {"bad-values",
       "irradiance that is NaN or negative gives the bits of 0, infinite irradiance gives the bits of 65504",
       "frames with dispatches", 0, 0, kBits, &badValues},
      {"reach", "a pixel's irradiance changes no bit beyond the diffusion's kernel",
       "frames larger than the kernel", 0, 0, kBits, &reach},
      {"alpha", "alpha has the irradiance's bits, or is not finite as there", "all", 0, 0, kBits, &alpha},
  };
  return table;
}

}  // namespace pellucid::harness::stress
