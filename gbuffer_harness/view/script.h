// Input from a file in place of a person: tests play it to the viewer.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "view/state.h"

namespace pellucid::harness {

// One line "FRAME COMMAND ARGUMENTS", before that frame of the screen, counted from 1:
//   move X Y                          cursor, pixels of the window
//   press | release left | middle | right | shift | w | a | s | d | e | q
//   wheel NOTCHES
//   resize WIDTH HEIGHT               of the window
//   set KEY=VALUE                     of --set
//   material PRESET                   of the selected material
//   show NAME                         of shownNames(), with - for spaces
//   split NAME AT                     NAME to the left of AT, 0..1 of the picture's width
//   exposure FACTOR
//   turn MODEL LIGHTS                 frames in which the model and the lights turn once; 0: still
//   save FILE.exr, screenshot FILE.png
struct ScriptLine {
  int frame = 1;
  std::string command;
  std::vector<std::string> arguments;
  std::string where;  // file and line, for messages
};

// Lines in order of their frames; empty ones and those that begin with # say nothing. Throws InputError
// naming file and line for an unknown command, a wrong number of arguments, and frames that go back.
std::vector<ScriptLine> readScript(const std::filesystem::path& path);

// Carries out the commands that change the state: set, show, split and exposure. False for others. Throws
// InputError naming the line and the value.
bool applyToState(const ScriptLine& line, ViewState& state, Changes& changes);

// The line's argument as a number. Throws InputError likewise.
float numberOf(const ScriptLine& line, std::size_t argument);

}  // namespace pellucid::harness
