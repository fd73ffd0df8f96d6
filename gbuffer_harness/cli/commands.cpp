#include "cli/commands.h"

namespace pellucid::harness {

void addCommands(const Command& app) {
  addInfoCommand(app);
  addInitCommand(app);
  addReplayCommand(app);
  addPlanCommand(app);
  addMaterialCommand(app);
  addTruthCommand(app);
  addCompareCommand(app);
  addFlickerCommand(app);
  addCaptureCommand(app);
  addStressCommand(app);
  addViewCommand(app);
}

}  // namespace pellucid::harness
