/* Sparse Cholesky factorisation front by front: L + delta I = P^T C D C^T P, the R^-1 of the paper's section 4.
 *
 * A front gets its part of the matrix, eliminates its own steps, and takes what they leave to the steps of its border
 * straight to the fronts that own those (specification, M 7.4). An entry is the sum of its terms in the order of
 * elimination, each product fused with the sum.
 */
#include "codec/basis/vectors.h"

/* Column of each of its steps in the matrix of a front. */
INLINE void find_columns(const Fronts *fronts, const Front *front, uint32_t *column) {
    for (int64_t j = 0; j < front->own; j++) column[front->first + j] = (uint32_t)j;
    for (int64_t j = front->own; j < front->width; j++)
        column[fronts->borders.data[front->edge + j - front->own]] = (uint32_t)j;
}

/* Part of row k of a front's matrix, less what the rows before it take. */
INLINE void eliminate(const int vectors, int64_t p, double *matrix, int64_t apart, const double *inverse, int64_t k) {
    Vector lanes[VECTORS];
    double *row = matrix + k * apart + p;
    EACH(v, vectors) lanes[v] = load(row + v * WIDTH);
    for (int64_t i = 0; i < k; i++) {
        const double *from = matrix + i * apart;
        double share = -from[k] * inverse[i];
        EACH(v, vectors) lanes[v] = add_scaled(lanes[v], share, load(from + p + v * WIDTH));
    }
    EACH(v, vectors) store(row + v * WIDTH, lanes[v]);
}

/* Part of what a front leaves to the steps at its columns i and i + 1. */
INLINE void leave(const int vectors, int64_t p, const double *matrix, int64_t apart, const double *inverse, int64_t own,
                  int64_t i, double *result) {
    Vector lanes[VECTORS], others[VECTORS];
    EACH(v, vectors) lanes[v] = others[v] = zeros();
    for (int64_t k = 0; k < own; k++) {
        const double *from = matrix + k * apart;
        double share = -from[i] * inverse[k], other = -from[i + 1] * inverse[k];
        EACH(v, vectors) {
            Vector row = load(from + p + v * WIDTH);
            lanes[v] = add_scaled(lanes[v], share, row);
            others[v] = add_scaled(others[v], other, row);
        }
    }
    EACH(v, vectors) {
        store(result + p + v * WIDTH, lanes[v]);
        store(result + apart + p + v * WIDTH, others[v]);
    }
}

/* Factorise the matrix that has `diagonal`, and minus its weight, one without any, for every edge, to the columns of -C, as rows of the
 * fronts' matrices, and D^-1. `column` is scratch of n + 1, `scratch` of two rows of a front's matrix, at most
 * 2 (n + 16). */
void LEVEL(factorize_fronts)(ConstInts offsets, ConstInts neighbours, ConstDoubles weights, ConstDoubles diagonal,
                             Fronts fronts, Words column, Doubles scratch, Doubles values, Doubles inverse) {
    int64_t n = fronts.rows.size, count = fronts.firsts.size - 1, filled = fronts.places.data[count];
    double *matrices = aligned(values.data), *left = aligned(scratch.data);
    for (int64_t i = 0; i < filled; i += WIDTH) store(matrices + i, zeros());
    for (int64_t t = 0; t < count; t++) {
        Front front = front_at(&fronts, t);
        double *matrix = matrices + front.place, *pivots = inverse.data + front.first;
        int64_t own = front.own, width = front.width, apart = front.apart;
        find_columns(&fronts, &front, column.data);
        for (int64_t k = 0; k < own; k++) {
            uint32_t r = fronts.rows.data[front.first + k];
            matrix[k * apart + k] += diagonal.data[r];
            for (int64_t i = offsets.data[r]; i < offsets.data[r + 1]; i++) {
                uint32_t step = fronts.steps.data[neighbours.data[i]];
                if (step > front.first + k) matrix[k * apart + column.data[step]] -= weights.size > 0 ? weights.data[i] : 1.0;
            }
        }
        for (int64_t k = 0; k < own; k++) {
            for (int64_t p = k / WIDTH * WIDTH; p < apart; p += LANES)
                WITH_VECTORS(least(VECTORS, (apart - p) / WIDTH), p, eliminate, matrix, apart, pivots, k);
            pivots[k] = 1.0 / matrix[k * apart + k];
        }
        uint32_t owner = UINT32_MAX;
        Front target = front;
        for (int64_t i = own; i < width; i += 2) {
            for (int64_t p = i / WIDTH * WIDTH; p < apart; p += LANES)
                WITH_VECTORS(least(VECTORS, (apart - p) / WIDTH), p, leave, matrix, apart, pivots, own, i, left);
            for (int64_t row = i; row < i + 2; row++) {
                uint32_t step = fronts.borders.data[front.edge + row - own];
                if (step == n) break;
                if (fronts.owners.data[step] != owner) {
                    owner = fronts.owners.data[step];
                    target = front_at(&fronts, owner);
                    find_columns(&fronts, &target, column.data);
                }
                double *to = matrices + target.place + (step - target.first) * target.apart;
                const double *from = left + (row - i) * apart;
                for (int64_t j = row; j < width; j++) {
                    uint32_t later = fronts.borders.data[front.edge + j - own];
                    if (later < n) to[column.data[later]] += from[j];
                }
            }
        }
        for (int64_t k = 0; k < own; k++)
            for (int64_t p = 0; p < apart; p += WIDTH)
                store(matrix + k * apart + p, scaled(load(matrix + k * apart + p), -pivots[k]));
    }
}

