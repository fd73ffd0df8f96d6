// Outputs of random frames in a file, to compare devices: a frame is the same on all of them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>

#include "stress/measures.h"
#include "stress/random_frame.h"

namespace pellucid::harness::stress {

// A line of text, then for each frame its seed and index (64 bits), width and height (32 bits) and RGBA
// (32-bit floats), all little-endian.
class ResultsWriter {
public:
  // Throws InputError, as add() does, for a file that cannot be written.
  explicit ResultsWriter(const std::filesystem::path& path);
  void add(const StressFrame& frame, const Image& output);

private:
  std::filesystem::path path_;
  std::ofstream file_;
};

// How far outputs are from those of the file, over owned pixels of RGB: relative, with kFloor and kCeiling.
struct Difference {
  std::uint64_t frames = 0, sameBits = 0;            // frames of which all bits are the same
  std::uint64_t values = 0, above3 = 0, above2 = 0;  // values; those that differ by more than 1e-3 and 1e-2
  Worst worst;
  std::uint64_t worstFrame = 0;
};

class ResultsReader {
public:
  // Throws InputError, as add() does, naming the file and what is wrong with it.
  explicit ResultsReader(const std::filesystem::path& path);

  // The file's next frame must be this one.
  void add(const StressFrame& frame, const Image& output);
  bool ended() { return file_.peek() == std::ifstream::traits_type::eof(); }

  Difference tame, wild;

private:
  template <class T>
  T read();

  std::filesystem::path path_;
  std::ifstream file_;
};

}  // namespace pellucid::harness::stress
