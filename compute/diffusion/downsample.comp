// The two levels of the diffusion pyramid after level pass.value.x. A texel takes the nearest of the four surfaces under
// it and averages those of 4 x 4 texels that lie on it. A group makes 7 x 7 texels of the second level and, before them, the
// 16 x 16 of the first that they need: one an invocation.
#version 460
#extension GL_EXT_control_flow_attributes : require
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require

#define GROUP_SIDE PELLUCID_DOWNSAMPLE_GROUP
#include "diffusion/pyramid.glsl"

layout(set = 0, binding = PELLUCID_BINDING_PYRAMID) uniform utexture2D pyramidImage;

#include "frame/group_order.glsl"

const uint kFirstLevel = 1u; // of the pyramid
const uint kInvocations = uint(PELLUCID_DOWNSAMPLE_GROUP * PELLUCID_DOWNSAMPLE_GROUP);
// Sides of what a tile needs of the level before, and of its input.
const int kFirst = PELLUCID_DOWNSAMPLE_GROUP, kInput = 2 * kFirst + 2;
// Rows of the input that the invocations load at a time, and how often.
const int kLoadRows = int(kInvocations) / kInput, kLoads = (kInput + kLoadRows - 1) / kLoadRows;
// The input and, once that has been used, the first level: as many groups run at a time as these fit into a
// processor. Slopes are not needed.
shared uvec2 colors[kInput * kInput]; // and mass, material and plane, as packed
shared float depths[kInput * kInput];
shared uint anySurface; // in the input

#include "diffusion/downsampled.glsl"

// True where a texel and all around it are full and lie on one plane. `at`: not in the outermost rows and columns.
bool isFlatAround(uvec4 bits, ivec2 at, uint level) {
  float depth = uintBitsToFloat(bits.z), most = 0.0;
  vec2 size = texelSize(depth, level), slope = unpackHalf2x16(bits.w);
  uint different = 0u;
  for (int y = -1; y <= 1; ++y)
    for (int x = -1; x <= 1; ++x) {
      if (x == 0 && y == 0) continue;
      int index = slot(at + ivec2(x, y), kFirst);
      most = max(most, abs(depths[index] - depth - dot(slope, vec2(x, y) * size)));
      different |= colors[index].y ^ bits.y;
    }
  return isPlane(bits) && (different & kSamePlane) == 0u && most * most < kPlaneOffset / inverseSpread(slope, size);
}

void main() {
  int invocation = int(gl_LocalInvocationIndex);
  if (invocation == 0) anySurface = 0u;
  barrier();
  uint finer = pass.value.x;
  ivec4 rect = levelRect(finer + 1u), lastRect = levelRect(finer + 2u);
  uint list = finer == kFirstLevel ? PELLUCID_LIST_DOWNSAMPLE : PELLUCID_LIST_DOWNSAMPLE_COARSE;
  uvec2 group = workGroupBordersFirst(list);
  bool checks = readsUnwritten(list);
  ivec2 own = lastRect.xy + PELLUCID_DOWNSAMPLE_TILE * ivec2(group), start = 2 * own - 1;
  ivec2 mine = ivec2(invocation % kInput, invocation / kInput), firstLoad = 2 * start - 1 + mine;
  int slotOfMine = slot(mine, kInput);
  ivec4 finerRect = levelRect(finer);
  // How many rows of the level there are from its first one on, in this column and where the invocation has a row.
  bool loads = mine.y < kLoadRows && firstLoad.x >= finerRect.x && firstLoad.x < finerRect.z;
  uint rows = loads ? uint(finerRect.w - finerRect.y) : 0u, row = uint(firstLoad.y - finerRect.y);
  // All loads before the first is used, so that their latencies overlap.
  bool written[kLoads];
  [[unroll]] for (int j = 0; j < kLoads; ++j) {
    ivec2 pixel = (firstLoad + ivec2(0, j * kLoadRows)) << finer;
    written[j] = row + uint(j * kLoadRows) < rows;
    if (checks) written[j] = written[j] && (finer == kFirstLevel ? isInCell(pixel) : isNearMaterial(pixel));
  }
  uvec4 loaded[kLoads];
  [[unroll]] for (int j = 0; j < kLoads; ++j)
    loaded[j] = written[j]
                    ? texelFetch(pyramidImage, inAtlas(finer, firstLoad + ivec2(0, j * kLoadRows)), 0)
                    : uvec4(0u);
  [[unroll]] for (int j = 0; j < kLoads; ++j)
    if (mine.y < kLoadRows && mine.y + j * kLoadRows < kInput) {
      if (loaded[j].y >> 16 != 0u) anySurface = 1u;
      colors[slotOfMine + j * kLoadRows * kInput] = loaded[j].xy;
      depths[slotOfMine + j * kLoadRows * kInput] = uintBitsToFloat(loaded[j].z);
    }
  barrier();
  ivec2 at = ivec2(gl_LocalInvocationID.xy), texel = start + at;
  bool inside = contains(rect, texel);
  // All invocations agree; texels of nothing are nothing.
  bool some = anySurface != 0u;
  uvec4 bits = uvec4(0u);
  if (some && inside) bits = downsampled(finer, texel, 2 * at.y * kInput + at.x, kInput, 16);
  barrier();
  colors[slot(at, kFirst)] = bits.xy;
  depths[slot(at, kFirst)] = uintBitsToFloat(bits.z);
  barrier();
  // The outer ones are the groups' beside.
  if (inside && all(greaterThan(at, ivec2(0))) && all(lessThan(at, ivec2(kFirst - 1)))) {
    if (finer == 1u && isFlatAround(bits, at, finer + 1u)) bits.x |= kFlat;
    writeLevel(finer + 1u, texel, bits);
  }
  at = ivec2(invocation % PELLUCID_DOWNSAMPLE_TILE, invocation / PELLUCID_DOWNSAMPLE_TILE);
  texel = own + at;
  if (at.y < PELLUCID_DOWNSAMPLE_TILE && contains(lastRect, texel))
    writeLevel(finer + 2u, texel, some ? downsampled(finer + 1u, texel, 2 * at.y * kFirst + at.x, kFirst, 16) : uvec4(0u));
}
