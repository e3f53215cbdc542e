/* E = U^T V and V = U E (paper, section 4; specification, M 10.2).
 *
 * Every number is the sum of its terms in the order of rows, or of columns, each product rounded before it is added.
 * Where there are as many columns as a vector has, vectors lie along them.
 */
#include "codec/signal/signal.h"

#define VECTORS_OF_DOUBLES
#include "codec/basis/vectors.h"

/* A vector of floats, of which the first `left` count; the lanes behind are zero. */
INLINE Vector load_floats(const float *from, int64_t left) {
    typedef float Floats __attribute__((vector_size(4 * REGISTER), __aligned__(4), may_alias));
    Vector vector = zeros();
    if (left >= WIDTH)
        EACH(i, PARTS) vector.part[i] = __builtin_convertvector(*(const Floats *)(from + i * REGISTER), Part);
    else
        EACH(i, PARTS) EACH(j, REGISTER) if (i * REGISTER + j < left) vector.part[i][j] = from[i * REGISTER + j];
    return vector;
}

/* Coefficients of columns j to j + `vectors` WIDTH and of `axes` axes from d on, of which the first `columns` count. */
INLINE void project_tile(const int vectors, const int axes, ConstSingles2 subspace, ConstDoubles2 values, int64_t j,
                         int64_t columns, int64_t d, Doubles2 coefficients) {
    Vector sums[3][VECTORS];
    EACH(a, axes) EACH(v, vectors) sums[a][v] = zeros();
    /* What is read beyond the columns is in the next row, but for the last rows. */
    int64_t size = subspace.rows * subspace.columns;
    for (int64_t r = 0; r < subspace.rows; r++) {
        int64_t first = r * subspace.columns + j;
        Vector row[VECTORS];
        EACH(v, vectors) row[v] = load_floats(subspace.data + first + v * WIDTH, size - first - v * WIDTH);
        EACH(a, axes) {
            double value = values.data[r * values.columns + d + a];
            EACH(v, vectors) sums[a][v] = sum_of(sums[a][v], scaled(row[v], value));
        }
    }
    EACH(a, axes) EACH(v, vectors) EACH(i, WIDTH) {
        int64_t column = v * WIDTH + i;
        if (column < columns)
            coefficients.data[(j + column) * coefficients.columns + d + a] =
                sums[a][v].part[i / REGISTER][i % REGISTER];
    }
}

/* E = U^T V, for as many columns U of `subspace` as there are rows of `coefficients`. */
void ISA(project)(ConstSingles2 subspace, ConstDoubles2 values, Doubles2 coefficients) {
    int64_t count = coefficients.rows;
    for (int64_t j = 0; j < count; j += 2 * WIDTH) {
        int64_t columns = least(count - j, 2 * WIDTH), d = 0;
        for (; d + 3 <= values.columns; d += 3) project_tile(2, 3, subspace, values, j, columns, d, coefficients);
        for (; d < values.columns; d++) project_tile(2, 1, subspace, values, j, columns, d, coefficients);
    }
}

/* Rows r to r + WIDTH, the last one again and again beyond the end, of `axes` axes from d on. */
INLINE void reconstruct_tile(const int axes, ConstSingles2 subspace, ConstDoubles2 coefficients, int64_t r, int64_t d,
                             Doubles2 values) {
    const float *rows[WIDTH];
    EACH(i, WIDTH) rows[i] = subspace.data + least(r + i, subspace.rows - 1) * subspace.columns;
    Vector sums[3];
    EACH(a, axes) sums[a] = zeros();
    for (int64_t q = 0; q < coefficients.rows; q++) {
        Vector column;
        EACH(i, PARTS) {
            Part part = spread(0.0);
            EACH(j, REGISTER) part[j] = rows[i * REGISTER + j][q];
            column.part[i] = part;
        }
        EACH(a, axes) sums[a] = sum_of(sums[a], scaled(column, coefficients.data[q * coefficients.columns + d + a]));
    }
    EACH(a, axes) EACH(i, WIDTH)
        if (r + i < subspace.rows)
            values.data[(r + i) * values.columns + d + a] = sums[a].part[i / REGISTER][i % REGISTER];
}

/* Some rows from r on, and some vectors side by side from column d on. */
INLINE void reconstruct_rows(const int rows, const int vectors, ConstSingles2 subspace, ConstDoubles2 coefficients,
                             int64_t r, int64_t d, Doubles2 values) {
    const float *left = subspace.data + r * subspace.columns;
    const double *right = coefficients.data + d;
    Vector sums[ROWS][VECTORS];
    EACH(i, rows) EACH(v, vectors) sums[i][v] = zeros();
    for (int64_t q = 0; q < coefficients.rows; q++, right += coefficients.columns)
        EACH(i, rows) EACH(v, vectors)
            sums[i][v] = sum_of(sums[i][v], scaled(load(right + v * WIDTH), left[i * subspace.columns + q]));
    EACH(i, rows) EACH(v, vectors) store(values.data + (r + i) * values.columns + d + v * WIDTH, sums[i][v]);
}

/* All rows of some vectors side by side. */
INLINE void reconstruct_strip(const int vectors, int64_t d, ConstSingles2 subspace, ConstDoubles2 coefficients,
                              Doubles2 values) {
    int64_t r = 0;
    for (; r + ROWS <= subspace.rows; r += ROWS) reconstruct_rows(ROWS, vectors, subspace, coefficients, r, d, values);
    for (; r < subspace.rows; r++) reconstruct_rows(1, vectors, subspace, coefficients, r, d, values);
}

/* A vector's columns or more; the last vector may lie over the one before. */
static void reconstruct_wide(ConstSingles2 subspace, ConstDoubles2 coefficients, Doubles2 values) {
    int64_t d = 0, columns = values.columns;
    for (; d + LANES <= columns; d += LANES)
        WITH_VECTORS(VECTORS, d, reconstruct_strip, subspace, coefficients, values);
    if (d + WIDTH <= columns) WITH_VECTORS((columns - d) / WIDTH, d, reconstruct_strip, subspace, coefficients, values);
    if (columns % WIDTH) reconstruct_strip(1, columns - WIDTH, subspace, coefficients, values);
}

/* V = U E, for as many columns U of `subspace` as there are rows of `coefficients`. */
void ISA(reconstruct)(ConstSingles2 subspace, ConstDoubles2 coefficients, Doubles2 values) {
    if (values.columns >= WIDTH) {
        reconstruct_wide(subspace, coefficients, values);
        return;
    }
    for (int64_t r = 0; r < subspace.rows; r += WIDTH) {
        int64_t d = 0;
        for (; d + 3 <= values.columns; d += 3) reconstruct_tile(3, subspace, coefficients, r, d, values);
        for (; d < values.columns; d++) reconstruct_tile(1, subspace, coefficients, r, d, values);
    }
}
