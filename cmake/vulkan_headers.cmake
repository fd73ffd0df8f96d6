# The Vulkan headers: those of the target Vulkan::Headers where the project around has one, of CMake's FindVulkan or of a folder of
# Vulkan-Headers, so that all of a program reads the same; else those that CMake finds.
if(NOT TARGET Vulkan::Headers)
  find_path(PELLUCID_VULKAN_INCLUDE vulkan/vulkan_core.h REQUIRED)
endif()

# Installed packages name no headers: engines have their own.
function(pellucid_vulkan_headers target)
  if(TARGET Vulkan::Headers)
    target_link_libraries(${target} PUBLIC $<BUILD_INTERFACE:Vulkan::Headers>)
  else()
    target_include_directories(${target} SYSTEM PUBLIC $<BUILD_INTERFACE:${PELLUCID_VULKAN_INCLUDE}>)
  endif()
endfunction()
