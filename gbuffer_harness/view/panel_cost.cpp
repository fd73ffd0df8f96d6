// GPU times of the dispatches, and the budget that holds a frame time.
#include <imgui.h>
#include <cstdint>

#include "pellucid/pellucid.h"
#include "view/panel.h"

namespace pellucid::harness {

Changes drawCost(ViewState& state, PanelState& panel, const ViewFrames& frames) {
  Changes changes;
  const bool isNew = panel.cost.add(frames.recorded(), frames.times());
  if (!ImGui::CollapsingHeader("GPU time", ImGuiTreeNodeFlags_DefaultOpen)) return changes;
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
  ImGui::Checkbox("hold a frame time", &panel.budget.on);
  if (panel.budget.on) {
    ImGui::SameLine();
    ImGui::PushItemWidth(100);
    ImGui::DragFloat("ms", &panel.budget.milliseconds, 0.01f, 0.01f, 1000, "%.2f");
    ImGui::PopItemWidth();
    panel.measure = true;
    if (isNew) changes.frame |= panel.budget.step(panel.cost.lastSum() / 1000, state.settings);
  }
  return changes;
}

}  // namespace pellucid::harness
