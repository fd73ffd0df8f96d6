// Materials: presets, and the values of each description.
#include <imgui.h>

#include <algorithm>

#include "capture/material.h"
#include "common/error.h"
#include "pellucid/pellucid_material.h"
#include "view/panel.h"

namespace pellucid::harness {

namespace {

constexpr double kLeast = 1e-6, kMost = 1e4;  // of the compiler's ranges what sliders reach

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

struct DrawValues {
  bool operator()(PresetMaterial&) const { return false; }
  bool operator()(CoefficientMaterial& material) const {
    bool changed = dragReals("scattering, 1/mm", material.scattering.data(), 3, kLeast, kMost);
    changed |= dragReals("absorption, 1/mm", material.absorption.data(), 3, 0, kMost);
    changed |= dragReals("g", &material.g, 1, -0.99, 0.99);
    changed |= dragReals("index of refraction", &material.ior, 1, 1, 3);
    return changed;
  }
  bool operator()(OpenPbrMaterial& material) const {
    float color[3];
    std::copy(material.color.begin(), material.color.end(), color);
    bool changed = ImGui::ColorEdit3("color", color, ImGuiColorEditFlags_Float);
    if (changed)
      std::transform(color, color + 3, material.color.begin(),
                     [](float value) { return std::clamp<double>(value, 0, 1); });
    changed |= dragReals("radius, mm", &material.radius, 1, kLeast, kMost);
    changed |= dragReals("radius scale", material.radiusScale.data(), 3, kLeast, kMost);
    changed |= dragReals("anisotropy", &material.anisotropy, 1, -0.99, 0.99);
    changed |= dragReals("specular ior", &material.ior, 1, 1, 3);
    return changed;
  }
  bool operator()(SkinMaterial& material) const {
    bool changed = dragReals("melanin", &material.melanin, 1, 0, 1);
    changed |= dragReals("share of eumelanin", &material.melaninType, 1, 0, 1);
    changed |= dragReals("hemoglobin", &material.hemoglobin, 1, 0, 1);
    changed |= dragReals("index of refraction", &material.ior, 1, 1, 3);
    return changed;
  }
  bool operator()(BurleyMaterial& material) const {
    return dragReals("Burley's d, mm", material.distance.data(), 3, 1e-4, 1e3);
  }
  // More through one lobe is less through the other.
  bool operator()(ThinWallMaterial& material) const {
    const bool reflected = dragReals("reflectance", material.reflectance.data(), 3, 0, 1);
    const bool through = dragReals("transmittance", material.transmittance.data(), 3, 0, 1);
    for (std::size_t c = 0; c < 3; ++c) {
      double& other = reflected ? material.transmittance[c] : material.reflectance[c];
      other = std::min(other, 1 - (reflected ? material.reflectance[c] : material.transmittance[c]));
    }
    return reflected || through;
  }
  bool operator()(GaussianMaterial&) const {
    ImGui::TextWrapped("a sum of Gaussians, which the panel does not change");
    return false;
  }
};

// The first change of a preset replaces it by coefficients; layered skin has none.
bool drawValues(MaterialSource& source) {
  if (!std::holds_alternative<PresetMaterial>(source)) return std::visit(DrawValues{}, source);
  try {
    MaterialSource values = coefficientsOf(source, "this material");
    if (!std::visit(DrawValues{}, values)) return false;
    source = values;
    return true;
  } catch (const InputError& error) {
    ImGui::TextWrapped("%s", error.what());
    return false;
  }
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
  changes.materials |= drawValues(source);
  ImGui::PopID();
  return changes;
}

}  // namespace pellucid::harness
