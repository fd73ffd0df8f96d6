#include "view/panel.h"

#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "common/compare.h"
#include "replay/settings.h"

namespace pellucid::harness {

namespace {

constexpr ImU32 kWhite = IM_COL32(255, 255, 255, 255), kShade = IM_COL32(0, 0, 0, 160);

void hint(const std::string& text) {
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", text.c_str());
}

bool combo(const char* label, int& index, const std::vector<std::string>& names) {
  return ImGui::Combo(
      label, &index,
      [](void* data, int i, const char** text) {
        *text = (*static_cast<const std::vector<std::string>*>(data))[static_cast<std::size_t>(i)].c_str();
        return true;
      },
      const_cast<std::vector<std::string>*>(&names), static_cast<int>(names.size()));
}

bool shownCombo(const char* label, Shown& shown) {
  int index = static_cast<int>(shown);
  const bool changed = combo(label, index, shownNames());
  shown = static_cast<Shown>(index);
  return changed;
}

bool drawSetting(const Setting& setting, ReplaySettings& settings) {
  Setting::Values values = setting.get(settings);
  const char* const label = setting.label.c_str();
  const bool isFlag = setting.names == std::vector<std::string>{"0", "1"};
  bool changed = false;
  if (setting.kind == Setting::Kind::Bits) {
    auto bits = static_cast<unsigned>(values[0]);
    for (std::size_t i = 0; i < setting.names.size(); ++i)
      changed |= ImGui::CheckboxFlags(setting.names[i].c_str(), &bits, 1u << i);
    values[0] = bits;
  } else if (isFlag) {
    bool on = values[0] != 0;
    changed = ImGui::Checkbox(label, &on);
    values[0] = on;
  } else if (setting.kind == Setting::Kind::Choice) {
    int index = static_cast<int>(values[0]);
    const auto offered = setting.names.begin() + static_cast<std::ptrdiff_t>(setting.high) + 1;
    changed = combo(label, index, {setting.names.begin(), offered});
    values[0] = index;
  } else if (setting.kind == Setting::Kind::Whole) {
    int whole = static_cast<int>(values[0]);
    changed = ImGui::SliderInt(label, &whole, static_cast<int>(setting.low), static_cast<int>(setting.high));
    values[0] = whole;
  } else {
    changed = ImGui::SliderScalarN(label, ImGuiDataType_Double, values.data(),
                                   static_cast<int>(values.size()), &setting.low, &setting.high, "%.3g");
  }
  hint("--set " + syntaxOf(setting));
  if (changed) assignNearest(setting, settings, values);
  return changed;
}

bool drawSettings(ReplaySettings& settings) {
  bool changed = false, open = false;
  std::string group;
  for (const Setting& setting : settingsTable()) {
    if (setting.label.empty()) continue;
    if (setting.group != group) {
      open =
          ImGui::CollapsingHeader(setting.group.c_str(), group.empty() ? ImGuiTreeNodeFlags_DefaultOpen : 0);
      group = setting.group;
    }
    if (!open) continue;
    const bool hasEffect = !setting.hasEffect || setting.hasEffect(settings);
    if (!hasEffect) ImGui::BeginDisabled();
    changed |= drawSetting(setting, settings);
    if (!hasEffect) ImGui::EndDisabled();
  }
  return changed;
}

Changes drawDisplay(ViewState& state, const PanelState& panel, const ViewFrames& frames) {
  Changes changes;
  if (!ImGui::CollapsingHeader("Picture", ImGuiTreeNodeFlags_DefaultOpen)) return changes;
  Display& display = state.display;
  changes.shown |= shownCombo("show", display.shown);
  if (display.shown == Shown::Debug || (display.split && display.left == Shown::Debug)) {
    int view = std::max(static_cast<int>(state.settings.debugView) - 1, 0);
    const std::vector<std::string> names = {"thickness, mm", "transmittance", "occlusion", "irradiance"};
    changes.frame |= combo("debug view", view, names);
    state.settings.debugView = static_cast<PellucidDebugView>(view + 1);
  }
  changes.shown |= ImGui::Checkbox("split", &display.split);
  if (display.split) {
    ImGui::SameLine();
    changes.shown |= shownCombo("left", display.left);
  }
  if (isFalseColor(display.shown) || (display.split && isFalseColor(display.left))) {
    changes.shown |= combo("channel", display.channel, {"R", "G", "B"});
    float ends[2] = {panel.colors.low, panel.colors.high};
    if (ImGui::DragFloat2("false colors", ends,
                          0.01f * std::max(std::abs(panel.colors.high - panel.colors.low), 1e-3f))) {
      display.falseLow = ends[0];
      display.falseHigh = ends[1];
      changes.shown = true;
    }
    if (ImGui::Button("ends of the picture")) {
      display.falseLow = display.falseHigh = 0;
      changes.shown = true;
    }
  }
  changes.shown |=
      ImGui::SliderFloat("exposure", &display.exposure, 0.01f, 100, "%.3g", ImGuiSliderFlags_Logarithmic);
  const Capture& capture = frames.outline();  // whole, as those of all truths are
  if (!capture.truth) return changes;
  const Comparison error = compareImages(frames.image(Shown::After), capture.truth->image, capture.material);
  ImGui::Text("relative RMSE from the truth: %.4f %.4f %.4f", error.channels[0].relativeRmse,
              error.channels[1].relativeRmse, error.channels[2].relativeRmse);
  return changes;
}

Changes drawCamera(ViewState& state, PanelState& panel, const Source& source) {
  Changes changes;
  if (!ImGui::CollapsingHeader("Camera")) return changes;
  if (const std::string fixed = source.fixedCamera(); !fixed.empty()) {
    ImGui::TextWrapped("%s", fixed.c_str());
    return changes;
  }
  ModelCamera& lens = state.camera.lens;
  if (!lens.orthographic) {
    constexpr double kDegrees = 180 / std::numbers::pi;
    float degrees = static_cast<float>(lens.verticalFov * kDegrees);
    if (ImGui::SliderFloat("field of view", &degrees, 1, 120, "%.1f deg")) {
      lens.verticalFov = static_cast<double>(degrees) / kDegrees;
      changes.scene = true;
    }
  }
  if (ImGui::Button("as it was")) {
    state.camera = source.start().camera;
    changes.scene = true;
  }
  ImGui::SameLine();
  ImGui::Checkbox("size of the window", &panel.followWindow);
  int size[2] = {state.width, state.height};
  if (!panel.followWindow && ImGui::InputInt2("size", size, ImGuiInputTextFlags_EnterReturnsTrue)) {
    state.width = std::clamp(size[0], 1, kLargestSide);
    state.height = std::clamp(size[1], 1, kLargestSide);
    changes.scene = true;
  }
  ImGui::TextDisabled(
      "drag: orbit; right: look; middle: pan; wheel: zoom\nw a s d e q: walk; shift + drag: light");
  return changes;
}

// GPU times of the last frame.
void drawCost(const ViewFrames& frames) {
  if (!ImGui::CollapsingHeader("GPU time", ImGuiTreeNodeFlags_DefaultOpen)) return;
  const auto milliseconds = [](const std::vector<DispatchTime>& times) {
    double sum = 0;
    for (const DispatchTime& time : times) sum += time.microseconds / 1000;
    return sum;
  };
  const PellucidPlan& plan = frames.run(Shown::After).plan();
  ImGui::Text("%.3f ms in %u dispatches; material covers %.1f %%", milliseconds(frames.times()),
              plan.dispatchCount, 100 * frames.coveredPart());
  if (!frames.sceneTimes().empty()) ImGui::Text("rasterizer: %.3f ms", milliseconds(frames.sceneTimes()));
  for (const DispatchTime& time : frames.times())
    ImGui::Text("%8.1f us  %s", time.microseconds, time.name.c_str());
  for (std::uint32_t i = 0; i < plan.skipCount; ++i)
    ImGui::TextWrapped("skipped: %u x %s (%s)", plan.skips[i].count, plan.skips[i].what,
                       plan.skips[i].reason);
}

}  // namespace

bool dragReals(const char* label, double* values, int count, double low, double high) {
  const double speed = 0.005 * std::max(std::abs(*std::max_element(values, values + count)), 1e-3);
  const bool changed = ImGui::DragScalarN(label, ImGuiDataType_Double, values, count,
                                          static_cast<float>(speed), &low, &high, "%.4g");
  for (int i = 0; i < count; ++i) values[i] = std::clamp(values[i], low, high);
  return changed;
}

Changes drawPanel(ViewState& state, PanelState& panel, const ViewFrames& frames, const Source& source,
                  const ScreenRect& screen) {
  ImGui::SetNextWindowPos({screen.width - kPanelWidth, 0});
  ImGui::SetNextWindowSize({kPanelWidth, screen.height});
  ImGui::Begin("Pellucid", nullptr,
               ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoCollapse |
                   ImGuiWindowFlags_NoTitleBar);
  ImGui::PushItemWidth(200);
  Changes changes;
  if (!panel.message.empty()) {
    ImGui::PushStyleColor(ImGuiCol_Text,
                          panel.isError ? ImVec4(1, 0.45f, 0.4f, 1) : ImVec4(0.6f, 0.9f, 0.6f, 1));
    ImGui::TextWrapped("%s", panel.message.c_str());
    ImGui::PopStyleColor();
  }
  changes.add(drawDisplay(state, panel, frames));
  changes.frame |= drawSettings(state.settings);
  changes.add(drawMaterials(state));
  changes.add(drawLights(state, source));
  changes.add(drawCamera(state, panel, source));
  drawCost(frames);
  if (ImGui::CollapsingHeader("Save")) {
    ImGui::InputText("capture", panel.savePath, sizeof panel.savePath);
    if (ImGui::Button("save capture, settings, result and picture")) panel.save = true;
  }
  for (const std::string& warning : frames.warnings()) ImGui::TextWrapped("warning: %s", warning.c_str());
  ImGui::PopItemWidth();
  ImGui::End();
  return changes;
}

void drawOverlay(const ViewState& state, const PanelState& panel, const ViewFrames& frames,
                 const ScreenRect& picture, float cursorX, float cursorY) {
  ImDrawList* const list = ImGui::GetBackgroundDrawList();
  const auto text = [&](float x, float y, const std::string& words) {
    const ImVec2 size = ImGui::CalcTextSize(words.c_str());
    list->AddRectFilled({x - 4, y - 2}, {x + size.x + 4, y + size.y + 2}, kShade);
    list->AddText({x, y}, kWhite, words.c_str());
  };
  const auto name = [](Shown shown) { return shownNames()[static_cast<std::size_t>(shown)]; };
  const Display& display = state.display;
  const float split = picture.x + display.splitAt * picture.width, top = picture.y + 8;
  if (display.split) {
    list->AddLine({split, picture.y}, {split, picture.y + picture.height}, kWhite, 2);
    text(picture.x + 8, top, name(display.left));
  }
  text((display.split ? split : picture.x) + 8, top, name(display.shown));
  const ScreenRect legend = legendOf(display, picture);
  if (legend.width > 0) {
    char ends[2][32];
    std::snprintf(ends[0], sizeof ends[0], "%.4g", static_cast<double>(panel.colors.high));
    std::snprintf(ends[1], sizeof ends[1], "%.4g", static_cast<double>(panel.colors.low));
    list->AddRect({legend.x - 1, legend.y - 1}, {legend.x + legend.width + 1, legend.y + legend.height + 1},
                  kWhite);
    text(legend.x, legend.y - 20, ends[0]);
    text(legend.x, legend.y + legend.height + 6, ends[1]);
  }
  const Capture& capture = frames.outline();
  const auto texel = texelAt(picture, capture.width, capture.height, cursorX, cursorY);
  if (!texel) return;
  const Shown shown = display.split && cursorX < split ? display.left : display.shown;
  std::string words = name(shown) + " at " + std::to_string(texel->x) + ", " + std::to_string(texel->y) + ":";
  for (const float value : frames.value(shown, texel->x, texel->y)) {
    char number[32];
    std::snprintf(number, sizeof number, " %.4g", static_cast<double>(value));
    words += number;
  }
  text(picture.x + 8, picture.y + picture.height - 22, words);
}

}  // namespace pellucid::harness
