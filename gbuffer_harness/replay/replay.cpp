#include "replay/replay.h"

#include <algorithm>
#include <cstring>
#include <iterator>
#include <utility>

#include "capture/shadow_images.h"
#include "common/error.h"
#include "common/parallel.h"
#include "common/progress.h"
#include "pellucid/pellucid_views.h"
#include "replay/exposure.h"

namespace pellucid::harness {

namespace {

// The recording of FrameRun::frameFor that is no single dispatch's.
constexpr std::uint32_t kWholePlan = PELLUCID_MAX_DISPATCHES;

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : (values[half - 1] + values[half]) / 2;
}

}  // namespace

// The device images of one frame.
class FrameRun::Images {
public:
  Images(Device& device, const Capture& capture, const ReplaySettings& settings, FrameData& data,
         std::shared_ptr<const InputImages> inputs, const Images* previous, ImagePool* pool)
      : device_(device), pool_(pool), preExposure_(preExposureOf(settings)), inputs_(std::move(inputs)) {
    const bool shared = inputs_ != nullptr;
    if (!shared) inputs_ = std::make_shared<InputImages>(device, capture, settings);
    inputs_->bind(data);
    PellucidFrame& f = data.frame;
    outputIsIrradiance_ = settings.inPlace();
    if (outputIsIrradiance_) {
      f.output = f.irradiance;
      output_ = &inputs_->irradiance();
    } else {
      GpuImage& output = create(capture.width, capture.height, settings.outputFormat);
      f.output = output.use();
      output_ = &output;
      if (shared || settings.debugView != PELLUCID_DEBUG_NONE)
        output.clear();
      else
        output.upload(exposed(composited(capture)));
    }
    PellucidImageNeed needs[kMaxImageNeeds];
    uint32_t count = kMaxImageNeeds;
    requireOk(pellucidGetImageNeeds(&f, &count, needs), f, capture.name);
    for (uint32_t i = 0; i < count; ++i) {
      if (needs[i].persistent) {
        history_ = previous ? previous->history_ : nullptr;
        if (!history_) {
          history_ = std::make_shared<GpuImage>(device, static_cast<int>(needs[i].extent[0]),
                                                static_cast<int>(needs[i].extent[1]), needs[i].format);
          history_->clear(0xFF);  // as transients: what a fresh one holds must not matter
          fresh_ = history_.get();
        }
        f.options.history = history_->use();
        continue;
      }
      GpuImage& image =
          create(static_cast<int>(needs[i].extent[0]), static_cast<int>(needs[i].extent[1]), needs[i].format);
      if (!pool) image.clear(0xFF);  // brings it into GENERAL; what it holds must not matter
      transients_.push_back(&image);
      f.transients[i] = image.use();
    }
  }

  // Bytes of 0xFF, or of 0 to a little more than what indices may be.
  void poison(std::uint64_t seed, std::uint32_t materials) const {
    if (!outputIsIrradiance_) output_->clear(0xFF);
    for (GpuImage* image : transients_) {
      if (seed % 2 == 0)
        image->clear(0xFF);
      else
        image->fill(seed, std::min(materials + 1, 255u));
    }
  }
  void fillGarbage(std::uint64_t seed) const {
    if (!outputIsIrradiance_) output_->clear(0xFF);
    constexpr std::uint8_t kBytes[] = {0x00, 0xFF, 0x7B};  // 0, NaN, large finite numbers in both formats
    const auto fill = [&](GpuImage& image) {
      if (seed % 4 < std::size(kBytes))
        image.clear(kBytes[seed % 4]);
      else
        image.fill(seed);
    };
    for (GpuImage* image : transients_) fill(*image);
    if (fresh_) fill(*fresh_);
  }
  void uploadOutput(const Image& content) const { output_->upload(content); }
  const GpuImage& output() const { return *output_; }
  Image irradiance() const { return inputs_->irradiance().download(); }
  void restoreIrradiance(const Capture& capture) const {
    if (outputIsIrradiance_) inputs_->irradiance().upload(exposed(capture.irradiance));
  }

private:
  GpuImage& create(int width, int height, VkFormat format) {
    images_.push_back(pool_ ? pool_->take(width, height, format)
                            : std::make_shared<GpuImage>(device_, width, height, format));
    return *images_.back();
  }
  Image exposed(Image image) const {
    scaleColors(image, preExposure_);
    return image;
  }
  static Image composited(const Capture& capture) {
    Image result = capture.irradiance;
    const auto channels = static_cast<size_t>(result.channels);  // albedo has three
    for (size_t i = 0; i < capture.albedo.data.size(); ++i)
      result.data[i / 3 * channels + i % 3] *= capture.albedo.data[i];
    return result;
  }

