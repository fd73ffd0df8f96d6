// Structs, binding numbers and group sizes, read by C++ and GLSL alike. All members have 16 bytes, so
// std140, std430 and C++ agree without padding; structs for std430 alone may hold arrays of 8-byte members. View space is
// the camera's; lengths in scene units unless said otherwise.
#ifndef PELLUCID_SHARED_H
#define PELLUCID_SHARED_H

#ifdef __cplusplus
#include <glm/mat4x4.hpp>
#include <glm/vec4.hpp>
#endif

// Sides of workgroups and of what a group does.
#define PELLUCID_GROUP_X 8        // of groups without a side of their own
#define PELLUCID_BLOCK 64         // pixels of a block, in which the image is divided from its first pixel on
#define PELLUCID_BLOCK_BORDER 8   // pixels beyond the rect that blocks reach: a texel of level 3
#define PELLUCID_CELL 8           // pixels of a cell: a block has a bit for each of its 8 x 8
#define PELLUCID_BLOCK_GROUP 16   // side of the groups that do one block each
#define PELLUCID_DOWNSAMPLE_COLUMNS 8 // texels of level 3 that a group makes
#define PELLUCID_DOWNSAMPLE_ROWS 4
#define PELLUCID_COARSE_COLUMNS 2 // texels of level 7
#define PELLUCID_COARSE_ROWS 1
#define PELLUCID_DIFFUSE_COLUMNS 32 // pixels that a group diffuses
#define PELLUCID_DIFFUSE_ROWS 16
#define PELLUCID_ENTRY_POINTS_GROUP 16
#define PELLUCID_ENTRY_LEVELS 4
#define PELLUCID_PROBES_GROUP 8   // cells of the gather
#define PELLUCID_FILTER_GROUP 16  // cells of the gather

// Bindings of set 0: number, name in the shaders' sources, type. A number is one binding in all passes, each of which declares
// those that it reads or writes (module/src/passes.cpp).
#define PELLUCID_BINDINGS(X) \
  X(PELLUCID_BINDING_FRAME, 0, frame, kUniforms) \
  X(PELLUCID_BINDING_LIGHTS, 1, lights, kUniforms) \
  X(PELLUCID_BINDING_SHADOWS, 2, shadows, kUniforms) \
  X(PELLUCID_BINDING_GATHER_MAPS, 3, gatherMaps, kUniforms) \
  X(PELLUCID_BINDING_MATERIALS, 4, materials, kStorage) \
  X(PELLUCID_BINDING_KERNELS, 5, kernels, kStorage) \
  X(PELLUCID_BINDING_ENTRY_MAPS, 6, entryMaps, kStorage) \
  X(PELLUCID_BINDING_LISTS, 7, lists, kStorage) /* BlockLists */ \
  X(PELLUCID_BINDING_FRONT_DEPTH, 8, frontDepthImage, kSampled) \
  X(PELLUCID_BINDING_BACK_DEPTH, 9, backDepthImage, kSampled) \
  X(PELLUCID_BINDING_ALBEDO, 10, albedoImage, kSampled) \
  X(PELLUCID_BINDING_MATERIAL, 11, materialImage, kSampled) \
  X(PELLUCID_BINDING_SOURCE, 12, sourceImage, kSampled) \
  X(PELLUCID_BINDING_HELD, 13, heldImage, kSampled) /* the output's content before the frame */ \
  X(PELLUCID_BINDING_HISTORY, 14, historyImage, kSampled) \
  X(PELLUCID_BINDING_PYRAMID, 15, pyramidImage, kSampled) /* the level or levels that are read */ \
  X(PELLUCID_BINDING_COARSER_LEVELS, 16, coarserLevelsImage, kSampled) /* of upsampling: levels 4 to 7 */ \
  X(PELLUCID_BINDING_ENTRY_POINTS, 17, entriesImage, kSampled) \
  X(PELLUCID_BINDING_FOUND_PROBES, 18, foundImage, kSampled) \
  X(PELLUCID_BINDING_FILTERED_PROBES, 19, filteredProbesImage, kSampled) \
  X(PELLUCID_BINDING_DESTINATION, 20, destinationImage, kStored) \
  X(PELLUCID_BINDING_LEVELS, 21, levelsDestination, kStored) /* of the pyramid, written */ \
  X(PELLUCID_BINDING_ENTRIES_DESTINATION, 22, entriesDestination, kStored) \
  X(PELLUCID_BINDING_PROBES_DESTINATION, 23, probesImage, kStored) \
  X(PELLUCID_BINDING_FILTERED_DESTINATION, 24, sharedImage, kStored) \
  X(PELLUCID_BINDING_BLOCKS, 25, blocksImage, kStored) /* words of the blocks and lists of them */ \
  X(PELLUCID_BINDING_HIDDEN_IRRADIANCE, 26, hiddenIrradianceImage, kSampled) \
  X(PELLUCID_BINDING_MOTION, 27, motionImage, kSampled) \
  X(PELLUCID_BINDING_SHADOW_IMAGES, 28, shadowImage0, kSampled) /* the last ones: one each for as many shadow images as a pass has */
