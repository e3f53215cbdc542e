/* Which of the compiled levels of a kernel runs: the best that the processor has. */
#ifdef KERNEL_LEVELS

#include "codec/basis/basis.h"
#include "codec/sequence/kernels.h"
#include "codec/signal/signal.h"

#define CHOOSE(result, name, parameters, arguments)                                                                    \
    result name##_v1 parameters;                                                                                       \
    result name##_v3 parameters;                                                                                       \
    result name##_v4 parameters;                                                                                       \
    result name parameters {                                                                                           \
        if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&                                 \
            __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512bw"))                                  \
            return name##_v4 arguments;                                                                                \
        if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi2"))         \
            return name##_v3 arguments;                                                                                \
        return name##_v1 arguments;                                                                                    \
    }

CHOOSE(void, cosines, (int64_t first, Doubles table, Doubles2 columns), (first, table, columns))
CHOOSE(void, resize_columns, (ConstDoubles2 previous, Doubles table, Doubles2 columns), (previous, table, columns))
CHOOSE(int64_t, iteration_space, (int64_t n, int64_t c), (n, c))
CHOOSE(double, iterate,
       (Fronts fronts, Doubles values, ConstDoubles inverse, ConstDoubles2 start, int64_t power, int64_t iterations,
        double once, Doubles scratch, Doubles2 subspace),
       (fronts, values, inverse, start, power, iterations, once, scratch, subspace))
CHOOSE(double, cholesky_onorm, (ConstDoubles2 columns, double once, Doubles scratch, Doubles2 subspace),
       (columns, once, scratch, subspace))
CHOOSE(int64_t, completion_space, (int64_t h), (h))
CHOOSE(int64_t, complete_columns, (ConstDoubles2 first, double least_pivot, Doubles scratch, Doubles2 whole),
       (first, least_pivot, scratch, whole))
CHOOSE(void, factorize_fronts,
       (ConstInts offsets, ConstInts neighbours, ConstDoubles weights, ConstDoubles diagonal, Fronts fronts, Words column,
        Doubles scratch, Doubles values, Doubles inverse),
       (offsets, neighbours, weights, diagonal, fronts, column, scratch, values, inverse))
CHOOSE(void, solve_columns,
       (Fronts fronts, Doubles values, ConstDoubles inverse, ConstDoubles2 columns, int64_t power, Doubles scratch,
        Doubles2 solution),
       (fronts, values, inverse, columns, power, scratch, solution))
CHOOSE(void, project, (ConstDoubles2 subspace, ConstDoubles2 values, Doubles2 coefficients),
       (subspace, values, coefficients))
CHOOSE(int64_t, show_frames, (ConstDoubles2 field, int64_t first, ConstDoubles2 weights, Doubles2 frames),
       (field, first, weights, frames))
CHOOSE(void, reconstruct, (ConstDoubles2 subspace, ConstDoubles2 coefficients, Doubles2 values),
       (subspace, coefficients, values))

#else

typedef int one_level_needs_no_choice;

#endif
