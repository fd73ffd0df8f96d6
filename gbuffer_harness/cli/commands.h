// The subcommands of `pellucid`, one file each. A callback throws a harness error for main() to turn
// into an exit code.
#pragma once

namespace CLI {
class App;
}

namespace pellucid::harness {

void addCommands(CLI::App& app);  // all of them, in the help's order

void addAnglesCommand(CLI::App& app);
void addInfoCommand(CLI::App& app);
void addInitCommand(CLI::App& app);
void addReplayCommand(CLI::App& app);
void addPlanCommand(CLI::App& app);
void addMaterialCommand(CLI::App& app);
void addReferenceCommand(CLI::App& app);
void addCompareCommand(CLI::App& app);
void addTruthCommand(CLI::App& app);
void addEvaluateCommand(CLI::App& app);
void addFlickerCommand(CLI::App& app);
void addCaptureCommand(CLI::App& app);
void addSheetCommand(CLI::App& app);
void addMeasureDotsCommand(CLI::App& app);
void addStressCommand(CLI::App& app);
void addViewCommand(CLI::App& app);
void addPerceptionCommand(CLI::App& app);
void addShadersCommand(CLI::App& app);

}  // namespace pellucid::harness
