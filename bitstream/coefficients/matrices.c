/* Levels of a sequence, in matrices of frequencies by components (specification, S 4). */
#include "bitstream/coefficients/matrices.h"

#include "bitstream/entropy/integers.h"

enum {
    UNARY = 14,
    SPAN = SIGNED_SPAN(UNARY),
    INPUTS = 6,
    CLASSES = 12,
    PLACES = 40,
    TABLE = CLASSES * CLASSES * SPAN, /* slots of each of the first five inputs */
    MATRIX_SLOTS = 5 * TABLE + CLASSES * PLACES * SPAN,
    WEIGHT_SETS = 3,
};

/* Magnitude class 0 .. 11 of a sum of magnitudes. */
INLINE int64_t class_of(int64_t value) {
    if (value < 5) return value;
    return 5 + (value >= 7) + (value >= 10) + (value >= 15) + (value >= 25) + (value >= 50) + (value >= 150);
}

/* Bits of an index, 0 .. 11. */
INLINE int64_t octave(int64_t value) {
    int64_t bits = 0;
    for (; value > 0 && bits < CLASSES - 1; value >>= 1) bits++;
    return bits;
}

INLINE int64_t magnitude_of(int64_t level) { return level < 0 ? -level : level; }

/* Magnitude in a matrix, zero outside. */
INLINE int64_t at(const int32_t *data, int64_t rows, int64_t columns, int64_t row, int64_t column) {
    if (row < 0 || column < 0 || row >= rows || column >= columns) return 0;
    return magnitude_of(data[row * columns + column]);
}

/* Code the number of rows that are not zero behind, and these rows; returns that number. `slow` is scratch, an entry a
 * column. */
int64_t code_matrix(Coder given, Bank bank, Ints2 levels, ConstInts2 reference, int64_t rows, Longs slow) {
    RangeCoder coder;
    Mixer mixer;
    int64_t columns = levels.columns;
    if (!open_coder(&coder, given) || !open_bank(&mixer, bank, MATRIX_SLOTS, WEIGHT_SETS * SPAN, INPUTS)
        || reference.columns != columns || slow.size != columns || rows < 0 || rows > levels.rows
        || levels.rows >= INT32_MAX)
        return MISUSED;
    for (int64_t i = 0; i < columns; i++) slow.data[i] = 0;
    rows = code_uniform(&coder, rows, levels.rows + 1);
    for (int64_t j = 0; j < rows && !overran(&coder); j++) {
#define A(row, column) at(levels.data, levels.rows, columns, row, column)
#define B(row, column) at(reference.data, reference.rows, columns, row, column)
        int64_t band = octave(j), selector = SPAN * (j == 0 ? 0 : j < 12 ? 1 : 2), mean = 0;
        int64_t place = j < 20 ? j : least(PLACES - 1, 20 + (j - 20) / 8);
        for (int64_t i = 0; i < columns; i++) {
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
            *level = (int32_t)code_signed(&coder, &mixer, INPUTS, contexts, selector, UNARY, *level);
            int64_t magnitude = least(magnitude_of(*level), 4096);
            slow.data[i] += (64 * magnitude - slow.data[i]) >> 2;
            mean += (128 * magnitude - mean) >> 2;
        }
#undef A
#undef B
    }
    close_coder(&coder, given);
    return rows;
}
