#include "stress/results.h"

#include <algorithm>
#include <cmath>

#include "common/error.h"

namespace pellucid::harness::stress {

namespace {

const std::string kHeader = "pellucid stress results 1\n";

template <class T>
void write(std::ofstream& file, const T& value) {
  file.write(reinterpret_cast<const char*>(&value), sizeof value);
}

}  // namespace

ResultsWriter::ResultsWriter(const std::filesystem::path& path) : path_(path), file_(path, std::ios::binary) {
  file_ << kHeader;
  if (!file_) throw InputError(path.string(), "", "cannot be written");
}

void ResultsWriter::add(const StressFrame& frame, const Image& output) {
  write(file_, frame.seed);
  write(file_, frame.index);
  write(file_, static_cast<std::int32_t>(output.width));
  write(file_, static_cast<std::int32_t>(output.height));
  file_.write(reinterpret_cast<const char*>(output.data.data()),
              static_cast<std::streamsize>(output.data.size() * sizeof(float)));
  if (!file_.flush()) throw InputError(path_.string(), "", "cannot be written");
}

ResultsReader::ResultsReader(const std::filesystem::path& path) : path_(path), file_(path, std::ios::binary) {
  std::string header(kHeader.size(), '\0');
  file_.read(header.data(), static_cast<std::streamsize>(header.size()));
  if (!file_ || header != kHeader) throw InputError(path.string(), "", "is no file of stress results");
}

template <class T>
T ResultsReader::read() {
  T value{};
  file_.read(reinterpret_cast<char*>(&value), sizeof value);
  if (!file_) throw InputError(path_.string(), "", "ends in the middle of a frame");
  return value;
}

void ResultsReader::add(const StressFrame& frame, const Image& output) {
  const auto seed = read<std::uint64_t>(), index = read<std::uint64_t>();
  const auto width = read<std::int32_t>(), height = read<std::int32_t>();
  if (seed != frame.seed || index != frame.index || width != output.width || height != output.height)
    throw InputError(path_.string(), "",
                     "has frame " + std::to_string(index) + " of seed " + std::to_string(seed) + ", " +
                         std::to_string(width) + " x " + std::to_string(height) + ", where frame " +
                         std::to_string(frame.index) + " of seed " + std::to_string(frame.seed) + " is " +
                         std::to_string(output.width) + " x " + std::to_string(output.height));
  Image other(width, height, 4);
  file_.read(reinterpret_cast<char*>(other.data.data()),
             static_cast<std::streamsize>(other.data.size() * sizeof(float)));
  if (!file_) throw InputError(path_.string(), "", "ends in the middle of a frame");

  Difference& d = frame.wild ? wild : tame;
  const Pixels owned = ownedPixels(frame);
  ++d.frames;
  d.sameBits += differentBits(other, output, owned).value == 0;
  const Worst worst = apart(output, other, owned);
  if (worst.value > d.worst.value) {
    d.worst = worst;
    d.worstFrame = frame.index;
  }
  for (std::size_t p = 0; p < owned.size(); ++p) {
    if (!owned[p]) continue;
    for (std::size_t i = 4 * p; i < 4 * p + 3; ++i) {
      const double a = static_cast<double>(output.data[i]), b = static_cast<double>(other.data[i]);
      const double error = relative(std::abs(a - b), b);
      ++d.values;
      d.above3 += !(error <= 1e-3);
      d.above2 += !(error <= 1e-2);
    }
  }
}

}  // namespace pellucid::harness::stress
