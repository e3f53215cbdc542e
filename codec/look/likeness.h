/* See likeness.c. */
#ifndef BSM_LOOK_LIKENESS_H
#define BSM_LOOK_LIKENESS_H
#include "bitstream/kernel.h"

int64_t likeness(ConstSingles2 first, ConstSingles2 second, ConstSingles wide, ConstSingles narrow, double visible,
                 double plain, Singles2 scratch, Doubles sums, Singles2 map);

#endif
