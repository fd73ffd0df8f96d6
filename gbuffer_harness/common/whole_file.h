// Files that are either whole or not there.
#pragma once

#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>
#include <string>
#include <system_error>
#include <vector>

#include "common/error.h"

namespace pellucid::harness {

// Calls write(temporary), a name of its own in the folder of `path`, and renames it to `path`. Whoever
// looks at `path` meanwhile, or after a crash, sees what was there before. Nothing is left behind when
// write throws. What is there and no regular file, like a device node, is not replaced by one. Throws
// InputError, naming `path`, when there is no such folder or the file cannot be renamed, and what write
// throws.
template <class Write>
void writeWhole(const std::filesystem::path& path, const Write& write) {
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(path, error);
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status))
    throw InputError(path.string(), "", "is there and no regular file; nothing is written in its place");
  std::ostringstream suffix;
  suffix << ".part-" << std::hex << std::random_device{}();
  std::filesystem::path temporary = path;
  temporary += suffix.str();
  const std::filesystem::path folder = std::filesystem::absolute(path, error).parent_path();
  if (!std::filesystem::is_directory(folder, error))
    throw InputError(path.string(), "", "cannot be written: there is no folder " + folder.string());
  try {
    write(temporary);
  } catch (const InputError& e) {
    std::filesystem::remove(temporary, error);
    // Who asked for `path` knows nothing of the temporary name.
    std::string sentence = e.what();
    for (std::size_t at; (at = sentence.find(suffix.str())) != std::string::npos;)
      sentence.erase(at, suffix.str().size());
    throw InputError("", "", sentence);
  } catch (...) {
    std::filesystem::remove(temporary, error);
    throw;
  }
  std::filesystem::rename(temporary, path, error);
  if (!error) return;
  const std::string reason = error.message();
  std::filesystem::remove(temporary, error);
  throw InputError(path.string(), "", "cannot be written: " + reason);
}

// Throws UsageError when `output`, which an option names, is one of the files that a command reads, also by another path or a link.
inline void requireNoInput(const std::string& option, const std::filesystem::path& output, const std::vector<std::filesystem::path>& inputs) {
  std::error_code error;  // of a file that is not there: it is no other's
  for (const std::filesystem::path& input : inputs)
    if (std::filesystem::equivalent(output, input, error))
      throw UsageError(option + " " + output.string() + ": is an input of this command, which would be lost; name another file");
}

// writeWhole() of a text; a full disk is an InputError, too.
inline void writeWholeText(const std::filesystem::path& path, const std::string& text) {
  writeWhole(path, [&](const std::filesystem::path& temporary) {
    std::ofstream file(temporary, std::ios::binary);
    file << text;
    if (!file.flush()) throw InputError(path.string(), "", "cannot be written");
  });
}

}  // namespace pellucid::harness
