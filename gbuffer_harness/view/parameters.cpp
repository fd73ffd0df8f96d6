#include "view/parameters.h"

#include <algorithm>
#include <cmath>

namespace pellucid::harness {

namespace {

using Values = Parameter::Values;

template <class T>
Values values(const T& value) {
  return {static_cast<float>(value), 0, 0, 0};
}
template <std::size_t N>
Values values(const std::array<float, N>& value) {
  Values result{};
  std::copy(value.begin(), value.end(), result.begin());
  return result;
}

template <class T>
void store(T& field, const Values& from) {
  field = static_cast<T>(from[0]);
}
template <std::size_t N>
void store(std::array<float, N>& field, const Values& from) {
  std::copy_n(from.begin(), N, field.begin());
}

// `field`: a reference to the member of any ReplaySettings, const or not.
template <class Access>
Parameter bound(Parameter parameter, const Access& field) {
  parameter.get = [field](const ReplaySettings& settings) { return values(field(settings)); };
  parameter.set = [field](ReplaySettings& settings, const Values& to) { store(field(settings), to); };
  return parameter;
}

#define FIELD(member) \
  [](auto& settings) -> auto& { return settings.member; }

Parameter choice(const char* key, const char* label, const char* help, std::vector<std::string> choices) {
  Parameter parameter{key, label, help, ParameterKind::Choice};
  parameter.high = static_cast<float>(choices.size() - 1);
  parameter.choices = std::move(choices);
  return parameter;
}
Parameter flag(const char* key, const char* label, const char* help) {
  return {key, label, help, ParameterKind::Flag};
}
Parameter whole(const char* key, const char* label, const char* help, float low, float high) {
  return {key, label, help, ParameterKind::Whole, 1, low, high};
}
Parameter real(const char* key, const char* label, const char* help, float low, float high,
               int components = 1) {
  return {key, label, help, ParameterKind::Real, components, low, high};
}

Parameter usedWhere(Parameter parameter, std::function<bool(const ReplaySettings&)> used) {
  parameter.used = std::move(used);
  return parameter;
}

bool hasTranslucency(const ReplaySettings& s) { return s.features & PELLUCID_FEATURE_TRANSLUCENCY; }
// Other settings of the frame may still keep light from being gathered; the plan's skips say so.
bool gathers(const ReplaySettings& s) {
  return hasTranslucency(s) && s.features & PELLUCID_FEATURE_DIFFUSION && !s.translucency.cameraThickness;
}
bool angleIs(const ReplaySettings& s, PellucidAngleModel model) { return s.translucency.angleModel == model; }

Parameter feature(const char* label, const char* help, std::uint32_t bit) {
  Parameter parameter = flag("features", label, help);
  parameter.get = [bit](const ReplaySettings& s) { return values((s.features & bit) != 0); };
  parameter.set = [bit](ReplaySettings& s, const Values& to) {
    s.features = to[0] != 0 ? s.features | bit : s.features & ~bit;
  };
  return parameter;
}

// A choice between numbers; the first stands for any number that is not offered.
template <class Access>
Parameter numbered(Parameter parameter, const Access& field, std::vector<std::uint32_t> numbers) {
  parameter.get = [field, numbers](const ReplaySettings& s) {
    const auto found = std::find(numbers.begin(), numbers.end(), field(s));
    return values(found == numbers.end() ? 0 : found - numbers.begin());
  };
  parameter.set = [field, numbers](ReplaySettings& s, const Values& to) {
    field(s) = numbers[static_cast<std::size_t>(to[0])];
  };
  return parameter;
}

Parameter gatherSamples() {
  Parameter parameter =
      whole("gather", "samples", "Of the shadow map, for each probe of the gather; 0: one thickness a pixel.",
            0, 64);
  parameter.step = 4;
  return bound(parameter, FIELD(translucency.gatherSamples));
}

Parameter gatherSpacing() {
  return numbered(choice("gather-spacing", "probe spacing", "Pixels a side that one probe stands for.",
                         {"by size", "1", "2", "4"}),
                  FIELD(translucency.gatherSpacing), {0, 1, 2, 4});
}

ParameterGroup quality() {
  return {"Quality",
          true,
          {usedWhere(gatherSamples(), gathers), usedWhere(gatherSpacing(), gathers),
           feature("translucency", "Light that comes through.", PELLUCID_FEATURE_TRANSLUCENCY),
           feature("diffusion", "Light that leaves beside where it enters.", PELLUCID_FEATURE_DIFFUSION),
           bound(choice("indirect", "indirect", "Passes run everywhere, or where the GPU finds material.",
                        {"none", "material"}),
                 FIELD(indirectDispatches))}};
}

ParameterGroup thickness() {
  return {"Thickness and transmittance",
          false,
          {usedWhere(bound(choice("thickness", "thickness", "Its source for lights with a shadow map.",
                                  {"light", "camera"}),
                           FIELD(translucency.cameraThickness)),
                     hasTranslucency),
           usedWhere(bound(choice("transmittance", "T(d)", "What stands for the material's own.",
                                  {"material", "linear", "Gaussians", "Gaussians as printed"}),
                           FIELD(transmittance)),
                     hasTranslucency),
           usedWhere(bound(real("max-thickness", "largest thickness, mm",
                                "Thicker parts let nothing through; 0: no limit.", 0, 100),
                           FIELD(translucency.maximumThickness)),
                     hasTranslucency),
           usedWhere(bound(real("filter", "filter", "Multiplies T (thesis: .55 .29 .28).", 0, 1, 3),
                           FIELD(translucency.transmittanceFilter)),
                     hasTranslucency),
           usedWhere(bound(flag("chord", "chord", "Camera thickness without the cosine correction."),
                           FIELD(translucency.chordThickness)),
                     [](const ReplaySettings& s) {
                       return hasTranslucency(s) && s.translucency.cameraThickness;
                     })}};
}

ParameterGroup angles() {
  const auto oneThickness = [](const ReplaySettings& s) {
    return hasTranslucency(s) && (s.translucency.gatherSamples == 0 || !gathers(s));
  };
  // The models with tables of directions need tables that sliders cannot make.
  return {
      "Angle between view and light",
      false,
      {usedWhere(bound(choice("angle", "model", "The cosine of the light on the hidden face.",
                              {"normal", "cosine", "inverse cosine", "polynomial", "minimum dot"}),
                       FIELD(translucency.angleModel)),
                 oneThickness),
       usedWhere(
           bound(real("polynomial", "c0 c1 c2 c3",
                      "c0 + c1 a + c2 a^2 + c3 a^3 of the angle a between camera and light, radians.", -10,
                      10, 4),
                 FIELD(translucency.anglePolynomial)),
           [=](const ReplaySettings& s) { return oneThickness(s) && angleIs(s, PELLUCID_ANGLE_POLYNOMIAL); }),
       usedWhere(bound(real("minimum-dot", "minimum dot", "Cosine above which nothing comes through.", -1, 0),
                       FIELD(translucency.minimumDot)),
                 [=](const ReplaySettings& s) {
                   return oneThickness(s) &&
                          (angleIs(s, PELLUCID_ANGLE_MINIMUM_DOT) || s.translucency.prescaleAngle);
                 }),
       usedWhere(bound(flag("prescale", "pre-scaled", "The curves begin at the minimum dot."),
                       FIELD(translucency.prescaleAngle)),
                 oneThickness),
       usedWhere(
           bound(flag("view", "one view ray", "The camera's axis for all pixels, as the thesis has it."),
                 FIELD(translucency.constantViewDirection)),
           oneThickness)}};
}

ParameterGroup reuse() {
  return {"Reuse between frames",
          false,
          {bound(choice("reuse", "reuse", "Light that came through is taken from the frame before.",
                        {"none", "alternate", "coherence"}),
                 FIELD(reuse)),
           usedWhere(bound(real("coherence-threshold", "threshold",
                                "Change of the cosine between camera and light.", 0, 0.1f),
                           FIELD(coherenceThreshold)),
                     [](const ReplaySettings& s) { return s.reuse == PELLUCID_REUSE_COHERENCE; })}};
}

}  // namespace

const std::vector<ParameterGroup>& parameterGroups() {
  static const std::vector<ParameterGroup> groups = {quality(), thickness(), angles(), reuse()};
  return groups;
}

void assign(const Parameter& parameter, ReplaySettings& settings, Values to) {
  const Values before = parameter.get(settings);
  for (std::size_t i = 0; i < to.size(); ++i) {
    if (std::isnan(to[i])) to[i] = before[i];
    to[i] = std::clamp(to[i], parameter.low, parameter.high);
    if (parameter.kind != ParameterKind::Real) to[i] = parameter.step * std::round(to[i] / parameter.step);
  }
  parameter.set(settings, to);
}

}  // namespace pellucid::harness
