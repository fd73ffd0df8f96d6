#include "view/scripted_input.h"

#include <imgui.h>

#include <algorithm>
#include <iterator>

namespace pellucid::harness {

void ScriptedInput::play(int frame, ViewState& state, Changes& changes,
                         const std::function<void(const ScriptLine&)>& other) {
  if (lines_.empty()) return;
  for (; next_ < lines_.size() && lines_[next_].frame <= frame; ++next_) {
    const ScriptLine& line = lines_[next_];
    if (applyToState(line, state, changes)) continue;
    if (line.command == "move") {
      x_ = numberOf(line, 0);
      y_ = numberOf(line, 1);
    } else if (line.command == "wheel") {
      ImGui::GetIO().MouseWheel = numberOf(line, 0);
    } else if (line.command == "press" || line.command == "release") {
      press(line.arguments.front(), line.command == "press");
    } else {
      other(line);
    }
  }
  feed();
}

void ScriptedInput::press(const std::string& what, bool down) {
  if (what == "shift") {
    shift_ = down;
  } else if (what == "left" || what == "right" || what == "middle") {
    buttons_[what == "left" ? 0 : what == "right" ? 1 : 2] = down;
  } else {
    const int key = what == "space" ? ' ' : what[0] - 'a' + 'A';
    std::erase(keys_, key);
    if (down) keys_.push_back(key);
  }
}

// Every frame anew: a window's own events would say otherwise.
void ScriptedInput::feed() const {
  ImGuiIO& io = ImGui::GetIO();
  io.MousePos = {x_, y_};
  std::copy(std::begin(buttons_), std::end(buttons_), io.MouseDown);
  io.KeyShift = shift_;
  for (const int key : {'W', 'A', 'S', 'D', 'E', 'Q', ' '})
    io.KeysDown[key] = std::find(keys_.begin(), keys_.end(), key) != keys_.end();
}

}  // namespace pellucid::harness
