/* Prediction of the rows of a block in closed loop, from their levels (specification, S 6), and the choice of levels.
 *
 * The columns of a row are known one after the other; each known one moves what is expected of those behind it, by the
 * Cholesky factor of the second moments of the rows before.
 */
#include "bitstream/coefficients/coefficients.h"
#include "codec/sequence/temporal.h"

/* How much the past counts, per row, in the weights of the prediction; their regularization; energy in squared steps
 * that is added to that of a row before the row is weighed by the inverse of it (half costs 0.3 %, twice saves 0.1 %);
 * and as many rows the vertices around a block count for, together, before its first row. */
static const double FORGETTING = 0.985, RIDGE = 0.004, NOISE = 30, AROUND = 30;
/* First rows of a block, each with its own weights; after them the weights are made anew every `RENEWAL` rows. */
enum { DENSE_ROWS = 16, RENEWAL = 8 };

/* Rows of the Cholesky factor of moments + ridge I, extended over all columns. */
INLINE void factorize_moments(Doubles2 moments, double ridge, double *factor) {
    int64_t size = moments.rows, width = moments.columns;
    for (int64_t a = 0; a < size; a++) {
        double *row = factor + a * width;
        for (int64_t b = a; b < width; b++) row[b] = moments.data[a * width + b];
        row[a] += ridge;
        for (int64_t k = 0; k < a; k++) {
            const double *before = factor + k * width;
            double share = before[a];
            for (int64_t b = a; b < width; b++) row[b] -= share * before[b];
        }
        double root = __builtin_sqrt(row[a]);
        for (int64_t b = a; b < width; b++) row[b] /= root;
    }
}

/* Whether the weights of the prediction are made anew before row j. */
INLINE bool is_renewed(int64_t j) { return j < DENSE_ROWS || j % RENEWAL == 0; }

/* What is expected of the columns behind b, which is `surprise` off, given what was: `before`, or `after` itself. */
INLINE void expect_apart(
    const double *factor, int64_t width, int64_t b, double surprise, const double *before, double *after) {
    const double *line = factor + b * width;
    surprise /= line[b];
    for (int64_t c = b + 1; c < width; c++) after[c] = before[c] + surprise * line[c];
}

/* Let column b, which is `surprise` off, move what is expected of those behind it. */
INLINE void expect_behind(const double *factor, int64_t width, int64_t b, double surprise, double *expect) {
    expect_apart(factor, width, b, surprise, expect, expect);
}

/* Learn from row j, whose columns are all known. */
INLINE void learn_row(Doubles2 moments, double step, int64_t j, const double *now) {
    if (j == 0) return;
    double energy = NOISE * step * step;
    for (int64_t b = 0; b < moments.columns; b++) energy += now[b] * now[b];
    double weight = 1.0 / energy;
    for (int64_t a = 0; a < moments.rows; a++) {
        double share = weight * now[a], *line = moments.data + a * moments.columns;
        for (int64_t b = a; b < moments.columns; b++) line[b] = FORGETTING * line[b] + share * now[b];
    }
}

/* Go through all rows: fills `decoded`. `factor`, `row` and `expected`, of the shape of `moments` and as long as its
 * rows, are scratch. */
KERNEL void follow_rows(ConstDoubles2 known, ConstInts2 levels, Doubles2 decoded, Doubles2 moments, double step,
    Doubles2 factor, Doubles row, Doubles expected) {
    int64_t count = known.columns, size = moments.rows, width = moments.columns, coded = width - count;
    double *expect = expected.data, *now = row.data, half_step = 0.5 * step;
    int state = 0;
    for (int64_t j = 0; j < levels.rows; j++) {
        if (is_renewed(j)) factorize_moments(moments, RIDGE, factor.data);
        for (int64_t b = 0; b < width; b++) expect[b] = 0.0;
        for (int64_t b = 0; b < width; b++) {
            if (b < count) {
                now[b] = known.data[j * count + b];
            } else {
                int32_t level = levels.data[j * coded + b - count];
                now[b] = expect[b] + trellis_point(state, level) * half_step;
                state = trellis_following(state, level);
                decoded.data[j * coded + b - count] = now[b];
            }
            if (b < size) expect_behind(factor.data, width, b, now[b] - expect[b], expect);
        }
        learn_row(moments, step, j, now);
    }
}

/* Fills `moments` with what a loop begins with: how a field follows from `known` at vertices around, a row for each,
 * all of which together count as `AROUND` rows of the block. `mean` and `row`, as long as rows of `moments`, are
 * scratch. */
