#include "cli/evaluate_report.h"

#include <algorithm>
#include <cstdio>
#include <sstream>

#include "cli/metrics_json.h"

namespace pellucid::harness {

namespace {

using Json = nlohmann::ordered_json;

std::optional<Comparison> compared(const Capture& capture, const Image& result, Subset subset,
                                   const EvaluationBoxes& boxes) {
  const Mask mask = comparisonMask(capture.material, capture.irradiance, subset);
  if (std::find(mask.begin(), mask.end(), 1) == mask.end()) return std::nullopt;
  return compareImages(result, capture.truth->image, mask, boxes.side, boxes.coverage);
}

std::string errorCells(const std::optional<Comparison>& comparison) {
  if (!comparison) return "no such pixels | ";
  char text[128];
  const auto& k = comparison->channels;
  std::snprintf(text, sizeof text, "%.3f %.3f %.3f | %+.0f %+.0f %+.0f %%", k[0].relativeRmse,
                k[1].relativeRmse, k[2].relativeRmse, 100 * k[0].bias, 100 * k[1].bias, 100 * k[2].bias);
  return text;
}

std::string eyeCells(const EyeMetrics& eye) {
  char text[256];
  const auto& tint = eye.tint.channel;
  const std::string tints = eye.tint.blocks > 0
                                ? (std::snprintf(text, sizeof text, "%.3f %.3f %.3f | %.3f", tint[0], tint[1],
                                                 tint[2], eye.tint.redOverGreen),
                                   text)
                                : "no such blocks | ";
  std::snprintf(text, sizeof text, "%zu (%zu) | %zu | %s | %.3f | %.3f | %.3g", eye.isolated,
                eye.isolatedInTruth, eye.spots, tints.c_str(), eye.flip.mean, eye.flip.p99,
                eye.flip.exposure);
  return text;
}

Json toJson(const std::optional<Comparison>& comparison) {
  if (!comparison) return nullptr;
  Json json;
  for (const ChannelDifference& channel : comparison->channels) {
    json["rel_rmse"].push_back(channel.relativeRmse);
    json["bias"].push_back(channel.bias);
  }
  json["blocks"] = comparison->samples;
  json["nonFinite"] = comparison->nonFiniteA;
  return json;
}

}  // namespace

Evaluation evaluate(const std::string& captureName, const std::string& model, const Capture& capture,
                    const Image& result, const EvaluationBoxes& boxes, double exposure) {
  Evaluation e{captureName,
               model,
               compared(capture, result, Subset::All, boxes),
               compared(capture, result, Subset::Unlit, boxes),
               measureEye(result, capture, exposure),
               {},
               {}};
  if (const Truth& truth = *capture.truth; !truth.standardError.empty()) {
    e.noise = relativeNoise(truth.image, truth.standardError, capture.material, boxes.side);
    e.noiseOf8 = relativeNoise(truth.image, truth.standardError, capture.material, 8);
  }
  return e;
}

namespace {

std::string noiseCells(const std::vector<double>& noise) {
  if (noise.empty()) return "no such block";
  char text[64];
  std::snprintf(text, sizeof text, "%.4f %.4f %.4f", noise[0], noise[1], noise[2]);
  return text;
}

// One row a capture whose truth says its noise.
std::string noiseTable(const std::vector<Evaluation>& evaluations, const EvaluationBoxes& boxes) {
  std::ostringstream rows;
  const std::string* last = nullptr;
  for (const Evaluation& e : evaluations) {
    if ((e.noise.empty() && e.noiseOf8.empty()) || (last && *last == e.capture)) continue;
    last = &e.capture;
    rows << "| " << e.capture << " | " << noiseCells(e.noise) << " | " << noiseCells(e.noiseOf8) << " |\n";
  }
  if (rows.str().empty()) return "";
  std::ostringstream text;
  text
      << "\nNoise of the truths: standard error over RMS (R G B), averages wholly of surface.\n\n| capture | "
      << boxes.side << "x" << boxes.side << " | 8x8 |\n|-|-|-|\n"
      << rows.str();
  return text.str();
}

}  // namespace

std::string evaluationMarkdown(const std::vector<Evaluation>& evaluations, const EvaluationBoxes& boxes) {
  std::ostringstream text;
  text << "Relative RMSE and mean bias (R G B) against path-traced truth, " << boxes.side << "x" << boxes.side
       << " averages of which " << 100 * boxes.coverage
       << " % and more are surface; unlit: pixels without front irradiance.\n\n"
       << "| capture | model | all | bias | unlit | bias |\n|-|-|-|-|-|-|\n";
  for (const Evaluation& e : evaluations)
    text << "| " << e.capture << " | " << e.model << " | " << errorCells(e.all) << " | "
         << errorCells(e.unlit) << " |\n";
  text << "\nWhat the eye sees against path-traced truth: isolated pixels (those of the truth in "
          "parentheses), spots that the truth lacks, "
          "tint of 8x8 averages (R G B, then red over green), FLIP.\n\n"
       << "| capture | model | isolated | spots | tint | red/green | FLIP mean | 99th percentile | at "
          "exposure |\n"
       << "|-|-|-|-|-|-|-|-|-|\n";
  for (const Evaluation& e : evaluations)
    text << "| " << e.capture << " | " << e.model << " | " << eyeCells(e.eye) << " |\n";
  text << noiseTable(evaluations, boxes);
  return text.str();
}

std::string evaluationJson(const std::vector<Evaluation>& evaluations, const EvaluationBoxes& boxes) {
  Json results = Json::array();
  for (const Evaluation& e : evaluations)
    results.push_back({{"capture", e.capture},
                       {"model", e.model},
                       {"all", toJson(e.all)},
                       {"unlit", toJson(e.unlit)},
                       {"isolated", e.eye.isolated},
                       {"isolatedInTruth", e.eye.isolatedInTruth},
                       {"spots", e.eye.spots},
                       {"tint", toJson(e.eye.tint)},
                       {"flip", toJson(e.eye.flip)},
                       {"truthNoise", e.noise},
                       {"truthNoise8x8", e.noiseOf8}});
  return Json{{"box", boxes.side}, {"boxCoverage", boxes.coverage}, {"results", std::move(results)}}.dump(2) +
         "\n";
}

}  // namespace pellucid::harness
