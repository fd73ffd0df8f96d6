// What names of files and layers say of a buffer: the faces it shows, and how a person names it.
#pragma once

#include <set>
#include <string>
#include <vector>

#include "init/manifest.h"

namespace pellucid::harness {

// Letters and digits, in lower case.
std::string plain(const std::string& text);

// depth.0001: the frame's number says nothing of the content.
std::string withoutFrame(const std::string& stem);

// Words in lower case: those of "sceneBack_02" are "scene" and "back".
std::vector<std::string> wordsOf(const std::string& text);

enum class Side { Unknown, Front, Back };

// Renders of front and of back faces have passes of equal names, so that only other names tell them apart.
class Sides {
public:
  explicit Sides(const std::vector<ChannelGroup>& groups);

  // By the name of the part, the file, or, of files of one name, the folder. Where all are "back", as of a
  // camera behind a head, the word tells nothing apart.
  Side ofFile(const ChannelGroup& group) const { return areAllBack_ ? Side::Unknown : said(group); }
  bool areAllBack() const { return areAllBack_; }
  // By the layer, or else by the file. Of colors only the view layer counts: light groups may be named
  // "back".
  Side of(Role role, const ChannelGroup& group) const;

private:
  Side said(const ChannelGroup& group) const;
  Side ofStem(const std::string& stem) const;

  std::set<std::string> stems_;       // plain
  std::multiset<std::string> names_;  // of files in several folders
  bool areAllBack_ = false;
};

// Three numbers a pixel, where other roles have one.
inline bool isTriple(Role role) { return role == Role::Irradiance || role == Role::Albedo; }
inline bool isDepth(Role role) { return role == Role::FrontDepth || role == Role::BackDepth; }

// The view layer that a program writes before the pass: "Char" of Char.Depth, and of Char.Depth.left in the
// view "left".
std::string layerOf(const ChannelGroup& group);

// True of one channel of a normal, a place or a motion, as Nz: not only depths end in z.
bool isOfVector(const ChannelGroup& group, const std::vector<ChannelGroup>& groups);

// The name by which an option takes this group: its layer or channel, with the file where several have the
// name.
std::string labelOf(const ChannelGroup& group, const std::vector<ChannelGroup>& groups);

// Groups that an option may mean by `name`: a layer or channel, a file, or both as in "file:layer".
struct Named {
  std::vector<ChannelGroup> groups;  // with the channels that are named
  bool isFile = false;               // the name is that of a file alone
};
Named groupsNamed(const std::string& name, Role role, const std::vector<ChannelGroup>& groups);

}  // namespace pellucid::harness
