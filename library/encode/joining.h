/* A given mesh as it is coded: one vertex at each position (encoder only). */
#pragma once

#include "library/bsmenc.h"
#include "library/writing.h"

/* Kinds of errors that decoders do not have: those of bsmenc.h. */
#define BSMDEC_UNREACHABLE ((bsmdec_status)BSMENC_UNREACHABLE)
#define BSMDEC_FAULT ((bsmdec_status)BSMENC_FAULT)
#define BSMDEC_STOPPED ((bsmdec_status)BSMENC_STOPPED)

/* A number rounded to single precision. It is volatile because GCC 12, in loops over three numbers, makes vectors of
 * the conversions, and leaves them out. */
INLINE double in_single(double value) {
    volatile float single = (float)value;
    return single;
}

typedef struct {
    int64_t vertices, faces, frames;
    ConstDoubles2 positions; /* of all frames */
    const uint32_t *corners;
} GivenMesh;

/* Numbers are those of joined vertices, by their first appearance in faces that are kept. */
typedef struct {
    Ints index;   /* of each given vertex, -1: in no face that is kept */
    Ints first;   /* the first given vertex of each */
    Ints kept;    /* the given face of each that is kept */
    Ints2 faces;  /* those that are kept */
    int64_t merged, loose, collapsed; /* vertices that are at the place of another one, or in no face; faces left out */
} JoinedMesh;

/* The number of each row of `width` integers: that of an equal row before it, or the next. Returns how many there are,
 * -1 without memory. */
int64_t number_rows(const int64_t *rows, int64_t count, int width, Arena *scratch, Ints numbers);
/* Make one vertex of those at one position in all frames; -0.0 is there where 0.0 is, unless `exact`. With `keep`,
 * faces without area stay. */
bool join_mesh(const GivenMesh *given, bool exact, bool keep, Writer *writer, JoinedMesh *joined);