#ifdef __cplusplus
#define PELLUCID_BINDING_NUMBER(number, value, name, type) number = value,
enum PellucidBindingNumber : unsigned { PELLUCID_BINDINGS(PELLUCID_BINDING_NUMBER) };
#else
#define PELLUCID_BINDING_NUMBER(number, value, name, type) const uint number = value;
PELLUCID_BINDINGS(PELLUCID_BINDING_NUMBER)
#endif
#define PELLUCID_SHADOW_IMAGE_COUNT 8     // 16 sampled images in all, which every device has
#define PELLUCID_ENTRY_IMAGE_COUNT 12     // of the entry points: four maps with exit depth and caster material
#define PELLUCID_BINDING_COUNT (PELLUCID_BINDING_SHADOW_IMAGES + PELLUCID_ENTRY_IMAGE_COUNT)

// Lights and shadow maps of one dispatch are uniform buffers, which are cached apart from what images pass
// through. 16 KiB is what every device binds.
#define PELLUCID_DISPATCH_LIGHTS 128
#define PELLUCID_DISPATCH_SHADOWS 112

// FrameConstants::flags.x
#define PELLUCID_FLAG_BACK_DEPTH 1u
#define PELLUCID_FLAG_BACK_THICKNESS 2u // the image of back depths holds mm
#define PELLUCID_FLAG_ALBEDO 4u
#define PELLUCID_FLAG_FRONT_VIEW_Z 8u
#define PELLUCID_FLAG_BACK_VIEW_Z 16u
#define PELLUCID_FLAG_CAMERA_THICKNESS 32u
#define PELLUCID_FLAG_CONSTANT_VIEW 64u
#define PELLUCID_FLAG_CHORD_THICKNESS 128u
#define PELLUCID_FLAG_CHORD 256u // some light, or a debug view, needs camera-space thickness
#define PELLUCID_FLAG_DIFFUSED 512u // the diffusion spreads the light that the camera sees
#define PELLUCID_FLAG_WIDE_OUTPUT 1024u // 32 bits a channel, which keep what halves round
#define PELLUCID_FLAG_THIN_WALLS 2048u // some material is thin-walled
#define PELLUCID_FLAG_HIDDEN_IRRADIANCE 8192u
#define PELLUCID_FLAG_BODIES 16384u // probes say what bodies return of the diffused irradiance
#define PELLUCID_FLAG_ADDS 4096u // the result is added to what the output holds
#define PELLUCID_FLAG_PACKED_OUTPUT 32768u // B10G11R11: 6, 6 and 5 bits of mantissa

