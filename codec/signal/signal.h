/* The kernels of signals. */
#pragma once

#include "codec/basis/basis.h"

/* A position, and a number more. */
typedef double Four __attribute__((vector_size(32)));
typedef double UnalignedFour __attribute__((vector_size(32), aligned(8), may_alias));

void ISA(project)(ConstSingles2 subspace, ConstDoubles2 values, Doubles2 coefficients);
void ISA(reconstruct)(ConstSingles2 subspace, ConstDoubles2 coefficients, Doubles2 values);
void look_around(ConstInts offsets, ConstInts neighbors, ConstInts vertices, Bytes inside, ConstDoubles2 sums,
                 ConstDoubles weights, Doubles springs, Doubles2 pulls);
void continue_known(Fronts fronts, Singles values, ConstSingles inverse, ConstDoubles springs, ConstDoubles2 pulls,
    Singles scratch, Doubles2 continued);
void place_block(ConstDoubles2 prediction, ConstSingles2 subspace, ConstInts2 levels, double half_step,
    Doubles scratch, Doubles2 positions);
int64_t smooth_all(ConstInts offsets, ConstInts neighbors, ConstDoubles2 positions, double amount, Doubles scratch,
    Doubles2 smoothed);
/* A position in single precision, and a number more. */
typedef float FourSingles __attribute__((vector_size(16), aligned(4), may_alias));
/* Places of cells after rounds of smoothing, at rows of rings (`find_rings`): each round leaves out one ring more. All
 * vertices take part in each round where `rows` has no array. `scratch` has eight numbers a vertex. */
const FourSingles *prolong_rows(ConstInts offsets, ConstInts neighbors, ConstInts own, ConstDoubles2 places,
    int64_t rounds, ConstInts rows, ConstLongs ends, Singles scratch);
int64_t prolong(ConstInts offsets, ConstInts neighbors, ConstInts own, ConstDoubles2 places, int64_t rounds,
    Singles scratch, Doubles2 positions);
/* What the filter sums (M 12.3): p_2 to p_5. */
enum { DEGREE = 5, POWERS = DEGREE - 1 };
void filter_polynomial(double amount, double *powers);
int64_t find_rings(ConstInts offsets, ConstInts neighbors, Ints number, ConstInts vertices, Ints rows, Longs starts);
/* Rows of vertices, ring by ring around the first of them, where each ring begins, and the rows of all vertices. */
typedef struct {
    ConstInts number, rows;
    ConstLongs starts;
} Rings;

void filter_rows(ConstInts offsets, ConstInts neighbors, Rings rings, ConstDoubles2 positions, ConstDoubles weights,
    Doubles2 current, Doubles2 following, Doubles2 smoothed);
int64_t local_frames(ConstDoubles2 positions, ConstInts2 faces, Doubles2 frames);
int64_t tangent_steps(ConstDoubles2 positions, ConstInts2 faces, double step, double ratio, Doubles2 scratch,
                      Doubles steps);
int64_t add_heights(Doubles2 positions, ConstDoubles2 frames, ConstInts2 levels, double step);
int64_t add_slides(Doubles2 positions, ConstDoubles2 frames, ConstInts2 levels, ConstDoubles steps);
