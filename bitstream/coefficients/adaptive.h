/* Adaptive coding of quantized coefficients. See adaptive.py. */
#ifndef BSM_ADAPTIVE_H
#define BSM_ADAPTIVE_H

#include "bitstream/coefficients/levels.h"

int64_t code_block(Coder coder, Bank bank, Past past, ConstInts2 expectations, Ints2 levels);

#endif
