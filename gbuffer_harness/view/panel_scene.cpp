// Materials and lights.
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "capture/material.h"
#include "common/error.h"
#include "pellucid/pellucid_material.h"
#include "view/panel.h"

namespace pellucid::harness {

namespace {

bool dragReals(const char* label, double* values, int count, double low, double high) {
  const double speed = 0.005 * std::max(std::abs(*std::max_element(values, values + count)), 1e-3);
  const bool changed = ImGui::DragScalarN(label, ImGuiDataType_Double, values, count,
                                          static_cast<float>(speed), &low, &high, "%.4g");
  for (int i = 0; i < count; ++i) values[i] = std::clamp(values[i], low, high);
  return changed;
}

bool drawPreset(MaterialSource& source) {
  const auto* preset = std::get_if<PresetMaterial>(&source);
  bool changed = false;
  if (!ImGui::BeginCombo("preset", preset ? preset->preset.c_str() : "none")) return false;
  for (std::uint32_t i = 0; i < pellucidPresetCount(); ++i) {
    const std::string name = pellucidPresetName(i);
    if (!ImGui::Selectable(name.c_str(), preset && preset->preset == name)) continue;
    source = PresetMaterial{name};
    changed = true;
    break;  // `preset` is gone
  }
  ImGui::EndCombo();
  return changed;
}

// The first change of a preset replaces it by coefficients; layered skin has none.
bool drawCoefficients(MaterialSource& source) {
  CoefficientMaterial material{};
  try {
    material = coefficientsOf(source, "this material");
  } catch (const InputError& error) {
    ImGui::TextWrapped("%s", error.what());
    return false;
  }
  constexpr double kLeast = 1e-6, kMost = 1e4;  // of the compiler's ranges what sliders reach
  bool changed = dragReals("scattering, 1/mm", material.scattering.data(), 3, kLeast, kMost);
  changed |= dragReals("absorption, 1/mm", material.absorption.data(), 3, 0, kMost);
  changed |= dragReals("g", &material.g, 1, -0.99, 0.99);
  changed |= dragReals("index of refraction", &material.ior, 1, 1, 3);
  if (changed) source = material;
  return changed;
}

bool drawBurley(BurleyMaterial& material) {
  return dragReals("Burley's d, mm", material.distance.data(), 3, 1e-4, 1e3);
}

// More through one lobe is less through the other.
bool drawThinWall(ThinWallMaterial& material) {
  const bool reflected = dragReals("reflectance", material.reflectance.data(), 3, 0, 1);
  const bool through = dragReals("transmittance", material.transmittance.data(), 3, 0, 1);
  for (std::size_t c = 0; c < 3; ++c) {
    double& other = reflected ? material.transmittance[c] : material.reflectance[c];
    other = std::min(other, 1 - (reflected ? material.reflectance[c] : material.transmittance[c]));
  }
  return reflected || through;
}

const char* typeName(PellucidLightType type) {
  return type == PELLUCID_LIGHT_DIRECTIONAL ? "directional" : type == PELLUCID_LIGHT_POINT ? "point" : "spot";
}

bool drawCone(Light& light) {
  constexpr double kDegrees = 180 / std::numbers::pi;
  double degrees[2] = {light.innerConeAngle * kDegrees, light.outerConeAngle * kDegrees};
  if (!dragReals("cone, degrees", degrees, 2, 0, 90)) return false;
  light.outerConeAngle = std::max(degrees[1], 0.1) / kDegrees;
  light.innerConeAngle = std::min(degrees[0] / kDegrees, 0.999 * light.outerConeAngle);
  return true;
}

bool drawLight(Light& light, const Source& source) {
  const bool fixed = !source.fixedLights().empty();
  float color[3];
  std::copy(light.color.begin(), light.color.end(), color);
  bool changed = false;
  if (ImGui::ColorEdit3("color", color, ImGuiColorEditFlags_Float | ImGuiColorEditFlags_HDR)) {
    std::transform(color, color + 3, light.color.begin(), [](float c) { return std::max(c, 0.0f); });
    changed = true;
  }
  changed |= dragReals("intensity", &light.intensity, 1, 0, 1e30);
  if (fixed) return changed;
  if (ImGui::BeginCombo("type", typeName(light.type))) {
    for (const PellucidLightType type :
         {PELLUCID_LIGHT_DIRECTIONAL, PELLUCID_LIGHT_POINT, PELLUCID_LIGHT_SPOT})
      if (ImGui::Selectable(typeName(type), type == light.type) && type != light.type) {
        const Light before = light;
        light = newLight(type, source.start().camera, source.center(), source.radius()).light;
        light.color = before.color;
        changed = true;
      }
    ImGui::EndCombo();
  }
  const double reach = 1e6 * source.radius();
  if (light.type != PELLUCID_LIGHT_DIRECTIONAL)
    changed |= dragReals("position", light.position.data(), 3, -reach, reach);
  if (light.type != PELLUCID_LIGHT_POINT) {
    Vector3 direction = light.direction;
    if (dragReals("direction", direction.data(), 3, -1e6, 1e6) &&
        std::hypot(direction[0], direction[1], direction[2]) > 1e-6) {
      light.direction = direction;
      changed = true;
    }
  }
  if (light.type == PELLUCID_LIGHT_SPOT) changed |= drawCone(light);
  return changed;
}

}  // namespace

Changes drawMaterials(ViewState& state) {
  Changes changes;
  if (!ImGui::CollapsingHeader("Material", ImGuiTreeNodeFlags_DefaultOpen) || state.materials.empty())
    return changes;
  ImGui::PushID("material");
  const int last = static_cast<int>(state.materials.size()) - 1;
  if (last > 0) ImGui::SliderInt("index", &state.selectedMaterial, 0, last);
  state.selectedMaterial = std::clamp(state.selectedMaterial, 0, last);
  MaterialSource& source = state.materials[static_cast<std::size_t>(state.selectedMaterial)];
  changes.materials |= drawPreset(source);
  if (auto* burley = std::get_if<BurleyMaterial>(&source))
    changes.materials |= drawBurley(*burley);
  else if (auto* wall = std::get_if<ThinWallMaterial>(&source))
    changes.materials |= drawThinWall(*wall);
  else
    changes.materials |= drawCoefficients(source);
  ImGui::PopID();
  return changes;
}

Changes drawLights(ViewState& state, const Source& source) {
  Changes changes;
  if (!ImGui::CollapsingHeader("Lights", ImGuiTreeNodeFlags_DefaultOpen)) return changes;
  ImGui::PushID("lights");
  const std::string fixed = source.fixedLights();
  if (!fixed.empty()) ImGui::TextWrapped("%s", fixed.c_str());
  for (std::size_t i = 0; i < state.lights.size(); ++i) {
    ImGui::PushID(static_cast<int>(i));
    changes.scene |= ImGui::Checkbox("##on", &state.lights[i].on);
    ImGui::SameLine();
    const std::string name = std::to_string(i) + ": " + typeName(state.lights[i].light.type);
    if (ImGui::RadioButton(name.c_str(), state.selectedLight == static_cast<int>(i)))
      state.selectedLight = static_cast<int>(i);
    ImGui::PopID();
  }
  const auto selected = static_cast<std::size_t>(state.selectedLight);
  if (selected < state.lights.size()) changes.scene |= drawLight(state.lights[selected].light, source);
  if (fixed.empty()) {
    if (ImGui::Button("add")) {
      state.lights.push_back(newLight(PELLUCID_LIGHT_POINT, state.camera, source.center(), source.radius()));
      state.selectedLight = static_cast<int>(state.lights.size()) - 1;
      changes.scene = true;
    }
    ImGui::SameLine();
    if (ImGui::Button("remove") && selected < state.lights.size()) {
      state.lights.erase(state.lights.begin() + static_cast<std::ptrdiff_t>(selected));
      state.selectedLight = std::max(state.selectedLight - 1, 0);
      changes.scene = true;
    }
  }
  ImGui::PopID();
  return changes;
}

}  // namespace pellucid::harness
