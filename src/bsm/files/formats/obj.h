/* The lines of an OBJ. */
#pragma once

#include "bitstream/kernel.h"

/* Lines and numbers, in `counts`: of points, texture coordinates and normals, each with the numbers of a line; of faces
 * and their corners; of other lines, of words that are hard to read, and of corners with each kind of reference. */
enum { POINTS, POINT_NUMBERS, TEXCOORDS, TEXCOORD_NUMBERS, NORMALS, NORMAL_NUMBERS, FACES, CORNERS, OTHERS, WORDS,
    WITH_TEXCOORDS, WITH_NORMALS, OBJ_COUNTS };
static const int64_t NO_REFERENCE = INT64_MIN;

typedef struct {
    Doubles2 points, texcoords, normals;
    Longs sizes;                             /* corners of faces */
    Longs point, texcoord, normal;           /* of corners: indices from 0 on, or NO_REFERENCE */
    Longs2 others;                           /* faces before a line, where it begins, where it ends */
    Longs2 words;                            /* table, number in it, where the word begins, where it ends */
} ObjLines;

int64_t scan_obj(ConstBytes text, ConstLongs seen, bool fills, Longs counts, ObjLines lines);
