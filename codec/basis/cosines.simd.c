/* Cosine columns, cos(pi j (2 r + 1) / (2 n)) (specification, M 8.2): the same to the last bit on every machine, which
 * libraries are not. */
#define VECTORS_OF_DOUBLES
#include "codec/basis/vectors.h"

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

/* Entry k of the table is cos(pi k / (2 n)) for n `rows`: from the cosine up to pi / 4, from the sine of what is left
 * to pi / 2 beyond. */
INLINE void make_table(int64_t rows, double *table) {
    Part along;
    EACH(i, REGISTER) along[i] = i;
    double unit = PI / (double)(2 * rows);
    for (int64_t k = 0; k <= rows / 2; k += REGISTER)
        *(UnalignedPart *)(table + k) = series(((double)k + along) * unit, 20);
    for (int64_t k = rows / 2 + 1; k <= rows; k += REGISTER) {
        Part x = ((double)(rows - k) - along) * unit;
        *(UnalignedPart *)(table + k) = series(x, 21) * x;
    }
}

/* Where row r of a column has its angle: `angle` of the whole turn of 4 n, less than that. */
INLINE double cosine_at(const double *table, int64_t n, int64_t angle) {
    int64_t fold = least(angle, 4 * n - angle);
    double value = table[least(fold, 2 * n - fold)];
    return fold <= n ? value : -value;
}

/* All columns; `table` is scratch of n + 1, and 7 more. */
void ISA(cosines)(Doubles table, Doubles2 columns) {
    int64_t n = columns.rows;
    make_table(n, table.data);
    for (int64_t r = 0; r < n; r++)
        for (int64_t j = 0, angle = 0; j < columns.columns; j++) {
            columns.data[r * columns.columns + j] = cosine_at(table.data, n, angle);
            angle += 2 * r + 1;
            angle -= angle >= 4 * n ? 4 * n : 0;
        }
}

/* The first columns of `previous`, and cosines where it has fewer than `columns`; `table` as above. */
void ISA(resize_columns)(ConstSingles2 previous, Doubles table, Singles2 columns) {
    int64_t n = columns.rows, kept = least(previous.columns, columns.columns);
    if (kept < columns.columns) make_table(n, table.data);
    for (int64_t r = 0; r < n; r++) {
        float *row = columns.data + r * columns.columns;
        for (int64_t j = 0; j < kept; j++) row[j] = previous.data[r * previous.columns + j];
        for (int64_t j = kept, angle = kept * (2 * r + 1) % (4 * n); j < columns.columns; j++) {
            row[j] = (float)cosine_at(table.data, n, angle);
            angle += 2 * r + 1;
            angle -= angle >= 4 * n ? 4 * n : 0;
        }
    }
}
