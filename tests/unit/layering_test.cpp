// The include arrows of the project, and what a folder must not contain; CONTRIBUTING.md has the reasons.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <regex>
#include <sstream>

namespace {

namespace fs = std::filesystem;

const fs::path kRoot = PELLUCID_SOURCE_DIR;

std::string contents(const fs::path& file) {
  std::ifstream in(file);
  std::stringstream text;
  text << in.rdbuf();
  return text.str();
}

// Comments may name what code must not use.
std::string code(const fs::path& file) {
  static const std::regex comments(R"(//[^\n]*|/\*[^*]*\*+([^/*][^*]*\*+)*/)");
  return std::regex_replace(contents(file), comments, "");
}

std::vector<fs::path> sources(const fs::path& folder) {
  std::vector<fs::path> found;
  for (const auto& entry : fs::recursive_directory_iterator(kRoot / folder)) {
    const std::string extension = entry.path().extension().string();
    if (extension == ".h" || extension == ".cpp" || extension == ".glsl" || extension == ".comp")
      found.push_back(entry.path());
  }
  EXPECT_FALSE(found.empty()) << folder << " has no sources: the test looks in the wrong place";
  return found;
}

struct Rule {
  std::string folder, pattern, reason, except;  // a file, or a folder of files, for which the rule is not
};

const std::vector<Rule> kRules = {
    {"compute/shared", R"(#include\s*[<"](?!glm/|pellucid_))",
     "shared headers include nothing but GLM types and each other", ""},
    {"compute/lib", R"(\blayout\s*\()", "lib is maths: bindings belong to passes", ""},
    {"compute/lib", R"(#include\s*"(?!lib/|shared/))", "lib does not know the passes", ""},
    {"compute", R"(#include\s*"(pellucid/|capture/|replay/|scene/))", "shaders include shaders", ""},
    {"module", R"(#include\s*"(capture|replay|scene|common|cli|reference|raster)/)",
     "the module does not know the harness", ""},
    {"module", R"(\bprintf|\bfprintf|#include\s*<(iostream|fstream|cstdio)>)",
     "the module writes no files and no output", ""},
    {"module",
     R"(vkAllocateMemory|vkQueueSubmit|vkQueueWaitIdle|vkDeviceWaitIdle|vkWaitForFences|vkCreateImage\b)",
     "the caller owns memory, submission and waits", ""},
    {"module", R"(vk\.vkCmd)", "only record.cpp records", "record.cpp"},
    {"module/src", R"(#include\s*<Eigen)", "Eigen is the material compiler's", ""},
    {"module/include", R"(#include\s*<(string|vector|array|memory|functional|glm)|\bthrow\b|std::)",
     "the public API is C", ""},
    {"gbuffer_harness", R"(#include\s*"(bench|tests)/)", "the harness does not know its users", ""},
    {"gbuffer_harness/reference",
     R"(#include\s*"(lib/|frame/|translucency/|diffusion/|gather/|shared/|compute/|replay/))",
     "the reference is independent of the shaders", ""},
    {"gbuffer_harness/replay", R"(#include\s*<(OpenEXR|ImfI|nlohmann))",
     "replay needs no files, so that the bench does not either", ""},
    {"gbuffer_harness/metrics",
     R"(#include\s*(<(OpenEXR|Imf|nlohmann|CLI)|"(capture/(exr|read|write)|replay/)))",
     "metrics know captures and images, no files", ""},
    {"gbuffer_harness/scene", R"(#include\s*<(OpenEXR|Imf|nlohmann))", "procedural scenes need no files", ""},
    {"gbuffer_harness/raster",
     R"(#include\s*(<(OpenEXR|Imf|nlohmann|tiny_gltf)|"(capture/(exr|read|write)|gltf/|replay/|view/)))",
     "the rasterizer knows models and captures, neither files nor replays", ""},
    {"gbuffer_harness/sample", R"(#include\s*"view/)", "integrators copy the sample, and not the viewer", ""},
    {"gbuffer_harness/cli", R"(#include\s*<CLI)", "each source with CLI11 takes many seconds to compile",
     "command.cpp"},
    {"gbuffer_harness", R"(#include\s*[<"]tiny_gltf|tinygltf::)", "all but the loader speak raster/model.h",
     "gltf"},
};

TEST(Layering, Holds) {
  for (const Rule& rule : kRules) {
    const std::regex pattern(rule.pattern);
    for (const fs::path& file : sources(rule.folder)) {
      if (file.filename() == rule.except || file.parent_path().filename() == rule.except) continue;
      std::smatch match;
      const std::string text = code(file);
      EXPECT_FALSE(std::regex_search(text, match, pattern))
          << file << ": \"" << match.str() << "\": " << rule.reason;
    }
  }
}

}  // namespace
