/* GOPs to frames (specification, S 3.7 to S 7, S 10). */
#pragma once

#include "codec/sequence/gop.h"

bool begin_gops(Gops *gops, Context *context, const Header *header, const Graph *graph, const Blocks *blocks,
    ConstInts2 faces, ConstDoubles2 first_frame, int64_t given, const MovingAttribute *moving, int count,
    Arena *scratch);
/* Keep only what a later run of the mesh cannot do without. */
void suspend_gops(Gops *gops);
void end_gops(Gops *gops);
/* Frames are missing here. */
void forget_frames(Gops *gops);
/* After this, frames can be shown. */
bool decode_gop(Gops *gops, const Gop *gop, Arena *scratch);
/* What frame `t` of the GOP is in a track, until the GOP is over. */
bool show_frame(Gops *gops, int64_t t, Arena *scratch, int track, ConstDoubles2 *frame);
