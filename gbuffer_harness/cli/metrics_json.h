// Metrics of what the eye sees as JSON.
#pragma once

#include <nlohmann/json.hpp>

#include "metrics/eye.h"
#include "metrics/flicker.h"

namespace pellucid::harness {

inline nlohmann::ordered_json toJson(const Tint& tint) {
  return {{"channels", tint.channel}, {"redOverGreen", tint.redOverGreen}, {"blocks", tint.blocks}};
}

inline nlohmann::ordered_json toJson(const Flip& flip) {
  return {{"mean", flip.mean}, {"p99", flip.p99}, {"exposure", flip.exposure}};
}

inline nlohmann::ordered_json toJson(const Flicker& flicker) {
  return {{"rel_rmse", flicker.relativeRmse},
          {"p999", flicker.p999},
          {"worst", flicker.worst},
          {"worstPixel", flicker.worstPixel},
          {"pixels", flicker.pixels}};
}

inline nlohmann::ordered_json toJson(const SpotFlicker& spots) {
  return {
      {"still", spots.still}, {"turned", spots.turned}, {"appear", spots.appear}, {"vanish", spots.vanish}};
}

}  // namespace pellucid::harness