/* Forward and back substitution for all columns at once: R^z X, with R = (C D C^T)^-1 (paper, section 4). */

/* Rows `start` to `end` of a panel, less what some rows of a front take of each; these stay in registers. */
INLINE void take_rows(const int vectors, const int rows, Vector taken[ROWS][VECTORS], const double *entries, int64_t apart,
                      const uint32_t *border, int64_t start, int64_t end, double *x, int64_t lane) {
    for (int64_t j = start; j < end; j++) {
        double *row = x + (border ? border[j] : j) * lane;
        Vector lanes[VECTORS];
        EACH(v, vectors) lanes[v] = load(row + v * WIDTH);
        EACH(i, rows) {
            double entry = entries[i * apart + j];
            EACH(v, vectors) lanes[v] = add_scaled(lanes[v], entry, taken[i][v]);
        }
        EACH(v, vectors) store(row + v * WIDTH, lanes[v]);
    }
}

/* C X = B for successive rows of a front from its row k on: what they take of each other, of the later rows of the front,
 * and of its border. */
INLINE void take_forward(const int vectors, const int rows, int64_t lane, const Front *front, int64_t k,
                         const uint32_t *border, const double *matrix, double *x) {
    Vector taken[ROWS][VECTORS];
    double *own = x + front->first * lane;
    const double *entries = matrix + k * front->apart;
    EACH(i, rows) {
        EACH(v, vectors) taken[i][v] = load(own + (k + i) * lane + v * WIDTH);
        EACH(j, rows) if (j < i) {
            double entry = entries[j * front->apart + k + i];
            EACH(v, vectors) taken[i][v] = add_scaled(taken[i][v], entry, taken[j][v]);
        }
        EACH(v, vectors) store(own + (k + i) * lane + v * WIDTH, taken[i][v]);
    }
    take_rows(vectors, rows, taken, entries, front->apart, 0, k + rows, front->own, own, lane);
    take_rows(vectors, rows, taken, entries + front->own, front->apart, border, 0, front->width - front->own, x, lane);
}

/* Sums of rows on the way back, each row of which is multiplied by what it has at rows `start` to `end` of a panel. */
INLINE void add_rows(const int vectors, const int rows, Vector sums[ROWS][VECTORS], const double *entries, int64_t apart,
                     const uint32_t *border, int64_t start, int64_t end, const double *x, int64_t lane) {
    for (int64_t j = start; j < end; j++) {
        const double *row = x + (border ? border[j] : j) * lane;
        EACH(i, rows) {
            double entry = entries[i * apart + j];
            EACH(v, vectors) sums[i][v] = add_scaled(sums[i][v], entry, load(row + v * WIDTH));
        }
    }
}

/* D C^T X = B for successive rows of a front from its row k on: each divided by its pivot, less its share of the rows
 * after it; first those of the border, then those of its front. */
