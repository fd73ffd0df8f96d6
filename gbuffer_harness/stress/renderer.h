// Renders random frames on one device and counts what it renders.
#pragma once

#include <cstdint>
#include <memory>

#include "replay/replay.h"
#include "stress/random_frame.h"

namespace pellucid::harness::stress {

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

private:
  Device device_;
  Contexts contexts_;
  std::uint64_t recordings_ = 0, pixels_ = 0;
};

}  // namespace pellucid::harness::stress
