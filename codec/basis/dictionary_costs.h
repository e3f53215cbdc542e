/* What dictionaries cost, as bitstream/costs.h has it of all else (specification, M 14.2, M 14.3). */
#pragma once

#include "bitstream/costs.h"
#include "codec/basis/basis.h"

/* Columns count as they are computed, in vectors of sixteen. */
INLINE double whole_columns(int64_t columns) { return (double)((columns + 15) / 16 * 16); }
INLINE double solve_work(const Fronts *fronts, int64_t columns) {
    return 50 + fronts->sums.data[0] * (0.3 * (double)((columns + 63) / 64) + 0.02 * whole_columns(columns));
}
INLINE double factor_work(const Fronts *fronts) {
    return fronts->sums.data[1] / 6 + 50.0 * (double)fronts->rows.size + 4000;
}
INLINE double onorm_work(double rows, int64_t columns) {
    double c = whole_columns(columns);
    return rows * (3 + 0.4 * c + c * c / 80) + 3000;
}
static const double IN_DOUBLES = 2; /* Onorm, over that in single precision */
INLINE double dictionary_work(const Fronts *fronts, int64_t columns, double solutions, double onorms, double care) {
    double rows = (double)fronts->rows.size;
    double rounds = solutions * solve_work(fronts, columns) + onorms * onorm_work(rows, columns);
    return 5 * rows * whole_columns(columns) + rounds + 6 * rows * (double)columns * care;
}
INLINE double completion_work(double rows, double first, double columns) {
    double more = above_zero(columns - first);
    return (first * first * first / 3 + more * first * (first + rows)) / 15 + 2 * rows * columns + 1500;
}
INLINE double ground_work(const Fronts *fronts, int64_t columns) {
    return factor_work(fronts) + solve_work(fronts, 3) + 1.5 * (double)fronts->rows.size * (double)columns;
}
INLINE double patch_memory(const Fronts *fronts, int64_t columns) {
    double rows = (double)fronts->rows.size, c = whole_columns(columns),
           size = fronts->places.data[fronts->places.size - 1];
    return 8 * (6 * rows * c + 2 * c * c + size) + 500 * rows;
}
