// The harness's exceptions, one per exit code of the command line.
#pragma once

#include <cstddef>
#include <new>
#include <stdexcept>
#include <string>

namespace pellucid::harness {

// Text of a file as a message shows it: control characters, which a terminal would obey, become spaces, and
// of text longer than `most` bytes the middle is left out, between whole UTF-8 characters.
inline std::string readable(std::string text, std::size_t most) {
  for (char& c : text)
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = ' ';
  if (text.size() <= most) return text;
  const auto splits = [&](std::size_t at) { return (static_cast<unsigned char>(text[at]) & 0xc0) == 0x80; };
  std::size_t head = most / 2, tail = text.size() - most / 2;
  while (head > 0 && splits(head)) --head;
  while (tail < text.size() && splits(tail)) ++tail;
  return text.substr(0, head) + " ... " + text.substr(tail);
}

// Bad input (exit code 3). The sentence names the file, the field and the value. Names and values of files
// may be as long as the files; no path is longer than 4,096 bytes.
class InputError : public std::runtime_error {
public:
  InputError(const std::string& file, const std::string& field, const std::string& sentence)
      : std::runtime_error((file.empty() ? std::string() : readable(file, 4096) + ": ") +
                           (field.empty() ? std::string() : readable(field, 400) + ": ") +
                           readable(sentence, 4000)) {}
};

// Calls work(), which takes memory for what is in `file`; where there is none left, throws InputError.
template <class Work>
auto withinMemory(const std::string& file, const Work& work) {
  try {
    return work();
  } catch (const std::bad_alloc&) {
    throw InputError(file, "", "needs more memory than there is");
  }
}

// Wrong use of the command line (exit code 2).
class UsageError : public std::runtime_error {
public:
  using std::runtime_error::runtime_error;
};

// No usable Vulkan device, or a Vulkan call failed (exit code 4).
class DeviceError : public std::runtime_error {
public:
  using std::runtime_error::runtime_error;
};

}  // namespace pellucid::harness
