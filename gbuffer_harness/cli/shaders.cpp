// `pellucid shaders`: the module's shaders for other APIs.
#include <cstdio>
#include <filesystem>
#include <memory>

#include "cli/commands.h"
#include "cli/shader_translation.h"
#include "common/error.h"
#include "common/whole_file.h"

namespace pellucid::harness {

namespace {

struct Output {
  ShaderLanguage language;
  const char *option, *help, *extension, *index, *target;
  std::string folder;  // empty: not asked for
};

struct Options {
  Output outputs[3] = {{ShaderLanguage::Hlsl,
                        "--hlsl",
                        "folder for HLSL and hlsl.json",
                        ".hlsl",
                        "hlsl.json",
                        "Shader Model 6.0",
                        {}},
                       {ShaderLanguage::Msl,
                        "--msl",
                        "folder for the Metal Shading Language and msl.json",
                        ".metal",
                        "msl.json",
                        "Metal 2.3",
                        {}},
                       {ShaderLanguage::Spirv,
                        "--spirv",
                        "folder for SPIR-V and spirv.json",
                        ".spv",
                        "spirv.json",
                        "Vulkan 1.1",
                        {}}};
};

void write(const Output& output) {
  const std::filesystem::path folder = output.folder;
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error)
    throw InputError(folder.string(), output.option,
                     "is no folder and cannot be made one: " + error.message());
  nlohmann::ordered_json index = {{"version", PELLUCID_VERSION}, {"target", output.target}};
  for (const PipelineShader& shader : pipelineShaders()) {
    const TranslatedShader translated = translateShader(shader, output.language);
    const std::string file = shader.name + output.extension;
    writeWholeText(folder / file, translated.text);
    nlohmann::ordered_json entry = {{"file", file}};
    entry.update(translated.description);
    index["shaders"].push_back(entry);
  }
  writeWholeText(folder / output.index, index.dump(1) + "\n");
  std::printf("wrote %zu shaders (%s) and %s to %s\n", index["shaders"].size(), output.target, output.index,
              folder.c_str());
}

void writeAll(const Options& options) {
  bool any = false;
  for (const Output& output : options.outputs) {
    if (output.folder.empty()) continue;
    any = true;
    write(output);
  }
  if (!any) throw UsageError("shaders: there is nothing to write without --hlsl, --msl or --spirv DIR");
}

}  // namespace

void addShadersCommand(const Command& app) {
  const auto options = std::make_shared<Options>();
  const Command command = app.subcommand(
      "shaders", "Write the module's shaders for other APIs, with their bindings as JSON; needs no device");
  for (Output& output : options->outputs) command.option(output.option, output.folder, output.help);
  command.run([options] { writeAll(*options); });
}

}  // namespace pellucid::harness
