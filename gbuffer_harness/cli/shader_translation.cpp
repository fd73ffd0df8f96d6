#include "cli/shader_translation.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <spirv_hlsl.hpp>
#include <spirv_msl.hpp>
#include <string_view>
#include <utility>

#include "cli/commands.h"
#include "common/error.h"
#include "common/whole_file.h"

namespace pellucid::harness {

namespace {

using Json = nlohmann::ordered_json;
using spirv_cross::Compiler;
using spirv_cross::Resource;

// Names by the id of a specialization constant; the shaders hold none.
constexpr std::pair<uint32_t, const char*> kConstantNames[] = {
    {0, "debugViews"}, {5, "lightTables"}, {6, "uses"}, {7, "accumulates"}};

std::string constantName(const std::string& pipeline, uint32_t id) {
  for (const auto& [named, name] : kConstantNames)
    if (named == id) return name;
  throw InputError(pipeline, "specialization constant", std::to_string(id) + " has no name");
}

// The pipeline's values in place of the defaults.
Json specialize(Compiler& compiler, const PipelineShader& pipeline) {
  const PellucidShader& shader = pipeline.shader;
  Json constants = Json::array();
  for (const spirv_cross::SpecializationConstant& constant : compiler.get_specialization_constants()) {
    spirv_cross::SPIRConstant& value = compiler.get_constant(constant.id);
    for (uint32_t i = 0; i < shader.constantCount; ++i)
      if (shader.constants[i].id == constant.constant_id) value.m.c[0].r[0].u32 = shader.constants[i].value;
    const std::string name = constantName(pipeline.name, constant.constant_id);
    compiler.set_name(constant.id, name);
    const bool isBool = compiler.get_type(value.constant_type).basetype == spirv_cross::SPIRType::Boolean;
    constants.push_back({{"id", constant.constant_id},
                         {"name", name},
                         {"type", isBool ? "bool" : "uint"},
                         {"value", value.scalar()}});
  }
  std::sort(constants.begin(), constants.end(),
            [](const Json& a, const Json& b) { return a["id"] < b["id"]; });
  return constants;
}

Json workgroupSize(const Compiler& compiler) {
  Json size = Json::array();
  for (uint32_t i = 0; i < 3; ++i)
    size.push_back(compiler.get_execution_mode_argument(spv::ExecutionModeLocalSize, i));
  return size;
}

struct BindingType {
  const char* name;
  bool isBuffer, isWritten;
};

Json describeBinding(Compiler& compiler, const Resource& resource, const BindingType& type,
                     ShaderLanguage language) {
  const uint32_t binding = compiler.get_decoration(resource.id, spv::DecorationBinding);
  const std::string name = pellucidBindingName(binding), number = std::to_string(binding);
  compiler.set_name(resource.id, name);
  if (type.isBuffer) compiler.set_name(resource.base_type_id, name + "Block");
  Json json = {{"binding", binding}, {"type", type.name}, {"name", name}};
  if (language == ShaderLanguage::Hlsl)
    json["register"] = (type.isWritten                                   ? "u"
                        : type.name == std::string_view("uniformBuffer") ? "b"
                                                                         : "t") +
                       number;
  else
    json["argument"] = (type.isBuffer ? "buffer(" : "texture(") + number + ")";
  return json;
}

// Bindings that the shader accesses, by number.
Json describeBindings(Compiler& compiler, ShaderLanguage language) {
  const spirv_cross::ShaderResources all =
      compiler.get_shader_resources(compiler.get_active_interface_variables());
  Json bindings = Json::array();
  const auto add = [&](const Resource& resource, const BindingType& type) {
    bindings.push_back(describeBinding(compiler, resource, type, language));
  };
  for (const Resource& r : all.uniform_buffers) add(r, {"uniformBuffer", true, false});
  for (const Resource& r : all.storage_buffers) {
    const bool isRead = compiler.get_buffer_block_flags(r.id).get(spv::DecorationNonWritable);
    add(r, {isRead ? "readOnlyStorageBuffer" : "storageBuffer", true, !isRead});
  }
  for (const Resource& r : all.separate_images) add(r, {"sampledImage", false, false});
  for (const Resource& r : all.storage_images) add(r, {"storageImage", false, true});
  std::sort(bindings.begin(), bindings.end(),
            [](const Json& a, const Json& b) { return a["binding"] < b["binding"]; });
  return bindings;
}

// Describes the shader and readies `compiler`, whose names the translation then has.
Json describe(Compiler& compiler, const PipelineShader& shader, ShaderLanguage language) {
  compiler.rename_entry_point("main", shader.name, spv::ExecutionModelGLCompute);
  compiler.set_enabled_interface_variables(compiler.get_active_interface_variables());
  const Json constants = specialize(compiler, shader);
  const bool pushes =
      !compiler.get_shader_resources(compiler.get_active_interface_variables()).push_constant_buffers.empty();
  return {{"pipeline", shader.pipeline},
          {"name", pellucidPipelineName(shader.pipeline)},
          {"shadowViewType", shader.shadowViewType},
          {"entryPoint", shader.name},
          {"workgroupSize", workgroupSize(compiler)},
          {"specializationConstants", constants},
          {"pushConstantBytes", pushes ? PELLUCID_PUSH_CONSTANT_BYTES : 0},
          {"bindings", describeBindings(compiler, language)}};
}

const char* languageName(ShaderLanguage language) { return language == ShaderLanguage::Hlsl ? "HLSL" : "MSL"; }

TranslatedShader toHlsl(const PipelineShader& shader) {
  spirv_cross::CompilerHLSL compiler(shader.shader.words, shader.shader.wordCount);
  Json description = describe(compiler, shader, ShaderLanguage::Hlsl);
  spirv_cross::CompilerHLSL::Options options;
  options.shader_model = 60;
  options.use_entry_point_name = true;
  compiler.set_hlsl_options(options);
  compiler.set_root_constant_layouts({{0, PELLUCID_PUSH_CONSTANT_BYTES, 0, kHlslConstantSpace}});
  const spirv_cross::VariableID groups = compiler.remap_num_workgroups_builtin();
  if (groups) {
    compiler.set_decoration(groups, spv::DecorationDescriptorSet, kHlslConstantSpace);
    compiler.set_decoration(groups, spv::DecorationBinding, 1);
    auto enabled = compiler.get_active_interface_variables();
    enabled.insert(groups);
    compiler.set_enabled_interface_variables(std::move(enabled));
  }
  description["readsGroups"] = groups != 0;
  return {compiler.compile(), description};
}

TranslatedShader toMsl(const PipelineShader& shader) {
  spirv_cross::CompilerMSL compiler(shader.shader.words, shader.shader.wordCount);
  const Json description = describe(compiler, shader, ShaderLanguage::Msl);
  spirv_cross::CompilerMSL::Options options;
  options.set_msl_version(2, 3);
  options.enable_decoration_binding = true;
  compiler.set_msl_options(options);
  spirv_cross::MSLResourceBinding push;
  push.stage = spv::ExecutionModelGLCompute;
  push.desc_set = spirv_cross::kPushConstDescSet;
  push.binding = spirv_cross::kPushConstBinding;
  push.count = 1;
  push.msl_buffer = kMslPushConstantBuffer;
  compiler.add_msl_resource_binding(push);
  return {compiler.compile(), description};
}

}  // namespace

std::vector<PipelineShader> pipelineShaders() {
  std::vector<PipelineShader> shaders;
  for (uint32_t i = 0; i < pellucidGetPipelineCount(); ++i) {
    PellucidShader plain, array;
    pellucidGetShader(i, VK_IMAGE_VIEW_TYPE_2D, VK_FORMAT_UNDEFINED, nullptr, &plain);
    pellucidGetShader(i, VK_IMAGE_VIEW_TYPE_2D_ARRAY, VK_FORMAT_UNDEFINED, nullptr, &array);
    const std::string name = pellucidPipelineName(i);
    const bool same = plain.words == array.words;
    shaders.push_back({name, same ? "any" : "2D", i, plain});
    if (!same) shaders.push_back({name + "_array", "2D_ARRAY", i, array});
  }
  return shaders;
}

TranslatedShader translateShader(const PipelineShader& shader, ShaderLanguage language) {
  try {
    return language == ShaderLanguage::Hlsl ? toHlsl(shader) : toMsl(shader);
  } catch (const spirv_cross::CompilerError& error) {
    throw InputError("pipeline " + shader.name, languageName(language), error.what());
  }
}

namespace {

struct Output {
  ShaderLanguage language;
  const char *option, *help, *extension, *index, *target;
  std::string folder = {};  // empty: not asked for
};

struct Options {
  Output outputs[2] = {
      {ShaderLanguage::Hlsl, "--hlsl", "folder for HLSL and hlsl.json", ".hlsl", "hlsl.json", "Shader Model 6.0"},
      {ShaderLanguage::Msl, "--msl", "folder for the Metal Shading Language and msl.json", ".metal", "msl.json",
       "Metal 2.3"}};
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
  if (!any) throw UsageError("shaders: there is nothing to write without --hlsl or --msl DIR");
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
