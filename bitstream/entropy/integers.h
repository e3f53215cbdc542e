/* Integers as mixed decisions (specification, C 3). */
#ifndef BSM_INTEGERS_H
#define BSM_INTEGERS_H

#include "bitstream/entropy/mixing.h"

enum { SUFFIX_NODES = 24 };

/* Nodes that an integer takes. */
#define UNSIGNED_SPAN(unary) ((unary) + SUFFIX_NODES + 2)
#define SIGNED_SPAN(unary) (UNSIGNED_SPAN(unary) + 2)

/* Code an integer in 0 .. 2^24 - 2 + unary, from `node` on: a unary prefix, then an Exp-Golomb escape (C 3.1). */
SHARED int64_t code_unsigned(RangeCoder *coder, const Mixer *mixer, int inputs, const int64_t *contexts,
    int64_t selector, int unary, int64_t value, int64_t node) {
    for (int k = 0; k < unary; k++)
        if (!code_mixed_bit(coder, mixer, inputs, contexts, node + k, selector, value > k)) return k;
    int64_t rest = value - unary + 1;
    int size = 0;
    while (size < SUFFIX_NODES - 1
        && code_mixed_bit(coder, mixer, inputs, contexts, node + unary + size, selector, rest >> (size + 1) > 0))
        size++;
    int64_t result = 1;
    if (size > 0) { /* the leading bit below the first is worth modelling, the others are noise */
        int leading = (int)(rest >> (size - 1)) & 1;
        result = 2 + code_mixed_bit(coder, mixer, inputs, contexts, node + unary + SUFFIX_NODES, selector, leading);
        if (size > 1) {
            int64_t count = INT64_C(1) << (size - 1);
            result = result * count + code_uniform(coder, rest & (count - 1), count);
        }
    }
    return unary + result - 1;
}

/* Code an integer of magnitude below 2^24: zero, sign, then the rest (C 3.2). */
SHARED int64_t code_signed(RangeCoder *coder, const Mixer *mixer, int inputs, const int64_t *contexts,
    int64_t selector, int unary, int64_t value) {
    if (!code_mixed_bit(coder, mixer, inputs, contexts, 0, selector, value != 0)) return 0;
    int negative = code_mixed_bit(coder, mixer, inputs, contexts, 1, selector, value < 0);
    int64_t rest = (value < 0 ? -value : value) - 1;
    int64_t magnitude = 1 + code_unsigned(coder, mixer, inputs, contexts, selector, unary, rest, 2);
    return negative ? -magnitude : magnitude;
}

#endif
