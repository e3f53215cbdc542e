/* What frames are predicted from, and how they are made of what was coded. */
#pragma once

#include "bitstream/kernel.h"

enum { LARGEST_LEVEL = (1 << 23) - 1 }; /* that is coded */

void learn_around(ConstDoubles2 known, ConstDoubles2 field, Doubles2 moments, double step, Doubles mean, Doubles row);
void follow_rows(ConstDoubles2 known, ConstInts2 levels, Doubles2 decoded, Doubles2 moments, double step,
    Doubles2 factor, Doubles row, Doubles expected);
void search_rows(ConstDoubles2 known, ConstDoubles2 targets, ConstInts2 reference, int64_t lead, int64_t stair,
    Ints2 levels, Doubles2 decoded, Doubles2 moments, double step, Doubles2 factor, Doubles row,
    Doubles2 expected, Doubles2 values, Ints2 ways, Bytes2 origins, Longs slow);
/* BENDING: the columns that GOPs know of positions about a part: they, their squares and their cubes (S 3.7).
 * INHERITED: components of a GOP that those of the next one are predicted from: motion is repeated in other mixtures.
 * BATCH: frames that are made at a time, as many as a vector has numbers.
 * LAG: how far before the latest frame those are that help to predict the next ones, of those that are kept (S 7.2).
 * TRACK_MEMORY: bytes of a number of a vertex in the first frame of an attribute that moves.
 * SPARE_MEMORY: bytes that decoders keep no dictionary in, though they are granted. */
enum { BENDING = 19, INHERITED = 24, BATCH = 8, LAGS = 8, LEAST_KEPT = 2, MOST_KEPT = 64,
    POSITIONS_KEPT = 1 << 19, TRACK_MEMORY = 40, SPARE_MEMORY = 1 << 22 };
static const int LAG[LAGS] = {1, 2, 3, 5, 8, 13, 21, 34};
/* 2^(-q / 4). */
static const double QUARTERS[4] = {1.0, 0.8408964152537145, 0.7071067811865476, 0.5946035575013605};
/* How many decoded frames low-delay frames may refer to; attributes refer to LEAST_KEPT. */
INLINE int64_t frames_kept(int64_t vertices) {
    return least(MOST_KEPT, largest(LEAST_KEPT, POSITIONS_KEPT / vertices));
}
int64_t ISA(show_frames)(ConstDoubles2 field, int64_t first, ConstDoubles2 weights, Doubles2 frames);
int64_t ISA(turn_columns)(Doubles2 free, Doubles vector, Doubles shares);
