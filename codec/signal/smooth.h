#ifndef BSM_SMOOTH_H
#define BSM_SMOOTH_H

#include "bitstream/kernel.h"

void apply_powers(ConstInts offsets, ConstInts neighbours, Doubles terms, int64_t degree);
void combine_powers(ConstDoubles2 positions, ConstDoubles terms, ConstDoubles weights, Doubles2 smoothed);
int64_t smooth_all(ConstInts offsets, ConstInts neighbours, ConstDoubles2 positions, ConstDoubles weights,
                   Doubles scratch, Doubles2 smoothed);
int64_t find_rings(ConstInts offsets, ConstInts neighbours, Ints number, ConstInts vertices, Ints rows, Longs starts);
void filter_rows(ConstInts offsets, ConstInts neighbours, ConstInts number, ConstDoubles2 positions, ConstDoubles weights,
                 ConstInts rows, ConstLongs starts, Doubles2 current, Doubles2 following, Doubles2 smoothed);

#endif
