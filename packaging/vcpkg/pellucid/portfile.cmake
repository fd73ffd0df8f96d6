# Builds the tree that contains this port.
get_filename_component(source "${CMAKE_CURRENT_LIST_DIR}/../../.." ABSOLUTE)
vcpkg_check_features(OUT_FEATURE_OPTIONS features FEATURES material PELLUCID_BUILD_MATERIAL)
vcpkg_cmake_configure(SOURCE_PATH "${source}" OPTIONS ${features}
  -DPELLUCID_BUILD_HARNESS=OFF -DPELLUCID_BUILD_TESTS=OFF -DPELLUCID_BUILD_BENCH=OFF -DPELLUCID_WARNINGS_AS_ERRORS=OFF
  "-DPELLUCID_GLSLANG=${CURRENT_HOST_INSTALLED_DIR}/tools/glslang/glslangValidator${VCPKG_HOST_EXECUTABLE_SUFFIX}")
vcpkg_cmake_install()
vcpkg_cmake_config_fixup(CONFIG_PATH lib/cmake/pellucid)
vcpkg_fixup_pkgconfig()
file(REMOVE_RECURSE "${CURRENT_PACKAGES_DIR}/debug/include" "${CURRENT_PACKAGES_DIR}/debug/share")
vcpkg_install_copyright(FILE_LIST "${source}/LICENSE")
