// A replay's settings that the panel offers: names, ranges and how a value reaches its field.
#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "replay/frame.h"

namespace pellucid::harness {

enum class ParameterKind {
  Choice,  // index into `choices`
  Flag,    // 0 or 1
  Whole,
  Real
};

struct Parameter {
  using Values = std::array<float, 4>;

  std::string key;    // of `pellucid replay --set`
  std::string label;  // with the unit
  std::string help;   // a sentence
  ParameterKind kind = ParameterKind::Real;
  int components = 1;       // 1..4; of Real
  float low = 0, high = 1;  // both are allowed
  float step = 1;           // of Whole: values are multiples of it
  std::vector<std::string> choices;
  std::function<Values(const ReplaySettings&)> get;
  std::function<void(ReplaySettings&, const Values&)> set;
  std::function<bool(const ReplaySettings&)>
      used;  // false: it has no effect with these settings; empty: always
};

struct ParameterGroup {
  std::string name;
  bool open = false;  // as the panel begins
  std::vector<Parameter> parameters;
};

const std::vector<ParameterGroup>& parameterGroups();

// Sets a parameter to the nearest value that it allows; NaN leaves it as it is.
void assign(const Parameter& parameter, ReplaySettings& settings, Parameter::Values values);

}  // namespace pellucid::harness