  Device& device_;
  ImagePool* pool_;
  float preExposure_;
  std::shared_ptr<const InputImages> inputs_;
  std::vector<std::shared_ptr<GpuImage>> images_;
  std::vector<GpuImage*> transients_;
  GpuImage* output_ = nullptr;
  bool outputIsIrradiance_ = false;
  std::shared_ptr<GpuImage> history_;  // of all frames of a sequence
  GpuImage* fresh_ = nullptr;          // the history, if this frame is the sequence's first
};

PellucidContextDesc contextDesc(const Device& device) {
  PellucidContextDesc desc;
  pellucidInitContextDesc(&desc);
  desc.instance = device.instance();
  desc.physicalDevice = device.physicalDevice();
  desc.device = device.handle();
  desc.getInstanceProcAddr = &vkGetInstanceProcAddr;
  desc.options.descriptorPools = !device.pushes();
  return desc;
}

Context::Context(Device& device, const std::function<void(PellucidContextDesc&)>& change) {
  PellucidContextDesc desc = contextDesc(device);
  desc.message = &appendError;
  desc.messageUser = &message_;
  if (device.writesWithoutFormat()) desc.options.outputFormat = VK_FORMAT_UNDEFINED;
  desc.options.parallelFor = [](void*, uint32_t count, void (*job)(void*, uint32_t), void* data) {
    parallelRows(static_cast<int>(count), 0, [&](int i) { job(data, static_cast<uint32_t>(i)); });
  };
  if (change) change(desc);
  const ProgressLine progress("compiling shaders");
  const PellucidResult result = pellucidCreateContext(&desc, &context_);
  if (result != PELLUCID_OK) throw DeviceError(std::string(pellucidResultName(result)) + ": " + message_);
}

Context::~Context() { pellucidDestroyContext(context_); }

const Context& Contexts::of(const Capture& capture) {
  const bool arrays = hasLayers(capture.lights);
  const bool tables = std::any_of(capture.lights.begin(), capture.lights.end(), [](const Light& light) {
    return !light.angleTable.empty() || !light.distanceTable.empty();
  });
  std::unique_ptr<Context>& context = contexts_[2 * arrays + tables];
  if (!context)
    context = std::make_unique<Context>(device_, [&](PellucidContextDesc& desc) {
      if (arrays) desc.options.shadowViewType = VK_IMAGE_VIEW_TYPE_2D_ARRAY;
      desc.options.lightTables = tables;
    });
  return *context;
}

FrameRun::FrameRun(Device& device, const Context& context, const Capture& capture,
                   const std::vector<PellucidMaterial>& materials, const ReplaySettings& settings,
                   const FrameRun* previous)
    : device_(device), context_(context), name_(capture.name), plan_(std::make_unique<PellucidPlan>()) {
  makeFrame(capture, materials, settings, data_);
  images_ = std::make_unique<Images>(device, capture, settings, data_, nullptr,
                                     previous ? previous->images_.get() : nullptr, nullptr);
  plan(previous ? previous->plan_.get() : nullptr);
}

