#version 460
// Plays an engine that knows where its materials are: a group writes the words of a block, an invocation looks at a cell.
#extension GL_GOOGLE_include_directive : require

#include "frame/gbuffer_decode.glsl"
#include "lib/camera.glsl"
#include "lib/cell_words.glsl"
#include "lib/rect.glsl"

layout(local_size_x = PELLUCID_GROUP_X, local_size_y = PELLUCID_GROUP_Y) in;
layout(set = 0, binding = 0) uniform usampler2D materialImage;
layout(set = 0, binding = 1) uniform sampler2D frontDepthImage;
layout(set = 0, binding = 2, r32ui) uniform writeonly uimage2D destination;
layout(push_constant) uniform Frame {
  ivec4 rect;      // x, y, end x, end y
  vec4 depth;      // as Camera::depth
  uvec4 material;  // x: first bit of the index, y: its bits, z: materials
  uint blockColumns;
  int firstX, firstY; // pixel of block (0, 0)
  uint viewZ;      // 1: depths are planar distances
  uint distances;  // 1: the frame reads them
  uint more;       // 1: bits and distances that the surfaces need not have; 2: all that there are
};

// The words; bits of floats >= 0 compare as the floats do.
shared uint words[PELLUCID_BLOCK_WORDS];

bool hasMaterial(ivec2 pixel) {
  uint index = decodeMaterial(texelFetch(materialImage, pixel, 0)) >> material.x & material.y;
  return index != 0u && index <= material.z;
}

float distanceAt(ivec2 pixel) {
  Camera camera;
  camera.depth = depth;
  camera.range = vec4(-1.0); // no depth that a pixel with material has holds nothing
  float stored = decodeDepth(texelFetch(frontDepthImage, pixel, 0).x);
  return viewZ != 0u ? planarDistanceViewZ(stored) : planarDistance(camera, stored);
}

void main() {
  ivec2 cell = ivec2(gl_LocalInvocationID.xy), place = PELLUCID_BLOCK * ivec2(gl_WorkGroupID.xy) + PELLUCID_CELL * cell;
  uint word = gl_LocalInvocationIndex;
  if (word < uint(PELLUCID_BLOCK_WORDS)) words[word] = word == 2u ? floatBitsToUint(kNoDepth) : 0u;
  barrier();
  // Knuth's hash of the cell's place says which others are there.
  bool some = more == 2u || more == 1u && (uint(place.x * 31 + place.y) * 2654435761u >> 31) != 0u;
  float least = more == 2u ? 0.0 : kNoDepth, most = more == 2u ? kNoDepth : 0.0;
  for (int i = 0; i < PELLUCID_CELL * PELLUCID_CELL; ++i) {
    ivec2 pixel = ivec2(firstX, firstY) + place + ivec2(i % PELLUCID_CELL, i / PELLUCID_CELL);
    if (!contains(rect, pixel) || !hasMaterial(pixel)) continue;
    some = true;
    float distance = distances != 0u ? distanceAt(pixel) : -1.0;
    if (!(distance > 0.0)) continue;
    // Another shader may round otherwise.
    float wider = more == 1u ? 2.0 : 1.0001;
    least = min(least, distance / wider);
    most = max(most, min(distance * wider, kNoDepth));
  }
  if (some) {
    atomicOr(words[wordOfCell(cell)], bitOfCell(cell));
    atomicMin(words[2], floatBitsToUint(least));
    atomicMax(words[3], floatBitsToUint(most));
  }
  barrier();
  if (word >= uint(PELLUCID_BLOCK_WORDS)) return;
  // NaN where words may hold anything.
  uint value = word < 2u || distances != 0u ? words[word] : 0xFFFFFFFFu;
  imageStore(destination, tileWordPlace(firstWordOfBlock(gl_WorkGroupID.xy, blockColumns) + word), uvec4(value));
}
