/* Levels of a sequence, in matrices of frequencies by components (specification, S 4). */
#include "bitstream/coefficients/coefficients.h"

enum {
    UNARY = 14,
    OTHER_ZERO = SIGNED_SPAN(UNARY), /* nodes of the grid without even points: whether a level is zero, whether one */
    OTHER_ONE,
    MORE, /* whether a row of those that follow has levels */
    SPAN,
    TOGETHER = 8, /* rows that share a flag */
    INPUTS = 6,
    PLACES = 40,
    TABLE = CLASSES * CLASSES * SPAN, /* slots of each of the first five inputs */
    MATRIX_SLOTS = 5 * TABLE + CLASSES * PLACES * SPAN,
    WEIGHT_SETS = 3,
};
INSIDE const BankPlan MATRIX_BANK = {
    .slots = MATRIX_SLOTS, .selectors = WEIGHT_SETS * SPAN, .inputs = INPUTS, .limit = 400, .rate = 10};

/* Bits of an index, 0 .. 11. */
INLINE int64_t octave(int64_t value) {
    int64_t bits = 0;
    for (; value > 0 && bits < CLASSES - 1; value >>= 1) bits++;
    return bits;
}

/* Sum of the magnitudes in some rows, of those that there are. */
INLINE int64_t sum_of(const int32_t *data, int64_t rows, int64_t columns, int64_t first, int64_t end) {
    int64_t sum = 0;
    for (int64_t k = columns * (first < 0 ? 0 : first); k < columns * least(end, rows); k++)
        sum += magnitude_of(data[k]);
    return sum;
}

/* The place of a row as a context, and its set of weights (S 4.2). */
INLINE int64_t row_place(int64_t j) { return j < 20 ? j : least(PLACES - 1, 20 + (j - 20) / 8); }
INLINE int64_t row_weights(int64_t j) { return SPAN * (j == 0 ? 0 : j < 12 ? 1 : 2); }

INLINE int zero_node(int grid) { return grid ? OTHER_ZERO : 0; }
INLINE int one_node(int grid) { return grid ? OTHER_ONE : 2; }

/* Code whether row j or a later one has levels (S 4.2); `behind` is the sum of the reference from row j on. */
INLINE int code_more(RangeCoder *coder, const Bank *bank, Ints2 levels, ConstInts2 reference, int64_t j,
    int64_t behind, int more) {
    int64_t lately = class_of(sum_of(levels.data, levels.rows, levels.columns, j - TOGETHER, j));
    int64_t next = class_of(sum_of(reference.data, reference.rows, reference.columns, j, j + TOGETHER));
    int64_t left = class_of(behind);
    const int64_t contexts[INPUTS] = {
        SPAN * (CLASSES * octave(j) + lately),
        TABLE + SPAN * (CLASSES * octave(j) + left),
        2 * TABLE + SPAN * (CLASSES * left + lately),
        3 * TABLE + SPAN * (CLASSES * left + next),
        4 * TABLE + SPAN * (CLASSES * next + lately),
        5 * TABLE + SPAN * (PLACES * left + row_place(j)),
    };
    return code_mixed_bit(coder, bank, INPUTS, contexts, MORE, row_weights(j), more);
}

/* Code one level of a grid (S 4.2). */
INLINE int32_t code_level(
    RangeCoder *coder, const Bank *bank, const int64_t *contexts, int64_t selector, int grid, int32_t level) {
    if (!code_mixed_bit(coder, bank, INPUTS, contexts, zero_node(grid), selector, level != 0)) return 0;
    int negative = code_mixed_bit(coder, bank, INPUTS, contexts, 1, selector, level < 0);
    int64_t magnitude = magnitude_of(level);
    if (code_mixed_bit(coder, bank, INPUTS, contexts, one_node(grid), selector, magnitude > 1))
        magnitude = 2 + code_unsigned(coder, bank, INPUTS, contexts, selector, UNARY - 1, magnitude - 2, 3);
    else
        magnitude = 1;
    return (int32_t)(negative ? -magnitude : magnitude);
}

/* Code rows, as many together as it takes to reach the last one with levels; `few` is only coded with row `bend`. What
 * is not coded is 0. `slow` is scratch, an entry a column. */
void code_matrix(
    RangeCoder *coder, const Bank *bank, Ints2 levels, ConstInts2 reference, const Stairs *stairs, Longs slow) {
    int64_t columns = levels.columns;
    for (int64_t i = 0; i < columns; i++) slow.data[i] = 0;
    int64_t behind = sum_of(reference.data, reference.rows, columns, 0, reference.rows), most = columns;
    int state = 0;
    for (int64_t j = 0; j < levels.rows && !overran(coder); j++) {
#define A(row, column) magnitude_at(levels.data, levels.rows, columns, row, column)
#define B(row, column) magnitude_at(reference.data, reference.rows, columns, row, column)
        int64_t band = octave(j), selector = row_weights(j), mean = 0, place = row_place(j);
        int64_t whole = least(columns, stairs->lead + stairs->stair * j);
        if (j % TOGETHER == 0) {
            int more = code_more(coder, bank, levels, reference, j, behind, j < stairs->rows);
            behind -= sum_of(reference.data, reference.rows, columns, j, j + TOGETHER);
            if (!more) break;
        }
        if (j == stairs->bend) most = code_uniform(coder, stairs->few, columns + 1);
        int64_t end = least(whole, most);
        for (int64_t i = 0; i < end; i++) {
            int64_t above = 2 * A(j - 1, i) + A(j - 2, i) + A(j - 3, i);
            int64_t left = 2 * A(j, i - 1) + A(j, i - 2);
            int64_t around = A(j - 1, i + 1) + A(j - 1, i - 1);
            int64_t before = 2 * B(j, i) + B(j - 1, i) + B(j + 1, i);
            int64_t usual = class_of(slow.data[i] >> 4);
            const int64_t contexts[INPUTS] = {
                SPAN * (CLASSES * band + usual),
                TABLE + SPAN * (CLASSES * octave(i) + class_of(above)),
                2 * TABLE + SPAN * (CLASSES * class_of(before) + usual),
                3 * TABLE + SPAN * (CLASSES * class_of(above) + class_of(left)),
                4 * TABLE + SPAN * (CLASSES * class_of(mean >> 5) + class_of((above + left + around + before) >> 1)),
                5 * TABLE + SPAN * (PLACES * class_of(left + around) + place),
            };
            int32_t *level = levels.data + j * columns + i;
            *level = code_level(coder, bank, contexts, selector, trellis_grid(state), *level);
            state = trellis_following(state, *level);
            int64_t magnitude = least(magnitude_of(*level), 4096);
            slow.data[i] += (64 * magnitude - slow.data[i]) >> 2;
            mean += (128 * magnitude - mean) >> 2;
        }
        for (int64_t i = end; i < columns; i++) {
            levels.data[j * columns + i] = 0;
            state = trellis_following(state, 0);
        }
#undef A
#undef B
    }
}
