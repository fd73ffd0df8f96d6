// Lights of a frame that contribute, by the dispatches that take them.
#pragma once

#include <array>
#include <span>

#include "setup.h"

namespace pellucid {

constexpr uint32_t kAmbientCoefficients = 27;  // of PellucidFrameOptions::ambient

// Light from all around takes a place among the lights of dispatches: one of this type, which no caller can
// name.
inline bool isAmbient(const PellucidLight& light) { return light.type == PELLUCID_SHADER_LIGHT_AMBIENT; }

// All that a plan leaves out, and why.
struct Skips {
  std::array<PellucidSkip, PELLUCID_MAX_SKIPS> list{};
  uint32_t size = 0;

  // Static strings. Equal ones are counted.
  void add(const char* what, const char* reason);
};

// One dispatch binds a number of shadow images (see mostImages) and windows of fixed size on the constants of
// lights and shadow maps, so lights are taken in order into groups that need no more. Constants are laid out
// light by light within the groups.
struct LightGroup {
  uint32_t firstLight = 0, lightCount = 0;       // of Lights::active
  uint32_t shadowCount = 0;                      // shadow maps
  VkDeviceSize lightBytes = 0, shadowBytes = 0;  // of the groups before, in the constants
  VkDeviceSize gatherMapBytes = 0, entryMapBytes = 0;
  uint32_t gathered = 0;                     // lights that are gathered from; the first ones
  bool shapes = false;                       // its probes say how much light curved surfaces return
  uint32_t entryColumns = 0, entryRows = 0;  // of their maps' entry points
  uint32_t entryWidth = 0, entryHeight = 0;  // the most that one of them has
  uint32_t entryGroups = 0;                  // workgroups that make those of all levels
  bool beside = true;                        // exit depths and caster materials have slots among the images
  uint32_t imageCount = 0;
  uint32_t mostImages =
      PELLUCID_SHADOW_IMAGE_COUNT;  // more where the entry points' dispatch alone reads them
  std::array<uint32_t, PELLUCID_ENTRY_IMAGE_COUNT> images{};  // into frame.shadowImages

  // Slot of an image, or mostImages.
  uint32_t slot(uint32_t image) const;
  // Gives the images of a light's map slots; false if there are not enough.
  bool addImages(const Setup& setup, const PellucidLight& light, const PellucidShadowMap& map);
  // Adds the light, its maps and their images; false (and no change) if they do not fit.
  bool addLight(const Setup& setup, const PellucidLight& light);
  // Probes find the light that comes through, and shapes where the frame has no such light.
  bool hasProbes() const { return gathered > 0 || shapes; }
  // An empty group whose constants follow this one's.
  LightGroup next() const;
  // True where the exit depth beside the light's map is read. Thickness from the camera knows nothing of the
  // light's way and its exit.
  bool readsExit(const Setup& setup, const PellucidLight& light, const PellucidShadowMap& map) const;
  bool readsCaster(const PellucidShadowMap& map) const { return beside && map.options.casterMaterialImage != 0; }

private:
  bool addImage(uint32_t image);
};

struct Lights {
  // Each light is looked at once: `out` is warned of those that add nothing, and `skips` counts them.
  Lights(const Setup& setup, Findings& out);

  PellucidLight ambient;  // its intensity is 0 where the frame has none
  bool needsChord;        // thickness along view rays is asked for
  Skips skips;            // lights that add nothing, and what they lack

  uint32_t lightCount = 0;                    // lights that contribute
  bool lackExit = false, lackCaster = false;  // a map of theirs has no such image
  uint32_t holdBackFaces = 0;                 // as many of them have such maps
  // Lights that are gathered from come first, because one dispatch adds all of these lights to the pixels.
  static constexpr uint32_t kMost = PELLUCID_MAX_DISPATCHES * PELLUCID_DISPATCH_LIGHTS;
  static constexpr uint32_t kAmbient = UINT32_MAX;
  std::array<uint32_t, kMost> active;  // lightCount of them, into frame.lights, or kAmbient

  const PellucidLight& light(const Inputs& inputs, uint32_t index) const {
    return active[index] == kAmbient ? ambient : inputs.frame.lights[active[index]];
  }

  // Groups. A curved surface returns the same share under any light: a frame without gathered lights has a
  // first group without lights where surfaces have shapes.
  uint32_t count = 0, gathered = 0;          // gathered: with probes
  uint32_t entryColumns = 0, entryRows = 0, entryGroups = 0;  // the most of a group
  // Dispatches of thin walls' light beside a gather. Without one, the pass of solids' light adds it.
  uint32_t walls = 0;
  // False where exit depths and caster materials need more dispatches than a plan has: then they are left out
  // as if the frame had only the maps.
  bool beside = true;
  LightGroup last;
  std::array<LightGroup, PELLUCID_MAX_DISPATCHES> first{};  // a frame with more has no plan

  bool fitPlan() const { return count <= first.size() && lightCount <= kMost; }
  std::span<const LightGroup> list() const { return {first.data(), fitPlan() ? count : first.size()}; }
  // Dispatches besides those over all pixels: probes, entry points where lights are gathered, and one filter.
  uint32_t gatherDispatches() const {
    return gathered > 0 ? 2 * gathered + (first[0].gathered > 0 ? 1 : 0) : 0;
  }
  // Dispatches over all pixels, of one thickness a pixel.
  uint32_t fused() const { return count - gathered; }

private:
  void group(const Setup& setup, bool withBeside);
};

}  // namespace pellucid
