/* Columns that complete others to a square matrix with columns at right angles (specification, M 8.7).
 *
 * With U the h columns that are there, E the first h columns of I, and A = I + E^T U, the matrix I - (U + E) A^-T (U + E)^T
 * is orthogonal and takes E to -U; so its columns from h on are at right angles to U. A has a symmetric part that is not
 * indefinite, which is why it is factorised without exchanges.
 */
#include "codec/basis/completion.h"

#include "codec/basis/solver/vectors.h"

/* A^T = L R, of a multiple of ROWS rows, with the identity behind those that there are; and the rows of a panel. */
typedef struct {
    int64_t size, apart;
    double *lower, *upper, *panel;
} Completion;

INLINE Completion completion_of(int64_t h, double *memory) {
    int64_t apart = whole_vectors(h);
    return (Completion){apart, apart, memory, memory + apart * apart, memory + 2 * apart * apart};
}

/* Doubles of scratch that completing h columns takes. */
int64_t LEVEL(completion_space)(int64_t h) {
    int64_t apart = whole_vectors(h);
    return 2 * apart * apart + apart * LANES + WIDTH - 1;
}

/* Fills `lower` and `upper`; returns the least pivot. */
static double factorize_sum(ConstDoubles2 first, Completion own) {
    int64_t h = first.columns, apart = own.apart;
    double least_seen = 2.0;
    for (int64_t i = 0; i < own.size; i++) {
        for (int64_t k = 0; k < apart; k++) {
            own.upper[i * apart + k] = (i < h && k < h ? first.data[k * h + i] : 0.0) + (i == k);
            own.lower[i * apart + k] = 0.0;
        }
    }
    for (int64_t k = 0; k < own.size; k++) {
        const double *above = own.upper + k * apart;
        if (!(above[k] >= least_seen)) least_seen = above[k];
        double scale = 1.0 / above[k];
        for (int64_t i = k + 1; i < own.size; i++) {
            double *row = own.upper + i * apart, share = row[k] * scale;
            own.lower[i * apart + k] = share;
            for (int64_t b = k / WIDTH * WIDTH; b < apart; b += WIDTH)
                store(row + b, add_scaled(load(row + b), -share, load(above + b)));
            row[k] = 0.0;
        }
    }
    return least_seen;
}

/* Some rows of the panel, from row i on, less what a triangle takes of rows `from` to `to`. */
INLINE void take_panel(const int vectors, int64_t column, const double *triangle, int64_t apart, double *panel, int64_t i,
                       int64_t from, int64_t to) {
    Vector sums[ROWS][VECTORS];
    EACH(r, ROWS) EACH(v, vectors) sums[r][v] = load(panel + (i + r) * LANES + column + v * WIDTH);
    for (int64_t k = from; k < to; k++)
        EACH(r, ROWS) EACH(v, vectors)
            sums[r][v] = add_scaled(sums[r][v], -triangle[(i + r) * apart + k], load(panel + k * LANES + column + v * WIDTH));
    EACH(r, ROWS) EACH(v, vectors) store(panel + (i + r) * LANES + column + v * WIDTH, sums[r][v]);
}

/* Overwrite the panel by A^-T times it. */
static void solve_panel(Completion own) {
    int64_t apart = own.apart;
    double *panel = own.panel;
    for (int64_t i = 0; i < own.size; i += ROWS) {
        WITH_VECTORS(VECTORS, 0, take_panel, own.lower, apart, panel, i, 0, i);
        for (int64_t r = i + 1; r < i + ROWS; r++)
            for (int64_t k = i; k < r; k++)
                for (int64_t b = 0; b < LANES; b++)
                    panel[r * LANES + b] = FUSED(-own.lower[r * apart + k], panel[k * LANES + b], panel[r * LANES + b]);
    }
    for (int64_t i = own.size - ROWS; i >= 0; i -= ROWS) {
        WITH_VECTORS(VECTORS, 0, take_panel, own.upper, apart, panel, i, i + ROWS, own.size);
        for (int64_t r = i + ROWS - 1; r >= i; r--) {
            double scale = 1.0 / own.upper[r * apart + r];
            for (int64_t k = r + 1; k < i + ROWS; k++)
                for (int64_t b = 0; b < LANES; b++)
                    panel[r * LANES + b] = FUSED(-own.upper[r * apart + k], panel[k * LANES + b], panel[r * LANES + b]);
            for (int64_t b = 0; b < LANES; b++) panel[r * LANES + b] *= scale;
        }
    }
}

/* Minus some rows of U, at `left`, times the panel: `some`. */
INLINE void take_product(const int vectors, int64_t column, const int rows, const double *left, int64_t h,
                         const double *panel, double *some) {
    Vector sums[ROWS][VECTORS];
    EACH(r, rows) EACH(v, vectors) sums[r][v] = zeros();
    for (int64_t k = 0; k < h; k++)
        EACH(r, rows) EACH(v, vectors)
            sums[r][v] = add_scaled(sums[r][v], -left[r * h + k], load(panel + k * LANES + column + v * WIDTH));
    EACH(r, rows) EACH(v, vectors) store(some + r * LANES + column + v * WIDTH, sums[r][v]);
}

/* Fill `whole`, first of all by the columns that are there, `first`. Returns whether A has no pivot below `least_pivot`. */
int64_t LEVEL(complete_columns)(ConstDoubles2 first, double least_pivot, Doubles scratch, Doubles2 whole) {
    int64_t h = first.columns, n = first.rows, c = whole.columns;
    if (whole.rows != n || c < h || c > n || scratch.size < LEVEL(completion_space)(h)) return MISUSED;
    Completion own = completion_of(h, aligned(scratch.data));
    for (int64_t r = 0; r < n; r++)
        for (int64_t b = 0; b < h; b++) whole.data[r * c + b] = first.data[r * h + b];
    if (!(factorize_sum(first, own) >= least_pivot)) return false;
    for (int64_t begin = h; begin < c; begin += LANES) {
        int64_t count = least(LANES, c - begin);
        for (int64_t k = 0; k < own.size; k++)
            for (int64_t b = 0; b < LANES; b++)
                own.panel[k * LANES + b] = k < h && b < count ? first.data[(begin + b) * h + k] : 0.0;
        solve_panel(own);
        for (int64_t r = 0; r < n; r += ROWS) {
            double some[ROWS * LANES];
            int64_t rows = least(ROWS, n - r);
            if (rows == ROWS) {
                WITH_VECTORS(VECTORS, 0, take_product, ROWS, first.data + r * h, h, own.panel, some);
            } else {
                for (int64_t i = 0; i < rows; i++)
                    WITH_VECTORS(VECTORS, 0, take_product, 1, first.data + (r + i) * h, h, own.panel, some + i * LANES);
            }
            for (int64_t i = 0; i < rows; i++) {
                double *to = whole.data + (r + i) * c + begin;
                for (int64_t b = 0; b < count; b++) {
                    double taken = r + i < h ? own.panel[(r + i) * LANES + b] : 0.0;
                    to[b] = some[i * LANES + b] - taken + (r + i == begin + b);
                }
            }
        }
    }
    return true;
}
