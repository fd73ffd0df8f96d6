// GPU times of the dispatches.
#include <imgui.h>
#include <cstdint>

#include "pellucid/pellucid.h"
#include "view/panel.h"

namespace pellucid::harness {

void drawCost(PanelState& panel, const ViewFrames& frames) {
  panel.cost.add(frames.recorded(), frames.times());
  if (!ImGui::CollapsingHeader("GPU time", ImGuiTreeNodeFlags_DefaultOpen)) return;
  const PellucidPlan& plan = frames.run(Shown::After).plan();
  ImGui::Text("%.3f ms in %u dispatches; material covers %.1f %%", panel.cost.smoothedSum() / 1000,
              plan.dispatchCount, 100 * frames.coveredPart());
  ImGui::Text("scene: %.2f ms on the CPU's clock", frames.sceneMilliseconds());
  if (!frames.sceneTimes().empty())
    ImGui::Text("of it, rasterizer: %.3f ms by the GPU's", sumOf(frames.sceneTimes()) / 1000);
  for (const CostHistory::Dispatch& dispatch : panel.cost.dispatches())
    ImGui::Text("%8.1f us  %s", dispatch.smoothed, dispatch.name.c_str());
  for (std::uint32_t i = 0; i < plan.skipCount; ++i)
    ImGui::TextWrapped("skipped: %u x %s (%s)", plan.skips[i].count, plan.skips[i].what,
                       plan.skips[i].reason);
  ImGui::Checkbox("record without end", &panel.measure);
}

}  // namespace pellucid::harness
