#include "init/sides.h"

#include <algorithm>
#include <cctype>
#include <string_view>

namespace pellucid::harness {

namespace {

bool isOfFaces(const std::string& word, const std::string& side) {
  return word == side || word == side + "s" || word == side + "side" || word.starts_with(side + "fac");
}

// Names that say both say nothing.
Side sideOf(bool isFront, bool isBack) {
  if (isFront == isBack) return Side::Unknown;
  return isBack ? Side::Back : Side::Front;
}

Side sideOfText(const std::string& text) {
  const std::vector<std::string> words = wordsOf(text);
  const auto says = [&](const char* side) {
    return std::any_of(words.begin(), words.end(),
                       [&](const std::string& word) { return isOfFaces(word, side); });
  };
  return sideOf(says("front"), says("back"));
}

std::string stemOf(const ChannelGroup& group) { return group.file.stem().string(); }

// Without the frame's number.
std::string plainStem(const ChannelGroup& group) {
  std::string stem = plain(stemOf(group));
  while (!stem.empty() && std::isdigit(static_cast<unsigned char>(stem.back()))) stem.pop_back();
  return stem;
}

// What a channel's name ends in, behind the last dot.
std::string lastPartOf(const std::string& channel) { return channel.substr(channel.rfind('.') + 1); }

bool isVectorWord(const std::string& word) {
  for (const char* known : {"n", "nn", "ng", "ns", "normal", "normals", "p", "pos", "position", "positions",
                            "v", "motion", "velocity", "vector", "tangent", "bitangent"})
    if (word == known) return true;
  return false;
}

bool hasVectorName(const std::string& text) {
  const std::vector<std::string> words = wordsOf(text);
  return !words.empty() && isVectorWord(words.back());
}

// Words by which a person may mean the group's file, or its part.
std::vector<std::string> fileNamesOf(const ChannelGroup& group) {
  std::filesystem::path bare = group.file;
  bare.replace_extension();
  std::vector<std::string> names = {stemOf(group), withoutFrame(stemOf(group)),
                                    group.file.filename().string(), group.file.string(), bare.string()};
  if (group.isNamed && !group.partName.empty()) names.push_back(group.partName);
  if (!group.isNamed) names.push_back(group.name);
  return names;
}

bool isOneOf(const std::string& name, const std::vector<std::string>& names) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

// The group, with the channels that `name` means; none: another group.
std::vector<ChannelGroup> ownNamed(const std::string& name, Role role, const ChannelGroup& group) {
  if (group.isNamed && group.name == name) return {group};
  const auto channel = std::find(group.channels.begin(), group.channels.end(), name);
  if (channel == group.channels.end() || (isTriple(role) && channel != group.channels.begin())) return {};
  ChannelGroup one = group;
  if (!isTriple(role)) one.channels = {name};
  return {one};
}

}  // namespace

std::string plain(const std::string& text) {
  std::string result;
  for (const unsigned char c : text)
    if (std::isalnum(c)) result += static_cast<char>(std::tolower(c));
  return result;
}

std::string withoutFrame(const std::string& stem) {
  const std::size_t end = stem.find_last_not_of("0123456789");
  return end != std::string::npos && end > 0 && end + 1 < stem.size() &&
                 std::string(". _-").find(stem[end]) != std::string::npos
             ? stem.substr(0, end)
             : stem;
}

std::vector<std::string> wordsOf(const std::string& text) {
  const auto is = [&](std::size_t i, int (*kind)(int)) {
    return i < text.size() && kind(static_cast<unsigned char>(text[i]));
  };
  std::vector<std::string> words;
  bool begins = true;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (!is(i, std::isalpha)) {
      begins = true;
      continue;
    }
    // A capital begins a word behind a small letter, and before one: ZBack is Z and Back.
    const bool isCapital =
        is(i, std::isupper) && i > 0 && (is(i - 1, std::islower) || is(i + 1, std::islower));
    if (begins || isCapital) words.emplace_back();
    words.back() += static_cast<char>(std::tolower(static_cast<unsigned char>(text[i])));
    begins = false;
  }
  return words;
}

Sides::Sides(const std::vector<ChannelGroup>& groups) {
  std::set<std::filesystem::path> files;
  for (const ChannelGroup& group : groups) {
    stems_.insert(plainStem(group));
    if (files.insert(group.file).second) names_.insert(group.file.filename().string());
  }
  areAllBack_ = std::all_of(groups.begin(), groups.end(),
                            [&](const ChannelGroup& group) { return said(group) == Side::Back; });
}

