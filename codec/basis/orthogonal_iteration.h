#ifndef BSM_ORTHOGONAL_ITERATION_H
#define BSM_ORTHOGONAL_ITERATION_H

#include "codec/basis/solver/solver.h"

int64_t LEVEL(iteration_space)(int64_t n, int64_t c);
double LEVEL(iterate)(Fronts fronts, Doubles values, ConstDoubles inverse, ConstDoubles2 start, int64_t power, int64_t iterations,
               double once, Doubles scratch, Doubles2 subspace);
double LEVEL(cholesky_onorm)(ConstDoubles2 columns, double once, Doubles scratch, Doubles2 subspace);

#endif
