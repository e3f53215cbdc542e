/* How much two pictures differ: squared differences, which count less where shades vary around them. */
#include "codec/look/look.h"

#define REACH 5 /* pixels to each side that the blur reaches */
#define KEPT (2 * REACH + 1)
#define BACKGROUND 1.0f
#define SIDE 4 /* samples along each side of a pixel */
#define COVERED 0.999f
enum { FIRST, SECOND, SQUARES, PRODUCT, FIELDS, SUMS = 2, LANES = 8 /* sums side by side */ };

/* Pixels of `small`: means of squares of samples. */
KERNEL int64_t averaged(ConstSingles2 samples, Singles2 small) {
    if (samples.rows != SIDE * small.rows || samples.columns != SIDE * small.columns) return MISUSED;
    for (int64_t row = 0; row < small.rows; row++) {
        const float *from = samples.data + SIDE * row * samples.columns;
        float *to = small.data + row * small.columns;
        for (int64_t i = 0; i < small.columns; i++) {
            float total = 0.0f;
            for (int64_t y = 0; y < SIDE; y++) {
                const float *at = from + y * samples.columns + SIDE * i;
                total += at[0] + at[1] + at[2] + at[3];
            }
            to[i] = total * (1.0f / (SIDE * SIDE));
        }
    }
    return 0;
}

/* One row of a blur along rows, or down columns: `rows` are those that it sums. */
INLINE void blur(const float *const *rows, float *restrict to, int64_t count, const float *weights) {
    for (int64_t i = 0; i < count; i++) {
        float sum = weights[0] * rows[REACH][i];
        for (int64_t k = 1; k <= REACH; k++) sum += weights[k] * (rows[REACH - k][i] + rows[REACH + k][i]);
        to[i] = sum;
    }
}

/* The products of a row of both pictures that are blurred, with background around it, above and below. */
INLINE void take_row(ConstSingles2 first, ConstSingles2 second, int64_t row, int64_t stride, float *fields) {
    float *x = fields, *y = x + stride, *squares = y + stride, *product = squares + stride;
    for (int64_t i = 0; i < stride; i++) x[i] = y[i] = BACKGROUND;
    for (int64_t i = 0; row >= 0 && row < first.rows && i < first.columns; i++) {
        x[REACH + i] = first.data[row * first.columns + i];
        y[REACH + i] = second.data[row * first.columns + i];
    }
    for (int64_t i = 0; i < stride; i++) {
        squares[i] = x[i] * x[i] + y[i] * y[i];
        product[i] = x[i] * y[i];
    }
}

/* `half` is the blur from its middle on. To `sums`: over pixels that either picture covers, blurred squared differences
 * over `steady` and both variances; and the largest difference of blurred pixels. */
KERNEL int64_t contrast(ConstSingles2 first, ConstSingles2 second, ConstSingles half, double steady, Singles2 scratch,
                        Doubles sums) {
    int64_t n = first.columns, stride = n + KEPT - 1 + LANES;
    if (first.rows != second.rows || first.columns != second.columns || half.size != REACH + 1 || sums.size != SUMS ||
        scratch.columns < stride || scratch.rows < FIELDS * (KEPT + 2))
        return MISUSED;
    float *padded = scratch.data, *down = padded + FIELDS * stride, *ring = down + FIELDS * stride;
    float base = (float)steady, most[LANES] = {0.0f};
    double found[LANES] = {0.0};
    for (int64_t row = -REACH; row < first.rows + REACH; row++) {
        int64_t place = (row + KEPT) % KEPT, at = row - REACH;
        take_row(first, second, row, stride, padded);
        for (int field = 0; field < FIELDS; field++) {
            const float *rows[KEPT];
            for (int64_t k = 0; k < KEPT; k++) rows[k] = padded + field * stride + k;
            blur(rows, ring + (field * KEPT + place) * stride, n, half.data);
            for (int64_t k = 0; k < KEPT; k++) rows[k] = ring + (field * KEPT + (row + 1 + k + KEPT) % KEPT) * stride;
            if (at >= 0) blur(rows, down + field * stride, n, half.data);
        }
        if (at < 0) continue;
        const float *one = first.data + at * n, *other = second.data + at * n;
        float *unlike = down, *apart = down + stride;
        for (int64_t i = 0; i < n; i++) {
            float x = down[i], y = apart[i], squares = down[SQUARES * stride + i];
            float change = squares - 2.0f * down[PRODUCT * stride + i], spread = squares - (x * x + y * y);
            float weighed = (change > 0.0f ? change : 0.0f) / (base + (spread > 0.0f ? spread : 0.0f));
            apart[i] = __builtin_fabsf(x - y);
            unlike[i] = (one[i] < COVERED) | (other[i] < COVERED) ? weighed : 0.0f;
        }
        for (int64_t i = n; i < n + LANES - 1; i++) unlike[i] = apart[i] = 0.0f;
        for (int64_t i = 0; i < n; i += LANES)
            for (int64_t k = 0; k < LANES; k++) {
                found[k] += (double)unlike[i + k];
                most[k] = apart[i + k] > most[k] ? apart[i + k] : most[k];
            }
    }
    sums.data[0] = sums.data[1] = 0.0;
    for (int k = 0; k < LANES; k++) {
        sums.data[0] += found[k];
        sums.data[1] = (double)most[k] > sums.data[1] ? (double)most[k] : sums.data[1];
    }
    return 0;
}
