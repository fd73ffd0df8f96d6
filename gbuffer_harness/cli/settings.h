// Options that say how a capture is run; shared by replay and plan.
#pragma once

#include <string>
#include <vector>

#include "cli/command.h"
#include "replay/frame.h"

namespace pellucid::harness {

struct SettingsOptions {
  std::vector<std::string> set;  // key=value or @FILE
  std::string debug;
  std::string mode = "physical";
  bool blocks = false;  // --debug takes "blocks", too, which is no view of the module

  bool showsBlocks() const { return blocks && debug == "blocks"; }

  void addTo(const Command& command);

  // Throws UsageError naming the key and the value, and InputError for a file.
  ReplaySettings parse() const;

  // As given, for the record; of files what they hold.
  std::string text() const;

private:
  std::vector<std::string> assignments() const;  // key=value
};

// What --set @FILE reads as these settings of --mode physical: a JSON object. The debug view is no key; its
// option is `debugOption`, or "".
std::string settingsJson(const ReplaySettings& settings);
std::string debugOption(const ReplaySettings& settings);

// Replaces the samples by those of the module's plan for the capture, which has none where it does not
// gather, for what is not the module. `materials`: with their own T(d). Throws InputError where the module
// refuses the frame.
void resolveGather(ReplaySettings& settings, const Capture& capture,
                   const std::vector<PellucidMaterial>& materials);

}  // namespace pellucid::harness
