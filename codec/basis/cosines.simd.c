/* Cosine columns, cos(pi j (2 r + 1) / (2 n)) (specification, M 8.2): the same to the last bit on every machine, which
 * libraries are not. */
#include "codec/basis/cosines.h"

#include "codec/basis/solver/vectors.h"

#define PI 3.141592653589793

/* The series of the cosine (`order` 20) or of the sine over its angle (21) of an angle of at most pi / 4. */
INLINE Part series(Part x, const int order) {
    Part value = x * 0.0 + 1.0;
    _Pragma("GCC unroll 10") for (int i = 0; i < 10; i++) {
        const int n = order - 2 * i;
        value = 1.0 - value * x * x / (double)(n * (n - 1));
    }
    return value;
}

/* Columns `first` and those after it; `table` is scratch of n + 1, and 7 more. */
void LEVEL(cosines)(int64_t first, Doubles table, Doubles2 columns) {
    int64_t rows = columns.rows, turn = 4 * rows;
    Part along;
    EACH(i, REGISTER) along[i] = i;
    double unit = PI / (double)(2 * rows);
    /* Entry k is cos(pi k / (2 n)): from the cosine up to pi / 4, from the sine of what is left to pi / 2 beyond. */
    for (int64_t k = 0; k <= rows / 2; k += REGISTER)
        *(UnalignedPart *)(table.data + k) = series(((double)k + along) * unit, 20);
    for (int64_t k = rows / 2 + 1; k <= rows; k += REGISTER) {
        Part x = ((double)(rows - k) - along) * unit;
        *(UnalignedPart *)(table.data + k) = series(x, 21) * x;
    }
    for (int64_t r = 0; r < rows; r++) {
        int64_t step = 2 * r + 1, angle = step * first % turn;
        double *row = columns.data + r * columns.columns;
        for (int64_t j = 0; j < columns.columns; j++) {
            int64_t fold = least(angle, turn - angle);
            row[j] = fold <= rows ? table.data[fold] : -table.data[2 * rows - fold];
            angle += step;
            if (angle >= turn) angle -= turn;
        }
    }
}