FrameRun::FrameRun(Device& device, const Context& context, const Capture& capture,
                   const std::vector<PellucidMaterial>& materials, const ReplaySettings& settings,
                   std::shared_ptr<const InputImages> inputs, const FrameRun* previous, ImagePool* pool)
    : device_(device), context_(context), name_(capture.name), plan_(std::make_unique<PellucidPlan>()) {
  makeFrame(capture, inputs->shape(), materials, settings, data_);
  if (settings.inPlace())
    throw InputError(name_, "aliasOutput", "the inputs are other frames', too");
  images_ = std::make_unique<Images>(device, capture, settings, data_, std::move(inputs),
                                     previous ? previous->images_.get() : nullptr, pool);
  plan(previous ? previous->plan_.get() : nullptr);
}

void FrameRun::plan(const PellucidPlan* previous) {
  const PellucidFrame& frame = data_.frame;
  requireOk(pellucidValidateFrame(&frame, nullptr, nullptr), frame, name_);
  requireOk(pellucidBuildPlan(&frame, previous, plan_.get()), frame, name_);
  constants_ =
      std::make_unique<HostBuffer>(device_, plan_->constantsSize,
                                   VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT | VK_BUFFER_USAGE_STORAGE_BUFFER_BIT |
                                       VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT);
  writeConstants();
}

void FrameRun::writeConstants() const {
  requireOk(pellucidWriteConstants(plan_.get(), &data_.frame, constants_->mapped(),
                                   static_cast<size_t>(constants_->size())),
            data_.frame, name_);
}

FrameRun::~FrameRun() = default;

PellucidConstantsSlice FrameRun::slice() const {
  return {constants_->handle(), 0, constants_->size(), constants_->mapped()};
}

void FrameRun::requireRecorded(PellucidResult result) const {
  if (result == PELLUCID_OK) return;
  throw InputError(name_, "", context_.message().empty() ? pellucidResultName(result) : context_.message());
}

PellucidFrame FrameRun::frameFor(std::uint32_t recording) const {
  PellucidFrame frame = data_.frame;
  if (device_.pushes()) return frame;
  const auto [pool, isNew] = pools_.try_emplace(recording, device_);
  if (isNew) requireRecorded(pellucidCreateDescriptorPool(context_.handle(), pool->second.receive()));
  frame.options.descriptorPool = pool->second;
  return frame;
}

void FrameRun::record(VkCommandBuffer commandBuffer, const PellucidPlan& plan,
                      std::uint32_t recording) const {
  const PellucidConstantsSlice constants = slice();
  const PellucidFrame frame = frameFor(recording);
  requireRecorded(pellucidRecordPlan(context_.handle(), commandBuffer, &plan, &frame, &constants));
}

void FrameRun::recordTogether(VkCommandBuffer commandBuffer, const std::vector<const FrameRun*>& runs) {
  std::vector<PellucidConstantsSlice> slices;
  for (const FrameRun* run : runs) slices.push_back(run->slice());
  std::vector<PellucidFrame> frames;
  for (const FrameRun* run : runs) frames.push_back(run->frameFor(kWholePlan));
  std::vector<PellucidView> views;
  for (size_t i = 0; i < runs.size(); ++i) views.push_back({runs[i]->plan_.get(), &frames[i], &slices[i]});
  runs.at(0)->requireRecorded(pellucidRecordViews(runs[0]->context_.handle(), commandBuffer,
                                                  static_cast<uint32_t>(views.size()), views.data()));
}

void FrameRun::record(VkCommandBuffer commandBuffer) const { record(commandBuffer, *plan_, kWholePlan); }

PellucidPlan FrameRun::only(uint32_t dispatch) const {
  PellucidPlan single = *plan_;
  single.dispatchCount = 1;
  single.dispatches[0] = plan_->dispatches[dispatch];
  return single;
}

