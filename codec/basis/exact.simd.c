/* Whether vectors are computed as IEEE 754 has it, see bitstream/kernel.h; library/arithmetic.c looks at single
 * numbers. */
#include "codec/basis/vectors.h"

/* A number that the compiler does not know, so that it computes nothing beforehand. */
static const volatile float LATE_ONE = 1;

/* Lanes do not fuse products and sums, and keep numbers below the least normal one. */
bool ISA(are_vectors_exact)(void) {
    Vector ones;
    EACH(i, PARTS) ones.part[i] = spread(LATE_ONE);
    Vector above = add_scaled(ones, 0x1p-13f, ones), below = add_scaled(ones, -0x1p-13f, ones),
        fused = scaled(ones, -1);
    Vector least_normal = scaled(ones, FLT_MIN), small = scaled(least_normal, 0.5f), twice = sum_of(small, small);
    EACH(i, PARTS) fused.part[i] += above.part[i] * below.part[i];
    bool exact = true;
    for (int i = 0; i < WIDTH; i++) {
        int part = i / REGISTER, lane = i % REGISTER;
        exact = exact && fused.part[part][lane] == 0 && small.part[part][lane] > 0
            && twice.part[part][lane] == least_normal.part[part][lane];
    }
    return exact;
}
