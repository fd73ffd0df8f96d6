// Writes what the viewer shows to files.
#pragma once

#include "common/image.h"
#include "view/frames.h"
#include "view/session.h"

namespace pellucid::harness {

// Writes the capture, the settings, the session and the result. `settings`: their text, which --set @FILE
// reads. Throws InputError for a file that cannot be written.
void saveView(const SavedFiles& files, const ViewFrames& frames, const std::string& settings,
              Session session);

}  // namespace pellucid::harness
