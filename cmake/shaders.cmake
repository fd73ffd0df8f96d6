# Compiles shaders to SPIR-V arrays inside a target; the extension says the stage. glslang writes the list
# of files each one includes, so editing any .glsl or shared header rebuilds exactly its users.
find_program(PELLUCID_GLSLANG glslangValidator REQUIRED)

# pellucid_decode_include(file variable): the variable becomes the folder that shaders are to include from first, so that
# `file` stands in for compute/frame/gbuffer_decode.glsl; empty without a file.
function(pellucid_decode_include file variable)
  set(${variable} "" PARENT_SCOPE)
  if(NOT file)
    return()
  endif()
  if(NOT EXISTS ${file} OR IS_DIRECTORY ${file})
    message(FATAL_ERROR "PELLUCID_GBUFFER_DECODE is \"${file}\", which is no file")
  endif()
  set(folder ${CMAKE_CURRENT_BINARY_DIR}/decode)
  configure_file(${file} ${folder}/frame/gbuffer_decode.glsl COPYONLY)
  set(${variable} ${folder} PARENT_SCOPE)
endfunction()
pellucid_decode_include("${PELLUCID_GBUFFER_DECODE}" PELLUCID_DECODE_INCLUDE)

# Drivers compile SPIR-V that glslang has inlined and simplified in half the time. Some builds of glslang cannot do so.
if(NOT DEFINED PELLUCID_GLSLANG_OPTIMIZES)
  set(probe ${CMAKE_CURRENT_BINARY_DIR}/glslang_optimizes)
  file(WRITE ${probe}.comp "#version 460\nvoid main() {}\n")
  execute_process(COMMAND ${PELLUCID_GLSLANG} -V -Os -o ${probe}.spv ${probe}.comp
                  RESULT_VARIABLE result OUTPUT_QUIET ERROR_QUIET)
  string(COMPARE EQUAL "${result}" 0 optimizes)
  set(PELLUCID_GLSLANG_OPTIMIZES ${optimizes} CACHE BOOL "glslang optimizes SPIR-V")
endif()

# pellucid_shader(target array source [OPTIMIZED] [definitions...]): array is the C name of the SPIR-V words.
function(pellucid_shader target array source)
  cmake_parse_arguments(PARSE_ARGV 3 arg "OPTIMIZED" "" "")
  set(directory ${CMAKE_CURRENT_BINARY_DIR}/spirv)
  set(header ${directory}/${array}.h)
  file(MAKE_DIRECTORY ${directory})
  set(definitions ${arg_UNPARSED_ARGUMENTS} ${PELLUCID_FILTER_CONSTANT})
  list(TRANSFORM definitions PREPEND -D)
  if(PELLUCID_SHADER_DEBUG)
    set(form -gVS)
  elseif(arg_OPTIMIZED AND PELLUCID_GLSLANG_OPTIMIZES)
    set(form -g0 -Os)
  else()
    set(form -g0)
  endif()
  add_custom_command(
    OUTPUT ${header}
    COMMAND ${PELLUCID_GLSLANG} --quiet -V --target-env vulkan1.1 ${form}
            "$<$<BOOL:${PELLUCID_DECODE_INCLUDE}>:-I${PELLUCID_DECODE_INCLUDE}>"
            -I${PROJECT_SOURCE_DIR}/compute ${definitions}
            --depfile ${header}.d --vn ${array} -o ${header} ${source}
    DEPENDS ${source}
    DEPFILE ${header}.d
    COMMENT "SPIR-V ${array}"
    COMMAND_EXPAND_LISTS
    VERBATIM)
  target_sources(${target} PRIVATE ${header})
  target_include_directories(${target} PRIVATE ${directory})
endfunction()

# One SPIR-V module a pass, two of those that read shadow images; module/src/passes.cpp says what is made of them.
function(pellucid_embed_shaders target)
  set(compute ${PROJECT_SOURCE_DIR}/compute)
  # The translucency runs a fifth longer when optimized: 96 registers in place of 72 on an NVIDIA H100.
  pellucid_shader(${target} kTranslucency ${compute}/translucency/translucency.comp)
  pellucid_shader(${target} kTranslucencyArray ${compute}/translucency/translucency.comp PELLUCID_SHADOW_ARRAY)
  pellucid_shader(${target} kAddHistory ${compute}/translucency/add_history.comp OPTIMIZED)
  pellucid_shader(${target} kBaseLevel ${compute}/diffusion/base_level.comp OPTIMIZED)
  pellucid_shader(${target} kDownsample ${compute}/diffusion/downsample.comp OPTIMIZED)
  pellucid_shader(${target} kCoarseLevels ${compute}/diffusion/coarse_levels.comp OPTIMIZED)
  pellucid_shader(${target} kUpsample ${compute}/diffusion/upsample.comp OPTIMIZED)
  pellucid_shader(${target} kDiffuse ${compute}/diffusion/diffuse.comp OPTIMIZED)
  pellucid_shader(${target} kEntryPoints ${compute}/gather/entry_points.comp OPTIMIZED)
  pellucid_shader(${target} kEntryPointsArray ${compute}/gather/entry_points.comp OPTIMIZED PELLUCID_SHADOW_ARRAY)
  pellucid_shader(${target} kProbes ${compute}/gather/probes.comp OPTIMIZED)
  pellucid_shader(${target} kFilterProbes ${compute}/gather/filter_probes.comp OPTIMIZED)
endfunction()
