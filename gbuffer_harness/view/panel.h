// The panel beside the picture: draws the state and changes it. Calls Dear ImGui between its NewFrame()
// and Render().
#pragma once

#include <array>
#include <optional>
#include <string>

#include "view/display.h"
#include "view/frames.h"
#include "view/source.h"
#include "view/state.h"

namespace pellucid::harness {

// Values that the panel knows besides the state, kept between frames of the screen.
struct PanelState {
  bool followWindow = false;  // the picture is as large as its area
  std::string message;        // of what went wrong or was done last
  bool isError = false;
  char savePath[512] = "out/view.exr";
  bool save = false;   // asked for in this frame
  FalseColors colors;  // as they are drawn
};

constexpr float kPanelWidth = 380;

// In the right part of a screen of that size.
Changes drawPanel(ViewState& state, PanelState& panel, const ViewFrames& frames, const Source& source,
                  const ScreenRect& screen);

// Over the picture: labels of its halves, the line of the split, ends of the legend, the value under the
// cursor.
void drawOverlay(const ViewState& state, const PanelState& panel, const ViewFrames& frames,
                 const ScreenRect& picture, float cursorX, float cursorY);

// One to four numbers under one label, kept within [low, high]. True: changed.
bool dragReals(const char* label, double* values, int count, double low, double high);

// Parts of the panel.
Changes drawMaterials(ViewState& state);
Changes drawLights(ViewState& state, const Source& source);

}  // namespace pellucid::harness
