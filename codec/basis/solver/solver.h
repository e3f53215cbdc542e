/* What Python calls of the solver. */
#ifndef BSM_SOLVER_H
#define BSM_SOLVER_H

#include "bitstream/kernel.h"

/* See fronts.py. */
typedef struct {
    ConstWords rows, steps, owners, firsts, starts, borders, places;
    ConstDoubles sums;
} Fronts;

/* Whether there is room for a factor of these fronts of n rows. */
INLINE bool fits_factor(const Fronts *fronts, int64_t n, Doubles values, Doubles inverse) {
    int64_t count = fronts->firsts.size - 1;
    return n > 0 && fronts->sums.size == 2 && fronts->rows.size == n && fronts->steps.size == n && fronts->owners.size == n && count > 0 &&
           fronts->starts.size == count + 1 && fronts->places.size == count + 1 &&
           fronts->borders.size >= fronts->starts.data[count] && inverse.size == n &&
           values.size >= (int64_t)fronts->places.data[count] + 7;
}

int64_t dissect(ConstInts offsets, ConstInts neighbours, int64_t leaf, Ints cuts, Words rows, Words firsts);
int64_t find_borders(ConstInts offsets, ConstInts neighbours, ConstWords rows, ConstWords firsts, double most_work,
                     Words scratch, Words steps, Words owners, Words starts, Words borders, Words places);
int64_t find_fronts(ConstInts offsets, ConstInts neighbours, int64_t leaf, double most_work, Words scratch, Words rows,
                    Words steps, Words owners, Words firsts, Words starts, Words borders, Words places, Doubles sums);
void LEVEL(factorize_fronts)(ConstInts offsets, ConstInts neighbours, ConstDoubles weights, ConstDoubles diagonal, Fronts fronts,
                      Words column, Doubles scratch, Doubles values, Doubles inverse);
void LEVEL(solve_columns)(Fronts fronts, Doubles values, ConstDoubles inverse, ConstDoubles2 columns, int64_t power,
                   Doubles scratch, Doubles2 solution);

#endif
