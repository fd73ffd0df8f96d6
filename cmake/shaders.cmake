# Compiles shaders to SPIR-V arrays inside a target; the extension says the stage. glslang writes the list
# of files each variant includes, so editing any .glsl or shared header rebuilds exactly its users.
find_program(PELLUCID_GLSLANG glslangValidator REQUIRED)

# pellucid_shader(target array source [definitions...]): array is the C name of the SPIR-V words.
function(pellucid_shader target array source)
  set(directory ${CMAKE_CURRENT_BINARY_DIR}/spirv)
  set(header ${directory}/${array}.h)
  file(MAKE_DIRECTORY ${directory})
  set(definitions ${ARGN})
  list(TRANSFORM definitions PREPEND -D)
  add_custom_command(
    OUTPUT ${header}
    COMMAND ${PELLUCID_GLSLANG} --quiet -V --target-env vulkan1.1
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
  set(passes ${PROJECT_SOURCE_DIR}/compute/passes)
  foreach(bits 16 32)
    set(format FORMAT=rgba${bits}f)
    if(bits EQUAL 16)
      list(APPEND format HALF)
    endif()
    pellucid_shader(${target} kTranslucency${bits}f ${passes}/translucency.comp ${format})
    pellucid_shader(${target} kGather${bits}f ${passes}/translucency.comp ${format} GATHER)
    pellucid_shader(${target} kDebug${bits}f ${passes}/translucency.comp ${format} DEBUG_VIEWS)
    pellucid_shader(${target} kDiffuse${bits}f ${passes}/diffuse.comp ${format})
    pellucid_shader(${target} kDiffuseCoarse${bits}f ${passes}/diffuse.comp ${format} COARSE)
    pellucid_shader(${target} kDiffuseGather${bits}f ${passes}/diffuse.comp ${format} GATHER)
    pellucid_shader(${target} kDiffuseCoarseGather${bits}f ${passes}/diffuse.comp ${format} COARSE GATHER)
    pellucid_shader(${target} kQuadsAndCopy${bits}f ${passes}/quads.comp ${format} COPY)
    pellucid_shader(${target} kAddHistory${bits}f ${passes}/add_history.comp ${format})
  endforeach()
  pellucid_shader(${target} kQuads ${passes}/quads.comp FORMAT=rgba16f HALF)
  pellucid_shader(${target} kResolve ${passes}/resolve.comp FORMAT=rgba16f HALF)
  pellucid_shader(${target} kReduceAndResolve ${passes}/resolve.comp FORMAT=rgba16f HALF REDUCES)
  pellucid_shader(${target} kReduce ${passes}/reduce.comp FORMAT=rgba16f HALF)
  pellucid_shader(${target} kGatherRecords ${passes}/gather_records.comp FORMAT=rgba16f HALF)
  pellucid_shader(${target} kGatherPoints ${passes}/gather_points.comp FORMAT=rgba16f HALF)
  pellucid_shader(${target} kGatherRecordsDirectional ${passes}/gather_records.comp FORMAT=rgba16f HALF DIRECTIONAL)
  pellucid_shader(${target} kGatherRecordsOneMap ${passes}/gather_records.comp FORMAT=rgba16f HALF DIRECTIONAL ONE_MAP)
  pellucid_shader(${target} kGatherPointsDirectional ${passes}/gather_points.comp FORMAT=rgba16f HALF DIRECTIONAL)
  pellucid_shader(${target} kGatherShare ${passes}/gather_share.comp FORMAT=rgba16f HALF)
endfunction()
