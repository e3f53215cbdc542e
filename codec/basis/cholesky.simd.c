/* Sparse Cholesky factorization front by front: L + delta I = P^T C D C^T P, the R^-1 of the paper's section 4.
 *
 * A front gets its part of the matrix, eliminates its own steps, and takes what they leave to the steps of its border
 * straight from the fronts that own those. Every entry is its number in the matrix less the terms of all steps before
 * it, one after the other (specification, M 7.6): fronts do not show.
 */
#include "codec/basis/vectors.h"

/* A front with its border, its matrix, and D^-1 of its own steps. */
typedef struct {
    Front front;
    const uint32_t *border;
    const float *matrix, *pivots;
} Factored;

/* Column of each of its steps in the matrix of a front. */
INLINE void find_columns(const Fronts *fronts, const Front *front, uint32_t *column) {
    for (int64_t j = 0; j < front->own; j++) column[front->first + j] = (uint32_t)j;
    for (int64_t j = front->own; j < front->width; j++)
        column[fronts->borders.data[front->edge + j - front->own]] = (uint32_t)j;
}

/* Part of row k of a front's matrix, less what the rows before it take. */
INLINE void eliminate(const int vectors, int64_t p, float *matrix, int64_t apart, const float *inverse, int64_t k) {
    Vector lanes[VECTORS];
    float *row = matrix + k * apart + p;
    EACH(v, vectors) lanes[v] = load(row + v * WIDTH);
    for (int64_t i = 0; i < k; i++) {
        const float *from = matrix + i * apart;
        float share = -from[k] * inverse[i];
        EACH(v, vectors) lanes[v] = add_scaled(lanes[v], share, load(from + p + v * WIDTH));
    }
    EACH(v, vectors) store(row + v * WIDTH, lanes[v]);
}

/* Subtract from part of one or two rows, which are as far apart as those of the front, the terms of the front's steps
 * for its columns i and i + 1. */
INLINE void leave(const int vectors, int64_t p, const int rows, const Factored *f, int64_t i, float *result) {
    int64_t apart = f->front.apart;
    Vector lanes[2][VECTORS];
    EACH(r, rows) EACH(v, vectors) lanes[r][v] = load(result + r * apart + p + v * WIDTH);
    for (int64_t k = 0; k < f->front.own; k++) {
        const float *from = f->matrix + k * apart;
        EACH(r, rows) {
            float share = -from[i + r] * f->pivots[k];
            EACH(v, vectors) lanes[r][v] = add_scaled(lanes[r][v], share, load(from + p + v * WIDTH));
        }
    }
    EACH(r, rows) EACH(v, vectors) store(result + r * apart + p + v * WIDTH, lanes[r][v]);
}

/* Subtract the terms of a front's steps for its columns i and i + 1 from one or two rows of the target's matrix.
 * `places` gives the target's column for each column of the front up to `end`; `left` is scratch. */
INLINE void take_from(const int rows, const Factored *f, int64_t i, int64_t end, const Front *target, float *matrix,
    const uint32_t *places, float *left) {
    int64_t apart = f->front.apart;
    float *to[2];
    EACH(r, rows) {
        to[r] = matrix + (f->border[i + r - f->front.own] - target->first) * target->apart;
        for (int64_t j = i + r; j < end; j++) left[r * apart + j] = to[r][places[j]];
    }
    for (int64_t p = i / WIDTH * WIDTH; p < end; p += LANES)
        WITH_VECTORS(least(VECTORS, (whole_vectors(end) - p) / WIDTH), p, leave, rows, f, i, left);
    EACH(r, rows) for (int64_t j = i + r; j < end; j++) to[r][places[j]] = left[r * apart + j];
}

/* Which column of a target's matrix each column of a front from i to `end` is: both are in ascending order. */
INLINE void find_places(const Fronts *fronts, const Front *front, int64_t i, int64_t end, const Front *target,
    uint32_t *places) {
    const uint32_t *border = fronts->borders.data + front->edge - front->own,
        *theirs = fronts->borders.data + target->edge;
    int64_t limit = target->first + target->own, last = target->width - target->own - 1, k = 0;
    for (; i < end && border[i] < limit; i++) places[i] = border[i] - (uint32_t)target->first;
    for (; i < end; i++) {
        while (k < last && theirs[k] != border[i]) k++;
        places[i] = (uint32_t)(target->own + k);
    }
}

/* Factorize the matrix that has `diagonal`, and minus its weight, one without any, for every edge, to the columns of
 * -C, as rows of the fronts' matrices, and D^-1. `column` is scratch of n + 1, `scratch` of three rows of a front's
 * matrix, at most 3 (n + 16), and 15 more. */
