#include "bitstream/coefficients/coefficients.h"

/* Adaptive coding of quantized coefficients (specification, M 9.2 to M 9.7). */

INSIDE const BankPlan BLOCK_BANK = {
    .slots = LEVEL_SLOTS, .selectors = SELECTORS * NODES, .inputs = EXPECTATIONS, .limit = 400, .rate = 4};

/* Code one level of a grid (M 9.6). */
INLINE int32_t code_level(
    RangeCoder *coder, const Bank *bank, const int64_t *contexts, int64_t selector, int grid, int32_t level) {
    uint32_t magnitude = level < 0 ? -(uint32_t)level : (uint32_t)level;
    int size = 0;
    while (size < LARGEST_SIZE
        && code_mixed_bit(coder, bank, EXPECTATIONS, contexts, size_node(size, grid), selector, magnitude >> size > 0))
        size++;
    if (size == 0) return 0;
    int32_t result = 1;
    if (size > 1) {
        int bit = magnitude >> (size - 2) & 1;
        int first = code_mixed_bit(coder, bank, EXPECTATIONS, contexts, first_bit_node(size), selector, bit);
        result = 2 | first;
        if (size > 2) {
            bit = magnitude >> (size - 3) & 1;
            int node = second_bit_node(size, first);
            result = 2 * result | code_mixed_bit(coder, bank, EXPECTATIONS, contexts, node, selector, bit);
            if (size > 3) {
                int32_t count = 1 << (size - 3);
                result = result * count + (int32_t)code_uniform(coder, magnitude & (uint32_t)(count - 1), count);
            }
        }
    }
    return code_bit(coder, ONE / 2, level < 0) ? -result : result;
}

/* Code the levels of a block in place, or stop at the end of the data. */
KERNEL void code_block(RangeCoder *coder, const Bank *bank, Past *past, const int32_t *expectations, Ints2 levels) {
    int64_t selector = level_selector(past);
    int state = 0;
    for (int64_t row = 0; row < levels.rows && !overran(coder); row++) {
        int32_t *now = past->now + 3 * row, *before = past->before + 3 * row, *usual = past->usual + 3 * row;
        for (int d = 0; d < 3; d++) {
            int32_t inputs[NEIGHBORS];
            int64_t contexts[EXPECTATIONS];
            gather_inputs(now, before, usual, row, d, inputs);
            set_contexts(expectations, situation(past, d), inputs, contexts);
            int32_t *level = levels.data + 3 * row + d;
            *level = code_level(coder, bank, contexts, selector, trellis_grid(state), *level);
            now[d] = remembered(*level);
            state = trellis_following(state, *level);
        }
    }
    close_block(past);
}
