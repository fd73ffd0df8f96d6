# Language level and, where Pellucid is not part of another project, warnings of its own targets; never imposed on those who link them.
function(pellucid_target target)
  set_target_properties(${target} PROPERTIES
    CXX_STANDARD 20 CXX_STANDARD_REQUIRED ON CXX_EXTENSIONS OFF POSITION_INDEPENDENT_CODE ON)
  # A clean build of few large translation units takes less than half of the time.
  get_target_property(type ${target} TYPE)
  if(PELLUCID_UNITY_BUILD AND type MATCHES LIBRARY)
    set_target_properties(${target} PROPERTIES UNITY_BUILD ON)
  endif()
  if(NOT PROJECT_IS_TOP_LEVEL AND NOT PELLUCID_WARNINGS_AS_ERRORS)
    return()
  endif()
  if(MSVC)
    target_compile_options(${target} PRIVATE /W4 $<$<BOOL:${PELLUCID_WARNINGS_AS_ERRORS}>:/WX>)
  else()
    target_compile_options(${target} PRIVATE
      -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion
      -Wno-missing-field-initializers # Vulkan structs start with sType and mean zero for the rest
      $<$<BOOL:${PELLUCID_WARNINGS_AS_ERRORS}>:-Werror>)
  endif()
endfunction()

# A library that others link, shared with BUILD_SHARED_LIBS: it exports what has PELLUCID_API alone.
function(pellucid_library target)
  set_target_properties(${target} PROPERTIES
    CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON
    VERSION ${PROJECT_VERSION} SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
  target_compile_definitions(${target} PRIVATE PELLUCID_EXPORTS PUBLIC $<$<BOOL:${BUILD_SHARED_LIBS}>:PELLUCID_SHARED>)
endfunction()
