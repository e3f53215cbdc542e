/* Entropy coding of a sequence's levels. See matrices.py. */
#ifndef BSM_MATRICES_H
#define BSM_MATRICES_H

#include "bitstream/entropy/mixing.h"

int64_t code_matrix(Coder coder, Bank bank, Ints2 levels, ConstInts2 reference, int64_t rows, Longs slow);

#endif
