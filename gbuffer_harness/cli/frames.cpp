#include "cli/frames.h"

#include <algorithm>

#include "cli/numbers.h"

namespace pellucid::harness {

namespace {

constexpr int kLastFrame = 9999999;
constexpr std::size_t kMostFrames = 1000000;

std::optional<int> frameIn(const std::string& text) {
  const std::optional<int> frame = numberIn<int>(text);
  return frame && *frame >= 0 && *frame <= kLastFrame ? frame : std::nullopt;
}

int parseFrame(const std::string& all, const std::string& text) {
  const std::optional<int> frame = frameIn(text);
  if (!frame)
    throw UsageError("--frames: \"" + text + "\" in \"" + all + "\" is not a frame from 0 to " +
                     std::to_string(kLastFrame));
  return *frame;
}

}  // namespace

std::vector<int> parseFrames(const std::string& text) {
  std::vector<int> frames;
  for (const std::string& range : split(text, ',')) {
    const std::vector<std::string> ends = split(range, '-');
    if (ends.size() > 2) throw UsageError("--frames: \"" + range + "\" is not FIRST-LAST");
    const int first = parseFrame(text, ends.front()), last = parseFrame(text, ends.back());
    if (last < first) throw UsageError("--frames: \"" + range + "\" ends before it begins");
    if (frames.size() + static_cast<std::size_t>(last - first) >= kMostFrames)
      throw UsageError("--frames: \"" + text + "\" are more than " + std::to_string(kMostFrames));
    for (int frame = first; frame <= last; ++frame) frames.push_back(frame);
  }
  std::sort(frames.begin(), frames.end());
  frames.erase(std::unique(frames.begin(), frames.end()), frames.end());
  return frames;
}

std::string framesText(const std::vector<int>& frames) {
  std::string text;
  for (std::size_t i = 0; i < frames.size();) {
    std::size_t last = i;
    while (last + 1 < frames.size() && frames[last + 1] == frames[last] + 1) ++last;
    if (!text.empty()) text += ',';
    text += std::to_string(frames[i]);
    if (last > i) text.append("-").append(std::to_string(frames[last]));
    i = last + 1;
  }
  return text;
}

FramePattern::FramePattern(const std::string& option, const std::string& path)
    : folder_(std::filesystem::path(path).parent_path()) {
  const std::string name = std::filesystem::path(path).filename().string();
  const std::size_t first = name.find('#');
  const std::size_t end = std::min(name.find_first_not_of('#', first), name.size());
  if (first == std::string::npos || name.find('#', end) != std::string::npos ||
      folder_.string().find('#') != std::string::npos)
    throw UsageError(
        option + ": \"" + path +
        "\" is not a file name with one run of #, the place of the frame number (name.####.exr)");
  before_ = name.substr(0, first);
  after_ = name.substr(end);
  width_ = end - first;
}

std::filesystem::path FramePattern::operator()(int frame) const {
  const std::string number = std::to_string(frame);
  const std::string zeros(width_ - std::min(width_, number.size()), '0');
  return folder_ / (before_ + zeros + number + after_);
}

std::vector<int> FramePattern::existing() const {
  std::vector<int> frames;
  std::error_code error;
  const std::filesystem::path folder = folder_.empty() ? "." : folder_;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
    const std::string name = entry.path().filename().string();
    if (name.size() < before_.size() + after_.size() || !name.starts_with(before_) || !name.ends_with(after_))
      continue;
    const auto frame = frameIn(name.substr(before_.size(), name.size() - before_.size() - after_.size()));
    if (frame && (*this)(*frame).filename() == name) frames.push_back(*frame);
  }
  std::sort(frames.begin(), frames.end());
  return frames;
}

}  // namespace pellucid::harness