void FrameRun::record(VkCommandBuffer commandBuffer, uint32_t dispatch) const {
  record(commandBuffer, only(dispatch), dispatch);
}

const void* FrameRun::constants() const { return constants_->mapped(); }

Image FrameRun::output() const { return images_->output().download(); }

Image FrameRun::output(const VkRect2D& rect) const { return images_->output().download(rect); }

Image FrameRun::irradiance() const { return images_->irradiance(); }

void FrameRun::fillGarbage(std::uint64_t seed) const {
  if (device_.guarded())
    images_->poison(seed, data_.frame.materialCount);
  else
    images_->fillGarbage(seed);
  std::memset(constants_->mapped(), static_cast<int>(seed & 0xFF), static_cast<size_t>(constants_->size()));
  writeConstants();
}

void FrameRun::uploadOutput(const Image& content) const { images_->uploadOutput(content); }

void FrameRun::restoreIrradiance(const Capture& capture) const { images_->restoreIrradiance(capture); }

namespace {

// With the factor of the light that the capture needs, if the user leaves the choice.
ReplaySettings chosen(const ReplaySettings& given, const Capture& capture) {
  ReplaySettings settings = given;
  if (given.preExposure == 0) settings.preExposure = preExposureFor(capture);
  return settings;
}

// `given`: the user's settings.
ReplayResult recorded(Device& device, const FrameRun& run, const ReplaySettings& given) {
  ReplayResult result;
  result.plan = run.plan();
  result.preExposure = run.frame().preExposure;
  device.run([&](VkCommandBuffer commandBuffer) { run.record(commandBuffer); });
  result.output = run.output();
  const bool holdsLight =
      given.debugView == PELLUCID_DEBUG_NONE || given.debugView == PELLUCID_DEBUG_IRRADIANCE;
  if (given.preExposure == 0 && holdsLight) scaleColors(result.output, 1 / result.preExposure);
  result.statistics = run.statistics();
  return result;
}

}  // namespace

ReplayResult ReplaySequence::run(const Capture& capture, const std::vector<PellucidMaterial>& materials,
                                 const ReplaySettings& settings) {
  if (last_ && (last_->frame().imageExtent[0] != static_cast<uint32_t>(capture.width) ||
                last_->frame().imageExtent[1] != static_cast<uint32_t>(capture.height)))
    cut();
  last_ = std::make_unique<FrameRun>(device_, contexts_.of(capture), capture, materials,
                                     chosen(settings, capture), last_.get());
  return recorded(device_, *last_, settings);
}

ReplayResult Replayer::run(const Capture& capture, const std::vector<PellucidMaterial>& materials,
                           const ReplaySettings& settings, uint32_t timedFrames) {
  const FrameRun run(device_, contextFor(capture), capture, materials, chosen(settings, capture));
  if (timedFrames == 0) return recorded(device_, run, settings);
  ReplayResult result;
  {
    const ProgressLine progress("rendering a first frame, in which the driver may compile shaders, too");
    result = recorded(device_, run, settings);
  }

  const uint32_t count = result.plan.dispatchCount;
  Timestamps timestamps(device_, count + 1);
  std::vector<std::vector<double>> times(count);
  for (uint32_t frame = 0; frame < timedFrames; ++frame) {
    run.restoreIrradiance(capture);
    device_.run([&](VkCommandBuffer commandBuffer) {
      timestamps.reset(commandBuffer);
      timestamps.mark(commandBuffer, 0);
      for (uint32_t i = 0; i < count; ++i) {
        run.record(commandBuffer, i);
        timestamps.mark(commandBuffer, i + 1);
      }
    });
    const std::vector<double> intervals = timestamps.intervals();
    for (uint32_t i = 0; i < count; ++i) times[i].push_back(intervals[i]);
  }
  for (uint32_t i = 0; i < count; ++i)
    result.times.push_back({result.plan.dispatches[i].name, median(times[i])});
  return result;
}

}  // namespace pellucid::harness
