// Promises that hold for every random frame. Most checks render a changed frame and compare the two.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "replay/replay.h"
#include "stress/measures.h"
#include "stress/random_frame.h"

namespace pellucid::harness::stress {

// Renders random frames on one device and counts what it renders.
class Renderer {
public:
  explicit Renderer(const DeviceOptions& options) : device_(options), contexts_(device_) {}
  virtual ~Renderer() = default;

  const Device& device() const { return device_; }
  std::uint64_t recordings() const { return recordings_; }
  std::uint64_t pixels() const { return pixels_; }  // of all recordings

  // Throws InputError for a frame that the module refuses. `previous`: as FrameRun takes it.
  std::unique_ptr<FrameRun> prepare(const StressFrame& frame, const FrameRun* previous = nullptr);

  // The whole output. `garbage`: as FrameRun::fillGarbage takes it. Virtual so that tests can damage what
  // checks see.
  virtual Image render(const StressFrame& frame, const FrameRun& run, std::uint64_t garbage);
  Image render(const StressFrame& frame) { return render(frame, *prepare(frame), frame.index); }

  // In a context of these PellucidUse bits. Empty if recording refuses the frame; then `said` is why.
  std::optional<Image> renderWith(const StressFrame& frame, std::uint32_t uses, std::string& said);

private:
  Device device_;
  Contexts contexts_;
  std::map<std::array<std::uint32_t, 2>, std::unique_ptr<Context>> contextsByUses_;
  std::uint64_t recordings_ = 0, pixels_ = 0;
};

// One frame, its output, and what several checks need of it.
class Subject {
public:
  // Renders the frame. Throws InputError for one that the module refuses.
  Subject(Renderer& renderer, const StressFrame& frame);

  Renderer& renderer;
  const StressFrame& frame;
  const Pixels owned;
  const std::unique_ptr<FrameRun> run;
  const Image before, output;  // before: garbage, or the irradiance that the output replaces

  bool translucent() const;  // has lights and the feature
  bool diffuses() const { return frame.settings.features & PELLUCID_FEATURE_DIFFUSION; }
  // Numbers of the check's own, the same whatever other checks run.
  Random random(const char* check) const;

  // The frame as energies are compared: no debug view, no reuse, irradiance within [0, 16000], no wild
  // albedo.
  const StressFrame& plain() { return plain_; }
  const Image& plainOutput();
  // The plain frame without lights.
  const StressFrame& unlit() { return unlit_; }
  const Image& unlitOutput();
  // Output of the plain frame with its lights at kDim of their intensity: what lights add is the difference.
  // A gather returns more of all light from curved surfaces, so that a frame without lights is no base.
  const Image& dimOutput();
  // Some of the plain frame's light ends at 65504 before the diffusion, where outputs no longer tell.
  bool saturates();

private:
  StressFrame plain_, unlit_;
  Image plainOutput_, unlitOutput_, dimOutput_;
  std::optional<bool> saturates_;
};

struct Check {
  const char* name;
  const char* what;            // must hold
  const char* frames;          // that it is asked of
  double tame;                 // the largest value that is no violation
  std::optional<double> wild;  // likewise; none: measured, and no violation
  const char* reason;          // of the tolerances
  // None: the frame is not one of `frames`.
  std::optional<Worst> (*run)(Subject& subject);
};

std::span<const Check> checks();

}  // namespace pellucid::harness::stress
