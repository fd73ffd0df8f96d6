// `pellucid capture MODEL`: a glTF file through the rasterizer.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "gltf/gltf.h"
#include "raster/raster.h"
#include "scene/turn.h"

namespace pellucid::harness {

// One capture to write, of the still scene or of a turntable.
struct CaptureFrame {
  std::filesystem::path output;
  Turn turn;
};

struct GltfCapture {
  std::string model, device;
  std::vector<CaptureFrame> frames;
  std::vector<double> cameraTurns = {0};  // of the whole turntable, radians: the auto camera fits them all
  GltfOptions gltf;
  RasterOptions raster;
  std::string camera;            // name of one of the file's cameras, or "auto"; empty: the first, else auto
  Vector3 toCamera = {0, 0, 1};  // of the auto camera, world
  double verticalFov = 30;       // of the auto camera, degrees
  bool orthographic = false;     // of the auto camera
  std::vector<std::string> lights;  // kLightSyntax; empty: the file's, and "back" when it has none
};

inline constexpr const char* kLightSyntax = "directional:X,Y,Z[:E], point:X,Y,Z[:I], spot:X,Y,Z[:I] or back";

// Writes the frames and says on stdout what there is, with a warning for everything that is drawn
// otherwise than asked.
void captureGltf(const GltfCapture& options);

// A light of the command line. X,Y,Z: direction of travel of a directional light, else the position; spots
// look at the model's center. E: irradiance at normal incidence, I: intensity, both of KHR_lights_punctual;
// by default 1 arrives at the model's center. "back": from behind and above, towards `camera`. Throws
// UsageError.
Light parseLight(const std::string& text, const Model& model, const ModelCamera& camera);

// Meters of "mm", "cm", "m" or a number. Throws UsageError.
double parseUnit(const std::string& text);

}  // namespace pellucid::harness