// Specialization constants
#define PELLUCID_CONSTANT_DEBUG_VIEWS 0
#define PELLUCID_CONSTANT_LIGHT_TABLES 5
#define PELLUCID_CONSTANT_KEEPS_PROBES 7
#define PELLUCID_CONSTANT_USES 6 // PellucidUse bits that frames may ask of the pipeline, among them:
#define PELLUCID_SHADER_USE_THIN_WALLS 32u
#define PELLUCID_SHADER_USE_AMBIENT 64u
#define PELLUCID_SHADER_USE_THESIS 128u

// Values of the public enums the shaders branch on; constants.cpp asserts that they agree.
#define PELLUCID_SHADER_LIGHT_DIRECTIONAL 0u
#define PELLUCID_SHADER_LIGHT_SPOT 2u
#define PELLUCID_SHADER_LIGHT_AMBIENT 3u // no PellucidLightType: module/src/lights.h
#define PELLUCID_SHADER_DEPTH_DEVICE 0u
#define PELLUCID_SHADER_DEPTH_VIEW_Z 1u
#define PELLUCID_SHADER_DEPTH_DISTANCE 2u
#define PELLUCID_SHADER_TRANSMITTANCE_EXP2 0u
#define PELLUCID_SHADER_TRANSMITTANCE_SINH_EXP 1u
#define PELLUCID_SHADER_TRANSMITTANCE_LINEAR 4u
#define PELLUCID_SHADER_ANGLE_NORMAL 0u
#define PELLUCID_SHADER_ANGLE_COSINE 1u
#define PELLUCID_SHADER_ANGLE_INVERSE_COSINE 2u
#define PELLUCID_SHADER_ANGLE_POLYNOMIAL 3u
#define PELLUCID_SHADER_DEBUG_THICKNESS 1u
#define PELLUCID_SHADER_DEBUG_TRANSMITTANCE 2u
#define PELLUCID_SHADER_DEBUG_OCCLUSION 3u

// TranslucencyPass::through: the materials that light comes through
#define PELLUCID_LIGHT_ALL 0u
#define PELLUCID_LIGHT_WALLS 1u  // thin-walled ones alone
#define PELLUCID_LIGHT_SOLIDS 2u // all others

// TranslucencyPass::write
#define PELLUCID_WRITE_LAST 1u   // the frame's final write
#define PELLUCID_WRITE_STARTS 2u // of a history, from 0
#define PELLUCID_WRITE_KEEPS 3u  // of a history, on top of its content

#define PELLUCID_GAUSSIANS 8
#define PELLUCID_LIGHT_TABLES 16
#define PELLUCID_LIGHT_ENTRIES 64 // of a light table
#define PELLUCID_GATHER_ENTRIES 64

// The diffusion pyramid's levels are 1..LAST_LEVEL; a texel of the last one is 128 pixels wide.
#define PELLUCID_LAST_LEVEL 7
// KernelConstants::share: levels 2 and 3, and all coarser ones.
#define PELLUCID_SHARE_COARSER 2
#define PELLUCID_SHARE_TABLES 3
#define PELLUCID_SHARE_ENTRIES 128
#define PELLUCID_PIXEL_SHARES 2

