/* Eight exponentials at a time, by additions and products alone: the same to the last bit on every processor. */
#ifndef BSM_DENOISE_EXPONENTIAL_H
#define BSM_DENOISE_EXPONENTIAL_H

#include "bitstream/kernel.h"

enum { EIGHT = 8 };
typedef double Eight __attribute__((vector_size(64)));
typedef int64_t EightLongs __attribute__((vector_size(64)));

/* exp(x) to 2e-11 of itself, for x of at most 0; below -700 what exp(-700) is, 1e-304. */
INLINE Eight exponentials(Eight x) {
    EightLongs above = x > -700.0;
    Eight lowest = {0.0};
    lowest -= 700.0;
    x = (Eight)(((EightLongs)x & above) | ((EightLongs)lowest & ~above));
    /* 1.5 * 2^52: the sum has the nearest whole number of halvings in its last bits. */
    Eight shifted = x * 1.4426950408889634 + 6755399441055744.0;
    Eight whole = shifted - 6755399441055744.0;
    Eight rest = (x - whole * 0.693147180369123816490) - whole * 1.90821492927058770002e-10;
    Eight sum = rest * (1.0 / 40320.0) + 1.0 / 5040.0;
    sum = sum * rest + 1.0 / 720.0;
    sum = sum * rest + 1.0 / 120.0;
    sum = sum * rest + 1.0 / 24.0;
    sum = sum * rest + 1.0 / 6.0;
    sum = sum * rest + 0.5;
    sum = sum * rest + 1.0;
    sum = sum * rest + 1.0;
    return (Eight)((EightLongs)sum + ((EightLongs)shifted << 52));
}

#endif
