# The component pellucid_sources of `cmake --install` (./run package): a folder that builds the libraries without glslang, and
# without an installed GLM or Eigen, because it holds the SPIR-V as words and the headers of both.
set(packaged COMPONENT pellucid_sources EXCLUDE_FROM_ALL)
foreach(file CMakeLists.txt README.md NOTICE)
  configure_file(${PROJECT_SOURCE_DIR}/cmake/sources/${file}.in ${CMAKE_CURRENT_BINARY_DIR}/sources/${file} @ONLY)
  install(FILES ${CMAKE_CURRENT_BINARY_DIR}/sources/${file} DESTINATION . ${packaged})
endforeach()
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION . ${packaged})
install(FILES ${PROJECT_SOURCE_DIR}/cmake/pellucid_target.cmake ${PROJECT_SOURCE_DIR}/cmake/vulkan_headers.cmake DESTINATION cmake ${packaged})
install(DIRECTORY include src DESTINATION . ${packaged})
install(DIRECTORY ${CMAKE_CURRENT_BINARY_DIR}/spirv DESTINATION . ${packaged} FILES_MATCHING PATTERN *.h)
foreach(folder lib shared frame translucency multisample)
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/compute/${folder} DESTINATION compute ${packaged})
endforeach()
if(PELLUCID_DECODE_INCLUDE)
  install(FILES ${PELLUCID_DECODE_INCLUDE}/frame/gbuffer_decode.glsl DESTINATION compute/frame ${packaged})
endif()
install(DIRECTORY $<TARGET_PROPERTY:glm::glm,INTERFACE_INCLUDE_DIRECTORIES>/glm DESTINATION third_party ${packaged}
        PATTERN gtc EXCLUDE PATTERN gtx EXCLUDE)
if(TARGET pellucid_material)
  install(DIRECTORY material DESTINATION . ${packaged} PATTERN CMakeLists.txt EXCLUDE)
  set(eigen $<TARGET_PROPERTY:Eigen3::Eigen,INTERFACE_INCLUDE_DIRECTORIES>/Eigen)
  foreach(part Cholesky Core Eigenvalues Geometry Householder Jacobi LU QR SVD) # what the material compiler includes, and what that does
    install(FILES ${eigen}/${part} DESTINATION third_party/Eigen ${packaged})
    install(DIRECTORY ${eigen}/src/${part} DESTINATION third_party/Eigen/src ${packaged})
  endforeach()
  install(DIRECTORY ${eigen}/src/misc ${eigen}/src/plugins DESTINATION third_party/Eigen/src ${packaged}
          PATTERN lapacke* EXCLUDE PATTERN blas.h EXCLUDE)
endif()
