/* Forward and back substitution for all columns at once: R^z X, with R = (C D C^T)^-1 (paper, section 4). */
#include "codec/basis/solver/substitution.h"

/* C X = B: each row, less what the rows before it take of it. As many rows of the border at a time as keep the
 * processor busy: an addition takes longer than it needs to begin the next. */
INLINE void take_border(const int vectors, const int rows, int64_t lane, const Front *front, const uint32_t *border,
                        const double *column, double *x) {
    Vector lanes[ROWS][VECTORS];
        EACH(i, rows)
        EACH(v, vectors) lanes[i][v] = load(x + border[i] * lane + v * WIDTH);
    for (int64_t k = 0; k < front->own; k++) {
        const double *source = x + (front->first + k) * lane, *entry = column + k * front->apart;
        EACH(i, rows)
            EACH(v, vectors) lanes[i][v] = add_scaled(lanes[i][v], -entry[i], load(source + v * WIDTH));
    }
    EACH(i, rows)
        EACH(v, vectors) store(x + border[i] * lane + v * WIDTH, lanes[i][v]);
}

INLINE void substitute_forward(const int vectors, int64_t lane, const Fronts *fronts, const double *matrices, double *x) {
        for (int64_t t = 0; t < fronts->firsts.size - 1; t++) {
        Front front = front_at(fronts, t);
        const double *matrix = matrices + front.place;
        double *own = x + front.first * lane;
        for (int64_t i = 1; i < front.own; i++) {
            Vector lanes[VECTORS];
            EACH(v, vectors) lanes[v] = load(own + i * lane + v * WIDTH);
            for (int64_t k = 0; k < i; k++) {
                double entry = -matrix[k * front.apart + i];
                EACH(v, vectors) lanes[v] = add_scaled(lanes[v], entry, load(own + k * lane + v * WIDTH));
            }
            EACH(v, vectors) store(own + i * lane + v * WIDTH, lanes[v]);
        }
        const uint32_t *border = fronts->borders.data + front.edge;
        int64_t size = front.width - front.own, i = 0;
        for (; i + ROWS <= size; i += ROWS) take_border(vectors, ROWS, lane, &front, border + i, matrix + front.own + i, x);
        for (; i < size; i += 2) take_border(vectors, 2, lane, &front, border + i, matrix + front.own + i, x);
    }
}

/* Sums of each row on the way back, which take the entries of its border in turn, so that no addition waits for the one
 * before; and rows side by side. Without fused products the last bits differ anyway, and more rows are worth more. */
#ifdef __wasm__
#define SUMS 1
#else
#define SUMS 2
#endif
#define BACK (ROWS / SUMS)

/* D C^T X = B for successive rows of a front from its row k on: each divided by its pivot, less its share of the rows
 * after it; first those of the border, then those of its front. */
INLINE void take_back(const int vectors, const int rows, int64_t lane, const Front *front, int64_t k,
                      const uint32_t *border, const double *matrix, const double *inverse, double *x) {
    Vector sums[SUMS][BACK][VECTORS];
    const int64_t size = front->width - front->own;
    double *own = x + front->first * lane;
    const double *entries = matrix + k * front->apart;
    EACH(i, rows) {
        EACH(v, vectors) {
            sums[SUMS - 1][i][v] = zeros();
            sums[0][i][v] = scaled(load(own + (k + i) * lane + v * WIDTH), inverse[front->first + k + i]);
        }
    }
    for (int64_t j = 0; j < size; j += SUMS) {
        EACH(i, rows) {
            const double *entry = entries + i * front->apart + front->own + j;
            EACH(v, vectors) EACH(s, SUMS)
                sums[s][i][v] = add_scaled(sums[s][i][v], -entry[s], load(x + border[j + s] * lane + v * WIDTH));
        }
    }
    EACH(down, rows) {
        const int i = rows - 1 - down;
        for (int64_t j = k + i + 1; j < front->own; j++) {
            double entry = -entries[i * front->apart + j];
            EACH(v, vectors) sums[0][i][v] = add_scaled(sums[0][i][v], entry, load(own + j * lane + v * WIDTH));
        }
        EACH(v, vectors) {
            Vector whole = SUMS > 1 ? sum_of(sums[0][i][v], sums[SUMS - 1][i][v]) : sums[0][i][v];
            store(own + (k + i) * lane + v * WIDTH, whole);
        }
    }
}

INLINE void substitute_back(const int vectors, int64_t lane, const Fronts *fronts, const double *matrices,
                            const double *inverse, double *x) {
    for (int64_t t = fronts->firsts.size - 2; t >= 0; t--) {
        Front front = front_at(fronts, t);
        const uint32_t *border = fronts->borders.data + front.edge;
        const double *matrix = matrices + front.place;
        int64_t k = front.own;
        for (; k >= BACK; k -= BACK) take_back(vectors, BACK, lane, &front, k - BACK, border, matrix, inverse, x);
        if (k > 0) take_back(vectors, 1, lane, &front, 0, border, matrix, inverse, x);
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