void ISA(factorize_fronts)(ConstInts offsets, ConstInts neighbors, ConstDoubles weights, ConstDoubles diagonal,
                             Fronts fronts, Words column, Singles scratch, Singles values, Singles inverse) {
    int64_t n = fronts.rows.size, count = fronts.firsts.size - 1, filled = fronts.places.data[count];
    float *matrices = aligned(values.data), *left = aligned(scratch.data);
    uint32_t *places = (uint32_t *)(left + 2 * whole_lines(n + 1));
    for (int64_t i = 0; i < filled; i += WIDTH) store(matrices + i, zeros());
    for (int64_t i = 0; i < 2 * whole_lines(n + 1); i += WIDTH) store(left + i, zeros());
    for (int64_t t = 0; t < count; t++) {
        Front front = front_at(&fronts, t);
        float *row = matrices + front.place;
        find_columns(&fronts, &front, column.data);
        for (int64_t k = 0; k < front.own; k++, row += front.apart) {
            uint32_t r = fronts.rows.data[front.first + k];
            row[k] = (float)diagonal.data[r];
            for (int64_t i = offsets.data[r]; i < offsets.data[r + 1]; i++) {
                uint32_t step = fronts.steps.data[neighbors.data[i]];
                if (step > front.first + k) row[column.data[step]] = weights.size > 0 ? -(float)weights.data[i] : -1.0f;
            }
        }
    }
    for (int64_t t = 0; t < count; t++) {
        Front front = front_at(&fronts, t);
        float *matrix = matrices + front.place, *pivots = inverse.data + front.first;
        int64_t own = front.own, width = front.width, apart = front.apart;
        for (int64_t k = 0; k < own; k++) {
            for (int64_t p = k / WIDTH * WIDTH, columns = whole_vectors(width); p < columns; p += LANES)
                WITH_VECTORS(least(VECTORS, (columns - p) / WIDTH), p, eliminate, matrix, apart, pivots, k);
            pivots[k] = 1.0f / matrix[k * apart + k];
        }
        Factored done = {front, fronts.borders.data + front.edge, matrix, pivots};
        const uint32_t *border = done.border - own;
        int64_t end = width - (width > own && border[width - 1] == n);
        for (int64_t i = own; i < end;) {
            uint32_t owner = fronts.owners.data[border[i]];
            Front target = front_at(&fronts, owner);
            find_places(&fronts, &front, i, end, &target, places);
            for (; i + 1 < end && fronts.owners.data[border[i + 1]] == owner; i += 2)
                take_from(2, &done, i, end, &target, matrices + target.place, places, left);
            if (i < end && fronts.owners.data[border[i]] == owner)
                take_from(1, &done, i++, end, &target, matrices + target.place, places, left);
        }
        for (int64_t k = 0; k < own; k++)
            for (int64_t p = 0; p < apart; p += WIDTH)
                store(matrix + k * apart + p, scaled(load(matrix + k * apart + p), -pivots[k]));
    }
}

/* Forward and back substitution for all columns at once: R^z X, with R = (C D C^T)^-1 (paper, section 4). */

/* Columns `start` to `end` of some rows of a front's matrix, and the row of a panel that each multiplies: that of its
 * step in the border, or, without a border, the row with its own number. */
typedef struct {
    const float *entries;
    int64_t apart; /* from one row of the matrix to the next */
    const uint32_t *border;
    int64_t start, end;
} Columns;

INLINE int64_t panel_row(const Columns *columns, int64_t j) { return columns->border ? columns->border[j] : j; }

INLINE Columns border_columns(const Factored *f, const float *entries) {
    return (Columns){entries + f->front.own, f->front.apart, f->border, 0, f->front.width - f->front.own};
}

/* Subtract from each row of a panel the terms of some rows of a front; these stay in registers. */
INLINE void take_rows(const int vectors, const int rows, Vector taken[ROWS][VECTORS], Columns columns, float *x,
    int64_t lane) {
    for (int64_t j = columns.start; j < columns.end; j++) {
        float *row = x + panel_row(&columns, j) * lane;
        Vector lanes[VECTORS];
        EACH(v, vectors) lanes[v] = load(row + v * WIDTH);
        EACH(i, rows) {
            float entry = columns.entries[i * columns.apart + j];
            EACH(v, vectors) lanes[v] = add_scaled(lanes[v], entry, taken[i][v]);
        }
        EACH(v, vectors) store(row + v * WIDTH, lanes[v]);
    }
}

/* C X = B for successive rows of a front from its row k on: what they take of each other, of the later rows of the
 * front, and of its border. */
INLINE void take_forward(const int vectors, const int rows, int64_t lane, const Factored *f, int64_t k, float *x) {
    Vector taken[ROWS][VECTORS];
    const Front *front = &f->front;
    float *own = x + front->first * lane;
    const float *entries = f->matrix + k * front->apart;
    EACH(i, rows) {
        EACH(v, vectors) taken[i][v] = load(own + (k + i) * lane + v * WIDTH);
        EACH(j, rows) if (j < i) {
            float entry = entries[j * front->apart + k + i];
            EACH(v, vectors) taken[i][v] = add_scaled(taken[i][v], entry, taken[j][v]);
        }
        EACH(v, vectors) store(own + (k + i) * lane + v * WIDTH, taken[i][v]);
    }
    take_rows(vectors, rows, taken, (Columns){entries, front->apart, 0, k + rows, front->own}, own, lane);
    take_rows(vectors, rows, taken, border_columns(f, entries), x, lane);
}