KERNEL void learn_around(ConstDoubles2 known, ConstDoubles2 field, Doubles2 moments, double step, Doubles mean,
    Doubles row) {
    int64_t count = known.columns, width = moments.columns, coded = width - count;
    double energy = 0.0, *now = row.data;
    for (int64_t i = 0; i < moments.rows * width; i++) moments.data[i] = 0.0;
    if (known.rows == 0) return;
    for (int64_t b = 0; b < width; b++) mean.data[b] = 0.0;
    for (int64_t j = 0; j < known.rows; j++) {
        for (int64_t b = 0; b < count; b++) mean.data[b] += known.data[j * count + b];
        for (int64_t b = 0; b < coded; b++) mean.data[count + b] += field.data[j * coded + b];
    }
    for (int64_t b = 0; b < width; b++) mean.data[b] /= (double)known.rows;
    for (int64_t j = 0; j < known.rows; j++) {
        for (int64_t b = 0; b < count; b++) now[b] = known.data[j * count + b] - mean.data[b];
        for (int64_t b = count; b < width; b++) now[b] = field.data[j * coded + b - count] - mean.data[b];
        for (int64_t b = 0; b < width; b++) energy += now[b] * now[b];
        for (int64_t a = 0; a < moments.rows; a++) {
            double *line = moments.data + a * width;
            for (int64_t b = a; b < width; b++) line[b] += now[a] * now[b];
        }
    }
    double weight = AROUND / ((double)known.rows * NOISE * step * step + energy);
    for (int64_t i = 0; i < moments.rows * width; i++) moments.data[i] *= weight;
}

/* The best way through the trellis of each row (an encoder's choice, no part of the format): for each state the way
 * survives that has the least squared error and price of bits, with expectations of its own for the columns behind. At
 * the end of a row the best survivor stays: what the rows behind are predicted from.
 */

enum { STATES = TRELLIS_STATES, BIT_UNIT = 256, PRICED = 6 };
/* Squared steps that a bit is worth. At the same error 0.1 takes as many bytes, 0.03 and 0.15 take 1 % more; at the
 * same look 0.1 takes up to 4 % more: levels of 0 blur shades. */
static const double WEIGHT = 0.05;
#define NEVER __builtin_inf()

/* What magnitudes cost on either grid, in 1 / BIT_UNIT of a bit, by the class of what is known around them: means of
 * what the coder takes. */
static const int16_t PRICES[CLASSES][2][PRICED] = {
    {{10, 1900, 3200, 4100, 4300, 4300}, {30, 1400, 2900, 3800, 4000, 4000}},
    {{6, 2244, 3668, 4538, 4794, 4845}, {64, 1053, 2955, 3825, 4081, 4133}},
    {{23, 1624, 3081, 4082, 4419, 4607}, {131, 791, 2464, 3466, 3803, 3990}},
    {{37, 1295, 2678, 3750, 4192, 4445}, {185, 659, 2124, 3197, 3638, 3891}},
    {{52, 1150, 2502, 3608, 4076, 4345}, {238, 587, 1953, 3059, 3527, 3796}},
    {{84, 973, 2236, 3326, 3885, 4169}, {316, 519, 1704, 2793, 3352, 3636}},
    {{132, 805, 1922, 2933, 3587, 3887}, {423, 463, 1419, 2430, 3084, 3384}},
    {{217, 672, 1524, 2314, 2959, 3315}, {561, 452, 1128, 1918, 2563, 2919}},
    {{387, 591, 1125, 1630, 2127, 2473}, {738, 514, 882, 1386, 1883, 2230}},
    {{652, 645, 912, 1177, 1453, 1695}, {921, 696, 790, 1055, 1331, 1574}},
    {{1051, 899, 991, 1060, 1168, 1258}, {1098, 1014, 957, 1025, 1134, 1223}},
    {{1685, 1458, 1473, 1484, 1463, 1460}, {1447, 1650, 1472, 1483, 1463, 1460}},
};

/* Survivors of all states, side by side. */
typedef struct {
    double cost[STATES];
    const double *expect[STATES]; /* of a row's columns */
} Survivors;

/* Bits of a magnitude, in 1 / BIT_UNIT: those above what has a price cost two bits for each doubling. */
INLINE double price_of(const int16_t *prices, int32_t magnitude) {
    if (magnitude < PRICED) return prices[magnitude];
    int doublings = 31 - __builtin_clz((unsigned)magnitude);
    double part = (double)magnitude / (double)(UINT32_C(1) << doublings) - 1.0;
    return prices[PRICED - 1] + 2.0 * BIT_UNIT * (doublings + part - 2.25);
}

/* Of the levels around a target, and none: the cheapest even and the cheapest odd one behind what cost `before`. */
INLINE void weigh_levels(double before, double scaled, int grid, const int16_t *prices, double bit, double *even,
    double *odd, int32_t *levels) {
    double size_of = __builtin_fabs(scaled), halves = 0.5 * (size_of + grid), error = size_of - (2 - grid);
    int32_t sign = scaled < 0.0 ? -1 : 1;
    *even = before + size_of * size_of + bit * prices[0];
    levels[0] = 0;
    if (halves < 1.0) { /* none or one, mostly */
        *odd = before + error * error + bit * prices[1];
        levels[1] = sign;
        return;
    }
    halves = __builtin_floor(halves);
    int32_t below = (int32_t)(halves < LARGEST_LEVEL - 1 ? halves : LARGEST_LEVEL - 1);
    for (int32_t magnitude = below; magnitude < below + 2; magnitude++) {
        error = size_of - (2 * magnitude - grid);
        double cost = before + error * error + bit * price_of(prices, magnitude);
        if (magnitude & 1) {
            *odd = cost;
            levels[1] = sign * magnitude;
        } else if (!(*even < cost)) {
            *even = cost;
            levels[0] = sign * magnitude;
        }
    }
}

