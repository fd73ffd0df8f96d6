#include "stress/checks.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "capture/shadow_images.h"
#include "common/error.h"
#include "stress/random_parts.h"

namespace pellucid::harness::stress {

std::unique_ptr<FrameRun> Renderer::prepare(const StressFrame& frame, const FrameRun* previous) {
  const Context& context = contexts_.of(frame.capture);
  if (frame.settings.inPlace() || previous)
    return std::make_unique<FrameRun>(device_, context, frame.capture, frame.materials, frame.settings,
                                      previous);
  // Without the picture that an engine would have around the surface: garbage takes its place.
  return std::make_unique<FrameRun>(device_, context, frame.capture, frame.materials, frame.settings,
                                    std::make_shared<InputImages>(device_, frame.capture, frame.settings));
}

Image Renderer::render(const StressFrame& frame, const FrameRun& run, std::uint64_t garbage) {
  run.restoreIrradiance(frame.capture);
  run.fillGarbage(garbage);
  device_.run([&](VkCommandBuffer commandBuffer) { run.record(commandBuffer); });
  ++recordings_;
  pixels_ += frame.capture.irradiance.pixels();
  return run.output();
}

std::optional<Image> Renderer::renderWith(const StressFrame& frame, std::uint32_t uses, std::string& said) {
  const bool arrays = hasLayers(frame.capture.lights);
  std::unique_ptr<Context>& context = contextsByUses_[{uses, arrays}];
  if (!context)
    context = std::make_unique<Context>(device_, [&](PellucidContextDesc& desc) {
      desc.options.uses = uses;
      if (arrays) desc.options.shadowViewType = VK_IMAGE_VIEW_TYPE_2D_ARRAY;
    });
  const FrameRun run(device_, *context, frame.capture, frame.materials, frame.settings);
  const std::size_t before = context->message().size();
  bool refused = false;
  device_.run([&](VkCommandBuffer commandBuffer) {
    try {
      run.record(commandBuffer);
    } catch (const InputError&) {
      refused = true;
    }
  });
  if (!refused) return render(frame, run, frame.index);
  said = context->message().substr(before);
  return {};
}

namespace {

// Irradiance as sanitize.glsl makes it, and room for twice its sum with other light.
void limitIrradiance(Image& irradiance) {
  for (std::size_t i = 0; i < irradiance.data.size(); ++i)
    if (i % 4 < 3)
      irradiance.data[i] = irradiance.data[i] > 0 ? std::min(irradiance.data[i], 16000.0f) : 0.0f;
}

StressFrame plainFrame(const StressFrame& frame) {
  StressFrame plain = frame;
  plain.settings.debugView = PELLUCID_DEBUG_NONE;
  plain.settings.reuse = PELLUCID_REUSE_NONE;
  limitIrradiance(plain.capture.irradiance);
  if (frame.wild) plain.capture.albedo = {};
  return plain;
}

constexpr double kDim = 0x1p-24;  // below what tolerances see

StressFrame withLights(StressFrame frame, double factor) {
  for (Light& light : frame.capture.lights) light.intensity *= factor;
  return frame;
}

StressFrame withoutLights(StressFrame frame) {
  frame.capture.lights.clear();
  return frame;
}

}  // namespace

Subject::Subject(Renderer& r, const StressFrame& f)
    : renderer(r),
      frame(f),
      owned(ownedPixels(f)),
      run(r.prepare(f)),
      before([&] {
        run->fillGarbage(f.index);
        return run->output();
      }()),
      output(r.render(f, *run, f.index)),
      plain_(plainFrame(f)),
      unlit_(withoutLights(plain_)) {}

bool Subject::translucent() const {
  return frame.settings.features & PELLUCID_FEATURE_TRANSLUCENCY && !frame.capture.lights.empty();
}

Random Subject::random(const char* check) const {
  std::uint64_t hash = 0xCBF29CE484222325u;  // FNV-1a
  for (const char* c = check; *c; ++c) hash = (hash ^ static_cast<unsigned char>(*c)) * 0x100000001B3u;
  return Random(frame.seed ^ hash, frame.index);
}

const Image& Subject::plainOutput() {
  if (plainOutput_.empty()) plainOutput_ = renderer.render(plain_);
  return plainOutput_;
}

const Image& Subject::unlitOutput() {
  if (unlitOutput_.empty()) unlitOutput_ = renderer.render(unlit_);
  return unlitOutput_;
}

const Image& Subject::dimOutput() {
  if (dimOutput_.empty()) dimOutput_ = renderer.render(withLights(plain_, kDim));
  return dimOutput_;
}

bool Subject::saturates() {
  if (!saturates_) {
    StressFrame read = plain_;
    read.settings.debugView = PELLUCID_DEBUG_IRRADIANCE;
    const Image image = renderer.render(read);
    saturates_ = false;
    for (std::size_t i = 0; i < image.data.size(); ++i)
      // Twice of it must fit, too.
      if (owned[i / 4] && i % 4 < 3 && !(static_cast<double>(image.data[i]) < kCeiling / 2))
        saturates_ = true;
  }
  return *saturates_;
}

namespace {

// Single bits: what may be written, what may be read.

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
  if (s.frame.settings.inPlace()) return {};
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
    for (Image* image : {&c.irradiance, &c.albedo})
      for (std::size_t k = 0; k < static_cast<std::size_t>(image->channels); ++k)
        image->data[i * static_cast<std::size_t>(image->channels) + k] = badFloat(random);
  });
}

