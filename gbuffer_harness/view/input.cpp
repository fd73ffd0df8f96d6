#include "view/input.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scene/vector.h"

namespace pellucid::harness {

namespace {

constexpr double kTurnsPerPicture = 0.5;  // a drag over the picture's height turns half a turn
constexpr double kZoomPerNotch = 0.9;
constexpr float kSplitReach = 6;  // pixels beside the split that still grasp it

bool contains(const ScreenRect& rect, float x, float y) {
  return x >= rect.x && y >= rect.y && x < rect.x + rect.width && y < rect.y + rect.height;
}

Light* selectedLight(ViewState& state) {
  const auto i = static_cast<std::size_t>(state.selectedLight);
  return i < state.lights.size() ? &state.lights[i].light : nullptr;
}

}  // namespace

Controls::Drag Controls::begun(const ViewState& state, const ViewInput& input,
                               const ScreenRect& picture) const {
  if (!input.left && !input.middle && !input.right) return Drag::None;
  if (drag_ != Drag::None) return drag_;
  if (!contains(picture, input.x, input.y)) return Drag::Outside;
  if (input.middle) return Drag::Pan;
  if (input.right) return Drag::Look;
  if (input.shift) return Drag::Light;
  const float split = picture.x + state.display.splitAt * picture.width;
  return state.display.split && std::abs(input.x - split) <= kSplitReach ? Drag::Split : Drag::Orbit;
}

Changes Controls::apply(ViewState& state, const ViewInput& input, const Source& source,
                        const ScreenRect& picture) {
  const bool wasDragging = drag_ != Drag::None;
  drag_ = begun(state, input, picture);
  Changes changes;
  if (!(picture.width > 0 && picture.height > 0)) return changes;
  ViewCamera& camera = state.camera;
  const bool cameraMoves = source.fixedCamera().empty(), lightsMove = source.fixedLights().empty();
  const double turn = 2 * std::numbers::pi * kTurnsPerPicture / static_cast<double>(picture.height);
  const double right = turn * static_cast<double>(input.movedX),
               up = -turn * static_cast<double>(input.movedY);
  // The cursor moved to where the button went down before that.
  const bool moved = wasDragging && (input.movedX != 0 || input.movedY != 0);
  Light* const light = selectedLight(state);
  if (moved && drag_ == Drag::Split) {
    state.display.splitAt = std::clamp((input.x - picture.x) / picture.width, 0.0f, 1.0f);
    changes.shown = true;
  }
  if (moved && drag_ == Drag::Light && light && lightsMove) {
    dragLight(*light, camera, source.center(), right, up);
    changes.scene = true;
  }
  if (moved && cameraMoves && (drag_ == Drag::Orbit || drag_ == Drag::Look || drag_ == Drag::Pan)) {
    if (drag_ == Drag::Orbit) orbit(camera, -right, -up);
    if (drag_ == Drag::Look) look(camera, -0.5 * right, 0.5 * up);
    if (drag_ == Drag::Pan) {
      const double away = glm::length(toGlm(camera.pivot) - toGlm(camera.eye()));
      const double height =
          camera.lens.orthographic ? camera.lens.height : 2 * away * std::tan(camera.lens.verticalFov / 2);
      const double step = height / static_cast<double>(picture.height);
      walk(camera, {-step * static_cast<double>(input.movedX), step * static_cast<double>(input.movedY), 0});
    }
    changes.scene = true;
  }
  if (input.wheel != 0 && contains(picture, input.x, input.y)) {
    const double factor = std::pow(kZoomPerNotch, static_cast<double>(input.wheel));
    if (input.shift && light && lightsMove) {
      pullLight(*light, source.center(), factor);
      changes.scene = true;
    } else if (!input.shift && cameraMoves) {
      zoom(camera, factor);
      changes.scene = true;
    }
  }
  const Vector3 step = {static_cast<double>(input.stepRight) - static_cast<double>(input.stepLeft),
                        static_cast<double>(input.up) - static_cast<double>(input.down),
                        static_cast<double>(input.forward) - static_cast<double>(input.back)};
  if (cameraMoves && (step[0] != 0 || step[1] != 0 || step[2] != 0)) {
    const double speed = source.radius() * static_cast<double>(input.seconds);
    walk(camera, {speed * step[0], speed * step[1], speed * step[2]});
    changes.scene = true;
  }
  if (changes.scene && cameraMoves) fitRange(camera, source.center(), source.radius());
  return changes;
}

}  // namespace pellucid::harness
