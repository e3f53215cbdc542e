/* The neighbours of all coefficients of a block, for who fits the weights of expectations, and for tests. */
#include "bitstream/coefficients/contexts.h"

/* Note the levels of a block one by one, and write the inputs of each, a row of NEIGHBOURS; then close the block. */
int64_t look_at_block(Past past, ConstInts2 levels, Ints2 inputs) {
    Chain chain;
    if (levels.columns != 3 || !open_past(&chain, past, levels.rows) || inputs.rows != 3 * levels.rows
        || inputs.columns != NEIGHBOURS)
        return MISUSED;
    for (int64_t i = 0; i < 3 * levels.rows; i++) {
        int64_t row = i / 3, at = 3 * row;
        int32_t *out = inputs.data + NEIGHBOURS * i;
        look_around(chain.now + at, chain.before + at, chain.usual + at, row, (int)(i - at), out);
        chain.now[i] = remembered(levels.data[i]);
    }
    close_block(&chain);
    return 0;
}

/* One bin, of weights and inputs, NEIGHBOURS of each. */
int64_t bin_of_expectation(ConstInts weights, ConstInts inputs) {
    if (weights.size != NEIGHBOURS || inputs.size != NEIGHBOURS) return MISUSED;
    return expectation_bin(weights.data, inputs.data);
}
