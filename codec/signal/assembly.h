/* Blocks put together to a mesh (specification, M 12). */
#pragma once

#include "codec/signal/chain.h"

typedef struct {
    Blended blend;
    Bytes lost;  /* vertices of blocks that were lost */
    Bytes added; /* blocks that were added */
    bool lossy;
} Assembly;

bool begin_assembly(Assembly *assembly, int64_t vertices, int64_t blocks, Arena *arena);
void add_block(Assembly *assembly, const DecodedBlock *block);
void lose_block(Assembly *assembly, const Blocks *blocks, int64_t index);
/* All positions in BSM units, smoothed; unknown ones are 0. */
bool blend_all(const Assembly *assembly, const Header *header, const Graph *graph, Arena *arena, Arena *scratch,
    Doubles2 *positions);
/* Marks of the vertices that are as the encoder had them, they and those at most `beyond` edges away; no array if all
 * are. */
bool mark_whole(const Assembly *assembly, const Header *header, const Graph *graph, Arena *arena, Arena *scratch,
    int beyond, Bytes *whole);
/* From BSM units to the unit of the mesh, in place (M 12.5). */
bool into_unit(Context *context, const Header *header, Doubles2 positions);
