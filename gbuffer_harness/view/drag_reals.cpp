#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "view/panel.h"

namespace pellucid::harness {

bool dragReals(const char* label, double* values, int count, double low, double high) {
  const double speed = 0.005 * std::max(std::abs(*std::max_element(values, values + count)), 1e-3);
  const bool changed = ImGui::DragScalarN(label, ImGuiDataType_Double, values, count,
                                          static_cast<float>(speed), &low, &high, "%.4g");
  for (int i = 0; i < count; ++i) values[i] = std::clamp(values[i], low, high);
  return changed;
}

}  // namespace pellucid::harness