// "headback" has no words, but says back faces beside "head" or "headfront".
Side Sides::ofStem(const std::string& stem) const {
  const auto says = [&](const std::string& side, const char* other) {
    if (!stem.ends_with(side)) return false;
    const std::string base = stem.substr(0, stem.size() - side.size());
    return !base.empty() && (stems_.count(base) || stems_.count(base + other));
  };
  return sideOf(says("front", "back"), says("back", "front"));
}

Side Sides::said(const ChannelGroup& group) const {
  if (const Side part = group.hasBeside ? sideOfText(group.partName) : Side::Unknown; part != Side::Unknown)
    return part;
  if (const Side stem = sideOfText(stemOf(group)); stem != Side::Unknown) return stem;
  if (const Side stem = ofStem(plainStem(group)); stem != Side::Unknown) return stem;
  return names_.count(group.file.filename().string()) > 1
             ? sideOfText(group.file.parent_path().filename().string())
             : Side::Unknown;
}

Side Sides::of(Role role, const ChannelGroup& group) const {
  const std::string layer = isDepth(role) && group.isNamed ? group.name : layerOf(group);
  const Side side = group.isNamed ? sideOfText(layer) : Side::Unknown;
  return side != Side::Unknown ? side : ofFile(group);
}

std::string layerOf(const ChannelGroup& group) {
  std::string name = group.name;
  if (!group.view.empty() && name.ends_with("." + group.view))
    name.resize(name.size() - group.view.size() - 1);
  const std::size_t dot = name.rfind('.');
  return dot == std::string::npos ? "" : name.substr(0, dot);
}

bool isOfVector(const ChannelGroup& group, const std::vector<ChannelGroup>& groups) {
  std::string channel = group.channels.front(), component = lastPartOf(channel);
  constexpr std::string_view kAxes = "xyzXYZ";
  const std::size_t axis = component.empty() ? kAxes.npos : kAxes.find(component.back());
  if (group.channels.size() != 1 || axis == kAxes.npos) return false;
  component.pop_back();
  if (component.empty()) return group.isNamed && hasVectorName(lastPartOf(group.name));
  if (hasVectorName(component)) return true;
  const auto isThere = [&](std::size_t other) {
    channel.back() = kAxes[axis / 3 * 3 + other];
    return std::any_of(groups.begin(), groups.end(), [&](const ChannelGroup& beside) {
      return beside.file == group.file && beside.part == group.part && isOneOf(channel, beside.channels);
    });
  };
  return isThere((axis + 1) % 3) || isThere((axis + 2) % 3);
}

std::string labelOf(const ChannelGroup& group, const std::vector<ChannelGroup>& groups) {
  const auto isAny = [&](const auto& is) { return std::any_of(groups.begin(), groups.end(), is); };
  const auto isBeside = [&](const ChannelGroup& other) {
    return other.file == group.file && other.part == group.part;
  };
  const auto isOther = [&](const ChannelGroup& other) {
    return isBeside(other) && other.channels.front() != group.channels.front() &&
           (!group.isNamed || other.name == group.name);
  };
  const bool isFile = !group.isNamed && !isAny(isOther);
  const std::string own = isFile || (group.isNamed && !isAny(isOther)) ? group.name : group.channels.front();
  const auto isSameName = [&](const ChannelGroup& other) {
    return !isBeside(other) && (other.name == own || isOneOf(own, other.channels));
  };
  if (!isAny(isSameName)) return own;
  const auto isPart = [&](const ChannelGroup& other) {
    return isSameName(other) && other.file == group.file;
  };
  const auto isSameStem = [&](const ChannelGroup& other) {
    return other.file != group.file && stemOf(other) == stemOf(group);
  };
  const std::string file = isAny(isPart)       ? group.partName
                           : isAny(isSameStem) ? group.file.string()
                                               : stemOf(group);
  return isFile ? file : file + ":" + own;
}

Named groupsNamed(const std::string& name, Role role, const std::vector<ChannelGroup>& groups) {
  Named named;
  const auto add = [&](std::vector<ChannelGroup> more) {
    named.groups.insert(named.groups.end(), more.begin(), more.end());
  };
  for (const ChannelGroup& group : groups) add(ownNamed(name, role, group));
  if (!named.groups.empty()) return named;
  for (const ChannelGroup& group : groups)
    for (const std::string& file : fileNamesOf(group))
      if (name.starts_with(file + ":")) {
        std::vector<ChannelGroup> own = ownNamed(name.substr(file.size() + 1), role, group);
        if (own.empty()) continue;
        add(own);
        break;
      }
  if (!named.groups.empty()) return named;
  named.isFile = true;
  for (const ChannelGroup& group : groups)
    if (isOneOf(name, fileNamesOf(group))) named.groups.push_back(group);
  return named;
}

}  // namespace pellucid::harness
