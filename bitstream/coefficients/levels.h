/* How a level becomes decisions: nodes and contexts (specification, M 9.5, M 9.6). */
#ifndef BSM_LEVELS_H
#define BSM_LEVELS_H

#include "bitstream/coefficients/contexts.h"
#include "bitstream/entropy/mixing.h"

enum {
    EXPECTATIONS = 3, /* from everything, from the same block alone, from earlier blocks alone */
    NODES = 38,
    SELECTORS = 2, /* first block of a chain, later blocks */
    LEVEL_SLOTS = EXPECTATIONS * BINS * NODES,
    LARGEST_SIZE = 23, /* bits of a magnitude */
    MAX_LEVEL = (1 << LARGEST_SIZE) - 1,
    SIZE_NODES = 14, /* magnitudes of more bits share the last */
    GRID_NODES = 2,  /* whether it is zero, or one, is another question on the odd grid */
    BIT_SIZES = 9,   /* magnitudes of more bits share the nodes of this size */
    FIRST_NODES = SIZE_NODES + GRID_NODES - 2,
    SECOND_NODES = FIRST_NODES + BIT_SIZES + 1 - 2 * 3,
};

/* Node of the decision whether the magnitude of a level on a grid has more than `size` bits. */
INLINE int size_node(int size, int grid) {
    if (grid && size < GRID_NODES) return SIZE_NODES + size;
    return size < SIZE_NODES - 1 ? size : SIZE_NODES - 1;
}

/* Node of the bit below the leading one of `size` bits, from 2 on. */
INLINE int first_bit_node(int size) { return FIRST_NODES + (size < BIT_SIZES ? size : BIT_SIZES); }

/* Node of the bit below `first`, for `size` from 3 on. */
INLINE int second_bit_node(int size, int first) { return SECOND_NODES + 2 * (size < BIT_SIZES ? size : BIT_SIZES) + first; }

/* Weights of all expectations, a row for each expectation and situation. */
INLINE bool are_expectations(ConstInts2 weights) {
    return weights.rows == EXPECTATIONS * SITUATIONS && weights.columns == NEIGHBOURS;
}

/* The contexts of a coefficient with these inputs, in this situation. */
INLINE void set_contexts(ConstInts2 expectations, int situation, const int32_t *inputs, int64_t *contexts) {
    for (int i = 0; i < EXPECTATIONS; i++) {
        const int32_t *weights = expectations.data + (i * SITUATIONS + situation) * NEIGHBOURS;
        contexts[i] = NODES * (BINS * i + expectation_bin(weights, inputs));
    }
}

/* First of the weight sets. */
INLINE int64_t level_selector(const Chain *chain) { return *chain->blocks == 0 ? 0 : NODES; }

#endif
