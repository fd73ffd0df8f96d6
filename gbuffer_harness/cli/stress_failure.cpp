#include "cli/stress_failure.h"

#include "capture/write.h"
#include "cli/settings.h"
#include "common/whole_file.h"

namespace pellucid::harness {

std::string writeFailure(const std::filesystem::path& folder, const stress::StressFrame& frame) {
  std::filesystem::create_directories(folder);
  const std::filesystem::path exr = folder / (frame.capture.name + ".exr"),
                              json = folder / (frame.capture.name + ".json");
  Capture capture = frame.capture;
  capture.irradiance = rgb(capture.irradiance);
  if (const std::uint32_t mark = frame.settings.translucency.materialMarkBit)
    for (std::uint8_t& m : capture.material) m = static_cast<std::uint8_t>(m & ~mark);
  writeCapture(capture, exr);
  ReplaySettings settings = frame.settings;
  settings.transmittance = frame.transmittance;
  writeWholeText(json, settingsJson(settings));
  const std::string debug = debugOption(settings);
  return "pellucid replay " + exr.string() + " --set @" + json.string() +
         (debug.empty() ? "" : " --debug " + debug);
}

}  // namespace pellucid::harness
