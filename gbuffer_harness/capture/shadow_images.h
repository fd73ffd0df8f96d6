// Images that hold a capture's shadow maps: one of each map, or tiles of an atlas and layers of an array.
#pragma once

#include <array>
#include <vector>

#include "capture/capture.h"

namespace pellucid::harness {

enum class ShadowContent { Depth, Exit, Caster };

struct ShadowImageSource {
  ShadowContent content;
  int width = 0, height = 0, layers = 1;
  std::vector<const ShadowMap*> maps;  // their tiles

  // One channel; caster materials as numbers. Texels of no tile hold 0.5, which is a surface of any encoding.
  Image layer(int index) const;
};

struct ShadowImages {
  std::vector<ShadowImageSource> images;
  // Indices into `images` of each map's depth, exit depth and caster material, by the lights' order; -1:
  // none.
  std::vector<std::array<int, 3>> ofMap;
};

// `lights` must outlive the result.
ShadowImages shadowImages(const std::vector<Light>& lights);

// True where a map lies in a layer, so that its views are of arrays.
bool hasLayers(const std::vector<Light>& lights);

}  // namespace pellucid::harness
