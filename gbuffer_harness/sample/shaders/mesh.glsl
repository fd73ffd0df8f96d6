#ifndef SAMPLE_MESH_GLSL
#define SAMPLE_MESH_GLSL

// DrawConstants of renderer.cpp.
layout(push_constant) uniform Draw {
  mat4 clipFromWorld;
  vec4 baseColor; // a: texels of less alpha are holes; 0: none are
  vec4 surface;   // x: material, y: roughness, z: scale of the normal map, 0: none
} draw;

#endif
