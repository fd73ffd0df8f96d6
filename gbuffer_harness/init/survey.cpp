#include "init/manifest.h"

#include <cctype>
#include <map>

#include "common/parse.h"
#include "init/sides.h"

namespace pellucid::harness {

namespace {

// Takes the channels of these components out of `components`, when all are there.
std::vector<std::string> take(std::map<std::string, std::string>& components, const char* wanted) {
  std::vector<std::string> result;
  for (const char* c = wanted; *c; ++c) {
    const auto found = components.find(std::string(1, *c));
    if (found == components.end()) return {};
    result.push_back(found->second);
  }
  for (const char* c = wanted; *c; ++c) components.erase(std::string(1, *c));
  return result;
}

// Some programs write the components of colors out.
std::string componentOf(const std::string& name) {
  const std::string component = lower(name);
  for (const char* color : {"red", "green", "blue", "alpha"})
    if (component == color) return component.substr(0, 1);
  return component;
}

void addPart(const std::filesystem::path& path, const ExrFile& file, int part,
             std::vector<ChannelGroup>& groups) {
  if (lower(file.partName(part)).find("crypto") != std::string::npos) return;
  std::map<std::string, std::map<std::string, std::string>> layers;  // component, in lower case -> channel
  for (const std::string& channel : file.channels(part)) {
    const std::size_t dot = channel.rfind('.');
    const std::string layer = dot == std::string::npos ? "" : channel.substr(0, dot);
    if (lower(layer).find("crypto") != std::string::npos) continue;
    layers[layer][componentOf(channel.substr(dot + 1))] = channel;
  }
  for (auto& [layer, components] : layers) {
    ChannelGroup group{path, part, layer, !layer.empty(), file.viewOf(part, components.begin()->second), file.partCount() > 1, {},
                       file.partName(part)};
    if (layer.empty()) group.name = file.partCount() > 1 ? file.partName(part) : withoutFrame(path.stem().string());
    const auto add = [&](std::vector<std::string> channels) {
      if (channels.empty()) return;
      group.channels = std::move(channels);
      groups.push_back(group);
    };
    for (const char* wanted : {"rgb", "xyz"}) add(take(components, wanted));
    components.erase("a");
    for (const auto& [component, channel] : components) add({channel});
  }
}

}  // namespace

std::vector<ChannelGroup> survey(const std::vector<std::filesystem::path>& files) {
  std::vector<ChannelGroup> groups;
  for (const std::filesystem::path& path : files) {
    const ExrFile file(path);
    for (int part = 0; part < file.partCount(); ++part) addPart(path, file, part, groups);
  }
  return groups;
}

Image readGroup(const ChannelGroup& group) {
  Image image;
  image.channels = static_cast<int>(group.channels.size());
  std::vector<ExrPlane> planes;
  for (std::size_t i = 0; i < group.channels.size(); ++i)
    planes.push_back({group.channels[i], &image, static_cast<int>(i), 0});
  ExrFile(group.file).read(group.part, ExrWindow::Display, planes);
  return image;
}

}  // namespace pellucid::harness
