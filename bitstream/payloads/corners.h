/* What all fields of integers begin with: corners, orders, models (specification, V 1 to V 6). */
#pragma once

#include "bitstream/fields/fields.h"
#include "bitstream/payloads/coding.h"

/* Corners of faces, their partners, and the rank of each vertex, which is its number until it is ordered (V 1). */
bool link_mesh(Context *context, ConstInts2 faces, int64_t vertices, Arena *arena, Arena *scratch, Corners *corners);
bool order_mesh(Corners *corners, Arena *arena, Arena *scratch, Ints *order);
/* Models and learners that have learned nothing (V 4.3, V 6.1). */
MUST_CHECK bool make_value_model(Arena *arena, ValueModel *model, bool of_twins);
MUST_CHECK bool make_learners(Arena *arena, int64_t count, Longs2 *learners);
/* What a kernel of values says of a payload: how many of `count` it has done. */
bool check_chunk_done(Coding *coding, int64_t done, int64_t count);
