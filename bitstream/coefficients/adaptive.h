/* Adaptive coding of quantized coefficients. See adaptive.py. */
#ifndef BSM_ADAPTIVE_H
#define BSM_ADAPTIVE_H

#include "bitstream/coefficients/levels.h"

/* As Python keeps it: what a chain has taught of levels and of numbers of rows; `width` is the largest of these. */
typedef struct {
    Bank bank, rows;
    Past past;
    ConstInts2 expectations;
    Longs missing;
    int64_t width;
} CoefficientModel;

int64_t code_rows(Coder coder, Bank bank, Longs missing, int64_t width, int64_t rows);
int64_t code_block(Coder coder, Bank bank, Past past, ConstInts2 expectations, Ints2 levels);
int64_t code_layers(Coder coder, CoefficientModel model, Ints2 levels, CoefficientModel over, int64_t rows, Ints2 above);

#endif
