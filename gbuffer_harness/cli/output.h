// Names of files on the command line.
#pragma once

#include <filesystem>
#include <string>

#include "common/error.h"
#include "common/parse.h"

namespace pellucid::harness {

// In lower case.
inline std::string extensionOf(const std::filesystem::path& path) { return lower(path.extension().string()); }

// Throws UsageError, naming `option`, for a name with another extension than .exr: EXR would be in a file
// that says it is something else.
inline void requireExr(const std::string& option, const std::filesystem::path& path) {
  const std::string extension = extensionOf(path);
  if (!extension.empty() && extension != ".exr")
    throw UsageError(option + ": \"" + path.string() + "\" is written as EXR and cannot be called " +
                     extension);
}

}  // namespace pellucid::harness
