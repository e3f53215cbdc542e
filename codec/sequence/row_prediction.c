/* Prediction of the rows of a block in closed loop, from their levels (specification, S 6).
 *
 * The columns of a row are known one after the other; each known one moves what is expected of those behind it, by the
 * Cholesky factor of the second moments of the rows before.
 */
#include "codec/sequence/row_prediction.h"

#include "bitstream/coefficients/coefficients.h"

/* Go through all rows: fills `decoded`. `factor`, `row` and `expected`, of the shape of `moments` and as long as its rows,
 * are scratch. */
KERNEL void follow_rows(ConstDoubles2 known, ConstInts2 levels, Doubles2 decoded, Doubles2 moments, double step,
    PredictionRules rules, Doubles2 factor, Doubles row, Doubles expected) {
    int64_t count = known.columns, size = moments.rows, width = moments.columns, coded = width - count;
    double *expect = expected.data, *now = row.data, half_step = 0.5 * step;
    int state = 0;
    for (int64_t j = 0; j < levels.rows; j++) {
        if (is_renewed(rules, j)) factorize_moments(moments, rules.ridge, factor.data);
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
        learn_row(moments, rules, step, j, now);
    }
}

/* Fills `moments` with what a loop begins with: how a field follows from `known` at vertices around, a row for each, all
 * of which together count as `rules.around` rows of the block. `mean` and `row`, as long as rows of `moments`, are scratch. */
KERNEL void learn_around(ConstDoubles2 known, ConstDoubles2 field, Doubles2 moments, double step, PredictionRules rules,
    Doubles mean, Doubles row) {
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
    double weight = rules.around / ((double)known.rows * rules.noise * step * step + energy);
    for (int64_t i = 0; i < moments.rows * width; i++) moments.data[i] *= weight;
}
