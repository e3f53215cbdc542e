/* Quantized coefficients: what surrounds them, and the kernels of this room. */
#pragma once

#include "bitstream/entropy/entropy.h"
#include "bitstream/trellis.h"

/* The neighbors of a coefficient, and expectations from them (specification, M 9.3 to M 9.5, M 9.7). See adaptive.c. */
enum {
    NEIGHBORS = 20,
    SITUATIONS = 6,
    UNIT = 16,
    WEIGHT_BITS = 10,
    BINS = 48,
    CEILING = 1 << 15,
    ABOVE = 8,  /* rows of zeros in front of the first frequency, as far as any neighbor reaches */
    BEYOND = 3, /* and after the last */
    MEMORY = 8, /* blocks over which the usual magnitudes are averaged */
};

/* The memory of a chain: magnitudes in the present block and the one before, and their running mean; three of row 0,
 * and so on, and zeros in the rows around, which may be read. */
typedef struct {
    int32_t *now, *before, *usual;
    int64_t width, blocks;
} Past;

/* Number of the weights for a coefficient. */
INLINE int situation(const Past *past, int coordinate) { return coordinate + (past->blocks == 0 ? 3 : 0); }

/* The magnitude of a level that a chain remembers. */
INLINE int32_t remembered(int64_t level) { return (int32_t)least(level < 0 ? -level : level, CEILING); }

/* The inputs of the expectations of coefficient `d` of a row (M 9.4). `now`, `before` and `usual` are that row of
 * three; all rows above it are known, and earlier coordinates of its row. */
INLINE void gather_inputs(
    const int32_t *now, const int32_t *before, const int32_t *usual, int64_t row, int d, int32_t *out) {
    int e = d == 2 ? 0 : d + 1, f = d == 0 ? 2 : d - 1;
    const int32_t *n = now, *b = before, *u = usual;
    out[0] = 16 * n[d - 3];
    out[1] = 16 * n[d - 6];
    out[2] = 16 * n[d - 9];
    out[3] = 8 * (n[d - 12] + n[d - 15]);
    out[4] = 4 * (n[d - 18] + n[d - 21] + 2 * n[d - 24]);
    out[5] = d > 0 ? 16 * n[d - 1] : 0;
    out[6] = d > 1 ? 16 * n[d - 2] : 0;
    out[7] = 8 * (n[e - 3] + n[f - 3]);
    out[8] = 4 * (n[e - 6] + n[f - 6] + n[e - 9] + n[f - 9]);
    out[9] = 16 * b[d];
    out[10] = 8 * (b[d - 3] + b[d + 3]);
    out[11] = 4 * (b[d - 6] + b[d + 6] + b[d - 9] + b[d + 9]);
    out[12] = 8 * (b[e] + b[f]);
    out[13] = 4 * (b[e - 3] + b[f - 3] + b[e + 3] + b[f + 3]);
    out[14] = u[d];
    out[15] = (u[d - 3] + u[d + 3]) >> 1;
    out[16] = (u[e] + u[f]) >> 1;
    out[17] = UNIT;
    out[18] = (int32_t)(16 * UNIT / (row + 1));
    out[19] = (int32_t)(64 * UNIT / ((row + 1) * (row + 1)));
}

/* Logarithm of an expectation, in thirds of an octave (each of them linear inside), 0 .. BINS - 1 (M 9.5). */
INLINE int expectation_bin(const int32_t *weights, const int32_t *inputs) {
    int64_t total = 0;
    for (int i = 0; i < NEIGHBORS; i++) total += (int64_t)weights[i] * inputs[i];
    total >>= WEIGHT_BITS;
    if (total < 1) return 0;
    int octave = 63 - __builtin_clzll((unsigned long long)total);
    int64_t fraction = (3 * (total - (INT64_C(1) << octave))) >> octave;
    return (int)least(3 * octave + fraction, BINS - 1);
}

/* Make the present block the one before, and start the next (M 9.7). */
INLINE void close_block(Past *past) {
    int32_t share = (int32_t)least(past->blocks + 1, MEMORY);
    for (int64_t i = 0; i < 3 * past->width; i++) {
        int32_t change = UNIT * past->now[i] - past->usual[i];
        past->before[i] = past->now[i];
        past->usual[i] += change / share - (change % share < 0); /* rounded down */
        past->now[i] = 0;
    }
    past->blocks++;
}

/* How a level becomes decisions: nodes and contexts (specification, M 9.5, M 9.6). */
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
INLINE int second_bit_node(int size, int first) {
    return SECOND_NODES + 2 * (size < BIT_SIZES ? size : BIT_SIZES) + first;
}

/* The contexts of a coefficient with these inputs, in this situation. */
INLINE void set_contexts(const int32_t *expectations, int situation, const int32_t *inputs, int64_t *contexts) {
    for (int i = 0; i < EXPECTATIONS; i++) {
        const int32_t *weights = expectations + (i * SITUATIONS + situation) * NEIGHBORS;
        contexts[i] = NODES * (BINS * i + expectation_bin(weights, inputs));
    }
}

/* First of the weight sets. */
INLINE int64_t level_selector(const Past *past) { return past->blocks == 0 ? 0 : NODES; }

/* Adaptive coding of quantized coefficients, with weights of all expectations, a row for each of them and situation. */
extern INSIDE const BankPlan BLOCK_BANK;
void code_block(RangeCoder *coder, const Bank *bank, Past *past, const int32_t *expectations, Ints2 levels);

/* Entropy coding of a sequence's levels. See matrices.c. */
enum { CLASSES = 12 };

/* Magnitude class 0 .. 11 of a sum of magnitudes. */
INLINE int64_t class_of(int64_t value) {
    if (value < 5) return value;
    return 5 + (value >= 7) + (value >= 10) + (value >= 15) + (value >= 25) + (value >= 50) + (value >= 150);
}

INLINE int64_t magnitude_of(int64_t level) { return level < 0 ? -level : level; }

/* Magnitude in a matrix, zero outside. */
INLINE int64_t magnitude_at(const int32_t *data, int64_t rows, int64_t columns, int64_t row, int64_t column) {
    if (row < 0 || column < 0 || row >= rows || column >= columns) return 0;
    return magnitude_of(data[row * columns + column]);
}

extern INSIDE const BankPlan MATRIX_BANK;
/* Where levels are: in `rows`, of the first `lead` columns, of each next one `stair` more, and from row `bend` on of no
 * more than `few` (S 4.2). */
typedef struct {
    int64_t rows, lead, stair, bend, few;
} Stairs;

void code_matrix(
    RangeCoder *coder, const Bank *bank, Ints2 levels, ConstInts2 reference, const Stairs *stairs, Longs slow);

/* Choosing levels. See nearest.c. */
enum { TARGET_UNIT = 256 }; /* targets are in 1 / TARGET_UNIT of a step */

void nearest_levels(ConstLongs targets, int32_t *ways, uint8_t *origins, int32_t *levels);

/* The learned numbers that adaptive coefficients start from: the bytes of spec/priors.bin, which the build turns into
 * C. */
#define PRIORS_BYTES 12120

extern const unsigned char PRIORS[PRIORS_BYTES];
