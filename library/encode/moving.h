/* Frames that share their faces, as a sequence (encoder only; specification, S). */
#pragma once

#include "library/encode/rounding.h"
#include "library/encode/writer.h"

/* Payloads of sections, one behind the other, and where each ends: blocks of the first frame, then GOPs. */
typedef struct {
    Header header;
    Buffer bytes;
    Longs ends;
    uint32_t sum;    /* of decoded positions */
    double farthest; /* the largest error of a coordinate */
} Motion;

/* Code frames so that no coordinate is off by more than `bound`. Their vertices and `faces` are in the order of
 * coding. */
bool code_motion(Writer *writer, ConstInts2 faces, ConstDoubles2 frames, double bound, Motion *motion);
void give_motion(Motion *motion);
