/* Columns that need no vectors: hash columns to start from, and Onorm by reflections. */
#include "codec/basis/basis.h"

/* Hash columns (specification, M 8.6): fixed pseudo-random numbers in [-1, 1), the same on every machine. */

/* Overwrite each entry by the splitmix64 of row * 2^32 + column. */
KERNEL void hash_columns(Doubles2 columns) {
    for (int64_t r = 0; r < columns.rows; r++)
        for (int64_t j = 0; j < columns.columns; j++) {
            uint64_t z = (((uint64_t)r << 32) + (uint64_t)j + 1) * 0x9E3779B97F4A7C15u;
            z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
            z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
            columns.data[r * columns.columns + j] = (double)((z ^ (z >> 31)) >> 11) * 0x1p-52 - 1.0;
        }
}

/* Onorm by Householder reflections: for columns too close to dependent for Cholesky QR. */

/* x and y of `size` entries, `apart` doubles from one to the next: the sum of their products. */
static double product(const double *x, const double *y, int64_t size, int64_t apart) {
    double sum = 0.0;
    for (int64_t i = 0; i < size; i++) sum += x[i * apart] * y[i * apart];
    return sum;
}

/* Reflect columns `first` to the last of `matrix`, from row k on, by I - scale v v^T; v is below row k of `reflectors`'
 * column k. `row` is scratch. */
static void reflect(ConstDoubles2 reflectors, int64_t k, double scale, int64_t first, double *row, Doubles2 matrix) {
    int64_t c = matrix.columns;
    for (int64_t j = first; j < c; j++) row[j] = 0.0;
    for (int64_t r = k; r < matrix.rows; r++)
        for (int64_t j = first; j < c; j++) row[j] += reflectors.data[r * c + k] * matrix.data[r * c + j];
    for (int64_t r = k; r < matrix.rows; r++) {
        double share = scale * reflectors.data[r * c + k];
        for (int64_t j = first; j < c; j++) matrix.data[r * c + j] -= share * row[j];
    }
}

/* Q of a QR factorisation with positive diagonal. `work` begins as the matrix, and ends as reflectors; `scratch` has room
 * for 3 c. */
void householder(Doubles2 work, Doubles scratch, Doubles2 q) {
    int64_t n = work.rows, c = work.columns;
    double *scales = scratch.data, *signs = scales + c, *row = signs + c;
    ConstDoubles2 reflectors = {work.data, n, c};
    for (int64_t k = 0; k < c; k++) {
        double *column = work.data + k * c + k;
        double length = __builtin_sqrt(product(column, column, n - k, c));
        /* Away from zero, so that no digits are lost; the length's sign is that of R's diagonal. */
        double moved = *column < 0.0 ? *column - length : *column + length;
        signs[k] = *column < 0.0 ? 1.0 : -1.0;
        *column = moved;
        double squared = product(column, column, n - k, c);
        scales[k] = squared > 0.0 ? 2.0 / squared : 0.0;
        reflect(reflectors, k, scales[k], k + 1, row, work);
    }
    for (int64_t i = 0; i < n * c; i++) q.data[i] = 0.0;
    for (int64_t k = 0; k < c; k++) q.data[k * c + k] = signs[k];
    for (int64_t k = c - 1; k >= 0; k--) reflect(reflectors, k, scales[k], k, row, q);
}
