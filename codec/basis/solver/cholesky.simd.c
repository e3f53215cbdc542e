/* Sparse Cholesky factorisation front by front: L + delta I = P^T C D C^T P, the R^-1 of the paper's section 4.
 *
 * A front gets its part of the matrix, eliminates its own steps, and takes what they leave to the steps of its border
 * straight to the fronts that own those (specification, M 7.4). An entry is the sum of its terms in the order of
 * elimination, each product fused with the sum.
 */
#include "codec/basis/solver/front.h"

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
