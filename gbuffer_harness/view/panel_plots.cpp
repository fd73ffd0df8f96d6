// Curves of the material, and what the dispatches cost.
#include <imgui.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <numbers>
#include <optional>
#include <vector>

#include "common/translucency_settings.h"
#include "pellucid/pellucid.h"
#include "pellucid/pellucid_material.h"
#include "reference/profile.h"
#include "reference/translucency.h"
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

// The angle model's values for 0..90 degrees beyond the right angle between the directions to the eye and to
// the light. Models with tables and -N.L have no one curve: no values.
Curves angleCurve(const TranslucencySettings& settings, int points) {
  Curves curves;
  curves.end = 90;
  const PellucidAngleModel model = settings.angleModel;
  if (model == PELLUCID_ANGLE_NORMAL || model > PELLUCID_ANGLE_MINIMUM_DOT) return curves;
  for (int i = 0; i < points; ++i) {
    const double x = std::sin(std::numbers::pi / 2 * i / (points - 1));
    curves.values[0].push_back(reference::angleFactor(settings, x, double(settings.minimumDot)));
  }
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
// Paul Tol's bright scheme: told apart by people who see red and green alike, too.
constexpr ImU32 kDispatches[] = {IM_COL32(68, 119, 170, 255),  IM_COL32(238, 102, 119, 255),
                                 IM_COL32(34, 136, 51, 255),   IM_COL32(204, 187, 68, 255),
                                 IM_COL32(102, 204, 238, 255), IM_COL32(170, 51, 119, 255),
                                 IM_COL32(187, 187, 187, 255)};

// An empty frame of the panel's width; returns its corners.
struct PlotFrame {
  ImVec2 low, high;
};
PlotFrame plotFrame(float height) {
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float width = ImGui::GetContentRegionAvail().x;
  ImGui::Dummy({width, height});
  const PlotFrame frame{at, {at.x + width, at.y + height}};
  ImGui::GetWindowDrawList()->AddRectFilled(frame.low, frame.high, IM_COL32(20, 20, 20, 255));
  return frame;
}

void plot(const char* title, const char* unit, const Curves& curves) {
  double most = 0;
  for (const std::vector<double>& channel : curves.values)
    for (const double value : channel) most = std::max(most, value);
  ImGui::Text("%s, 0 .. %.3g, over 0 .. %.3g %s", title, most, curves.end, unit);
  const PlotFrame frame = plotFrame(kPlotHeight);
  for (std::size_t c = 0; c < 3; ++c) {
    std::vector<ImVec2> line;
    const std::vector<double>& values = curves.values[c];
    for (std::size_t i = 0; i < values.size(); ++i)
      line.push_back({frame.low.x + (frame.high.x - frame.low.x) * static_cast<float>(i) /
                                        static_cast<float>(values.size() - 1),
                      frame.high.y - (frame.high.y - frame.low.y) *
                                         static_cast<float>(most > 0 ? values[i] / most : 0)});
    ImGui::GetWindowDrawList()->AddPolyline(line.data(), static_cast<int>(line.size()), kChannels[c], 0,
                                            1.5f);
  }
}

// The newest frame at the right; a dispatch's time lies on those before it.
void plotStack(const CostHistory& cost, double budget) {
  const PlotFrame frame = plotFrame(kPlotHeight);
  ImDrawList* const list = ImGui::GetWindowDrawList();
  double most = budget;
  for (std::size_t i = 0; i < cost.size(); ++i) {
    double sum = 0;
    for (const CostHistory::Dispatch& d : cost.dispatches()) sum += d.history[i];
    most = std::max(most, 1.1 * sum);
  }
  if (!(most > 0)) return;
  const float step = (frame.high.x - frame.low.x) / static_cast<float>(CostHistory::kFrames);
  const auto y = [&](double value) {
    return frame.high.y - (frame.high.y - frame.low.y) * static_cast<float>(value / most);
  };
  for (std::size_t i = 0; i < cost.size(); ++i) {
    const float right = frame.high.x - step * static_cast<float>(cost.size() - 1 - i);
    double sum = 0;
    for (std::size_t k = 0; k < cost.dispatches().size(); ++k) {
      const double next = sum + cost.dispatches()[k].history[i];
      list->AddRectFilled({right - step, y(next)}, {right, y(sum)}, kDispatches[k % std::size(kDispatches)]);
      sum = next;
    }
  }
  if (budget > 0)
    list->AddLine({frame.low.x, y(budget)}, {frame.high.x, y(budget)}, IM_COL32(255, 255, 255, 200));
  char top[32];
  std::snprintf(top, sizeof top, "%.3g ms", most / 1000);
  list->AddText({frame.low.x + 3, frame.low.y + 1}, IM_COL32(255, 255, 255, 200), top);
}

}  // namespace

void drawCurves(const ViewState& state, const ViewFrames& frames) {
  const auto selected = static_cast<std::size_t>(state.selectedMaterial);
  if (selected >= frames.materials().size()) return;
  const std::vector<PellucidMaterial> used =
      withTransmittance({frames.materials()[selected]}, state.settings.transmittance);
  plot("T(d)", "mm", transmittanceCurves(used.front(), kPoints));
  plot("2 pi r R(r), 1/mm", "mm", profileCurves(used.front(), kPoints));
  const Curves angle = angleCurve(state.settings.translucency, kPoints);
  if (!angle.values[0].empty()) plot("angle model", "degrees beyond 90", angle);
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
  plotStack(panel.cost, panel.budget.on ? 1000 * static_cast<double>(panel.budget.milliseconds) : 0);
  for (std::size_t k = 0; k < panel.cost.dispatches().size(); ++k) {
    const CostHistory::Dispatch& dispatch = panel.cost.dispatches()[k];
    ImGui::TextColored(ImGui::ColorConvertU32ToFloat4(kDispatches[k % std::size(kDispatches)]),
                       "%8.1f us  %s", dispatch.smoothed, dispatch.name.c_str());
  }
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
