// `pellucid plan`: the dispatch plan of a capture, without a device.
#include <cstdio>

#include "capture/material.h"
#include "capture/read.h"
#include "cli/commands.h"
#include "cli/plan_json.h"
#include "cli/settings.h"

namespace pellucid::harness {

void addPlanCommand(const Command& app) {
  struct Options {
    std::string input;
    SettingsOptions settings;
  };
  auto options = std::make_shared<Options>();
  const Command command =
      app.subcommand("plan", "Print the dispatch plan of a capture as JSON; needs no device");
  command.option("capture", options->input, "manifest (.json) or EXR with an embedded one").required();
  options->settings.addTo(command);
  command.run([options] {
    const Capture capture = readCapture(options->input);
    FrameData data;
    const std::vector<PellucidMaterial> materials = compileMaterials(capture);
    const ReplaySettings settings = options->settings.parse();
    makeFrame(capture, materials, settings, data);
    PellucidPlan plan;
    requireOk(pellucidBuildPlan(&data.frame, nullptr, &plan), data.frame, capture.name);
    std::printf("%s\n", planJson(plan, 2).c_str());
  });
}

}  // namespace pellucid::harness
