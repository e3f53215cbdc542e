/* What frames are predicted from, and how they are made of what was coded. */
#ifndef BSM_TEMPORAL_H
#define BSM_TEMPORAL_H

#include "bitstream/kernel.h"

void learn_around(ConstDoubles2 known, ConstDoubles2 field, Doubles2 moments, double step, Doubles mean, Doubles row);
void follow_rows(ConstDoubles2 known, ConstInts2 levels, Doubles2 decoded, Doubles2 moments, double step,
    Doubles2 factor, Doubles row, Doubles expected);
void search_rows(ConstDoubles2 known, ConstDoubles2 targets, ConstShorts prices, double weight, Ints2 levels,
    Doubles2 decoded, Doubles2 moments, double step, Doubles2 factor, Doubles row, Doubles2 expected, Doubles2 values,
    Ints2 ways, Bytes2 origins);
/* What GOPs know of positions about a part: they, their squares and their cubes (S 3.7), BENDING columns. */
enum { BENDING = 19 };
void bend_columns(ConstDoubles2 part, ConstDoubles2 positions, Doubles2 columns);
int64_t ISA(show_frames)(ConstDoubles2 field, int64_t first, ConstDoubles2 weights, Doubles2 frames);
int64_t ISA(multiply_matrices)(ConstDoubles2 left, ConstDoubles2 right, Doubles2 result);
int64_t ISA(turn_columns)(Doubles2 free, Doubles vector, Doubles shares);

#endif
