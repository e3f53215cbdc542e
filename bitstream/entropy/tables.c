/* The tables of the mixer (specification, C 2.1, C 2.2, C 2.6), which take less room as a formula.
 *
 * Every entry, also of the tables of fields, is more than 0.0001 away from where rounding changes. These formulas have
 * errors below 0.00000001 on every processor. */
#include "bitstream/entropy/entropy.h"

INSIDE uint16_t SQUASH[2 * SQUASH_REACH];
INSIDE int16_t STRETCH[1 << STRETCH_BITS];
INSIDE uint16_t RECIPROCAL[1 << SLOT_COUNT_BITS];

double growth(double x) {
    double term = x /= 4096, sum = 0;
    for (int k = 2; k < 10; k++) {
        sum += term;
        term *= x / k;
    }
    for (int k = 0; k < 12; k++) sum *= sum + 2;
    return sum;
}

void make_mixer_tables(void) {
    enum { HALF = 1 << (STRETCH_BITS - 1), CELL = ONE >> STRETCH_BITS };
    double power = 1 + growth(SQUASH_REACH / 256.), step = 1 + growth(-1. / 256);
    for (int i = 0; i < 2 * SQUASH_REACH; i++) {
        int32_t share = (int32_t)(ONE / (1 + power) + 0.5);
        SQUASH[i] = (uint16_t)(share < 1 ? 1 : least(share, ONE - 1));
        power *= step;
    }
    for (int j = HALF, x = 0; j < 2 * HALF; j++) {
        while (SQUASH[x + SQUASH_REACH] < CELL * j + CELL / 2) x++;
        STRETCH[j] = (int16_t)x;
        STRETCH[2 * HALF - 1 - j] = (int16_t)-x;
    }
    for (int n = 0; n < 1 << SLOT_COUNT_BITS; n++) RECIPROCAL[n] = (uint16_t)(2 * ONE / (2 * n + 3));
}
