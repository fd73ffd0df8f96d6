// Capture in, module, image out: one frame of an engine, on any Vulkan device.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "common/device.h"
#include "common/dispatch_time.h"
#include "common/owned.h"
#include "common/pool.h"
#include "replay/frame.h"
#include "replay/inputs.h"
#include "replay/statistics.h"

namespace pellucid::harness {

// The module's defaults for a context on the device.
PellucidContextDesc contextDesc(const Device& device);

// A module context on a device.
class Context {
public:
  // Throws DeviceError with the module's sentence. `change`: of what the context is made for, which is
  // everything.
  explicit Context(Device& device, const std::function<void(PellucidContextDesc&)>& change = {});
  ~Context();
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;

  const PellucidContext* handle() const { return context_; }
  const std::string& message() const { return message_; }  // the module's errors since creation

private:
  PellucidContext* context_ = nullptr;
  std::string message_;
};

// Contexts of a device that fit captures: shadow views of arrays where maps lie in layers, else 2D ones, and
// pipelines that look for light tables where there are some.
class Contexts {
public:
  explicit Contexts(Device& device) : device_(device) {}

  const Context& of(const Capture& capture);

private:
  Device& device_;
  std::unique_ptr<Context> contexts_[4];  // made when first asked for
};

// One capture on the device, planned and ready to record as often as wanted.
class FrameRun {
public:
  // `materials[i]` is the compiled capture.materials[i]. Throws InputError for what validation refuses.
  // The capture is not needed afterwards. `previous`: the frame recorded before this one, of the same size,
  // whose history it goes on with.
  FrameRun(Device& device, const Context& context, const Capture& capture,
           const std::vector<PellucidMaterial>& materials, const ReplaySettings& settings,
           const FrameRun* previous = nullptr);
  // Inputs may be those that other frames read, too: not where settings.aliasOutput makes the irradiance the
  // output. Pixels that the pass does not write hold 0. The capture's own images are not read. `pool`: lends
  // images; null: they are the run's own.
  FrameRun(Device& device, const Context& context, const Capture& capture,
           const std::vector<PellucidMaterial>& materials, const ReplaySettings& settings,
           std::shared_ptr<const InputImages> inputs, const FrameRun* previous = nullptr,
           ImagePool* pool = nullptr);
  ~FrameRun();

  const PellucidPlan& plan() const { return *plan_; }
  const PellucidFrame& frame() const { return data_.frame; }
  // The slice as the device left it: with what it decided about indirect dispatches.
  const void* constants() const;
  const std::string& name() const { return name_; }  // of the capture
  // The statistics of the last recording, which is finished.
  Statistics statistics() const { return readStatistics(*plan_, constants()); }

  void record(VkCommandBuffer commandBuffer) const;  // the whole plan
  // The whole plans of several runs of one context, side by side.
  static void recordTogether(VkCommandBuffer commandBuffer, const std::vector<const FrameRun*>& runs);
  void record(VkCommandBuffer commandBuffer, uint32_t dispatch) const;  // one dispatch of it, in its turn

  // Gives an irradiance image that is the output, too, its content before the first recording again.
  void restoreIrradiance(const Capture& capture) const;

  // Other bits where a recording must not depend on them: in transients, the constants' memory between
  // constants, and an output that is not the irradiance, which becomes 0xFF bytes: NaN in both formats. On
  // guarded devices transients hold 0xFF bytes or what looks like indices, by turns.
  void fillGarbage(std::uint64_t seed) const;

  // Content of an output that is not the irradiance before the first recording.
  void uploadOutput(const Image& content) const;

  // RGBA, of packed floats RGB. Outside the rect and at material 0: irradiance times albedo, as an engine
  // that composites in place would have there; 0 for debug views.
  Image output() const;
  Image output(const VkRect2D& rect) const;  // of a part
  // RGBA of the irradiance in its format, which an output that is the irradiance replaces.
  Image irradiance() const;

private:
  class Images;

  void plan(const PellucidPlan* previous);
  void writeConstants() const;
  PellucidConstantsSlice slice() const;
  // The frame with a pool for descriptors, where they are not pushed. `recording`: of those in one command
  // buffer, which share the slice and need pools of their own.
  PellucidFrame frameFor(std::uint32_t recording) const;
  void record(VkCommandBuffer commandBuffer, const PellucidPlan& plan, std::uint32_t recording) const;
  void requireRecorded(PellucidResult result) const;
  PellucidPlan only(uint32_t dispatch) const;

  using DescriptorPool = Owned<VkDescriptorPool, vkDestroyDescriptorPool>;

  Device& device_;
  const Context& context_;
  std::string name_;
  FrameData data_;
  mutable std::map<std::uint32_t, DescriptorPool> pools_;  // by recording, made when first asked for
  std::unique_ptr<Images> images_;
  std::unique_ptr<PellucidPlan> plan_;
  std::unique_ptr<HostBuffer> constants_;
};

struct ReplayResult {
  Image output;  // as FrameRun::output; divided by preExposure where that was chosen
  float preExposure = 1;
  PellucidPlan plan;
  Statistics statistics;
  std::vector<DispatchTime> times;  // one per dispatch; none without timed frames
};

// Frames in their order, each of which goes on with the history of the one before, as settings.reuse says.
class ReplaySequence {
public:
  explicit ReplaySequence(Device& device) : device_(device), contexts_(device) {}

  // As Replayer::run(), without times. After a frame of another size the history begins anew.
  ReplayResult run(const Capture& capture, const std::vector<PellucidMaterial>& materials,
                   const ReplaySettings& settings);
  // The next frame begins anew, as after a cut.
  void cut() { last_.reset(); }

private:
  Device& device_;
  Contexts contexts_;
  std::unique_ptr<FrameRun> last_;
};

class Replayer {
public:
  explicit Replayer(Device& device) : device_(device), contexts_(device) {}

  const Context& contextFor(const Capture& capture) { return contexts_.of(capture); }

  // `timedFrames`: recordings of the frame after the one that makes the output, in which drivers may still
  // compile shaders. Times are medians of their GPU timestamps, microseconds.
  ReplayResult run(const Capture& capture, const std::vector<PellucidMaterial>& materials,
                   const ReplaySettings& settings, uint32_t timedFrames = 0);

private:
  Device& device_;
  Contexts contexts_;
};

}  // namespace pellucid::harness
