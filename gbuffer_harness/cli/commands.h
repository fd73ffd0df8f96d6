// The subcommands of `pellucid`, one file each. A callback throws a harness error for main() to turn
// into an exit code.
#pragma once

#include "cli/command.h"

namespace pellucid::harness {

void addCommands(const Command& app);  // all that the program has, in the help's order

void addInfoCommand(const Command& app);
void addInitCommand(const Command& app);
void addReplayCommand(const Command& app);
void addPlanCommand(const Command& app);
void addMaterialCommand(const Command& app);
void addCompareCommand(const Command& app);
void addTruthCommand(const Command& app);
void addFlickerCommand(const Command& app);
void addCaptureCommand(const Command& app);
void addStressCommand(const Command& app);
void addViewCommand(const Command& app);

}  // namespace pellucid::harness
