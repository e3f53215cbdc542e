/* Whether this build, on this processor, computes as IEEE 754 has it; codec/basis/exact.simd.c looks at vectors. */
#include "library/arithmetic.h"

#include "codec/basis/basis.h"

#if !defined(__wasm__)

/* Numbers that the compiler does not know, so that it computes nothing beforehand. */
static const volatile double ONE_LATE = 1.0, DIVISOR_LATE = 49.0;

/* `half`: half of what 1 and the next number are apart. `near`: (1 + near) (1 - near) is rounded to 1. */
#define CHECK(Type, half, near, least_normal)                                                                          \
    do {                                                                                                               \
        Type one = (Type)ONE_LATE, h = half * one, above = one + near * one, below = one - near * one;                 \
        Type fused = above * below - one, wide = (one + h) + h - one, up = one + h / 2 - one;                          \
        Type nearest = one + h * 3 / 2 - one - 2 * h, normal = least_normal * one, small = normal / 2;                 \
        exact = exact && fused == 0 && wide == 0 && up == 0 && -one - h / 2 == -one && nearest == 0;                   \
        exact = exact && small > 0 && small + small == normal && small * 2 == normal;                                  \
    } while (0)

/* Compiled as kernels are, for processors that could fuse. */
KERNEL static bool are_numbers_exact(void) {
    bool exact = true;
    CHECK(double, 0x1p-53, 0x1p-27, DBL_MIN);
    CHECK(float, 0x1p-24f, 0x1p-13f, FLT_MIN);
    return exact;
}

/* Division is not by reciprocals; infinities, and the sign of zero, mean something. */
KERNEL static bool are_all_numbers_used(void) {
    double one = ONE_LATE, divisor = DIVISOR_LATE, none = one - one, infinite = one / none, minus_none = -none,
        quotient[3];
    for (int i = 0; i < 3; i++) quotient[i] = (double)(i + 1) * divisor / divisor;
    bool divides = quotient[0] == 1 && quotient[1] == 2 && quotient[2] == 3;
    return divides && !(infinite - infinite == 0) && one / (minus_none + none) > 0;
}

bool is_exact(void) { return are_numbers_exact() && are_all_numbers_used() && are_vectors_exact(); }

#endif
