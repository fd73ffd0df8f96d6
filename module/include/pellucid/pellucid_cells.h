/* Cells with material that the caller found: an engine that knows where its materials are saves the pass that looks
 * for them.
 *
 * With frame.indirectDispatches = PELLUCID_INDIRECT_CELLS the plan has no "find cells". For each frame, the caller
 * writes words into one of the transients before the recorded commands run:
 * - blocks of PELLUCID_CELL_BLOCK_PIXELS a side cover the rect, row by row from firstPixel on. Block (x, y) has the
 *   PELLUCID_CELL_BLOCK_WORDS words from PELLUCID_CELL_BLOCK_WORDS * (y * blocks[0] + x) on. Word w is texel
 *   (w % PELLUCID_CELL_IMAGE_COLUMNS, w / PELLUCID_CELL_IMAGE_COLUMNS) of the image. The words of all blocks are written;
 * - words 0 and 1 of a block have a bit for each cell of PELLUCID_CELL_PIXELS a side: bit 8 * (row % 4) + column of word
 *   row / 4, for rows and columns 0..7. The bit is set where a pixel of the rect has a material;
 * - words 2 and 3 are the bits of two floats, the nearest and the farthest planar distance of the surfaces that the
 *   block's pixels with material show, scene units: 0 <= nearest <= farthest <= 1e9. Farthest 0, with any nearest: no
 *   surface. The two words may hold anything where PellucidCells::distances is 0.
 * compute/lib/cell_words.glsl has the places and the bits.
 *
 * Words may say more than there is: more bits, and a wider interval, cost time and change no pixel. Pixels of a cell
 * whose bit is missing may stay unwritten, and gathered light is missing where surfaces lie outside the interval.
 *
 * The image is in VK_IMAGE_LAYOUT_GENERAL, as all transients are, and the recording keeps what it holds. The caller's
 * writes are made visible to PELLUCID_STAGES / PELLUCID_READS | PELLUCID_WRITES. From these writes on, up to
 * PellucidImageNeed::lastDispatch, the image's memory is in use.
 *
 * Writing the constants (pellucidRecordPlan, pellucidRecordViews, pellucidWriteConstants) empties the lists, in place of
 * "find cells". Commands that run again without new constants leave undefined pixels, which neither this library nor
 * Vulkan's validation sees. pellucid.h does not include this header.
 */
#ifndef PELLUCID_CELLS_H
#define PELLUCID_CELLS_H

#include "pellucid.h"

#ifdef __cplusplus
extern "C" {
#endif

enum {
  PELLUCID_CELL_PIXELS = 8,          /* a side of a cell */
  PELLUCID_CELL_BLOCK_PIXELS = 64,   /* a side of a block: 8 x 8 cells */
  PELLUCID_CELL_BLOCK_WORDS = 4,     /* of a block */
  PELLUCID_CELL_IMAGE_COLUMNS = 1024 /* texels of a row of the image */
};

/* The words that a frame takes. */
typedef struct PellucidCells {
  uint32_t transient;     /* index in frame.transients of the image, R32_UINT, and in the needs of pellucidGetImageNeeds */
  uint32_t blocks[2];     /* columns and rows; 0, 0: the frame takes none, and all fields are 0 */
  uint32_t firstPixel[2]; /* of block (0, 0), in pixels of imageExtent; even */
  uint32_t distances;     /* 1: the frame gathers and reads words 2 and 3, 0: it does not */
} PellucidCells;

/* The words to write for this frame, which pellucidBuildPlan takes, too. Frames without PELLUCID_INDIRECT_CELLS take no
 * words. Neither do frames that go without tile lists; the plan's skips say why. Pure: no device, no allocation.
 * INVALID_ARGUMENT for a null pointer; of a frame that is refused, the error that pellucidValidateFrame explains.
 * *cells then stays as it was. */
PELLUCID_API PellucidResult pellucidGetCells(const PellucidFrame* frame, PellucidCells* cells);

#ifdef __cplusplus
}
#endif
#endif
