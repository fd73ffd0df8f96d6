// `pellucid shaders`: every pipeline in every language, against the words of its SPIR-V and against plans.
#include <gtest/gtest.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include "cli/commands.h"
#include "cli/shader_translation.h"
#include "frame_fixture.h"
#include "temporary_directory.h"

namespace {

using namespace pellucid::harness;
using Json = nlohmann::json;
namespace fs = std::filesystem;

void run(const std::string& arguments) {
  CLI::App app;
  addShadersCommand(app);
  app.parse("shaders " + arguments);
}

std::string contents(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  EXPECT_TRUE(in) << file;
  return {std::istreambuf_iterator<char>(in), {}};
}

// All languages, written once for all tests.
struct Written {
  TemporaryDirectory folder;
  Json hlsl, msl;

  Written() {
    run("--hlsl " + path("") + " --msl " + path(""));
    hlsl = Json::parse(contents(folder / "hlsl.json"));
    msl = Json::parse(contents(folder / "msl.json"));
  }
  std::string path(const std::string& name) const { return (folder / name).string(); }
  std::string text(const Json& shader) const { return contents(folder / shader["file"].get<std::string>()); }
};

const Written& written() {
  static const Written all;
  return all;
}

// ---- The words, read here ----------------------------------------------------------------------------

struct Words {
  std::map<uint32_t, uint32_t> bindings;        // by variable
  std::map<uint32_t, uint32_t> constantIds;     // by result
  std::map<uint32_t, uint32_t> constantValues;  // by result, of integers and booleans
  std::set<uint32_t> used;                      // ids that functions name
  std::array<uint32_t, 3> localSize{};
  uint32_t sharedBytes = 0;
};

Words readWords(const std::string& bytes) {
  std::vector<uint32_t> words(bytes.size() / 4);
  std::memcpy(words.data(), bytes.data(), words.size() * 4);
  Words read;
  bool inFunction = false;
  std::array<uint32_t, 3> sizeConstants{};
  uint32_t sizeId = 0;
  std::map<uint32_t, uint32_t> sizes, pointees;  // by type
  for (size_t i = 5; i < words.size(); i += words[i] >> 16) {
    const uint32_t *w = &words[i], count = w[0] >> 16, op = w[0] & 0xFFFF;
    inFunction = inFunction || op == 54;                                          // OpFunction
    if (inFunction) read.used.insert(w + 1, w + count);                           // and literals
    if (op == 16 && w[2] == 17) std::copy(w + 3, w + 6, read.localSize.begin());  // LocalSize
    if (op == 71 && w[2] == 33) read.bindings[w[1]] = w[3];                       // Binding
    if (op == 71 && w[2] == 1) read.constantIds[w[1]] = w[3];                     // SpecId
    if (op == 71 && w[2] == 11 && w[3] == 25) sizeId = w[1];                      // BuiltIn WorkgroupSize
    if (op == 48 || op == 49) read.constantValues[w[2]] = op == 48;               // OpSpecConstantTrue, False
    if (op == 43 || op == 50) read.constantValues[w[2]] = w[3];  // OpConstant, OpSpecConstant
    if ((op == 44 || op == 51) && w[2] == sizeId)
      std::copy(w + 3, w + 6, sizeConstants.begin());                     // composites
    if (op == 20) sizes[w[1]] = 4;                                        // OpTypeBool
    if (op == 21 || op == 22) sizes[w[1]] = w[2] / 8;                     // OpTypeInt, OpTypeFloat
    if (op == 23 || op == 24) sizes[w[1]] = sizes[w[2]] * w[3];           // OpTypeVector, OpTypeMatrix
    if (op == 28) sizes[w[1]] = sizes[w[2]] * read.constantValues[w[3]];  // OpTypeArray
    if (op == 30)                                                         // OpTypeStruct
      for (uint32_t member = 2; member < count; ++member) sizes[w[1]] += sizes[w[member]];
    if (op == 32) pointees[w[1]] = w[3];                                   // OpTypePointer
    if (op == 59 && w[3] == 4) read.sharedBytes += sizes[pointees[w[1]]];  // OpVariable, Workgroup
  }
  for (size_t i = 0; sizeId && i < 3; ++i) read.localSize[i] = read.constantValues[sizeConstants[i]];
  return read;
}

// ---- Tests ------------------------------------------------------------------------------------------

TEST(ShadersCommand, DescribesEveryPipelineInEveryLanguage) {
  const Written& all = written();
  std::set<std::pair<uint32_t, std::string>> described;
  for (const Json& shader : all.hlsl["shaders"]) {
    const uint32_t pipeline = shader["pipeline"];
    EXPECT_EQ(shader["name"], pellucidPipelineName(pipeline));
    const std::string type = shader["shadowViewType"];
    if (type != "2D_ARRAY") described.insert({pipeline, "2D"});
    if (type != "2D") described.insert({pipeline, "2D_ARRAY"});
  }
  EXPECT_EQ(described.size(), 2 * pellucidGetPipelineCount());

  ASSERT_EQ(all.msl["shaders"].size(), all.hlsl["shaders"].size());
  for (size_t i = 0; i < all.hlsl["shaders"].size(); ++i)
    for (const char* field :
         {"pipeline", "shadowViewType", "workgroupSize", "specializationConstants", "pushConstantBytes"})
      EXPECT_EQ(all.msl["shaders"][i][field], all.hlsl["shaders"][i][field]) << field;
}

TEST(ShadersCommand, DescribesWhatTheModulesWordsSay) {
  uint32_t mostShared = 0;
  for (const Json& shader : written().hlsl["shaders"]) {
    SCOPED_TRACE(shader["file"]);
    PellucidShader module;
    ASSERT_EQ(pellucidGetShader(shader["pipeline"],
                                shader["shadowViewType"] == "2D_ARRAY" ? VK_IMAGE_VIEW_TYPE_2D_ARRAY
                                                                       : VK_IMAGE_VIEW_TYPE_2D,
                                VK_FORMAT_UNDEFINED, nullptr, &module),
              PELLUCID_OK);
    const Words words = readWords(std::string(reinterpret_cast<const char*>(module.words), module.wordCount * 4));
    EXPECT_LE(words.sharedBytes, 16384u) << "more than the context asks of the device";
    mostShared = std::max(mostShared, words.sharedBytes);
    std::map<uint32_t, uint32_t> values;
    for (const auto& [result, id] : words.constantIds) values[id] = words.constantValues.at(result);
    for (uint32_t i = 0; i < module.constantCount; ++i) {
      EXPECT_TRUE(values.count(module.constants[i].id))
          << "the shader lacks constant " << module.constants[i].id;
      values[module.constants[i].id] = module.constants[i].value;
    }
    std::map<uint32_t, uint32_t> describedValues;
    for (const Json& constant : shader["specializationConstants"])
      describedValues[constant["id"]] = constant["value"];
    EXPECT_EQ(describedValues, values);

    EXPECT_EQ(shader["workgroupSize"], Json(words.localSize));
    std::set<uint32_t> declared, described;
    for (const auto& [variable, binding] : words.bindings)
      if (words.used.count(variable)) declared.insert(binding);
    for (const Json& binding : shader["bindings"])
      EXPECT_TRUE(described.insert(binding["binding"].get<uint32_t>()).second)
          << binding << " is there twice";
    // Literals of functions may look like ids, so that `declared` may hold more.
    EXPECT_TRUE(std::includes(declared.begin(), declared.end(), described.begin(), described.end()));
    EXPECT_GE(described.size() + 2, declared.size());
  }
  EXPECT_GT(mostShared, 8192u) << "shared memory was not counted";
}

std::string one(const std::string& text, const std::string& pattern, size_t group = 1) {
  std::smatch match;
  return std::regex_search(text, match, std::regex(pattern)) ? match[group].str() : "nothing like " + pattern;
}

TEST(ShadersCommand, HlslHasTheDescribedRegistersAndSizes) {
  for (const Json& shader : written().hlsl["shaders"]) {
    SCOPED_TRACE(shader["file"]);
    const std::string text = written().text(shader), entryPoint = shader["entryPoint"];
    std::map<std::string, std::string> constants;  // by macro
    for (const Json& constant : shader["specializationConstants"]) {
      const std::string macro = "SPIRV_CROSS_CONSTANT_ID_" + std::to_string(constant["id"].get<int>());
      const uint32_t value = constant["value"];
      constants[macro] = constant["type"] == "bool" ? value ? "true" : "false" : std::to_string(value) + "u";
      EXPECT_EQ(one(text, "#define " + macro + " (\\w+)"), constants[macro]);
    }
    std::smatch sizes;
    ASSERT_TRUE(std::regex_search(text, sizes,
                                  std::regex(R"(\[numthreads\((\w+), (\w+), (\w+)\)\]\s*void (\w+)\()")));
    EXPECT_EQ(sizes[4], entryPoint);
    for (size_t i = 0; i < 3; ++i) {
      const std::string size = constants.count(sizes[i + 1]) ? constants[sizes[i + 1]] : sizes[i + 1].str();
      EXPECT_EQ(std::stoul(size), shader["workgroupSize"][i]);
    }

    std::set<std::string> declared, described;
    static const std::regex reg(R"(register\((\w+), space(\d)\))");
    for (std::sregex_iterator match(text.begin(), text.end(), reg), end; match != end; ++match)
      EXPECT_TRUE(declared.insert((*match)[2].str() + (*match)[1].str()).second)
          << match->str() << " is there twice";
    for (const Json& binding : shader["bindings"]) {
      described.insert("0" + binding["register"].get<std::string>());
      if (binding["type"] != "uniformBuffer") {
        EXPECT_EQ(one(text, " " + binding["name"].get<std::string>() + R"( : register\((\w+))"),
                  binding["register"]);
      }
    }
    if (shader["pushConstantBytes"] == PELLUCID_PUSH_CONSTANT_BYTES)
      described.insert(std::to_string(kHlslConstantSpace) + "b0");
    if (shader["readsGroups"]) described.insert(std::to_string(kHlslConstantSpace) + "b1");
    EXPECT_EQ(declared, described);
  }
}

TEST(ShadersCommand, MslHasTheDescribedArguments) {
  std::set<std::string> kernels;
  for (const Json& shader : written().msl["shaders"]) {
    SCOPED_TRACE(shader["file"]);
    const std::string text = written().text(shader), entryPoint = shader["entryPoint"];
    EXPECT_TRUE(kernels.insert(entryPoint).second) << "kernels of one library need names of their own";
    const std::string arguments = one(text, "kernel void " + entryPoint + "\\((.*)\\)\n");
    std::set<std::string> declared, described;
    static const std::regex slot(R"( (\w+) \[\[((buffer|texture)\(\d+\))\]\])");
    for (std::sregex_iterator match(arguments.begin(), arguments.end(), slot), end; match != end; ++match)
      EXPECT_TRUE(declared.insert((*match)[2]).second) << match->str() << " is there twice";
    for (const Json& binding : shader["bindings"]) {
      described.insert(binding["argument"].get<std::string>());
      EXPECT_EQ(one(arguments, " " + binding["name"].get<std::string>() + R"( \[\[(\w+\(\d+\))\]\])"),
                binding["argument"]);
    }
    if (shader["pushConstantBytes"] == PELLUCID_PUSH_CONSTANT_BYTES)
      described.insert("buffer(" + std::to_string(kMslPushConstantBuffer) + ")");
    EXPECT_EQ(declared, described);

    for (const Json& constant : shader["specializationConstants"]) {
      const std::string id = std::to_string(constant["id"].get<int>());
      const uint32_t value = constant["value"];
      const std::string name =
          one(text, "constant \\w+ (\\w+) \\[\\[function_constant\\(" + id + "\\)\\]\\]");
      EXPECT_EQ(one(text, "is_function_constant_defined\\(" + name + "\\) \\? " + name + " : (\\w+)"),
                constant["type"] == "bool" ? value ? "true" : "false" : std::to_string(value) + "u");
    }
  }
}

// glslang reads HLSL up to what these shaders take of Shader Model 6.0. -Od leaves out spirv-opt, which takes
// most of the time. No compiler of MSL runs on Linux.
TEST(ShadersCommand, GlslangCompilesTheHlslToTheSameSizes) {
  for (const Json& shader : written().hlsl["shaders"]) {
    SCOPED_TRACE(shader["file"]);
    const std::string file = shader["file"], entryPoint = shader["entryPoint"];
    const std::string again = written().path("again.spv"), log = written().path("log.txt");
    const std::string command = std::string("\"") + PELLUCID_GLSLANG + "\" --quiet -D -V -Od -S comp -e " +
                                entryPoint + " --target-env vulkan1.1 \"" + written().path(file) +
                                "\" -o \"" + again + "\" > \"" + log + "\" 2>&1";
    ASSERT_EQ(std::system(command.c_str()), 0) << contents(log);
    EXPECT_EQ(Json(readWords(contents(again)).localSize), shader["workgroupSize"]);
  }
}

// A port binds what plans list: it finds each of a shader's bindings there, with the type.
TEST(ShadersCommand, PlansBindWhatIsDescribed) {
  static const std::map<std::string, int> types = {
      {"uniformBuffer", VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER},
      {"storageBuffer", VK_DESCRIPTOR_TYPE_STORAGE_BUFFER},
      {"readOnlyStorageBuffer", VK_DESCRIPTOR_TYPE_STORAGE_BUFFER},
      {"sampledImage", VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE},
      {"storageImage", VK_DESCRIPTOR_TYPE_STORAGE_IMAGE}};
  // The frame has all of these images, so that none stands in for another.
  static const std::map<std::string, uint32_t> inputs = {{"frontDepthImage", PELLUCID_RESOURCE_FRONT_DEPTH},
                                                         {"backDepthImage", PELLUCID_RESOURCE_BACK_DEPTH},
                                                         {"albedoImage", PELLUCID_RESOURCE_ALBEDO},
                                                         {"materialImage", PELLUCID_RESOURCE_MATERIAL}};
  std::set<uint32_t> seen;
  for (const auto& [lights, samples] : {std::pair(1u, 0u), {1u, 8u}, {2u, 8u}})
    for (const uint32_t indirect : {0u, 1u}) {
      pellucid::test::Frame f(lights);
      f.frame.albedo = f.view();
      for (PellucidImage& transient : f.frame.transients) transient = f.view();
      f.frame.options.gatherSamples = samples;
      f.frame.options.indirectDispatches = indirect;
      const PellucidPlan plan = f.plan();
      for (uint32_t i = 0; i < plan.dispatchCount; ++i) {
        const PellucidDispatch& d = plan.dispatches[i];
        SCOPED_TRACE(d.name);
        seen.insert(d.pipeline);
        std::map<uint32_t, const PellucidBinding*> bound;
        const std::vector<PellucidBinding> all = pellucid::test::bindingsOf(plan, d);
        for (const PellucidBinding& b : all) bound[b.binding] = &b;
        for (const Json& shader : written().hlsl["shaders"]) {
          if (shader["pipeline"] != d.pipeline) continue;
          for (const Json& binding : shader["bindings"]) {
            const auto found = bound.find(binding["binding"]);
            ASSERT_NE(found, bound.end()) << binding;
            EXPECT_EQ(found->second->type, types.at(binding["type"])) << binding;
            const auto input = inputs.find(binding["name"]);
            if (input != inputs.end()) {
              EXPECT_EQ(found->second->resource, input->second) << binding;
            }
          }
        }
      }
    }
  EXPECT_EQ(seen.size() + 3, pellucidGetPipelineCount()) << "all but debug view, add history and accumulate probes";
}

}  // namespace
