/* Columns that complete others to a square matrix with columns at right angles (specification, M 8.7).
 *
 * With U the h columns that are there, E the first h columns of I, and A = I + E^T U, the matrix
 * I - (U + E) A^-T (U + E)^T is orthogonal and takes E to -U; so its columns from h on are orthogonal to U. A has a
 * symmetric part that is not indefinite, which is why it is factorized without exchanges.
 */
#include "codec/basis/vectors.h"

/* A^T = L R, of a multiple of ROWS rows, with the identity behind those that there are; the rows of a panel; and as
 * many rows of U + E as are taken at a time. */
typedef struct {
    int64_t size;
    float *lower, *upper, *panel, *some;
} Completion;

/* Numbers of scratch that completing h columns takes. */
int64_t ISA(completion_space)(int64_t h) {
    int64_t size = whole_vectors(h);
    return 2 * size * size + size * LANES + ROWS * size + LINE - 1;
}

/* Take `share` times a row from another, in `count` columns of whole vectors. */
SHARED void take_row(float *row, float share, const float *other, int64_t count) {
    for (int64_t b = 0; b < count; b += WIDTH) store(row + b, add_scaled(load(row + b), -share, load(other + b)));
}

/* Entry (i, k) of U + E. */
INLINE float sum_at(ConstSingles2 first, int64_t i, int64_t k) { return first.data[i * first.columns + k] + (i == k); }

/* Fills `lower` and `upper`; returns the least pivot. */
static float factorize_sum(ConstSingles2 first, Completion own) {
    int64_t h = first.columns, size = own.size;
    float least_seen = 2.0f;
    for (int64_t i = 0; i < size; i++)
        for (int64_t k = 0; k < size; k++) own.upper[i * size + k] = i < h && k < h ? sum_at(first, k, i) : i == k;
    for (int64_t k = 0; k < size; k++) {
        const float *above = own.upper + k * size;
        if (!(above[k] >= least_seen)) least_seen = above[k];
        float scale = 1.0f / above[k];
        for (int64_t i = k + 1; i < size; i++) {
            float *row = own.upper + i * size, share = row[k] * scale;
            int64_t from = k / WIDTH * WIDTH;
            take_row(row + from, share, above + from, size - from);
            own.lower[i * size + k] = share;
            row[k] = 0.0f;
        }
    }
    return least_seen;
}

INLINE void take_tile(const int vectors, int64_t column, const float *left, int64_t apart, const float *panel,
                      int64_t first, int64_t last, float *rows) {
    Vector sums[ROWS][VECTORS];
    EACH(r, ROWS) EACH(v, vectors) sums[r][v] = load(rows + r * LANES + column + v * WIDTH);
    int64_t step = first < last ? 1 : -1;
    for (int64_t k = first; k != last; k += step)
        EACH(r, ROWS) EACH(v, vectors)
            sums[r][v] = add_scaled(sums[r][v], -left[r * apart + k], load(panel + k * LANES + column + v * WIDTH));
    EACH(r, ROWS) EACH(v, vectors) store(rows + r * LANES + column + v * WIDTH, sums[r][v]);
}

/* Take from ROWS rows of a panel what as many rows at `left` make of others, from the first to before the last. */
SHARED void take_rows(const float *left, int64_t apart, const float *panel, int64_t first, int64_t last, float *rows) {
    WITH_VECTORS(VECTORS, 0, take_tile, left, apart, panel, first, last, rows);
}

/* Overwrite the panel by A^-T times it. */
static void solve_panel(Completion own) {
    int64_t size = own.size;
    for (int64_t i = 0; i < size; i += ROWS) {
        float *rows = own.panel + i * LANES;
        take_rows(own.lower + i * size, size, own.panel, 0, i, rows);
        for (int64_t r = 1; r < ROWS; r++)
            for (int64_t k = 0; k < r; k++)
                take_row(rows + r * LANES, own.lower[(i + r) * size + i + k], rows + k * LANES, LANES);
    }
    for (int64_t i = size - ROWS; i >= 0; i -= ROWS) {
        float *rows = own.panel + i * LANES;
        const float *left = own.upper + i * size + i;
        take_rows(left, size, rows, size - i - 1, ROWS - 1, rows);
        for (int64_t r = ROWS - 1; r >= 0; r--) {
            for (int64_t k = ROWS - 1; k > r; k--)
                take_row(rows + r * LANES, left[r * size + k], rows + k * LANES, LANES);
            float scale = 1.0f / left[r * size + r];
            for (int64_t b = 0; b < LANES; b += WIDTH)
                store(rows + r * LANES + b, scaled(load(rows + r * LANES + b), scale));
        }
    }
}

/* From this pivot on, columns are completed with the accuracy that is asked for. */
static const double LEAST_PIVOT = 0x1p-20;

/* Fill `whole`, first of all by the columns that are there, `first`. Returns whether A has no smaller pivot. */
int64_t ISA(complete_columns)(ConstSingles2 first, Singles scratch, Singles2 whole) {
    int64_t h = first.columns, n = first.rows, c = whole.columns, size = whole_vectors(h);
    float *memory = aligned(scratch.data), *panel = memory + 2 * size * size;
    Completion own = {size, memory, memory + size * size, panel, panel + size * LANES};
    for (int64_t r = 0; r < n; r++)
        for (int64_t b = 0; b < h; b++) whole.data[r * c + b] = first.data[r * h + b];
    if (!(factorize_sum(first, own) >= LEAST_PIVOT)) return false;
    for (int64_t begin = h; begin < c; begin += LANES) {
        int64_t count = least(LANES, c - begin);
        for (int64_t k = 0; k < own.size; k++)
            for (int64_t b = 0; b < LANES; b++)
                own.panel[k * LANES + b] = k < h && b < count ? first.data[(begin + b) * h + k] : 0.0f;
        solve_panel(own);
        for (int64_t r = 0; r < n; r += ROWS) {
            float rows[ROWS * LANES];
            int64_t taken = least(ROWS, n - r);
            for (int64_t i = 0; i < ROWS; i++) {
                for (int64_t b = 0; b < LANES; b++) rows[i * LANES + b] = r + i == begin + b;
                for (int64_t k = 0; k < h; k++) own.some[i * own.size + k] = i < taken ? sum_at(first, r + i, k) : 0.0f;
            }
            take_rows(own.some, own.size, own.panel, 0, h, rows);
            for (int64_t i = 0; i < taken; i++)
                for (int64_t b = 0; b < count; b++) whole.data[(r + i) * c + begin + b] = rows[i * LANES + b];
        }
    }
    return true;
}
