// The module's shaders in the languages of other APIs.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "pellucid/pellucid.h"

namespace pellucid::harness {

enum class ShaderLanguage { Hlsl, Msl };  // Shader Model 6.0, Metal 2.3

// Bindings have registers and arguments of their numbers, in HLSL of space 0. These are beside them.
constexpr uint32_t kHlslConstantSpace =
    1;  // b0: push constants; b1: PellucidDispatch::groups, which HLSL cannot ask for
constexpr uint32_t kMslPushConstantBuffer = 23;  // above all bindings of buffers

// A pipeline of the module with one of the types of shadow views.
struct PipelineShader {
  std::string name;            // of the pipeline, with "_array" where 2D_ARRAY has a shader of its own
  const char* shadowViewType;  // "2D", "2D_ARRAY", or "any"
  uint32_t pipeline;           // index below pellucidGetPipelineCount()
  PellucidShader shader;
};
std::vector<PipelineShader> pipelineShaders();  // in the order of pipelines

struct TranslatedShader {
  std::string text;
  nlohmann::ordered_json
      description;  // entry point, workgroup size, constants and bindings; packaging/README.md
};

// Specialization constants have the pipeline's values as defaults. Throws InputError, naming pipeline and
// language, for what cannot be said in the language.
TranslatedShader translateShader(const PipelineShader& shader, ShaderLanguage language);

}  // namespace pellucid::harness
