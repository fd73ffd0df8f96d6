# Every file of compute that others include compiles alone, so that a reader finds all of its names in it or in what it includes.
# cmake -DGLSLANG=... -DCOMPUTE=... -DOUT=... -P shaders_alone.cmake
#
# Extensions stand at the top of a shader, before what it includes.
file(GLOB_RECURSE files RELATIVE ${COMPUTE} ${COMPUTE}/*.glsl)
list(LENGTH files count)
if(count LESS 10)
  message(FATAL_ERROR "${COMPUTE}: only ${count} files to include")
endif()
set(failed "")
foreach(file IN LISTS files)
  file(WRITE ${OUT}/alone.comp
    "#version 460\n#extension GL_GOOGLE_include_directive : require\n#extension GL_EXT_samplerless_texture_functions : require\n#include \"${file}\"\nvoid main() {}\n")
  execute_process(COMMAND ${GLSLANG} -V --target-env vulkan1.1 -I${COMPUTE} -o ${OUT}/alone.spv ${OUT}/alone.comp
    RESULT_VARIABLE result OUTPUT_VARIABLE text ERROR_VARIABLE text)
  if(result)
    string(APPEND failed "compute/${file} does not compile alone:\n${text}\n")
  endif()
endforeach()
if(failed)
  message(FATAL_ERROR "${failed}")
endif()