/* Add to the sums of some rows of a front the products of their columns with rows of a panel, the last first. */
INLINE void add_rows(const int vectors, const int rows, Vector sums[ROWS][VECTORS], Columns columns, const float *x,
    int64_t lane) {
    for (int64_t j = columns.end - 1; j >= columns.start; j--) {
        const float *row = x + panel_row(&columns, j) * lane;
        EACH(i, rows) {
            float entry = columns.entries[i * columns.apart + j];
            EACH(v, vectors) sums[i][v] = add_scaled(sums[i][v], entry, load(row + v * WIDTH));
        }
    }
}

/* D C^T X = B for successive rows of a front from its row k on: each divided by its pivot, less its share of the rows
 * after it, the last first. */
INLINE void take_back(const int vectors, const int rows, int64_t lane, const Factored *f, int64_t k, float *x) {
    Vector sums[ROWS][VECTORS];
    const Front *front = &f->front;
    float *own = x + front->first * lane;
    const float *entries = f->matrix + k * front->apart;
    EACH(i, rows)
        EACH(v, vectors) sums[i][v] = scaled(load(own + (k + i) * lane + v * WIDTH), f->pivots[k + i]);
    add_rows(vectors, rows, sums, border_columns(f, entries), x, lane);
    add_rows(vectors, rows, sums, (Columns){entries, front->apart, 0, k + rows, front->own}, own, lane);
    EACH(down, rows) {
        const int i = rows - 1 - down;
        EACH(up, rows) if (rows - 1 - up > i) {
            float entry = entries[i * front->apart + k + rows - 1 - up];
            EACH(v, vectors) sums[i][v] = add_scaled(sums[i][v], entry, sums[rows - 1 - up][v]);
        }
        EACH(v, vectors) store(own + (k + i) * lane + v * WIDTH, sums[i][v]);
    }
}

INLINE Factored factored_at(const Fronts *fronts, const float *matrices, const float *inverse, int64_t t) {
    Front front = front_at(fronts, t);
    return (Factored){front, fronts->borders.data + front.edge, matrices + front.place, inverse + front.first};
}

INLINE void substitute_panel(const int vectors, float *x, int64_t lane, const Fronts *fronts, const float *matrices,
                             const float *inverse) {
    int64_t count = fronts->firsts.size - 1;
    for (int64_t t = 0; t < count; t++) {
        Factored f = factored_at(fronts, matrices, inverse, t);
        int64_t k = 0;
        for (; k + ROWS <= f.front.own; k += ROWS) take_forward(vectors, ROWS, lane, &f, k, x);
        if (ROWS > 3 && f.front.own - k == 3) take_forward(vectors, 3, lane, &f, k, x);
        else if (ROWS > 2 && f.front.own - k == 2) take_forward(vectors, 2, lane, &f, k, x);
        else if (f.front.own > k) take_forward(vectors, 1, lane, &f, k, x);
    }
    for (int64_t t = count - 1; t >= 0; t--) {
        Factored f = factored_at(fronts, matrices, inverse, t);
        int64_t k = f.front.own;
        for (; k >= ROWS; k -= ROWS) take_back(vectors, ROWS, lane, &f, k - ROWS, x);
        if (ROWS > 3 && k == 3) take_back(vectors, 3, lane, &f, 0, x);
        else if (ROWS > 2 && k == 2) take_back(vectors, 2, lane, &f, 0, x);
        else if (k > 0) take_back(vectors, 1, lane, &f, 0, x);
    }
}

/* Overwrite panels of X, their rows in the order of elimination, by (C D C^T)^-1 X. */
void ISA(substitute)(Fronts fronts, const float *matrices, const float *inverse, Panels panels) {
    for (int64_t b = 0; b < panel_count(&panels); b++) {
        Panel panel = panel_at(&panels, b);
        WITH_VECTORS(panel.apart / WIDTH, panel.data, substitute_panel, panel.apart, &fronts, matrices, inverse);
    }
}

/* R X for X of shape (n, c) and a factor of `factorize_fronts`; X is rounded to single precision. */
void ISA(solve_columns)(Fronts fronts, Singles values, ConstSingles inverse, ConstDoubles2 columns, Singles scratch,
                          Doubles2 solution) {
    Panels panels = {aligned(scratch.data), padded_rows(columns.rows), whole_vectors(columns.columns)};
    for (int64_t i = 0; i < panels_size(&panels); i += WIDTH) store(panels.data + i, zeros());
    for (int back = 0; back < 2; back++) {
        for (int64_t b = 0; b < panel_count(&panels); b++) {
            Panel panel = panel_at(&panels, b);
            int64_t width = least(panel.apart, columns.columns - panel.first);
            for (int64_t k = 0; k < columns.rows; k++) {
                int64_t at = fronts.rows.data[k] * columns.columns + panel.first;
                float *row = panel.data + k * panel.apart;
                for (int64_t j = 0; j < width; j++)
                    if (back) solution.data[at + j] = row[j];
                    else row[j] = (float)columns.data[at + j];
            }
        }
        if (!back) ISA(substitute)(fronts, aligned(values.data), inverse.data, panels);
    }
}
