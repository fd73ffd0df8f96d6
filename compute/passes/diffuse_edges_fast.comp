// Edges summed fast where gathered light is added to them, which the resolve that sums them otherwise does not know yet.
#version 460
#extension GL_EXT_control_flow_attributes : require
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require

#define GROUP_SIDE PELLUCID_EDGES_GROUP
#include "passes/resolved.glsl"
#include "passes/shared_points.glsl"

layout(set = 0, binding = PELLUCID_BINDING_KERNELS) readonly buffer Kernels { KernelConstants kernels[]; };

const int kSources = PELLUCID_FAST_EDGES_SOURCES;
shared uvec4 places[kSources];
shared uvec2 colors[kSources];
shared float depths[kSources];

#include "passes/fast_edges.glsl"

bool sums(ivec2 texel) { return isSummed(texelFetch(pyramidImage, sharesPlace(texel), 0)); }

#include "passes/fast_edges_tiles.glsl"

void main() {
  if (texelFetch(pyramidImage, summedPlace(), 0).x != 0u)
    sumTiles(gl_WorkGroupID.x, gl_NumWorkGroups.x, pass.value.y, pass.value.w != 0u);
}
