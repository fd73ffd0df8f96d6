// Effect of mouse and keys on the state, for a panel library and a test alike.
#pragma once

#include "view/display.h"
#include "view/source.h"
#include "view/state.h"

namespace pellucid::harness {

// Between two frames of the screen; positions are pixels from its top left corner.
struct ViewInput {
  float x = 0, y = 0;            // of the cursor
  float movedX = 0, movedY = 0;  // since the frame before
  float wheel = 0;               // notches, upwards above 0
  bool left = false, middle = false, right = false, shift = false;
  bool forward = false, back = false, stepLeft = false, stepRight = false, up = false, down = false;
  float seconds = 0;
};

// Left button: orbit; on the split: moves it; with shift: drags the selected light. Right: looks around.
// Middle: pans. Wheel: to the pivot and away; with shift: the light. w a s d, e and q: walks.
class Controls {
public:
  // `picture`: where the frame is on the screen; buttons pressed outside of it do nothing.
  Changes apply(ViewState& state, const ViewInput& input, const Source& source, const ScreenRect& picture);

private:
  enum class Drag { None, Outside, Split, Light, Orbit, Look, Pan };
  Drag begun(const ViewState& state, const ViewInput& input, const ScreenRect& picture) const;

  Drag drag_ = Drag::None;
};

}  // namespace pellucid::harness
