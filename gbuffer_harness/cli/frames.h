// Numbered frames on the command line: which, and in which files.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace pellucid::harness {

// "1-10,20": ranges and numbers from 0 to 9999999 with commas, ascending and each once, at most 1000000 of
// them. Throws UsageError.
std::vector<int> parseFrames(const std::string& text);

// The inverse: the shortest text for ascending numbers.
std::string framesText(const std::vector<int>& frames);

// A path whose file name has one run of '#', which stands for the frame number, padded with zeros to the
// run's length.
class FramePattern {
public:
  // Throws UsageError, naming `option`, unless there is one run.
  FramePattern(const std::string& option, const std::string& path);

  std::filesystem::path operator()(int frame) const;
  // Frames whose files are there, ascending.
  std::vector<int> existing() const;

private:
  std::filesystem::path folder_;
  std::string before_, after_;
  std::size_t width_;
};

}  // namespace pellucid::harness
