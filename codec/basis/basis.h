/* The kernels of dictionaries. */
#pragma once

#include "bitstream/kernel.h"

/* The fronts of a block of n rows, in the order of elimination: see fronts.c. */
typedef struct {
    Words rows, steps, owners, firsts, starts, borders, places;
    Doubles sums;
} Fronts;

int64_t find_fronts(ConstInts offsets, ConstInts neighbors, double most_work, Words scratch, Fronts *fronts);
void ISA(factorize_fronts)(ConstInts offsets, ConstInts neighbors, ConstDoubles weights, ConstDoubles diagonal,
                             Fronts fronts, Words column, Singles scratch, Singles values, Singles inverse);
void ISA(solve_columns)(Fronts fronts, Singles values, ConstSingles inverse, ConstDoubles2 columns, Singles scratch,
                          Doubles2 solution);
int64_t ISA(iteration_space)(int64_t n, int64_t c, int64_t apart);
enum { DONE, NEEDS_CARE, LOST }; /* columns must be made orthonormal one by one; they cannot be */
int64_t ISA(iterate)(Fronts fronts, Singles values, ConstSingles inverse, ConstSingles2 start, int64_t power,
                       int64_t iterations, int64_t apart, int64_t care, Singles scratch, Singles2 subspace);
int64_t ISA(doubles_space)(int64_t n, int64_t c);
int64_t ISA(onorm_in_doubles)(float *columns, int64_t rows, int64_t width, int64_t n, int64_t c, int64_t *care,
    const uint32_t *order, float *scratch);
int64_t ISA(completion_space)(int64_t h);
int64_t ISA(complete_columns)(ConstSingles2 first, Singles scratch, Singles2 whole);
void ISA(cosines)(Doubles table, Doubles2 columns);
void ISA(resize_columns)(ConstSingles2 previous, Doubles table, Singles2 columns);
bool ISA(are_vectors_exact)(void);

/* Entry of a hash column (specification, M 8.6): the splitmix64 of row * 2^32 + column, as a number in [-1, 1). */
INLINE double hash_at(int64_t row, int64_t column) {
    uint64_t z = (((uint64_t)row << 32) + (uint64_t)column + 1) * 0x9E3779B97F4A7C15u;
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
    return (double)((z ^ (z >> 31)) >> 11) * 0x1p-52 - 1.0;
}

bool weigh_by_cotangents(ConstInts offsets, ConstInts neighbors, ConstInts2 faces, ConstDoubles2 positions,
                         Doubles weights);
int64_t hold(ConstInts offsets, ConstInts neighbors, ConstDoubles weights, ConstInts rank, ConstInts vertices,
             ConstInts own_offsets, ConstInts own_neighbors, Doubles inner, Doubles springs, Ints starts, Ints outer,
             Doubles stiffness);
void pull(ConstInts starts, ConstInts outer, ConstDoubles stiffness, ConstDoubles2 field, Doubles2 pulls);
