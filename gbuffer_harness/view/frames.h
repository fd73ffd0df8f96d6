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

  const Capture& capture() const { return capture_; }
  const std::vector<PellucidMaterial>& materials() const { return materials_; }  // with their own T(d)
  const std::vector<std::string>& warnings() const { return warnings_; }

  // The frame whose output is looked at; what shows inputs has that of Shown::After.
  const FrameRun& run(Shown shown) const;
  // The host's image of what is shown, for the display: the truth of Truth and Difference, Tiles, Isolated.
  // Null for others, and where the capture has no truth.
  const GpuImage* hostImage(Shown shown) const;

  // The shown picture before exposure: RGB, or one channel or three for false colors. Pixels without a
  // material: as a replay has them.
  const Image& image(Shown shown) const;

  // Times of the last recording of Shown::After, by the GPU's clock.
  const std::vector<DispatchTime>& times() const { return times_; }
  // Wall-clock time of the last source.render() and upload.
  double sceneMilliseconds() const { return sceneMilliseconds_; }
  // How often Shown::After was recorded.
  std::uint64_t recorded() const { return recorded_; }

  // Frames of settings.reuse go on with the frame before; after this call the next one does not.
  void forgetHistory() { forget_ = true; }

private:
  struct Frame {
    std::shared_ptr<const FrameRun> run;
    std::vector<DispatchTime> times;
  };
  Frame make(const ViewState& state, Shown shown, const Capture& capture,
             const std::vector<PellucidMaterial>& materials,
             const std::shared_ptr<const InputImages>& inputs) const;
  Image made(Shown shown) const;
  void uploadHostImage(Shown shown);

  Device& device_;
  Source& source_;
  Contexts& contexts_;
  Capture capture_;
  std::vector<PellucidMaterial> materials_;
  std::vector<std::string> warnings_;
  std::shared_ptr<const InputImages> inputs_;
  std::map<Shown, std::unique_ptr<GpuImage>> hostImages_;
  std::map<Shown, std::shared_ptr<const FrameRun>> runs_;  // of After, Through and Debug
  mutable std::map<Shown, Image> images_;                  // downloaded when first asked for
  std::vector<DispatchTime> times_;
  double sceneMilliseconds_ = 0;
  std::uint64_t recorded_ = 0;
  VkFormat format_ = VK_FORMAT_UNDEFINED;  // of inputs_
  bool forget_ = false;
};

}  // namespace pellucid::harness
