/* The kernels of this room that are compiled for several levels of processors. */
#ifdef KERNEL_ISAS

#include "codec/basis/basis.h"
#include "codec/sequence/temporal.h"
#include "codec/signal/signal.h"

CHOOSE(bool, are_vectors_exact, (void), ())
CHOOSE_VOID(cosines, (Doubles table, Doubles2 columns), (table, columns))
CHOOSE_VOID(resize_columns, (ConstSingles2 previous, Doubles table, Singles2 columns), (previous, table, columns))
CHOOSE(int64_t, iteration_space, (int64_t n, int64_t c, int64_t apart), (n, c, apart))
CHOOSE(int64_t, iterate,
       (Fronts fronts, Singles values, ConstSingles inverse, ConstSingles2 start, int64_t power, int64_t iterations,
        int64_t apart, int64_t care, Singles scratch, Singles2 subspace),
       (fronts, values, inverse, start, power, iterations, apart, care, scratch, subspace))
CHOOSE(int64_t, completion_space, (int64_t h), (h))
CHOOSE(int64_t, complete_columns, (ConstSingles2 first, Singles scratch, Singles2 whole), (first, scratch, whole))
CHOOSE_VOID(factorize_fronts,
    (ConstInts offsets, ConstInts neighbors, ConstDoubles weights, ConstDoubles diagonal, Fronts fronts, Words column,
        Singles scratch, Singles values, Singles inverse),
       (offsets, neighbors, weights, diagonal, fronts, column, scratch, values, inverse))
CHOOSE_VOID(solve_columns,
       (Fronts fronts, Singles values, ConstSingles inverse, ConstDoubles2 columns, Singles scratch, Doubles2 solution),
       (fronts, values, inverse, columns, scratch, solution))
CHOOSE_VOID(project, (ConstSingles2 subspace, ConstDoubles2 values, Doubles2 coefficients),
       (subspace, values, coefficients))
CHOOSE(int64_t, show_frames, (ConstDoubles2 field, int64_t first, ConstDoubles2 weights, Doubles2 frames),
       (field, first, weights, frames))
CHOOSE(int64_t, turn_columns, (Doubles2 free, Doubles vector, Doubles shares), (free, vector, shares))
CHOOSE_VOID(reconstruct, (ConstSingles2 subspace, ConstDoubles2 coefficients, Doubles2 values),
       (subspace, coefficients, values))

#else

typedef int one_isa_needs_no_choice;

#endif