// A pixel without material between two owned ones: the gather may take it for hair before their surface, by its depth.
bool mayBeHair(const Subject& s, std::size_t pixel) {
  const int width = s.frame.capture.width, height = s.frame.capture.height;
  const int x = static_cast<int>(pixel) % width, y = static_cast<int>(pixel) / width;
  const auto owned = [&](int column, int row) { return s.owned[static_cast<std::size_t>(row * width + column)] != 0; };
  return (x > 0 && x + 1 < width && owned(x - 1, y) && owned(x + 1, y)) ||
         (y > 0 && y + 1 < height && owned(x, y - 1) && owned(x, y + 1));
}

std::optional<Worst> unownedDepths(Subject& s) {
  Random random = s.random("unowned-depths");
  return withUnowned(s, [&](Capture& c, std::size_t i) {
    if (mayBeHair(s, i)) return;
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

// docs/integration.md, "Conventions": NaN, infinity and what is negative counts as 0.
std::optional<Worst> badValues(Subject& s) {
  constexpr float kFloatInfinity = std::numeric_limits<float>::infinity();
  constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
  constexpr float kPairs[][2] = {{kNaN, 0},       {-kNaN, 0},  {-1, 0},
                                 {-kFloatInfinity, 0}, {-65504, 0}, {kFloatInfinity, 0}};
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

Worst larger(const Worst& a, const Worst& b) { return a.value < b.value ? b : a; }

// A rect with a corner anywhere, smaller than the image.
std::array<std::uint32_t, 4> randomRect(Random& random, int width, int height) {
  const bool across = width > 1 && (height == 1 || random.chance(0.5));
  const int x = random.whole(across ? 1 : 0, width - 1), y = random.whole(across ? 0 : height > 1, height - 1);
  return {static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y), static_cast<std::uint32_t>(width - x),
          static_cast<std::uint32_t>(height - y)};
}

// The second of two frames with reuse reads what the first one left, and no other bytes: those of a fresh history, or of a sequence
// with another rect.
std::optional<Worst> history(Subject& s) {
  const int width = s.frame.capture.width, height = s.frame.capture.height;
  if (!s.translucent() || width * height == 1) return {};
  Random random = s.random("history");
  StressFrame second = s.frame;
  second.settings.debugView = PELLUCID_DEBUG_NONE;
  second.settings.reuse = random.of({PELLUCID_REUSE_ACCUMULATE, PELLUCID_REUSE_ALTERNATE, PELLUCID_REUSE_COHERENCE});
  const bool accumulates = second.settings.reuse == PELLUCID_REUSE_ACCUMULATE;
  if (!accumulates) second.settings.anchor = {};  // refused with these
  second.settings.renderRect = randomRect(random, width, height);
  // Most other options keep a frame from gathering.
  second.settings.translucency = {};
  second.settings.translucency.gatherSamples = accumulates || random.chance(0.6) ? kDefaultGatherSamples : 0;
  second.settings.translucency.gatherSpacing = s.frame.settings.translucency.gatherSpacing;
  Image& motion = second.capture.motion;
  motion = Image(width, height, 2);
  const double speed = random.chance(0.3) ? 0 : random.magnitude(1e-3, 0.5);
  for (float& v : motion.data) v = random.chance(0.02) ? badFloat(random) : static_cast<float>(random.real(-speed, speed));
  // Parts lose their material, and others have it for the first time.
  StressFrame first = second, other = second;
  const int side = random.whole(1, 64);
  const double share = random.real(0, 0.7);
  const std::uint64_t seed = random.bits();
  for (std::size_t i = 0; i < first.capture.material.size(); ++i) {
    const auto column = static_cast<std::uint64_t>(static_cast<int>(i) % width / side),
               row = static_cast<std::uint64_t>(static_cast<int>(i) / width / side);
    if (Random(seed, row << 32 | column).chance(share)) first.capture.material[i] = 0;
  }
  other.settings.renderRect = {0, 0, 0, 0};
  const std::unique_ptr<FrameRun> fresh = s.renderer.prepare(first);
  if (fresh->plan().skipCount > 0 && std::any_of(fresh->plan().skips, fresh->plan().skips + fresh->plan().skipCount,
                                                 [](const PellucidSkip& skip) { return std::strcmp(skip.what, "accumulation") == 0; }))
    return {};
  const Image freshFirst = s.renderer.render(first, *fresh, second.index);
  const Image freshSecond = s.renderer.render(second, *s.renderer.prepare(second, fresh.get()), second.index);
  const std::unique_ptr<FrameRun> before = s.renderer.prepare(other);
  s.renderer.render(other, *before, second.index + 1);
  const std::unique_ptr<FrameRun> cut = s.renderer.prepare(first, before.get());
  const Image cutFirst = s.renderer.render(first, *cut, second.index + 1);
  const Image cutSecond = s.renderer.render(second, *s.renderer.prepare(second, cut.get()), second.index + 1);
  return larger(differentBits(cutFirst, freshFirst, ownedPixels(first)), differentBits(cutSecond, freshSecond, ownedPixels(second)));
}

std::vector<PellucidImageNeed> needsOf(PellucidFrame frame, const std::array<std::uint32_t, 4>& rect) {
  std::copy(rect.begin(), rect.end(), frame.options.renderRect);
  std::uint32_t count = kMaxImageNeeds;
  std::vector<PellucidImageNeed> needs(count);
  if (pellucidGetImageNeeds(&frame, &count, needs.data()) != PELLUCID_OK) count = 0;
  needs.resize(count);
  return needs;
}

// Two parts of the image take the images of the whole, and show the same light where no neighbor is beyond their edge.
std::optional<Worst> rects(Subject& s) {
  constexpr std::array<std::uint32_t, 4> kWhole = {0, 0, 0, 0};
  const auto width = static_cast<std::uint32_t>(s.frame.capture.width), height = static_cast<std::uint32_t>(s.frame.capture.height);
  if (width == 1 || s.frame.settings.debugView != PELLUCID_DEBUG_NONE) return {};
  Random random = s.random("rects");
  const auto edge = static_cast<std::uint32_t>(random.whole(1, static_cast<int>(width) - 1));
  const std::array<std::uint32_t, 4> parts[] = {{0, 0, edge, height}, {edge, 0, width - edge, height}};
  const std::vector<PellucidImageNeed> all = needsOf(s.run->frame(), kWhole);
  for (const auto& part : parts) {
    const std::vector<PellucidImageNeed> own = needsOf(s.run->frame(), part);
    if (own.size() != all.size() || !std::equal(own.begin(), own.end(), all.begin(), [](const auto& a, const auto& b) {
          return a.format == b.format && std::equal(a.extent, a.extent + 2, b.extent) && a.persistent == b.persistent;
        }))
      return Worst{1, static_cast<int>(part[0]), 0, -1};
  }
  StressFrame frame = s.frame;
  frame.settings.features = PELLUCID_FEATURE_TRANSLUCENCY;
  frame.settings.translucency.gatherSamples = 0;
  frame.settings.reuse = PELLUCID_REUSE_NONE;
  frame.settings.aliasOutput = false;
  frame.settings.renderRect = kWhole;
  if (!s.translucent()) return {};
  const Image whole = s.renderer.render(frame);
  Worst worst;
  for (const auto& part : parts) {
    frame.settings.renderRect = part;
    Pixels pixels = ownedPixels(frame);
    // A normal follows from two pixels to each side.
    for (std::size_t i = 0; i < pixels.size(); ++i)
      if (std::abs(2 * (static_cast<int>(i % width) - static_cast<int>(edge)) + 1) < 5) pixels[i] = 0;
    worst = larger(worst, differentBits(s.renderer.render(frame), whole, pixels));
  }
  return worst;
}

// A context without some uses refuses the frame by the name of one, or gives its bits. A run tries eight sets, because
// each set compiles the shaders again.
std::optional<Worst> uses(Subject& s) {
  constexpr const char* kNames[] = {"TRANSLUCENCY", "GATHER", "DIFFUSION", "REUSE", "DEBUG_VIEWS", "THIN_WALLS", "AMBIENT", "THESIS"};
  constexpr int kCount = static_cast<int>(std::size(kNames));
  Random random = s.random("uses");
  if (!random.chance(0.1) || s.frame.settings.inPlace()) return {};
  Random set(s.frame.seed, static_cast<std::uint64_t>(random.whole(0, 7)));
  std::uint32_t left = 0;
  for (int i = set.whole(1, 3); i > 0; --i) left |= 1u << set.whole(0, kCount - 1);
  std::string said;
  const std::optional<Image> image = s.renderer.renderWith(s.frame, ((1u << kCount) - 1) & ~left, said);
  if (image) return differentBits(*image, s.output, s.owned);
  bool named = false;
  for (int i = 0; i < kCount; ++i)
    named = named || ((left >> i & 1) && said.find(std::string("uses with PELLUCID_USE_") + kNames[i]) != std::string::npos);
  return Worst{named ? 0.0 : 1.0, -1, -1, -1};
}

// Clip coordinates are homogeneous. Powers of two round nothing.
std::optional<Worst> mapFactor(Subject& s) {
  StressFrame other = s.frame;
  Random random = s.random("map-factor");
  bool any = false;
  for (Light& light : other.capture.lights)
    for (ShadowMap& map : light.shadowMaps) {
      any = true;
      const double factor = std::exp2(random.whole(-6, 6));
      for (double& v : map.clipFromWorld) v *= factor;
    }
  if (!any) return {};
  return differentBits(s.renderer.render(other), s.output, s.owned);
}

std::optional<Worst> alpha(Subject& s) {
  return differentAlpha(s.frame.settings.inPlace() ? s.before : s.run->irradiance(), s.output, s.owned);
}

constexpr const char* kBits = "bits have no tolerance";

// Energies: what must come of changed light and thickness.

// A constant comes back as it is where nothing is added and nothing multiplied.
std::optional<Worst> constant(Subject& s) {
  if (!s.diffuses()) return {};
  StressFrame other = s.unlit();
  other.settings.features = PELLUCID_FEATURE_DIFFUSION;
  other.capture.albedo = {};
  Random random = s.random("constant");
  const float level = random.of({0.25f, 1.0f, 3.0f, 1000.0f});  // halves
  for (std::size_t i = 0; i < other.capture.irradiance.data.size(); ++i)
    if (i % 4 < 3) other.capture.irradiance.data[i] = level * static_cast<float>(i % 4 + 1);
  const Image& expected = other.capture.irradiance;
  return apart(s.renderer.render(other), expected, s.owned);
}

StressFrame withTwiceIrradiance(StressFrame frame) {
  for (std::size_t i = 0; i < frame.capture.irradiance.data.size(); ++i)
    if (i % 4 < 3) frame.capture.irradiance.data[i] *= 2;
  return frame;
}

std::optional<Worst> twiceIrradiance(Subject& s) {
  return notTwice(s.unlitOutput(), s.renderer.render(withTwiceIrradiance(s.unlit())), s.owned);
}

std::optional<Worst> moreIrradiance(Subject& s) {
  Random random = s.random("more-irradiance");
  StressFrame more = s.unlit();
  std::vector<float>& e = more.capture.irradiance.data;
  const double share = random.chance(0.3) ? 0 : random.magnitude(1e-3, 1), most = random.magnitude(0.1, 1000);
  for (std::size_t i = 0; i < e.size(); i += 4) {
    if (share == 0 || !random.chance(share)) continue;
    for (std::size_t k = 0; k < 3; ++k) e[i + k] += static_cast<float>(random.real(0, most));
  }
  if (share == 0)  // one bright pixel
    e[4 * static_cast<std::size_t>(random.whole(0, static_cast<int>(s.owned.size()) - 1))] +=
        static_cast<float>(most);
  return less(s.unlitOutput(), s.renderer.render(more), s.owned);
}

// Half the lights and not twice, as a gather takes from irradiance that the lights themselves bring.
std::optional<Worst> halfLights(Subject& s) {
  if (!s.translucent() || s.saturates()) return {};
  const Image half = s.renderer.render(withLights(s.plain(), 0.5));
  return notSum(s.dimOutput(), {half, half}, s.plainOutput(), s.owned);
}

// Light and irradiance together: holds where the output ends at 0, too.
std::optional<Worst> twiceAll(Subject& s) {
  const std::vector<Light>& lights = s.plain().capture.lights;
  const bool inDomain =
      std::all_of(lights.begin(), lights.end(), [](const Light& l) { return l.intensity <= 5e14; });
  if (!s.translucent() || !inDomain || s.saturates()) return {};
  return notTwice(s.plainOutput(), s.renderer.render(withTwiceIrradiance(withLights(s.plain(), 2))), s.owned);
}

std::optional<Worst> sumOfLights(Subject& s) {
  const std::size_t count = s.frame.capture.lights.size();
  if (!s.translucent() || count < 2 || count > 4 || s.saturates()) return {};
  std::vector<Image> parts;
  for (std::size_t i = 0; i < count; ++i) {
    StressFrame one = withLights(s.plain(), kDim);
    one.capture.lights[i] = s.plain().capture.lights[i];
    parts.push_back(s.renderer.render(one));
  }
  return notSum(s.dimOutput(), parts, s.plainOutput(), s.owned);
}

// The frame with light that is not gathered.
const StressFrame* ungathered(Subject& s, StressFrame& frame) {
  if (!s.translucent()) return nullptr;
  frame = s.plain();
  frame.settings.translucency.gatherSamples = 0;
  return &frame;
}

std::optional<Worst> thinnerLimit(Subject& s) {
  StressFrame frame;
  if (!ungathered(s, frame)) return {};
  StressFrame thinner = frame;
  float& most = thinner.settings.translucency.maximumThickness;
  Random random = s.random("thinner-limit");
  most = static_cast<float>(random.magnitude(0.01, 100)) * (most > 0 ? most / 100 : 1);
  return less(s.renderer.render(thinner), s.renderer.render(frame), s.owned);
}

std::optional<Worst> darkerFilter(Subject& s) {
  StressFrame frame;
  if (!ungathered(s, frame)) return {};
  StressFrame darker = frame;
  Random random = s.random("darker-filter");
  for (float& f : darker.settings.translucency.transmittanceFilter) f *= static_cast<float>(random.real());
  return less(s.renderer.render(darker), s.renderer.render(frame), s.owned);
}

// A back depth farther away, where it says the thickness and nothing else: the hidden point of a directional
// light without a map.
std::optional<Worst> fartherBacks(Subject& s) {
  StressFrame frame;
  Capture& c = frame.capture;
  if (!ungathered(s, frame) || c.backDepth.image.empty() || c.frontDepth.encoding != PELLUCID_DEPTH_VIEW_Z ||
      c.backDepth.encoding != PELLUCID_DEPTH_VIEW_Z)
    return {};
  std::erase_if(frame.capture.lights,
                [](const Light& light) { return light.type != PELLUCID_LIGHT_DIRECTIONAL; });
  if (frame.capture.lights.empty()) return {};
  for (Light& light : frame.capture.lights) light.shadowMaps.clear();
  // By default, the cosine of the back face has a part in the thickness, and changes with the depths.
  frame.settings.translucency.chordThickness = true;
  StressFrame thicker = frame;
  Random random = s.random("farther-backs");
  const auto factor = 1 + static_cast<float>(random.magnitude(1e-4, 1));
  for (std::size_t i = 0; i < s.owned.size(); ++i) {
    float& back = thicker.capture.backDepth.image.data[i];
    // One in front of the front is none.
    if (back > c.frontDepth.image.data[i] && back < 1e8f) back *= factor;
  }
  return less(s.renderer.render(thicker), s.renderer.render(frame), s.owned);
}

// The next frame of a camera that stands still shows what it kept.
std::optional<Worst> reuse(Subject& s) {
  const bool keepsPixels = s.frame.settings.reuse == PELLUCID_REUSE_ALTERNATE || s.frame.settings.reuse == PELLUCID_REUSE_COHERENCE;
  if (!keepsPixels || s.frame.settings.debugView != PELLUCID_DEBUG_NONE) return {};
  // In place, a frame with nothing to do keeps irradiance that is no number.
  if (s.run->plan().dispatchCount == 0) return {};
  const std::unique_ptr<FrameRun> next = s.renderer.prepare(s.frame, s.run.get());
  return apart(s.renderer.render(s.frame, *next, s.frame.index + 2), s.output, s.owned);
}

constexpr const char* kRounding = "passes round colors to halves, 5e-4 each";
constexpr const char* kLight = "colors are rounded to halves once with and once without the light, 5e-4 each";

}  // namespace

std::span<const Check> checks() {
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
      {"unowned-pixels", "irradiance and albedo of pixels that are not owned change no bit",
       "frames with pixels that are not owned", 0, 0, kBits, &unownedPixels},
      {"unowned-depths", "depths of pixels that are not owned change no bit, but of single pixels, which may be hair",
       "frames with pixels that are not owned", 0, 0, kBits, &unownedDepths},
      {"bad-values",
       "irradiance that is NaN, infinite or negative gives the bits of 0",
       "frames with dispatches", 0, 0, kBits, &badValues},
      {"reach", "a pixel's irradiance changes no bit beyond the diffusion's kernel",
       "frames larger than the kernel", 0, 0, kBits, &reach},
      {"history", "the second of two frames with reuse reads what the first one left, and no other bytes of the history",
       "frames with light, with random reuse, motion and rect", 0, 0, kBits, &history},
      {"rects", "two parts take the images that the whole image needs, and have its bits where they share no edge",
       "frames without a debug view; bits: one thickness a pixel", 0, 0, kBits, &rects},
      {"uses", "a context that leaves out some PellucidUse refuses the frame by the name of one, or has its bits",
       "one in ten whose output is not the irradiance", 0, 0, kBits, &uses},
      {"map-factor", "clipFromWorld times powers of two changes no bit", "frames with shadow maps", 0, 0, kBits, &mapFactor},
      {"alpha", "alpha has the irradiance's bits, or is not finite as there", "all", 0, 0, kBits, &alpha},
      {"constant", "constant irradiance comes back from the diffusion",
       "frames that diffuse, without lights and albedo", 1e-3, 1e-3, kRounding, &constant},
      {"twice-irradiance", "twice the irradiance gives twice the output", "all, without lights", 2e-3, 2e-3,
       kRounding, &twiceIrradiance},
      {"more-irradiance", "more irradiance at some pixels gives no pixel less", "all, without lights", 2e-3,
       2e-3, kRounding, &moreIrradiance},
      {"half-lights", "lights of half the intensity add half as much",
       "frames with lights that stay below 65504", 6e-3, 6e-3, kLight, &halfLights},
      {"twice-all",
       "twice the lights and irradiance give twice the output",
       "frames with lights that stay below 65504",
       2e-3,
       {},
       "as above; wild lights reach 65504 in the gather's probes, which hold halves",
       &twiceAll},
      {"sum-of-lights", "a frame of lights adds the sum of what each adds",
       "frames of 2 to 4 lights that stay below 65504", 5e-3, 5e-3, kLight, &sumOfLights},
      {"thinner-limit", "a smaller maximumThickness gives no pixel more", "frames with lights, not gathered",
       2e-3, 2e-3, kRounding, &thinnerLimit},
      {"darker-filter", "a smaller transmittanceFilter gives no pixel more",
       "frames with lights, not gathered", 2e-3, 2e-3, kRounding, &darkerFilter},
      {"farther-backs", "a back depth farther away gives no pixel more",
       "frames with directional lights and depths in view z, along view rays", 2e-3, 2e-3, kRounding, &fartherBacks},
      {"reuse", "the next frame of a still camera is the frame", "frames that reuse the light of pixels", 2e-3, 2e-3,
       kRounding, &reuse},
  };
  return table;
}

}  // namespace pellucid::harness::stress
