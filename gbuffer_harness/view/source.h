// The subject of the viewer: a model, a procedural scene or a capture.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "capture/capture.h"
#include "common/device.h"
#include "raster/raster.h"
#include "scene/scene.h"
#include "view/state.h"

namespace pellucid::harness {

class Source {
public:
  virtual ~Source() = default;

  virtual ViewState start() const = 0;  // as it is opened: size, camera, lights, materials

  // The capture of the state. Throws what the maker of captures throws. `warnings` receives sentences.
  virtual Capture render(const ViewState& state, std::vector<std::string>& warnings) = 0;

  virtual Vector3 center() const = 0;  // world; what lights are dragged round
  virtual double radius() const = 0;   // scene units, > 0

  // Empty where camera and size, or the lights' part of the irradiance, can change; else a sentence that says
  // why not.
  virtual std::string fixedCamera() const { return {}; }
  virtual std::string fixedLights() const { return {}; }
};

// Drawn by the device's rasterizer, which throws where the device cannot draw. The camera and the lights are
// where it begins; `raster` has the rest, whose size is the first.
std::unique_ptr<Source> modelSource(Device& device, Model model, const ModelCamera& camera,
                                    const RasterOptions& raster);

// Cast on the CPU. Throws InputError as makeScene() does.
std::unique_ptr<Source> sceneSource(const SceneParameters& parameters,
                                    const std::vector<MaterialSource>& materials);

// Keeps its camera and irradiance.
std::unique_ptr<Source> captureSource(Capture capture);

}  // namespace pellucid::harness
