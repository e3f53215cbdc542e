/* The tables of models of values (specification, V 14). */
#include "bitstream/fields/fields.h"

INSIDE int32_t SURVIVAL[2 * SURVIVAL_REACH + 1];
INSIDE int16_t ODDS[ODDS_SIZE], LESS[ODDS_SIZE];

static double logarithm(double x) {
    double sum = 0;
    for (; x > 1.4; x /= 2) sum += 0.6931471805599453;
    for (; x < 0.7; x *= 2) sum -= 0.6931471805599453;
    double t = (x - 1) / (x + 1), term = 2 * t;
    for (int k = 1; k < 24; k += 2) {
        sum += term / k;
        term *= t * t;
    }
    return sum;
}

static int32_t rounded(double x) { return (int32_t)__builtin_floor(x + 0.5); }

static int16_t entry_of(double odds) {
    odds *= 256;
    return (int16_t)rounded(odds > 4000 ? 4000 : odds < -4000 ? -4000 : odds);
}

static void make_value_tables(void) {
    static const double SCALES[] = {16, 4, 1.5, 1, 1. / 3}, WEIGHTS[] = {1, 2, 4, 1, 1};
    double powers[5], steps[5];
    for (int k = 0; k < 5; k++) {
        powers[k] = 1 + growth(16 * SCALES[k]);
        steps[k] = 1 + growth(SCALES[k] / -32);
    }
    for (int i = 2 * SURVIVAL_REACH; i >= 0; i--) {
        double tail = 0;
        for (int k = 0; k < 5; k++) {
            tail += WEIGHTS[k] / (1 + powers[k]);
            powers[k] *= steps[k];
        }
        SURVIVAL[i] = rounded(-65536 * logarithm(tail / 9));
    }
    for (int i = 0; i < ODDS_SIZE; i++) {
        double d = (i < 1 ? 0.5 : i < 32 ? i : (32 + i % 32 + 0.5) * (1 << (i / 32)) / 2) / 65536;
        double odds = logarithm(growth(d));
        ODDS[i] = entry_of(odds);
        LESS[i] = entry_of(odds - d);
    }
}

void make_tables(void) {
    enum { EMPTY, UNDER_WAY, FULL };
    static int state;
    int before = EMPTY;
    if (__atomic_compare_exchange_n(&state, &before, UNDER_WAY, false, __ATOMIC_ACQUIRE, __ATOMIC_ACQUIRE)) {
        make_mixer_tables();
        make_value_tables();
        __atomic_store_n(&state, FULL, __ATOMIC_RELEASE);
    }
    while (__atomic_load_n(&state, __ATOMIC_ACQUIRE) != FULL) {}
}
