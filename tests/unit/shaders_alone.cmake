# Every file of compute that others include compiles alone, so that a reader finds all of its names in it or in what it includes.
# cmake -DGLSLANG=... -DCOMPUTE=... -DOUT=... -P shaders_alone.cmake
#
# Extensions stand at the top of a shader, before what it includes. The exceptions are of translucency/transmission.glsl, which shaders of any stage include after they declared FrameConstants
# frame among their own bindings, as its top says.
set(exceptions frame/flags.glsl frame/light_tables.glsl translucency/ambient.glsl translucency/transmission.glsl)
file(GLOB_RECURSE files RELATIVE ${COMPUTE} ${COMPUTE}/*.glsl)
list(LENGTH files count)
if(count LESS 20)
  message(FATAL_ERROR "${COMPUTE}: only ${count} files to include")
endif()
set(failed "")
foreach(file IN LISTS files)
  file(WRITE ${OUT}/alone.comp
    "#version 460\n#extension GL_GOOGLE_include_directive : require\n#extension GL_EXT_samplerless_texture_functions : require\n#include \"${file}\"\nvoid main() {}\n")
  execute_process(COMMAND ${GLSLANG} -V --target-env vulkan1.1 -I${COMPUTE} -o ${OUT}/alone.spv ${OUT}/alone.comp
    RESULT_VARIABLE result OUTPUT_VARIABLE text ERROR_VARIABLE text)
  list(FIND exceptions ${file} excepted)
  if(result AND excepted EQUAL -1)
    string(APPEND failed "compute/${file} does not compile alone:\n${text}\n")
  elseif(NOT result AND NOT excepted EQUAL -1)
    string(APPEND failed "compute/${file} compiles alone and is no exception any more\n")
  endif()
endforeach()
if(failed)
  message(FATAL_ERROR "${failed}")
endif()
