/* GOPs to frames (specification, S 3.7 to S 7, S 10). */
#pragma once

#include "codec/sequence/gop.h"

bool begin_gops(Gops *gops, Context *context, const Header *header, const Graph *graph, const Blocks *blocks,
    ConstInts2 faces, ConstDoubles2 first_frame, int64_t given, const MovingAttribute *moving, int count,
    Arena *scratch);
/* The orthonormal cosines of T frames: row t, column frequency (S 5.1). */
bool time_cosines(int64_t frames, Arena *arena, Doubles2 *columns);
/* Keep only what a later run of the mesh cannot do without. */
void suspend_gops(Gops *gops);
void end_gops(Gops *gops);
/* Frames are missing here. */
void forget_frames(Gops *gops);
/* After this, frames can be shown. */
bool decode_gop(Gops *gops, const Gop *gop, Arena *scratch);
/* What frame `t` of the GOP is in a track, until the GOP is over. */
bool show_frame(Gops *gops, int64_t t, Arena *scratch, int track, ConstDoubles2 *frame);

#ifdef BSMDEC_WRITES
/* One track, with dictionaries of one that stays, and a history of its own. */
bool copy_gops(const Gops *from, int k, Context *context, Arena *arena, Gops *copy);
/* Write the basis of a field, of which `spectrum` has what is free in it (S 5.2), in steps; then, of one track, the
 * levels of a field over it or of low-delay frames, that is as `wanted`: `gops` goes on from it, and has it. */
bool write_basis(Gops *gops, GopField field, int64_t frames, ConstDoubles2 spectrum, Writing *writing, Arena *scratch,
    Doubles2 *basis);
bool write_gop(Gops *gops, int method, int64_t frames, GopField field, ConstDoubles2 wanted, Writing *writing,
    Arena *scratch);
#endif
