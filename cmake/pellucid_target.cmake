# Language level and warnings of Pellucid's own targets; never imposed on those who link them.
function(pellucid_target target)
  set_target_properties(${target} PROPERTIES
    CXX_STANDARD 20 CXX_STANDARD_REQUIRED ON CXX_EXTENSIONS OFF POSITION_INDEPENDENT_CODE ON)
  target_compile_options(${target} PRIVATE
    -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion
    -Wno-missing-field-initializers # Vulkan structs start with sType and mean zero for the rest
    $<$<BOOL:${PELLUCID_WARNINGS_AS_ERRORS}>:-Werror>)
endfunction()
