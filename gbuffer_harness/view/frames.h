// The viewer's frames: from the state to what the module made of it, only as far as something changed.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "replay/replay.h"
#include "view/source.h"
#include "view/state.h"

namespace pellucid::harness {

class ViewFrames {
public:
  // `contexts` of all uses and `source` must outlive it.
  ViewFrames(Device& device, Contexts& contexts, Source& source);

  // Makes anew what the changes ask for, and frames that the display newly shows. If update() throws, all
  // frames stay as they were.
  void update(const ViewState& state, const Changes& changes);

  // Size, lights and materials; images, where the scene is not on the device, and the truth.
  const Capture& outline() const { return scene_.capture; }
  // With all images; with those of the surfaces alone; the material. Downloaded when they are first asked
  // for.
  const Capture& capture() const;
  const Capture& surfaces() const;
  const std::vector<std::uint8_t>& material() const;
  const std::vector<PellucidMaterial>& materials() const { return materials_; }  // with their own T(d)
  const std::vector<std::string>& warnings() const { return scene_.warnings; }
  double coveredPart() const { return coveredPart_; }  // of the pixels that have a material

  // The frame whose output is looked at; what shows inputs has that of Shown::After.
  const FrameRun& run(Shown shown) const;
  const GpuImage* truth() const { return truth_.get(); }  // null: the capture has none

  // The shown picture before exposure: RGB, or one channel or three for false colors. Pixels without a
  // material: as a replay has them.
  const Image& image(Shown shown) const;
  // One texel of image(), one or three channels, for which no more than texels go to the host where it can
  // be.
  std::vector<float> value(Shown shown, int x, int y) const;

  // Times of the last recording of Shown::After, and of drawing the scene, by the GPU's clock.
  const std::vector<DispatchTime>& times() const { return times_; }
  const std::vector<DispatchTime>& sceneTimes() const;  // empty for scenes that the host makes
  // How often Shown::After was recorded.
  std::uint64_t recorded() const { return recorded_; }

  // Frames of settings.reuse go on with the frame before; after this call the next one does not.
  void forgetHistory() { forget_ = true; }

private:
  struct Frame {
    std::shared_ptr<const FrameRun> run;
    std::vector<DispatchTime> times;
  };
  Frame make(const ViewState& state, Shown shown, const Capture& outline,
             const std::vector<PellucidMaterial>& materials,
             const std::shared_ptr<const InputImages>& inputs);
  Image pixels(Shown shown, const Capture& surfaces, const VkRect2D& rect) const;
  void uploadTruth();

  Device& device_;
  Source& source_;
  Contexts& contexts_;
  ImagePool pool_;
  mutable Scene scene_;  // its images are downloaded into the capture
  mutable bool hasSurfaces_ = false, hasMaps_ = false, hasMaterial_ = false;
  double coveredPart_ = 0;
  std::vector<PellucidMaterial> materials_;
  std::shared_ptr<const InputImages> inputs_;
  std::unique_ptr<GpuImage> truth_;
  std::map<Shown, std::shared_ptr<const FrameRun>> runs_;  // of After, Through and Debug
  mutable std::map<Shown, Image> images_;                  // downloaded when first asked for
  std::vector<DispatchTime> times_;
  std::uint64_t recorded_ = 0;
  VkFormat format_ = VK_FORMAT_UNDEFINED;  // of inputs_
  bool forget_ = false;
};

}  // namespace pellucid::harness
