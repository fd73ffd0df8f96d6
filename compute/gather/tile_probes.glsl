// The probes around a tile of pixels, in shared memory.
#include "gather/gathered.glsl"

layout(set = 0, binding = PELLUCID_BINDING_PROBES, rgba32ui) uniform readonly uimage2D probesImage;

const int kTile = TILE_SIDE, kThreads = PELLUCID_GATHER_GROUP * PELLUCID_GATHER_GROUP;
const int kMostProbes = (kTile / 2 + 1) * (kTile / 2 + 1); // around all pixels

shared vec4 probePlanes[kMostProbes]; // see tangentPlane
shared uvec4 probes[kMostProbes];     // as the image, later as probeOf has them
shared uint someLight;                // kSome* of all

ivec2 tileStart() { return (ivec2(frame.rect.xy) / kTile + ivec2(gl_WorkGroupID.xy)) * kTile; }

// Probes of a row.
int probeRow(int side) { return (kTile >> shiftOf(side)) + 1; }

ivec2 cellOfProbe(int index, int side) {
  int y = side == 2 ? index / (kTile / 2 + 1) : index / (kTile / 4 + 1); // divisions by constants
  return (tileStart() >> shiftOf(side)) + ivec2(index - y * probeRow(side), y);
}

// Loads all probes as they are. Returns kSome* of the invocation's.
uint loadProbes(int index, int side) {
  int count = probeRow(side) * probeRow(side);
  ivec4 cells = cellsOf(frame.rect, side);
  uint some = 0u;
  [[dont_unroll]] for (int i = index; i < count; i += kThreads) {
    ivec2 cell = cellOfProbe(i, side);
    uvec4 bits = contains(cells, cell) ? imageLoad(probesImage, cell) : kNoProbe;
    probes[i] = bits;
    some |= kindsOfLight(bits);
  }
  return some;
}

// Unpacks all probes, between two barriers.
void unpackProbes(int index, int side) {
  int count = probeRow(side) * probeRow(side);
  [[dont_unroll]] for (int i = index; i < count; i += kThreads) {
    Probe p = unpackProbe(probes[i]);
    probePlanes[i] = tangentPlane(p, pixelInCell(cellOfProbe(i, side), side, p.index), tileStart());
    probes[i] = uvec4(packLight(p.added, p.convexity), p.material);
  }
}

uvec4 probeOf(ivec2 cell, ivec2 pixel, float front, out float off) {
  int side = int(pass.value.x);
  ivec2 place = cell - (tileStart() >> shiftOf(side));
  int at = place.y * probeRow(side) + place.x;
  vec4 plane = probePlanes[at];
  off = (front - plane.x - dot(plane.yz, vec2(pixel - tileStart()))) * plane.w;
  return probes[at];
}
