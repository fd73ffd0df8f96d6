// State that the viewer's panel and mouse change, and the work that a change makes necessary.
#pragma once

#include <string>
#include <vector>

#include "capture/capture.h"
#include "raster/view_camera.h"
#include "replay/frame.h"

namespace pellucid::harness {

struct ViewLight {
  Light light;  // without shadow maps
  bool on = true;
};

enum class Shown {
  After,       // the module's output
  Before,      // irradiance times albedo
  Through,     // what translucency alone adds
  Difference,  // |after - truth| or, without a truth, |after - before|
  Truth,       // of a capture that has one
  Debug,       // settings.debugView in false color
  FrontDepth,  // as the capture stores it, in false color
  Albedo,
  Material,  // index, in false color
};

struct Display {
  float exposure = 0;  // factor; 0: from the first picture, autoExposure()
  Shown shown = Shown::After;
  bool split = false;  // `left` is shown to the left of the split
  Shown left = Shown::Before;
  float splitAt = 0.5f;               // of the picture's width
  int channel = 0;                    // of false colors, 0..2
  float falseLow = 0, falseHigh = 0;  // values of the ends of the false colors; equal: those of the picture
};

constexpr int kLargestSide = 8192;  // pixels, of pictures and of windows
constexpr int kSmallestWindow = 64;

struct ViewState {
  int width = 512, height = 512;  // pixels of the picture, 1..kLargestSide
  ViewCamera camera;
  Vector3 center = {0, 0, 0};  // of the bodies, world, with which noise stays as the camera moves
  std::vector<ViewLight> lights;
  std::vector<MaterialSource> materials;
  ReplaySettings settings;
  Display display;
  int selectedLight = 0, selectedMaterial = 0;
};

// Parts that have to be made anew, along with all that depends on them.
struct Changes {
  bool scene = false;      // camera, lights, size: the images that the module reads
  bool materials = false;  // their coefficients
  bool frame = false;      // settings: the module's frame
  bool shown = false;      // exposure and the like: the picture on the screen

  void add(const Changes& other) {
    scene |= other.scene;
    materials |= other.materials;
    frame |= other.frame;
    shown |= other.shown;
  }
  bool any() const { return scene || materials || frame || shown; }
};

// The settings of the frame whose output `shown` needs: Through has no diffusion, Debug its view.
ReplaySettings settingsFor(const ViewState& state, Shown shown);

// True where the picture is looked up in false colors.
bool isFalseColor(Shown shown);

// Names for the panel, in the order of the enumeration.
const std::vector<std::string>& shownNames();

// A light of that type from behind and above, of which 1 arrives at `center`.
ViewLight newLight(PellucidLightType type, const ViewCamera& camera, const Vector3& center, double radius);

// Carries a light round `center` as the camera sees it: `right` and `up`, radians. Point and spot lights
// move, and spots go on looking at what they looked at; directional lights turn.
void dragLight(Light& light, const ViewCamera& camera, const Vector3& center, double right, double up);

// Multiplies a point or spot light's distance to `center` by `factor` > 0; as much light arrives there as
// before.
void pullLight(Light& light, const Vector3& center, double factor);

}  // namespace pellucid::harness
