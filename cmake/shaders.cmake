# Compiles compute/passes/*.comp to SPIR-V arrays inside a target. glslang writes the list of files
# each variant includes, so editing any .glsl or shared header rebuilds exactly its users.
find_program(PELLUCID_GLSLANG glslangValidator REQUIRED)

# pellucid_shader(target array pass [definitions...]): array is the C name of the SPIR-V words.
function(pellucid_shader target array pass)
  set(source ${PROJECT_SOURCE_DIR}/compute/passes/${pass}.comp)
  set(directory ${CMAKE_CURRENT_BINARY_DIR}/spirv)
  set(header ${directory}/${array}.h)
  file(MAKE_DIRECTORY ${directory})
  set(definitions ${ARGN})
  list(TRANSFORM definitions PREPEND -D)
  add_custom_command(
    OUTPUT ${header}
    COMMAND ${PELLUCID_GLSLANG} --quiet -V --target-env vulkan1.1 -S comp
            $<IF:$<BOOL:${PELLUCID_SHADER_DEBUG}>,-gVS,-g0>
            -I${PROJECT_SOURCE_DIR}/compute ${definitions}
            --depfile ${header}.d --vn ${array} -o ${header} ${source}
    DEPENDS ${source}
    DEPFILE ${header}.d
    COMMENT "SPIR-V ${array}"
    VERBATIM)
  target_sources(${target} PRIVATE ${header})
  target_include_directories(${target} PRIVATE ${directory})
endfunction()

function(pellucid_embed_shaders target)
  foreach(bits 16 32)
    set(format FORMAT=rgba${bits}f)
    pellucid_shader(${target} kTranslucency${bits}f translucency ${format})
    pellucid_shader(${target} kDebug${bits}f translucency ${format} DEBUG_VIEWS)
    pellucid_shader(${target} kDiffuse${bits}f diffuse ${format})
  endforeach()
endfunction()
