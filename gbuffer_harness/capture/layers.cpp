#include "capture/layers.h"

#include <algorithm>
#include <set>

namespace pellucid::harness {

namespace {

ExrFormat formatOf(const ExrFile& file, int part, const std::string& channel) {
  const std::string name = file.channelFormat(part, channel);
  return name == "half" ? ExrFormat::Half : name == "uint" ? ExrFormat::Uint : ExrFormat::Float;
}

}  // namespace

KeptLayers readOtherLayers(const BufferSource& irradiance) {
  KeptLayers kept;
  if (irradiance.isConstant()) return kept;
  const ExrFile file(irradiance.file, irradiance.field);
  const int own = file.findPart(irradiance.channels, irradiance.part, irradiance.field);
  std::set<std::string> taken = {"R", "G", "B"};
  const auto keep = [&](int part, const std::vector<std::pair<std::string, std::string>>& channels) {
    std::vector<ExrPlane> planes;
    for (const auto& [from, name] : channels) {
      if (!taken.insert(name).second) continue;
      Image& image = kept.images.emplace_back();
      image.channels = 1;
      planes.push_back({from, &image, 0, 0});
      kept.channels.push_back({name, formatOf(file, part, from), &image, 0});
    }
    if (!planes.empty()) file.read(part, ExrWindow::Display, planes);
  };
  const std::string& red = irradiance.channels.front();
  const std::string alpha = red.substr(0, red.rfind('.') + 1) + "A";  // npos + 1 is 0
  const std::vector<std::string> names = file.channels(own);
  if (std::find(names.begin(), names.end(), alpha) != names.end()) keep(own, {{alpha, "A"}});
  for (int part = 0; part < file.partCount(); ++part) {
    if (file.width(part, ExrWindow::Data) != file.width(own, ExrWindow::Data) ||
        file.height(part, ExrWindow::Data) != file.height(own, ExrWindow::Data))
      continue;  // a shadow map
    std::vector<std::pair<std::string, std::string>> channels;
    for (const std::string& name : file.channels(part)) channels.emplace_back(name, name);
    keep(part, channels);
  }
  return kept;
}

}  // namespace pellucid::harness
