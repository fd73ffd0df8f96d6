// Files of compute/: lib/ is maths with parameters only.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;

const fs::path kCompute = fs::path(PELLUCID_SOURCE_DIR) / "compute";

std::vector<fs::path> files(const fs::path& folder) {
  std::vector<fs::path> found;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_regular_file()) found.push_back(entry.path());
  EXPECT_FALSE(found.empty()) << folder << " is empty: the test looks in the wrong place";
  return found;
}

// `file` of `folder`, as a compute shader with nothing defined before it.
bool compilesAlone(const fs::path& folder, const std::string& file) {
  const std::string command = std::string("\"") + PELLUCID_GLSLANG +
                              "\" --quiet -V --target-env vulkan1.1 -I\"" + folder.string() +
                              "\" --stdin -S comp -o /dev/null";
  FILE* glslang = popen(command.c_str(), "w");
  if (!glslang) return false;
  const std::string shader = "#version 460\n#extension GL_GOOGLE_include_directive : require\n#include \"" +
                             file + "\"\nvoid main() {}\n";
  std::fputs(shader.c_str(), glslang);
  return pclose(glslang) == 0;
}

TEST(ShaderLibrary, EachFileCompilesAlone) {
  for (const fs::path& file : files(kCompute / "lib"))
    EXPECT_TRUE(compilesAlone(kCompute, "lib/" + file.filename().string()))
        << file << " uses a name that it neither defines nor includes";
}

TEST(ShaderLibrary, UndefinedNamesAreFound) {
  const fs::path folder =
      fs::path(testing::TempDir()) / ("pellucid_shader_library_" + std::to_string(::getpid()));
  fs::create_directories(folder);
  std::ofstream(folder / "impure.glsl") << "float scaled(float x) { return x * frame.scale; }\n";
  std::ofstream(folder / "pure.glsl") << "float scaled(float x, float scale) { return x * scale; }\n";
  EXPECT_FALSE(compilesAlone(folder, "impure.glsl"));
  EXPECT_TRUE(compilesAlone(folder, "pure.glsl"));
  fs::remove_all(folder);
}

}  // namespace
