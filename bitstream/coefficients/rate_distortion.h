/* Choosing levels by what they cost. See rate_distortion.py. */
#ifndef BSM_RATE_DISTORTION_H
#define BSM_RATE_DISTORTION_H

#include "bitstream/coefficients/levels.h"

int64_t search_levels(Bank bank, Past past, ConstInts2 expectations, ConstLongs2 targets, double price,
    ConstLongs costs, Ints2 ways, Bytes2 origins, Ints2 levels, Doubles kept);

#endif
