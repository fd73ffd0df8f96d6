// Saved views: the scene and the state that a capture does not hold.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "view/state.h"

namespace pellucid::harness {

// The files of one saved view. The capture, replayed with the settings, gives the result bit for bit; the
// session opens the scene again where it was left.
struct SavedFiles {
  std::filesystem::path capture;   // NAME.exr
  std::filesystem::path settings;  // NAME.settings.json, for --set @FILE
  std::filesystem::path session;   // NAME.view.json
  std::filesystem::path result;    // NAME.pellucid.exr
  std::filesystem::path picture;   // NAME.png
};

// `capture` names the first. Throws InputError for another extension than .exr.
SavedFiles savedFiles(const std::filesystem::path& capture);

struct Session {
  std::vector<std::string> scene;  // arguments of `pellucid view` that open it
  std::string settings;            // file name beside the session
  ViewState state;                 // but for its settings
};

std::string sessionJson(const Session& session);

// `start`: the state that the scene begins with, for what the session does not say. Throws InputError naming
// file, field and value.
Session readSession(const std::filesystem::path& path, const ViewState& start = {});

// True for a file that begins like one; false for one that cannot be read, too.
bool isSession(const std::filesystem::path& path);

}  // namespace pellucid::harness
