// What `pellucid evaluate` says of results against the truth of their captures.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "capture/capture.h"
#include "common/compare.h"
#include "metrics/eye.h"

namespace pellucid::harness {

struct EvaluationBoxes {
  int side = 4;           // pixels: averages that are compared
  double coverage = 0.5;  // part of an average's pixels that must be surface
};

// One model's result.
struct Evaluation {
  std::string capture, model;
  std::optional<Comparison> all, unlit;  // absent: no such pixels; unlit: without front irradiance
  EyeMetrics eye;
  // relativeNoise() of the truth over averages as above, wholly of surface, and over 8x8; empty: not known.
  std::vector<double> noise, noiseOf8;
};

// exposure: of FLIP, as measureFlip(). Throws InputError when sizes differ.
Evaluation evaluate(const std::string& captureName, const std::string& model, const Capture& capture,
                    const Image& result, const EvaluationBoxes& boxes, double exposure);

// Tables of error and bias, of what the eye sees, and of the truths' noise where it is known.
std::string evaluationMarkdown(const std::vector<Evaluation>& evaluations, const EvaluationBoxes& boxes);

// An object with `boxes` and an array of all numbers, one object a result.
std::string evaluationJson(const std::vector<Evaluation>& evaluations, const EvaluationBoxes& boxes);

}  // namespace pellucid::harness
