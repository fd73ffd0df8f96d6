// A script's mouse and keys, in place of the window's.
#pragma once

#include <functional>
#include <vector>

#include "view/script.h"

namespace pellucid::harness {

class ScriptedInput {
public:
  explicit ScriptedInput(std::vector<ScriptLine> lines) : lines_(std::move(lines)) {}

  bool isDone() const { return next_ == lines_.size(); }

  // Before Gui::begin() of a frame: carries out its lines on the state and on Dear ImGui's input. `other`:
  // takes resize, save and screenshot.
  void play(int frame, ViewState& state, Changes& changes,
            const std::function<void(const ScriptLine&)>& other);

private:
  void press(const std::string& what, bool down);
  void feed() const;

  std::vector<ScriptLine> lines_;
  std::size_t next_ = 0;
  float x_ = -1, y_ = -1;
  bool buttons_[3] = {false, false, false}, shift_ = false;
  std::vector<int> keys_;  // that are held
};

}  // namespace pellucid::harness
