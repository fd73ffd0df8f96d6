// Options that commands share: how a capture is read and run, and how results are written.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "capture/manifest.h"
#include "cli/command.h"
#include "replay/frame.h"

namespace pellucid::harness {

struct SettingsOptions {
  std::vector<std::string> set;  // key=value or @FILE
  std::string debug;
  std::string mode = "physical";

  void addTo(const Command& command);

  // Throws UsageError naming the key and the value, and InputError for a file.
  ReplaySettings parse() const;

  // As given, for the record; of files what they hold.
  std::string text() const;

private:
  std::vector<std::string> assignments() const;  // key=value
};

// The JSON object from which --set @FILE reads these settings in --mode physical. The debug view has no key;
// debugOption() gives the value of its option, or "".
std::string settingsJson(const ReplaySettings& settings);
std::string debugOption(const ReplaySettings& settings);

// True of names that captures have: .exr and .json, and not those of models.
bool isCaptureFile(const std::filesystem::path& path);

// Throws UsageError, naming `option`, for a name with another extension than .exr: EXR would be in a file
// that says it is something else.
void requireExr(const std::string& option, const std::filesystem::path& path);

}  // namespace pellucid::harness
