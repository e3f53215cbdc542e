/* Fans that are the same vertex, and faces that repeat a corner. See seams.py. */
#ifndef BSM_SEAMS_H
#define BSM_SEAMS_H

#include "bitstream/entropy/mixing.h"

/* As Python keeps it: an entry per fan, and -1 for what is not there or not known. */
typedef struct {
    Ints vertex, after, before, sibling, latest;
} Seams;

int64_t code_fans(Coder coder, Bank bank, ConstInts known, Seams seams);
int64_t code_degenerate(Coder coder, Ints corners, int64_t count);

#endif
