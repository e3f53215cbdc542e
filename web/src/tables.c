/* The tables of `bitstream/entropy/tables.c` and `bitstream/fields/tables.c`, computed: so nobody has to fetch them.
 *
 * No entry is nearer than 0.0001 to where rounding changes (specification, C 2.1, V 14.3); what is computed here is off
 * by less than 0.00000001. `scripts/kernels.mjs` compares all of them. */
#include <stdint.h>

uint16_t SQUASH[5760], RECIPROCAL[1024];
int16_t STRETCH[4096], ODDS[544], LESS[544];
int32_t SURVIVAL[1025];

/* e^x - 1, also where that is small. */
static double growth(double x) {
    double term = x /= 4096, sum = 0;
    for (int k = 2; k < 10; k++) {
        sum += term;
        term *= x / k;
    }
    for (int k = 0; k < 12; k++) sum *= sum + 2;
    return sum;
}

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

static int16_t limited(double x) { return (int16_t)rounded(x > 4000 ? 4000 : x < -4000 ? -4000 : x); }

/* Those that all kernels have. */
void make_tables(void) {
    double power = 1 + growth(11.25), step = 1 + growth(-1. / 256);
    for (int i = 0; i < 5760; i++) {
        int32_t share = rounded(65536 / (1 + power));
        SQUASH[i] = (uint16_t)(share < 1 ? 1 : share > 65535 ? 65535 : share);
        power *= step;
    }
    for (int j = 2048, x = 0; j < 4096; j++) {
        while (SQUASH[x + 2880] < 16 * j + 8) x++;
        STRETCH[j] = (int16_t)x;
        STRETCH[4095 - j] = (int16_t)-x;
    }
    for (int n = 0; n < 1024; n++) RECIPROCAL[n] = (uint16_t)(131072 / (2 * n + 3));
}

/* Those of what is coded by a model of values. */
void make_value_tables(void) {
    static const double SCALES[] = {16, 4, 1.5, 1, 1. / 3}, WEIGHTS[] = {1, 2, 4, 1, 1};
    double powers[5], steps[5];
    for (int k = 0; k < 5; k++) {
        powers[k] = 1 + growth(16 * SCALES[k]);
        steps[k] = 1 + growth(SCALES[k] / -32);
    }
    for (int i = 1024; i >= 0; i--) {
        double tail = 0;
        for (int k = 0; k < 5; k++) {
            tail += WEIGHTS[k] / (1 + powers[k]);
            powers[k] *= steps[k];
        }
        SURVIVAL[i] = rounded(-65536 * logarithm(tail / 9));
    }
    for (int i = 0; i < 544; i++) {
        double d = (i < 1 ? 0.5 : i < 32 ? i : (32 + i % 32 + 0.5) * (1 << (i / 32)) / 2) / 65536;
        double odds = logarithm(growth(d));
        ODDS[i] = limited(256 * odds);
        LESS[i] = limited(256 * (odds - d));
    }
}
