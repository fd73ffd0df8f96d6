#include "view/save.h"

#include <cmath>

#include "capture/exr.h"
#include "capture/write.h"
#include "common/error.h"
#include "common/png.h"
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

void savePicture(const std::filesystem::path& png, const Image& screen) {
  std::vector<std::uint8_t> bytes(screen.pixels() * 3);
  for (std::size_t i = 0; i < bytes.size(); ++i)
    bytes[i] = static_cast<std::uint8_t>(std::lround(screen.data[i / 3 * 4 + i % 3] * 255));
  writeWhole(png, [&](const auto& file) { writePng(file, screen.width, screen.height, bytes); });
}

}  // namespace pellucid::harness
