/* What Python calls of the solver. */
#ifndef BSM_SOLVER_H
#define BSM_SOLVER_H

#include "bitstream/kernel.h"

/* See fronts.py. */
typedef struct {
    ConstWords rows, steps, owners, firsts, starts, borders, places;
    ConstDoubles sums;
} Fronts;

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
