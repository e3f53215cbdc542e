/* The kernels of dictionaries. */
#ifndef BSM_BASIS_H
#define BSM_BASIS_H

#include "bitstream/kernel.h"

/* See laplacian.py. */
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

int64_t find_fronts(ConstInts offsets, ConstInts neighbours, int64_t leaf, double most_work, Words scratch, Words rows,
                    Words steps, Words owners, Words firsts, Words starts, Words borders, Words places, Doubles sums);
void LEVEL(factorize_fronts)(ConstInts offsets, ConstInts neighbours, ConstDoubles weights, ConstDoubles diagonal, Fronts fronts,
                      Words column, Doubles scratch, Doubles values, Doubles inverse);
void LEVEL(solve_columns)(Fronts fronts, Doubles values, ConstDoubles inverse, ConstDoubles2 columns, int64_t power,
                   Doubles scratch, Doubles2 solution);
int64_t LEVEL(iteration_space)(int64_t n, int64_t c);
double LEVEL(iterate)(Fronts fronts, Doubles values, ConstDoubles inverse, ConstDoubles2 start, int64_t power, int64_t iterations,
               double once, Doubles scratch, Doubles2 subspace);
double LEVEL(cholesky_onorm)(ConstDoubles2 columns, double once, Doubles scratch, Doubles2 subspace);
int64_t LEVEL(completion_space)(int64_t h);
int64_t LEVEL(complete_columns)(ConstDoubles2 first, double least_pivot, Doubles scratch, Doubles2 whole);
void LEVEL(cosines)(int64_t first, Doubles table, Doubles2 columns);
void LEVEL(resize_columns)(ConstDoubles2 previous, Doubles table, Doubles2 columns);
void hash_columns(Doubles2 columns);
void householder(Doubles2 work, Doubles scratch, Doubles2 q);
void cotangents(ConstInts offsets, ConstInts neighbours, ConstInts2 faces, ConstDoubles2 positions, double flatness,
                double smallness, Doubles weights);
int64_t hold(ConstInts offsets, ConstInts neighbours, ConstDoubles weights, ConstInts rank, ConstInts vertices,
             ConstInts own_offsets, ConstInts own_neighbours, Doubles inner, Doubles springs, Ints starts, Ints outer,
             Doubles stiffness);
void pull(ConstInts starts, ConstInts outer, ConstDoubles stiffness, ConstDoubles2 field, Doubles2 pulls);

#endif
