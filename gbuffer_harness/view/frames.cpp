#include "view/frames.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <glm/gtc/packing.hpp>
#include <utility>

#include "capture/material.h"
#include "metrics/isolated.h"
#include "shared/pellucid_shared.h"

namespace pellucid::harness {

namespace {

// Irradiance times albedo, as an image of the format holds it: what a replay leaves where no material is.
Image composited(const Capture& capture, VkFormat format) {
  Image result = capture.irradiance;
  for (std::size_t i = 0; i < result.data.size(); ++i) {
    if (!capture.albedo.empty()) result.data[i] *= capture.albedo.data[i];
    if (format == VK_FORMAT_R16G16B16A16_SFLOAT)
      result.data[i] = glm::unpackHalf1x16(glm::packHalf1x16(result.data[i]));
  }
  return result;
}

Image coveredTiles(const Capture& capture) {
  constexpr int kTile = PELLUCID_TILE;
  Image result(capture.width, capture.height, 1);
  for (int top = 0; top < capture.height; top += kTile)
    for (int left = 0; left < capture.width; left += kTile) {
      const int bottom = std::min(top + kTile, capture.height), right = std::min(left + kTile, capture.width);
      int covered = 0;
      for (int y = top; y < bottom; ++y)
        for (int x = left; x < right; ++x) covered += capture.material[pixelIndex(result, x, y)] != 0;
      const float part = static_cast<float>(covered) / static_cast<float>((bottom - top) * (right - left));
      for (int y = top; y < bottom; ++y)
        std::fill(result.at(left, y), result.at(left, y) + (right - left), part);
    }
  return result;
}

template <class Function>
Image combined(const Image& a, const Image& b, const Function& of) {
  Image result = a;
  for (std::size_t i = 0; i < result.data.size(); ++i) result.data[i] = of(a.data[i], b.data[i]);
  return result;
}

// Names the frame whose output or inputs a picture shows.
Shown frameOf(Shown shown) { return shown == Shown::Through || shown == Shown::Debug ? shown : Shown::After; }

// Names the image of the host that a picture needs.
Shown hostImageOf(Shown shown) { return shown == Shown::Difference ? Shown::Truth : shown; }

}  // namespace

ViewFrames::ViewFrames(Device& device, Contexts& contexts, Source& source)
    : device_(device), source_(source), contexts_(contexts) {}

ViewFrames::Frame ViewFrames::make(const ViewState& state, Shown shown, const Capture& capture,
                                   const std::vector<PellucidMaterial>& materials,
                                   const std::shared_ptr<const InputImages>& inputs) const {
  const auto before = runs_.find(shown);
  const bool goesOn = before != runs_.end() && !forget_ && capture.width == capture_.width &&
                      capture.height == capture_.height;
  Frame frame;
  frame.run = std::make_shared<const FrameRun>(device_, contexts_.of(capture), capture, materials,
                                               settingsFor(state, shown), inputs,
                                               goesOn ? before->second.get() : nullptr);
  const PellucidPlan& plan = frame.run->plan();
  const Timestamps timestamps(device_, plan.dispatchCount + 1);
  device_.run([&](VkCommandBuffer commandBuffer) {
    timestamps.reset(commandBuffer);
    timestamps.mark(commandBuffer, 0);
    for (std::uint32_t i = 0; i < plan.dispatchCount; ++i) {
      frame.run->record(commandBuffer, i);
      timestamps.mark(commandBuffer, i + 1);
    }
  });
  const std::vector<double> intervals = timestamps.intervals();
  for (std::uint32_t i = 0; i < plan.dispatchCount; ++i)
    frame.times.push_back({plan.dispatches[i].name, intervals[i]});
  return frame;
}

void ViewFrames::update(const ViewState& state, const Changes& changes) {
  const bool scene = changes.scene || !inputs_;
  const bool upload = scene || state.settings.outputFormat != format_;
  const bool compile = changes.materials || !inputs_;
  const bool frames = upload || compile || changes.frame;
  const auto start = std::chrono::steady_clock::now();
  std::optional<Capture> rendered;
  std::vector<std::string> warnings;
  if (scene) rendered = source_.render(state, warnings);
  const Capture& capture = rendered ? *rendered : capture_;
  const std::shared_ptr<const InputImages> inputs =
      upload ? std::make_shared<const InputImages>(device_, capture, state.settings) : inputs_;
  const double milliseconds =
      std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  std::vector<PellucidMaterial> materials = materials_;
  if (compile) {
    materials.clear();
    for (std::size_t i = 0; i < state.materials.size(); ++i)
      materials.push_back(compileMaterial(state.materials[i], "materials[" + std::to_string(i) + "]"));
  }
  std::map<Shown, Frame> made;
  const auto need = [&](Shown shown) {
    const Shown of = frameOf(shown);
    if ((frames || runs_.count(of) == 0) && made.count(of) == 0)
      made[of] = make(state, of, capture, materials, inputs);
  };
  need(Shown::After);
  need(state.display.shown);
  if (state.display.split) need(state.display.left);
  // All is made; nothing below throws but for memory.
  if (frames) {
    runs_.clear();
    images_.clear();
    hostImages_.clear();
    materials_ = std::move(materials);
  }
  for (auto& [of, frame] : made) {
    runs_[of] = std::move(frame.run);
    if (of != Shown::After) continue;
    times_ = std::move(frame.times);
    ++recorded_;
    forget_ = false;
  }
  if (scene) {
    capture_ = std::move(*rendered);
    warnings_ = std::move(warnings);
    sceneMilliseconds_ = milliseconds;
  }
  capture_.materials = state.materials;
  inputs_ = inputs;
  format_ = state.settings.outputFormat;
  uploadHostImage(state.display.shown);
  if (state.display.split) uploadHostImage(state.display.left);
}

void ViewFrames::uploadHostImage(Shown shown) {
  shown = hostImageOf(shown);
  const bool isHosts =
      shown == Shown::Tiles || shown == Shown::Isolated || (shown == Shown::Truth && capture_.truth);
  if (!isHosts || hostImages_.count(shown) > 0) return;
  auto image =
      std::make_unique<GpuImage>(device_, capture_.width, capture_.height, VK_FORMAT_R32G32B32A32_SFLOAT);
  image->upload(this->image(shown));
  hostImages_[shown] = std::move(image);
}

const GpuImage* ViewFrames::hostImage(Shown shown) const {
  const auto found = hostImages_.find(hostImageOf(shown));
  return found != hostImages_.end() ? found->second.get() : nullptr;
}

const FrameRun& ViewFrames::run(Shown shown) const {
  const auto found = runs_.find(frameOf(shown));
  return *(found != runs_.end() ? found : runs_.find(Shown::After))->second;
}

const Image& ViewFrames::image(Shown shown) const {
  const auto found = images_.find(shown);
  return found != images_.end() ? found->second : images_.emplace(shown, made(shown)).first->second;
}

Image ViewFrames::made(Shown shown) const {
  switch (shown) {
    case Shown::After: {
      const FrameRun& frame = run(shown);
      const Image output = frame.output();
      Image result = composited(capture_, frame.frame().outputFormat);
      for (std::size_t i = 0; i < result.pixels(); ++i)
        if (capture_.material[i] != 0) std::copy_n(&output.data[4 * i], 3, &result.data[3 * i]);
      return result;
    }
    case Shown::Before:
      return composited(capture_, VK_FORMAT_R32G32B32A32_SFLOAT);
    case Shown::Through: {
      Image result = rgb(run(shown).output());
      const Image& before = image(Shown::Before);
      for (std::size_t i = 0; i < result.pixels(); ++i)
        for (std::size_t c = 0; c < 3; ++c) {
          float& value = result.data[3 * i + c];
          value = capture_.material[i] != 0 ? std::max(value - before.data[3 * i + c], 0.0f) : 0;
        }
      return result;
    }
    case Shown::Difference:
      return combined(image(Shown::After), image(capture_.truth ? Shown::Truth : Shown::Before),
                      [](float a, float b) { return std::abs(a - b); });
    case Shown::Truth:
      return capture_.truth ? capture_.truth->image : Image(capture_.width, capture_.height, 3);
    case Shown::Debug:
      return rgb(run(shown).output());
    case Shown::FrontDepth:
      return capture_.frontDepth.image;
    case Shown::Normal: {
      if (capture_.normal.empty()) return Image(capture_.width, capture_.height, 3);
      Image result = capture_.normal;
      for (float& n : result.data) n = 0.5f * n + 0.5f;
      return result;
    }
    case Shown::Albedo:
      return capture_.albedo.empty() ? Image(capture_.width, capture_.height, 3, 1.0f) : capture_.albedo;
    case Shown::Material: {
      Image result(capture_.width, capture_.height, 1);
      std::copy(capture_.material.begin(), capture_.material.end(), result.data.begin());
      return result;
    }
    case Shown::Tiles:
      return coveredTiles(capture_);
    case Shown::Isolated: {
      const std::vector<std::uint8_t> marks =
          findIsolated(image(Shown::After), Surfaces(capture_), capture_.material).marks;
      Image result(capture_.width, capture_.height, 1);
      std::copy(marks.begin(), marks.end(), result.data.begin());
      return result;
    }
  }
  return {};
}

}  // namespace pellucid::harness
