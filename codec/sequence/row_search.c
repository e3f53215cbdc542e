/* The best way through the trellis of each row of a closed loop (an encoder's choice, no part of the format).
 *
 * For each state of the trellis the way survives that has the least squared error and price of bits, with expectations of
 * its own for the columns behind. At the end of a row the best survivor stays: what the rows behind are predicted from.
 */
#include "codec/sequence/row_search.h"

#include "bitstream/coefficients/coefficients.h"

enum { STATES = TRELLIS_STATES, BIT_UNIT = 256, LARGEST_LEVEL = (1 << 23) - 1 };
#define NEVER __builtin_inf()

typedef struct {
    double cost;
    double *expect;
} Survivor;

/* Bits of a magnitude, in 1 / BIT_UNIT: those above what has a price cost two bits for each doubling. */
INLINE double price_of(const int16_t *prices, int32_t magnitude) {
    if (magnitude < PRICED) return prices[magnitude];
    int doublings = 31 - __builtin_clz((unsigned)magnitude);
    double part = (double)magnitude / (double)(UINT32_C(1) << doublings) - 1.0;
    return prices[PRICED - 1] + 2.0 * BIT_UNIT * (doublings + part - 2.25);
}

/* Fills `levels` and `decoded` from `targets`, and moments as the decoder has them afterwards. `prices` are those of
 * price_matrix, `weight` the squared steps that a bit is worth. Scratch: `factor` and `row` as of follow_rows, `expected` of
 * 2 STATES + 1 rows, and of a row of STATES for each coded column `values`, `ways` and `origins`. */
KERNEL void search_rows(ConstDoubles2 known, ConstDoubles2 targets, ConstShorts prices, double weight, Ints2 levels,
    Doubles2 decoded, Doubles2 moments, double step, PredictionRules rules, Doubles2 factor, Doubles row,
    Doubles2 expected, Doubles2 values, Ints2 ways, Bytes2 origins) {
    int64_t count = known.columns, size = moments.rows, width = moments.columns, coded = width - count;
    double *now = row.data, half_step = 0.5 * step, bit = 4.0 * weight / BIT_UNIT;
    int state = 0;
    for (int64_t j = 0; j < levels.rows; j++) {
        if (is_renewed(rules, j)) factorize_moments(moments, rules.ridge, factor.data);
        Survivor old[STATES], new[STATES];
        for (int s = 0; s < STATES; s++) new[s] = (Survivor){NEVER, 0};
        new[state] = (Survivor){0.0, expected.data};
        for (int64_t b = 0; b < width; b++) expected.data[b] = 0.0;
        for (int64_t b = 0; b < count; b++) {
            now[b] = known.data[j * count + b];
            if (b < size) expect_behind(factor.data, width, b, now[b] - expected.data[b], expected.data);
        }
        for (int64_t i = 0; i < coded; i++) {
            int64_t b = count + i;
            double target = targets.data[j * coded + i];
            const int16_t *here = prices.data + 2 * PRICED * (j * coded + i);
            int32_t *way = ways.data + STATES * i;
            uint8_t *origin = origins.data + STATES * i;
            for (int s = 0; s < STATES; s++) {
                old[s] = new[s];
                new[s].cost = NEVER;
            }
            for (int s = 0; s < STATES; s++) {
                if (old[s].cost == NEVER) continue;
                int grid = trellis_grid(s);
                double scaled = (target - old[s].expect[b]) / half_step, size_of = __builtin_fabs(scaled);
                double below = __builtin_floor(0.5 * (size_of + grid));
                if (!(below < LARGEST_LEVEL - 1)) below = LARGEST_LEVEL - 1;
                for (int candidate = 0; candidate < 3; candidate++) {
                    if (candidate == 2 && below == 0.0) break;
                    int32_t magnitude = candidate < 2 ? (int32_t)below + candidate : 0;
                    double error = size_of - trellis_point(s, magnitude);
                    double cost = old[s].cost + error * error + bit * price_of(here + PRICED * grid, magnitude);
                    int32_t level = scaled < 0.0 ? -magnitude : magnitude;
                    int after = trellis_following(s, level);
                    if (cost < new[after].cost) {
                        new[after].cost = cost;
                        way[after] = level;
                        origin[after] = (uint8_t)s;
                    }
                }
            }
            double *room = expected.data + width * (1 + (i & 1 ? STATES : 0));
            for (int s = 0; s < STATES; s++) {
                if (new[s].cost == NEVER) continue;
                double *before = old[origin[s]].expect;
                values.data[STATES * i + s] = before[b] + trellis_point(origin[s], way[s]) * half_step;
                new[s].expect = before;
                if (b >= size) continue;
                new[s].expect = room + width * s;
                expect_apart(factor.data, width, b, values.data[STATES * i + s] - before[b], before, new[s].expect);
            }
        }
        int best = state;
        for (int s = 0; s < STATES; s++)
            if (new[s].cost < new[best].cost) best = s;
        state = best;
        for (int64_t i = coded; i-- > 0;) {
            int64_t at = STATES * i + best;
            levels.data[j * coded + i] = ways.data[at];
            decoded.data[j * coded + i] = now[count + i] = values.data[at];
            best = origins.data[at];
        }
        learn_row(moments, rules, step, j, now);
    }
}
