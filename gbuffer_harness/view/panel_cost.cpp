// Curves of the material, and what the dispatches cost.
#include <imgui.h>
#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "pellucid/pellucid.h"
#include "pellucid/pellucid_material.h"
#include "reference/profile.h"
#include "view/panel.h"

namespace pellucid::harness {

namespace {

struct Curves {
  double end = 1;                             // x runs from 0 to here, evenly, both ends included
  std::array<std::vector<double>, 3> values;  // R G B
};

constexpr double kDarkest = 0.01, kThinnest = 0.1, kThickest = 100, kTail = 0.05;

double brightest(const PellucidMaterial& material, double thickness) {
  double most = 0;
  for (std::uint32_t c = 0; c < 3; ++c)
    most = std::max(most, pellucidEvaluateTransmittance(&material, c, thickness));
  return most;
}

// T(d), d in mm, as far as some channel lets 1 % through, 0.1 to 100 mm. points: >= 2.
Curves transmittanceCurves(const PellucidMaterial& material, int points) {
  Curves curves;
  curves.end = kThinnest;
  while (curves.end < kThickest && brightest(material, curves.end) > kDarkest) curves.end *= 1.1;
  for (std::uint32_t c = 0; c < 3; ++c)
    for (int i = 0; i < points; ++i)
      curves.values[c].push_back(pellucidEvaluateTransmittance(&material, c, curves.end * i / (points - 1)));
  return curves;
}

// 2 pi r R(r), 1/mm, r in mm to the largest radius within which a channel has 95 % of its energy; no channel
// of a material that does not diffuse has values.
Curves profileCurves(const PellucidMaterial& material, int points) {
  Curves curves;
  std::array<std::optional<reference::Profile>, 3> profiles;
  double end = 0;
  for (int c = 0; c < 3; ++c) {
    std::optional<reference::Profile>& profile = profiles[static_cast<std::size_t>(c)];
    profile = reference::channelProfile(material, c);
    if (profile) end = std::max(end, reference::radiusOfTail(*profile, kTail));
  }
  if (end > 0) curves.end = end;
  for (std::size_t c = 0; c < 3; ++c)
    for (int i = 0; profiles[c] && i < points; ++i)
      curves.values[c].push_back(reference::ringDensity(*profiles[c], curves.end * i / (points - 1)));
  return curves;
}

constexpr int kPoints = 120;
constexpr float kPlotHeight = 90;
constexpr ImU32 kChannels[] = {IM_COL32(255, 90, 80, 255), IM_COL32(90, 220, 90, 255),
                               IM_COL32(110, 150, 255, 255)};
void plot(const char* title, const char* unit, const Curves& curves) {
  double most = 0;
  for (const std::vector<double>& channel : curves.values)
    for (const double value : channel) most = std::max(most, value);
  ImGui::Text("%s, 0 .. %.3g, over 0 .. %.3g %s", title, most, curves.end, unit);
  const ImVec2 low = ImGui::GetCursorScreenPos();
  const ImVec2 high = {low.x + ImGui::GetContentRegionAvail().x, low.y + kPlotHeight};
  ImGui::Dummy({high.x - low.x, kPlotHeight});
  ImGui::GetWindowDrawList()->AddRectFilled(low, high, IM_COL32(20, 20, 20, 255));
  for (std::size_t c = 0; c < 3; ++c) {
    std::vector<ImVec2> line;
    const std::vector<double>& values = curves.values[c];
    for (std::size_t i = 0; i < values.size(); ++i)
      line.push_back(
          {low.x + (high.x - low.x) * static_cast<float>(i) / static_cast<float>(values.size() - 1),
           high.y - (high.y - low.y) * static_cast<float>(most > 0 ? values[i] / most : 0)});
    ImGui::GetWindowDrawList()->AddPolyline(line.data(), static_cast<int>(line.size()), kChannels[c], 0,
                                            1.5f);
  }
}

}  // namespace

void drawCurves(const ViewState& state, const ViewFrames& frames) {
  const auto selected = static_cast<std::size_t>(state.selectedMaterial);
  if (selected >= frames.materials().size()) return;
  const std::vector<PellucidMaterial> used =
      withTransmittance({frames.materials()[selected]}, state.settings.transmittance);
  plot("T(d)", "mm", transmittanceCurves(used.front(), kPoints));
  plot("2 pi r R(r), 1/mm", "mm", profileCurves(used.front(), kPoints));
}

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
