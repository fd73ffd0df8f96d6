// The subject of the viewer: a model, a procedural scene or a capture.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "capture/capture.h"
#include "common/device.h"
#include "raster/rasterizer.h"
#include "scene/scene.h"
#include "view/state.h"

namespace pellucid::harness {

// The scene that a source makes of a state.
struct Scene {
  Capture capture;                          // without the images that `drawn` has
  std::shared_ptr<const DrawnFrame> drawn;  // null: the capture is whole
  std::vector<std::string> warnings;        // sentences for a person
};

class Source {
public:
  virtual ~Source() = default;

  // Throws what the maker of captures throws.
  virtual Scene render(const ViewState& state) = 0;

  // The material of each value of the scene's material image. Bodies of one material may have several values.
  virtual std::vector<MaterialSource> materials(const ViewState& state) const { return state.materials; }

  // True where the scene's colors are those of its materials, which have to be drawn anew with them.
  virtual bool drawsMaterials() const { return false; }

  // As the scene is opened: size, camera, center, lights, materials.
  const ViewState& start() const { return start_; }
  const Vector3& center() const { return start_.center; }  // what lights are dragged round, too
  double radius() const { return radius_; }                // scene units, > 0

  // Empty where camera and size, or the lights' part of the irradiance, can change; else a sentence that says
  // why not.
  const std::string& fixedCamera() const { return fixedCamera_; }
  const std::string& fixedLights() const { return fixedLights_; }

protected:
  ViewState start_;
  double radius_ = 1;
  std::string fixedCamera_, fixedLights_;
};

// Drawn by the device's rasterizer, which throws where the device cannot draw. The images stay on the device.
// The camera and the lights are where it begins; `raster` has the rest, whose size is the first.
std::unique_ptr<Source> modelSource(Device& device, Model model, const ModelCamera& camera,
                                    const RasterOptions& raster);

// Cast on the CPU. Throws InputError as makeScene() does.
std::unique_ptr<Source> sceneSource(const SceneParameters& parameters,
                                    const std::vector<MaterialSource>& materials);

// Keeps its camera and irradiance.
std::unique_ptr<Source> captureSource(Capture capture);

}  // namespace pellucid::harness
