/* Cosine columns, cos(pi j (2 r + 1) / (2 n)) (specification, M 8.2): the same to the last bit on every machine, which
 * libraries are not. */
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

/* Entry k of the table is cos(pi k / (2 n)) for n `rows`: from the cosine up to pi / 4, from the sine of what is left to
 * pi / 2 beyond. */
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

/* `count` columns from `first` on; their rows are `apart`. */
INLINE void fill_columns(const double *table, int64_t rows, int64_t first, int64_t count, double *columns, int64_t apart) {
    int64_t turn = 4 * rows, start = first % turn, more = 2 * first % turn;
    for (int64_t r = 0; r < rows; r++) {
        int64_t step = 2 * r + 1, angle = start;
        double *row = columns + r * apart;
        for (int64_t j = 0; j < count; j++) {
            int64_t fold = least(angle, turn - angle);
            double value = table[least(fold, 2 * rows - fold)];
            row[j] = fold <= rows ? value : -value;
            angle += step;
            angle -= angle >= turn ? turn : 0;
        }
        start += more;
        start -= start >= turn ? turn : 0;
    }
}

/* Columns `first` and those after it; `table` is scratch of n + 1, and 7 more. */
void LEVEL(cosines)(int64_t first, Doubles table, Doubles2 columns) {
    make_table(columns.rows, table.data);
    fill_columns(table.data, columns.rows, first, columns.columns, columns.data, columns.columns);
}

/* The first columns of `previous`, and cosines where it has fewer than `columns`; `table` as above. */
void LEVEL(resize_columns)(ConstDoubles2 previous, Doubles table, Doubles2 columns) {
    int64_t rows = columns.rows, kept = least(previous.columns, columns.columns), more = columns.columns - kept;
    if (more > 0) make_table(rows, table.data);
    for (int64_t r = 0; r < rows; r++) {
        double *row = columns.data + r * columns.columns;
        for (int64_t j = 0; j < kept; j++) row[j] = previous.data[r * previous.columns + j];
    }
    fill_columns(table.data, rows, kept, more, columns.data + kept, columns.columns);
}