#ifdef __cplusplus
namespace pellucid::shared {
using uint = unsigned;
using glm::ivec4;
using glm::mat4;
using glm::uvec2;
using glm::uvec4;
using glm::vec4;
#endif

// The camera as the shaders use it. With s = +1 or -1 the sign of view z in front of the eye, p = s z
// is the planar distance and a pixel's view ray is point(p) = origin + p direction.
struct Camera {
  vec4 rayBase; // pixel (0, 0): direction.xy, origin.xy
  vec4 rayX;    // change per pixel in x
  vec4 rayY;    // change per pixel in y
  vec4 depth;   // A, B, C, D: device depth = (A p + B) / (C p + D)
  vec4 range;   // x: s; y: AD - BC; z: device depth that holds nothing; w: mm per scene unit
};

struct FrameConstants {
  Camera camera;
  uvec4 rect;          // x, y, end x, end y
  ivec4 lattice;       // x, y: the image's first pixel, 0..127; z: pattern of samples of cell 0, 0; w: first row of
                       // the filtered probes in options.history, not 0 with accumulation alone
  ivec4 kept;          // of the earlier frame's probes: x, y: the image's first pixel; z: their first row; w: 0
  vec4 motion;         // x, y: pixels per unit of the motion image; z: factor of the earlier frame's light, 0: none is kept
  uvec4 flags;         // x: PELLUCID_FLAG_*; y: materials; z: debug view; w: angle model
  vec4 anglePolynomial;
  uvec4 marks;         // material values: x: bit without translucency, 0: none; y: their first bit in a word; z: bits of the index
  vec4 filterAndLimit;        // rgb: factor of T; w: largest thickness, mm
  ivec4 level[PELLUCID_LAST_LEVEL + 1]; // xy: where texel (0, 0) of the level lies in its image; of level 0, that
                                        // of the resolved level 2, zw: of its shares
  uvec4 blocks; // x, y: columns and rows that the rect and PELLUCID_BLOCK_BORDER pixels around it touch; z: first word of their lists; w: 1: groups go by lists
  // View ray of planar length 1 along pixels' columns and rows: of pixel (0, 0), changes per pixel in x (xy, zw) and y (xy).
  vec4 facingRay[2];
  vec4 axes; // unit directions of pixels' columns (xy) and rows (zw), view space
  mat4 ambient[3];   // per channel: the form whose value at a normal, 1 is the ambient light's irradiance
  uvec4 lightTables[PELLUCID_LIGHT_TABLES * PELLUCID_LIGHT_ENTRIES / 8]; // entries as halves, the first in the low bits
};

struct LightConstants {
  vec4 position;  // view space; w: 1 / range, 0 unlimited
  vec4 direction; // of travel, view space, unit; w: 1 / range of a distance table
  vec4 radiance;  // color times intensity; w: PELLUCID_LIGHT_TABLES + 1 times the angle table + the distance table; 0: none
  vec4 cone;      // KHR_lights_punctual: x: scale, y: offset of the cosine; z: scale, w: offset of the
                  // minimum dot's (m + x) / (m + 1)
  uvec4 meta;     // x: type; y: first of shadows[]; z: how many; w: 1: they hold back faces
};

struct ShadowConstants {
  mat4 clipFromView; // light clip from camera view space
  vec4 planar;       // dot(planar, (x, 1)): planar distance from the light, for DEPTH_VIEW_Z
  vec4 depth;        // x: perspective: clip z at the light; orthographic: scene units along the
                     // light per clip z or per planar unit; y: side of a texel, scene units; perspective: per unit of
                     // distance; z, w: texels
  vec4 offsets;      // of what is stored. x: constant, y: per steepest step from texel to texel, z: scene units along the
                     // light's ray, w: smallest step
  uvec4 meta;        // x: image, from bit 8 on its layer; y: encoding; z: 1 perspective; w: texel value that holds
                     // nothing (bits)
  uvec4 occluder;    // x: image and layer of the exit depth + 1; y: of the caster's material + 1; 0: none. z: scale of the
                     // material (bits); w: first texel of the tile: x, from bit 16 on y
};

#ifdef __cplusplus
} // namespace pellucid::shared
#endif
#include "pellucid_gather.h"
#ifdef __cplusplus
namespace pellucid::shared {
#endif

struct MaterialConstants {
  vec4 transmittance[3]; // per channel, the model's first four parameters
  vec4 transmittance4;   // rgb: the fifth; w: mm at which no channel lets light through that a half shows
  vec4 inverseReflectance; // rgb: 1/rho; w: 1 / mm at which T falls to half
  uvec4 meta;            // x: model; y: Gaussians; z: 1: thin-walled, EXP2 with rates 0
  vec4 gaussianFalloff[PELLUCID_GAUSSIANS]; // rgb: 1/(2 v), 1/mm^2; 1/v for the printed form
  vec4 gaussianWeight[PELLUCID_GAUSSIANS];  // rgb
  GatherConstants gather;
};

// A profile over the pyramid, at equal steps of log2 of a side in mm.
struct KernelConstants {
  vec4 range; // x: log2 of the first side; y: entries per octave
  vec4 share[PELLUCID_SHARE_TABLES * PELLUCID_SHARE_ENTRIES]; // rgb: which part of the energy at a level and
                                                              // coarser ones the coarser ones have
  // For each side of a pixel: which part of all energy level 2 and coarser ones have, and these and the fine filter of the
  // pixel and its neighbors.
  vec4 pixelShare[PELLUCID_PIXEL_SHARES * PELLUCID_SHARE_ENTRIES];
};

// VkDispatchIndirectCommands of the passes, which do
#define PELLUCID_LIST_DOWNSAMPLE 0u // levels 2 and 3: blocks with material and those beside
#define PELLUCID_LIST_UPSAMPLE 1u   // the same ones
#define PELLUCID_LIST_DIFFUSE 2u    // blocks with material
#define PELLUCID_LIST_PROBES 3u     // the same ones
#define PELLUCID_LIST_FILTER 4u     // the same ones
#define PELLUCID_LIST_COARSE 5u     // levels 4 to 7: all groups, if there is material
#define PELLUCID_LIST_ENTRIES 6u    // groups of entry points within reach of what blocks show
#define PELLUCID_LISTS 7
#define PELLUCID_BLOCK_WORDS 3    // see compute/frame/blocks.glsl
#define PELLUCID_BLOCK_WORDS_SHIFT 10 // log2 of the columns of their image
// Bits of a map's groups of entry points: 64 rows of 64 of level 0, and half as many rows of each coarser level.
#define PELLUCID_ENTRY_GROUP_WORDS 240

// Blocks of an image that goes by lists, at most. Counters of two blocks have a word, see compute/diffusion/list_blocks.glsl.
#define PELLUCID_LISTED_BLOCKS 32768

// As PellucidDispatch::indirectOffset documents for callers.
struct ListCommand {
  uvec4 groups; // x: groups so far; y, z: of the pass; w: of lists of all groups: how many
  uvec4 ran;    // x: groups of the last run
};

// Buffer of the passes that find and list blocks. Blocks' counters and bits of listed groups of entry points follow. Before and after
// a frame all counts and bits are 0, but those of `ran`.
struct BlockLists {
  ListCommand commands[PELLUCID_LISTS];
  uvec4 maps; // x: shadow maps that are gathered from; y: pixels a side of a cell
  vec4 reach; // x: how far from a surface probes look for entry points, scene units
};

// Push constants of the passes, PELLUCID_PUSH_CONSTANT_BYTES at most. `last`: 1 in the dispatch that writes the output.
struct TranslucencyPass { // and debug views
  uint through; // PELLUCID_LIGHT_*
  uint lights;
  uint write; // PELLUCID_WRITE_*
};
struct AddHistoryPass {
  uint last;
};
struct BaseLevelPass {
  uint copies; // 1: pixels go to the destination, too
};
struct CoarseLevelsPass {
  uint columns; // of groups
  uint coarsest;
};
struct UpsamplePass {
  uint coarsest;
};
struct DiffusePass {
  uint spacing; // pixels a side of a cell; 0: the frame has no probes
  uint last;
};
struct EntryPointsPass {
  uint entries; // columns and, from bit 16 on, rows of the entry points of level 0
};
struct ProbesPass {
  uint spacing; // pixels a side of a cell
  uint lights;
  uint entries; // as EntryPointsPass has them; bit 31: light is added to that of an earlier dispatch
  uint samples;
};
struct FilterProbesPass {
  uint spacing; // pixels a side of a cell
};

#ifdef __cplusplus
} // namespace pellucid::shared
#endif

#endif
