/* Adaptive coding of quantized coefficients (specification, M 9.2 to M 9.8). */
#include "bitstream/coefficients/adaptive.h"

#include "bitstream/coefficients/trellis.h"
#include "bitstream/entropy/integers.h"

enum { ROWS_UNARY = 8, ROWS_SPAN = UNSIGNED_SPAN(ROWS_UNARY), ROWS_SIZES = 16 };

/* Code one level of a grid (M 9.6). */
INLINE int32_t code_level(
    RangeCoder *coder, const Mixer *mixer, const int64_t *contexts, int64_t selector, int grid, int32_t level) {
    uint32_t magnitude = level < 0 ? -(uint32_t)level : (uint32_t)level;
    int size = 0;
    while (size < LARGEST_SIZE
        && code_mixed_bit(coder, mixer, EXPECTATIONS, contexts, size_node(size, grid), selector, magnitude >> size > 0))
        size++;
    if (size == 0) return 0;
    int32_t result = 1;
    if (size > 1) {
        int bit = magnitude >> (size - 2) & 1;
        int first = code_mixed_bit(coder, mixer, EXPECTATIONS, contexts, first_bit_node(size), selector, bit);
        result = 2 | first;
        if (size > 2) {
            bit = magnitude >> (size - 3) & 1;
            int node = second_bit_node(size, first);
            result = 2 * result | code_mixed_bit(coder, mixer, EXPECTATIONS, contexts, node, selector, bit);
            if (size > 3) {
                int32_t count = 1 << (size - 3);
                result = result * count + (int32_t)code_uniform(coder, magnitude & (uint32_t)(count - 1), count);
            }
        }
    }
    return code_bit(coder, ONE / 2, level < 0) ? -result : result;
}

/* Code a number of rows, as what it lacks to `width`, given the same of the block before (M 9.8). What is read may be
 * below zero. */
int64_t code_rows(Coder given, Bank bank, Longs missing, int64_t width, int64_t rows) {
    RangeCoder coder;
    Mixer mixer;
    if (!open_coder(&coder, given) || !open_bank(&mixer, bank, (1 + ROWS_SIZES) * ROWS_SPAN, ROWS_SPAN, 2)
        || missing.size != 1 || rows < 0 || rows > width || width > INT32_MAX)
        return MISUSED;
    int size = 0;
    while (missing.data[0] >> size > 0 && size < ROWS_SIZES - 1) size++;
    const int64_t contexts[2] = {0, ROWS_SPAN * (1 + size)};
    missing.data[0] = code_unsigned(&coder, &mixer, 2, contexts, 0, ROWS_UNARY, width - rows, 0);
    close_coder(&coder, given);
    return width - missing.data[0];
}

/* Code the levels of a block in place, or stop where the data is beyond its end. */
KERNEL int64_t code_block(Coder given, Bank bank, Past past, ConstInts2 expectations, Ints2 levels) {
    RangeCoder coder;
    Mixer mixer;
    Chain chain;
    if (!open_coder(&coder, given) || !open_bank(&mixer, bank, LEVEL_SLOTS, SELECTORS * NODES, EXPECTATIONS)
        || levels.columns != 3 || !open_past(&chain, past, levels.rows) || !are_expectations(expectations))
        return MISUSED;
    int64_t selector = level_selector(&chain);
    int state = 0;
    for (int64_t row = 0; row < levels.rows && !overran(&coder); row++) {
        int32_t *now = chain.now + 3 * row, *before = chain.before + 3 * row, *usual = chain.usual + 3 * row;
        for (int d = 0; d < 3; d++) {
            int32_t inputs[NEIGHBOURS];
            int64_t contexts[EXPECTATIONS];
            look_around(now, before, usual, row, d, inputs);
            set_contexts(expectations, situation(&chain, d), inputs, contexts);
            int32_t *level = levels.data + 3 * row + d;
            *level = code_level(&coder, &mixer, contexts, selector, trellis_grid(state), *level);
            now[d] = remembered(*level);
            state = trellis_following(state, *level);
        }
    }
    close_block(&chain);
    close_coder(&coder, given);
    return 0;
}

/* Code the levels of a block, and behind their number those of a layer above it, in place (M 9.8, M 11.1). Returns the
 * rows of that layer; where a reader finds more than `above` holds, or less than none, its levels are not coded. */
int64_t code_layers(Coder given, CoefficientModel model, Ints2 levels, CoefficientModel over, int64_t rows, Ints2 above) {
    if (code_block(given, model.bank, model.past, model.expectations, levels) == MISUSED) return MISUSED;
    rows = code_rows(given, over.rows, over.missing, over.width, rows);
    if (rows < 0 || rows > above.rows) return rows;
    Ints2 coded = {above.data, rows, above.columns};
    return code_block(given, over.bank, over.past, over.expectations, coded) == MISUSED ? MISUSED : rows;
}
