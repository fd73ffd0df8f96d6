// The commands of `./run demo`, whose program compiles in a third of the time.
#include "cli/commands.h"

namespace pellucid::harness {

void addCommands(const Command& app) {
  addReplayCommand(app);
  addCaptureCommand(app);
}

}  // namespace pellucid::harness