INLINE void take_back(const int vectors, const int rows, int64_t lane, const Front *front, int64_t k,
                      const uint32_t *border, const double *matrix, const double *inverse, double *x) {
    Vector sums[ROWS][VECTORS];
    double *own = x + front->first * lane;
    const double *entries = matrix + k * front->apart;
    EACH(i, rows)
        EACH(v, vectors) sums[i][v] = scaled(load(own + (k + i) * lane + v * WIDTH), inverse[front->first + k + i]);
    add_rows(vectors, rows, sums, entries + front->own, front->apart, border, 0, front->width - front->own, x, lane);
    add_rows(vectors, rows, sums, entries, front->apart, 0, k + rows, front->own, own, lane);
    EACH(down, rows) {
        const int i = rows - 1 - down;
        EACH(j, rows) if (j > i) {
            double entry = entries[i * front->apart + k + j];
            EACH(v, vectors) sums[i][v] = add_scaled(sums[i][v], entry, sums[j][v]);
        }
        EACH(v, vectors) store(own + (k + i) * lane + v * WIDTH, sums[i][v]);
    }
}

/* Call `function(vectors, rows, ...)` for what is left of `ROWS` rows. */
#if ROWS == 2
#define WITH_REST(rows, function, vectors, ...)                                                                        \
    if ((rows) == 1) function(vectors, 1, __VA_ARGS__)
#else
#define WITH_REST(rows, function, vectors, ...)                                                                        \
    switch (rows) {                                                                                                    \
        case 1: function(vectors, 1, __VA_ARGS__); break;                                                              \
        case 2: function(vectors, 2, __VA_ARGS__); break;                                                              \
        case 3: function(vectors, 3, __VA_ARGS__);                                                                     \
    }
#endif

INLINE void substitute_forward(const int vectors, int64_t lane, const Fronts *fronts, const double *matrices, double *x) {
    for (int64_t t = 0; t < fronts->firsts.size - 1; t++) {
        Front front = front_at(fronts, t);
        const uint32_t *border = fronts->borders.data + front.edge;
        const double *matrix = matrices + front.place;
        int64_t k = 0;
        for (; k + ROWS <= front.own; k += ROWS) take_forward(vectors, ROWS, lane, &front, k, border, matrix, x);
        WITH_REST(front.own - k, take_forward, vectors, lane, &front, k, border, matrix, x);
    }
}

INLINE void substitute_back(const int vectors, int64_t lane, const Fronts *fronts, const double *matrices,
                            const double *inverse, double *x) {
    for (int64_t t = fronts->firsts.size - 2; t >= 0; t--) {
        Front front = front_at(fronts, t);
        const uint32_t *border = fronts->borders.data + front.edge;
        const double *matrix = matrices + front.place;
        int64_t k = front.own;
        for (; k >= ROWS; k -= ROWS) take_back(vectors, ROWS, lane, &front, k - ROWS, border, matrix, inverse, x);
        WITH_REST(k, take_back, vectors, lane, &front, 0, border, matrix, inverse, x);
    }
}

INLINE void substitute_panel(const int vectors, double *x, int64_t lane, const Fronts *fronts, const double *matrices,
                             const double *inverse, int64_t power) {
    for (; power > 0; power--) {
        substitute_forward(vectors, lane, fronts, matrices, x);
        substitute_back(vectors, lane, fronts, matrices, inverse, x);
    }
}

/* Overwrite panels of X, their rows in the order of elimination, by (C D C^T)^-power X. */
void LEVEL(substitute)(Fronts fronts, const double *matrices, const double *inverse, Panels panels, int64_t power) {
    for (int64_t b = 0; b < panel_count(&panels); b++) {
        Panel panel = panel_at(&panels, b);
        WITH_VECTORS(panel.apart / WIDTH, panel.data, substitute_panel, panel.apart, &fronts, matrices, inverse, power);
    }
}

/* R^z X for X of shape (n, c) and a factor of `factorize_fronts`. */
void LEVEL(solve_columns)(Fronts fronts, Doubles values, ConstDoubles inverse, ConstDoubles2 columns, int64_t power,
                   Doubles scratch, Doubles2 solution) {
    Panels panels = {aligned(scratch.data), padded_rows(columns.rows), whole_vectors(columns.columns)};
    LEVEL(pack)(columns, columns.columns, fronts.rows.data, panels);
    LEVEL(substitute)(fronts, aligned(values.data), inverse.data, panels, power);
    LEVEL(unpack)(panels, fronts.rows.data, solution);
}