/* The prices at a place of a matrix, of which the rows above are there; `usual` is slow_i of S 4.3. */
INLINE const int16_t (*prices_at(Ints2 levels, ConstInts2 reference, int64_t j, int64_t i, int64_t usual))[PRICED] {
#define A(row, column) magnitude_at(levels.data, levels.rows, levels.columns, row, column)
#define B(row) magnitude_at(reference.data, reference.rows, levels.columns, row, i)
    return PRICES[class_of(2 * A(j - 1, i) + A(j - 2, i) + A(j - 3, i) + A(j - 1, i + 1) + A(j - 1, i - 1) + 2 * B(j)
        + B(j - 1) + B(j + 1) + (usual >> 4))];
#undef A
#undef B
}

/* Fills `levels` and `decoded` from `targets`, and moments as the decoder has them afterwards. `lead` and `stair`
 * are as of code_matrix. Scratch: `factor` and `row` as of follow_rows, `expected` of 2 STATES + 1 rows, for each coded
 * column an entry of `slow`, and a row of STATES of the others. */
KERNEL void search_rows(ConstDoubles2 known, ConstDoubles2 targets, ConstInts2 reference, int64_t lead, int64_t stair,
    Ints2 levels, Doubles2 decoded, Doubles2 moments, double step, Doubles2 factor, Doubles row,
    Doubles2 expected, Doubles2 values, Ints2 ways, Bytes2 origins, Longs slow) {
    int64_t count = known.columns, size = moments.rows, width = moments.columns, coded = width - count;
    double *now = row.data, half_step = 0.5 * step, bit = 4.0 * WEIGHT / BIT_UNIT;
    int state = 0;
    for (int64_t i = 0; i < coded; i++) slow.data[i] = 0;
    for (int64_t j = 0; j < levels.rows; j++) {
        if (is_renewed(j)) factorize_moments(moments, RIDGE, factor.data);
        Survivors both[2], *new = &both[0];
        for (int s = 0; s < STATES; s++) {
            new->cost[s] = s == state ? 0.0 : NEVER;
            new->expect[s] = expected.data;
        }
        for (int64_t b = 0; b < width; b++) expected.data[b] = 0.0;
        for (int64_t b = 0; b < count; b++) {
            now[b] = known.data[j * count + b];
            if (b < size) expect_behind(factor.data, width, b, now[b] - expected.data[b], expected.data);
        }
        for (int64_t i = 0; i < coded; i++) {
            int64_t b = count + i;
            double target = targets.data[j * coded + i];
            const int16_t(*here)[PRICED] = prices_at(levels, reference, j, i, slow.data[i]);
            int32_t *way = ways.data + STATES * i;
            uint8_t *origin = origins.data + STATES * i;
            double even[STATES], odd[STATES], *value = values.data + STATES * i;
            int32_t found[STATES][2];
            const Survivors *old = &both[i & 1];
            new = &both[~i & 1];
            for (int s = 0; s < STATES; s++) {
                double scaled = (target - old->expect[s][b]) / half_step;
                int grid = trellis_grid(s);
                weigh_levels(old->cost[s], scaled, grid, here[grid], bit, &even[s], &odd[s], found[s]);
                if (i >= lead + stair * j) odd[s] = NEVER;
            }
            double *room = expected.data + width * (1 + (i & 1 ? STATES : 0));
            _Pragma("GCC unroll 8") for (int s = 0; s < STATES; s++) {
                /* The states that lead here, and the parities of levels that do. */
                int one = s >> 1, other = one | STATES >> 1;
                int first = trellis_following(one, s & 1) & 1, second = trellis_following(other, s & 1) & 1;
                double cost = first ? odd[one] : even[one], rival = second ? odd[other] : even[other];
                int from = rival < cost ? other : one;
                new->cost[s] = rival < cost ? rival : cost;
                way[s] = rival < cost ? found[other][second] : found[one][first];
                origin[s] = (uint8_t)from;
                new->expect[s] = old->expect[from];
                value[s] = new->expect[s][b] + trellis_point(from, way[s]) * half_step;
            }
            for (int s = 0; s < STATES && b < size; s++) {
                if (new->cost[s] == NEVER) continue;
                expect_apart(factor.data, width, b, value[s] - new->expect[s][b], new->expect[s], room + width * s);
                new->expect[s] = room + width * s;
            }
        }
        int best = state;
        for (int s = 0; s < STATES; s++)
            if (new->cost[s] < new->cost[best]) best = s;
        state = best;
        for (int64_t i = coded; i-- > 0;) {
            int64_t at = STATES * i + best;
            levels.data[j * coded + i] = ways.data[at];
            decoded.data[j * coded + i] = now[count + i] = values.data[at];
            slow.data[i] += (64 * least(magnitude_of(ways.data[at]), 4096) - slow.data[i]) >> 2;
            best = origins.data[at];
        }
        learn_row(moments, step, j, now);
    }
}
