#include "view/save.h"

#include "capture/exr.h"
#include "capture/write.h"
#include "common/error.h"
#include "common/whole_file.h"

namespace pellucid::harness {

void saveView(const SavedFiles& files, const ViewFrames& frames, const std::string& settings,
              Session session) {
  writeWhole(files.capture, [&](const auto& file) { writeCapture(frames.capture(), file); });
  writeWholeText(files.settings, settings);
  session.settings = files.settings.filename().string();
  writeWholeText(files.session, sessionJson(session));
  writeWhole(files.result, [&](const auto& file) {
    writeExr(file, frames.image(Shown::After), {"R", "G", "B"}, {});
  });
}

}  // namespace pellucid::harness
