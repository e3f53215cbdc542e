/* Entropy coding of a sequence's levels. See matrices.py. */
#ifndef BSM_MATRICES_H
#define BSM_MATRICES_H

#include "bitstream/entropy/mixing.h"

enum { PRICED = 6 }; /* magnitudes whose prices are told */

int64_t code_matrix(
    Coder coder, Bank bank, Ints2 levels, ConstInts2 reference, int64_t rows, int64_t lead, int64_t stair, int64_t turn,
    int64_t few, Longs slow);
int64_t price_matrix(Coder coder, Bank bank, Ints2 levels, ConstInts2 reference, int64_t rows, int64_t lead,
    int64_t stair, int64_t turn, int64_t few, Longs slow, ConstLongs costs, Shorts prices);

#endif
